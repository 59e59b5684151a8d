"""The translation of each type of step, by cedar's categories."""

from __future__ import annotations

from collections.abc import Callable

from deodar_interop.importers.cedar.classes import (
    algebra,
    arrays,
    fields,
    functions,
    hebbian,
    numerics,
    oscillators,
    programming,
    rate_matrix,
    robotics,
    serial_order,
    sources,
    synaptic,
    vision,
)
from deodar_interop.importers.cedar.piece import SourceStep, StepPiece

CLASSES: dict[str, Callable[[SourceStep], StepPiece]] = {
    **fields.CLASSES,
    **rate_matrix.CLASSES,
    **sources.CLASSES,
    **hebbian.CLASSES,
    **serial_order.CLASSES,
    **algebra.CLASSES,
    **synaptic.CLASSES,
    **functions.CLASSES,
    **arrays.CLASSES,
    **programming.CLASSES,
    **numerics.CLASSES,
    **oscillators.CLASSES,
    **robotics.CLASSES,
    **vision.CLASSES,
}

DECLARED = frozenset(
    {
        "cedar.dynamics.NeuralField",
        "cedar.dynamics.Preshape",
        "cedar.dynamics.HebbianConnection",
        "cedar.dynamics.SerialOrder",
        "cedar.dynamics.HarmonicOscillator",
        "cedar.processing.steps.Timer",
        "cedar.processing.sources.Picture",
        "cedar.processing.sources.Video",
        "cedar.processing.sources.Camera",
        "cedar.processing.sources.CameraStream",
        "cedar.processing.sources.SinusSignal",
        "cedar.processing.sources.StepSignal",
        *sources.CLASSES,
        *oscillators.CLASSES,
    }
)
"""Types whose outputs have sizes of their own, whatever arrives."""

LOOPED = frozenset(
    {
        f"cedar.dynamics.{name}"
        for name in (
            "NeuralField",
            "Preshape",
            "HebbianConnection",
            "SpaceToRateCode",
            "SerialOrder",
            "HarmonicOscillator",
            "CSVToPhoneme",
            "LogTimeInterval",
            "ViewportCamera",
            "ViewportSlice",
        )
    }
    | {
        f"cedar.processing.steps.{name}"
        for name in (
            "Component",
            "ConfigurationLimits",
            "DNN",
            "PseudoInverseKinematics",
            "DampedPseudoInverseKinematics",
            "ExponentialSmoothing",
            "ForwardKinematics",
            "Jacobian",
            "NoopLooped",
            "NumericalDifferentiation",
            "NumericalIntegration",
            "PythonScriptLooped",
            "VehicleRotation",
        )
    }
    | {
        f"cedar.processing.sources.{name}"
        for name in (
            "SinusSignal",
            "StepSignal",
            "Camera",
            "Video",
            "CameraStream",
            "LocalReader",
            "NetReader",
            "TCPReader",
            "Noise",
            "RealSense",
            "VirtualCamera",
        )
    }
    | {f"cedar.processing.sinks.{name}" for name in ("LocalWriter", "NetWriter", "TCPWriter")}
    | {"cedar.processing.VideoSink", "cedar.dynamics.steps.TwoStepInput"}
)
"""Types that have a state, which triggers call; all others follow from them."""
