"""Earlier names of types and parameters, and the present ones."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from deodar.codec import collect

KINDS = {
    "cedar.processing.source.BoxInput": "cedar.processing.sources.BoxInput",
    "cedar.processing.source.ConstDiagonalMatrix": "cedar.processing.sources.ConstDiagonalMatrix",
    "cedar.processing.source.ConstMatrix": "cedar.processing.sources.ConstMatrix",
    "cedar.processing.source.GaussInput": "cedar.processing.sources.GaussInput",
    "cedar.dynamics.Noise": "cedar.processing.sources.Noise",
    "cedar.processing.Sigmoid": "cedar.processing.TransferFunction",
    "cedar.processing.steps.CountLarger": "cedar.processing.steps.Count",
    "cedar.processing.steps.VehicleRotationStep": "cedar.processing.steps.VehicleRotation",
    # renamed without an alias: cedar itself refuses these
    "cedar.processing.steps.LinearDynamics": "cedar.processing.steps.LinearFunction",
    "cedar.processing.steps.SinusDynamics": "cedar.processing.steps.Sinus",
    "cedar.processing.steps.RotationOnPlane": "cedar.processing.steps.AnglesOnPlane",
    "cedar.processing.steps.ForceLet": "cedar.processing.steps.VehicleObstacleAvoidanceForceLet",
}
"""Earlier ids of types, and the present ones."""

FIELD = {
    "restingLevel": "resting level",
    "tau": "time scale",
    "globalInhibition": "global inhibition",
    "inputNoiseGain": "input noise gain",
    "lateralKernels": "lateral kernels",
    "noiseCorrelationKernel": "noise correlation kernel",
}
"""Parameters of very old fields; cedar itself ignores these names."""

PARAMETERS: Mapping[str, Mapping[str, str]] = {
    "cedar.dynamics.NeuralField": FIELD,
    "cedar.processing.TransferFunction": {"sigmoid": "function"},
    "cedar.dynamics.HebbianConnection": {
        "input dimension": "source dimension",
        "input sizes": "source sizes",
        "association dimension": "target dimension",
        "association sizes": "target sizes",
    },
}

GAUSS = "cedar.aux.kernel.Gauss"
MOST_KERNELS = 100
"""Largest number of kernels of a very old field (a guess)."""


def renamed(kind: str, values: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the parameters of a step under their present names."""
    names = PARAMETERS.get(kind)
    if names is None:
        return values
    out = {key: value for key, value in values.items() if key not in names}
    for old, new in names.items():
        if old in values:
            out.setdefault(new, values[old])
    if "numberOfKernels" in out:
        out = _numbered(out)
    return out


def _numbered(values: dict[str, Any]) -> dict[str, Any]:
    """Return the parameters with `lateralKernel0`, `lateralKernel1`, ... as a list of kernels."""
    kernels = [values.pop(name) for k in range(MOST_KERNELS) if (name := f"lateralKernel{k}") in values]
    count = str(values.pop("numberOfKernels"))
    counted = kernels[: int(count)] if count.isdigit() else kernels
    values.setdefault("lateral kernels", collect([(GAUSS, kernel) for kernel in counted]))
    return values
