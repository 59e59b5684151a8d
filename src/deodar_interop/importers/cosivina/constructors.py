"""What each class of cosivina takes and offers: its arguments after the label in order, with their defaults,
and the components that elements, plots and scripts read.

Components are in cosivina's order. A class that is not listed has one component, `output`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

KERNEL = ("kernel", "output")
SUMS = ("horizontalSum", "verticalSum", "fullSum")
"""Components that are sums of the input."""

PHASE_PLOT = (
    "samplingPoints",
    "sampledRatesOfChange",
    "attractorStates",
    "attractorRatesOfChange",
    "repellorStates",
    "repellorRatesOfChange",
)

COMPONENTS: Mapping[str, tuple[str, ...]] = {
    "NeuralField": ("activation", "output", "h"),
    "SingleNodeDynamics": ("input", "activation", "output", "h", "rateOfChange", *PHASE_PLOT),
    "DynamicVariable": ("state", "initialState"),
    "MemoryTrace": ("activeRegions", "output"),
    "GaussKernel1D": KERNEL,
    "GaussKernel2D": ("kernelX", "kernelY", "output"),
    "GaussKernel3D": ("kernelX", "kernelY", "kernelZ", "output"),
    "MexicanHatKernel1D": KERNEL,
    "MexicanHatKernel2D": ("kernelExcY", "kernelExcX", "kernelInhY", "kernelInhX", "output"),
    "MexicanHatKernel3D": (
        "kernelExcY",
        "kernelExcX",
        "kernelExcZ",
        "kernelInhY",
        "kernelInhX",
        "kernelInhZ",
        "output",
    ),
    "LateralInteractions1D": ("kernel", "amplitudeGlobal", "fullSum", "output"),
    "LateralInteractions2D": (
        "kernelExcY",
        "kernelExcX",
        "kernelInhY",
        "kernelInhX",
        "amplitudeGlobal",
        "output",
        *SUMS,
    ),
    "LateralInteractions3D": (
        *("kernelExcY", "kernelExcX", "kernelExcZ", "kernelInhY", "kernelInhX", "kernelInhZ"),
        *("amplitudeGlobal", "output", "fullSum"),
    ),
    "LateralInteractionsShifted1D": ("kernel", "amplitudeGlobal", "fullSum", "output"),
    "LateralInteractionsDiscrete": ("amplitudeExc", "amplitudeGlobal", "output"),
    "KernelFFT": ("kernelFFT", "output"),
    "KernelInverseFFT": ("kernelFFT", "output"),
    "SumAllDimensions": SUMS,
    "ScalarToGaussian": ("output", "position"),
    "AdaptiveWeightMatrix": ("output", "weights"),
    "HebbianConnection": ("output", "reverse_output", "weights"),
}


def components(kind: str) -> tuple[str, ...]:
    """Return the components of a class."""
    return COMPONENTS.get(kind, ("output",))


SIZES = ("size", "inputSize", "outputSize", "stimulusSize")
FIXED: Mapping[str, tuple[str, ...]] = {
    "BoostStimulus": (),
    "CustomStimulus": ("size", "pattern"),
    "SumDimension": ("sumDimensions", "size", "dimensionOrder"),
    "ExpandDimension2D": ("expandDimension", "size"),
}
"""Parameters that `loadSettings` does not change, of classes in which they are not `SIZES`."""

SIZE = {"size": (1, 1)}
KERNEL_1D = {"circular": True, "normalized": True, "cutoffFactor": 5.0}
KERNEL_2D = {"circularY": True, "circularX": True, "normalized": True, "cutoffFactor": 5.0}
KERNEL_3D = {
    "circularY": True,
    "circularX": True,
    "circularZ": True,
    "normalized": True,
    "cutoffFactor": 5.0,
}
DIFFERENCE_1D = {"sigmaExc": 1.0, "amplitudeExc": 0.0, "sigmaInh": 1.0, "amplitudeInh": 0.0}
DIFFERENCE_2D = {
    "sigmaExcY": 1.0,
    "sigmaExcX": 1.0,
    "amplitudeExc": 0.0,
    "sigmaInhY": 1.0,
    "sigmaInhX": 1.0,
    "amplitudeInh": 0.0,
}
DIFFERENCE_3D = {
    **{"sigmaExcY": 1.0, "sigmaExcX": 1.0, "sigmaExcZ": 1.0, "amplitudeExc": 0.0},
    **{"sigmaInhY": 1.0, "sigmaInhX": 1.0, "sigmaInhZ": 1.0, "amplitudeInh": 0.0},
}
GLOBAL = {"amplitudeGlobal": 0.0}
FOURIER = {"sigmaExc": None, "amplitudeExc": 0.0, "sigmaInh": None, "amplitudeInh": 0.0, **GLOBAL}
GAUSS_1D = {"sigma": 1.0, "amplitude": 0.0, "position": 1.0}
GAUSS_2D = {"sigmaY": 1.0, "sigmaX": 1.0, "amplitude": 0.0, "positionY": 1.0, "positionX": 1.0}
GAUSS_3D = {
    **{"sigmaY": 1.0, "sigmaX": 1.0, "sigmaZ": 1.0, "amplitude": 0.0},
    **{"positionY": 1.0, "positionX": 1.0, "positionZ": 1.0},
}
RING_1D = {"circular": True, "normalized": False}
RING_2D = {"circularY": True, "circularX": True, "normalized": False}
RING_3D = {"circularY": True, "circularX": True, "circularZ": True, "normalized": False}

CONSTRUCTORS: Mapping[str, Mapping[str, Any]] = {
    "NeuralField": {**SIZE, "tau": 10.0, "h": -5.0, "beta": 4.0},
    "SingleNodeDynamics": {
        **{"tau": 10.0, "h": -5.0, "beta": 4.0, "selfExcitation": 0.0, "noiseLevel": 0.0},
        **{"range": (-10.0, 10.0), "resolution": 0.1},
    },
    "DynamicVariable": {**SIZE, "tau": 10.0, "initialState": None},
    "AttractorDynamics": {**SIZE, "amplitude": 0.0, "zeroPosition": None},
    "MemoryTrace": {**SIZE, "tauBuild": 100.0, "tauDecay": None, "threshold": 0.5},
    "GaussKernel1D": {**SIZE, "sigma": 1.0, "amplitude": 0.0, **KERNEL_1D},
    "GaussKernel2D": {**SIZE, "sigmaY": 1.0, "sigmaX": 1.0, "amplitude": 0.0, **KERNEL_2D},
    "GaussKernel3D": {**SIZE, "sigmaY": 1.0, "sigmaX": 1.0, "sigmaZ": 1.0, "amplitude": 0.0, **KERNEL_3D},
    "MexicanHatKernel1D": {**SIZE, **DIFFERENCE_1D, **KERNEL_1D},
    "MexicanHatKernel2D": {**SIZE, **DIFFERENCE_2D, **KERNEL_2D},
    "MexicanHatKernel3D": {**SIZE, **DIFFERENCE_3D, **KERNEL_3D},
    "LateralInteractions1D": {**SIZE, **DIFFERENCE_1D, **GLOBAL, **KERNEL_1D},
    "LateralInteractions2D": {**SIZE, **DIFFERENCE_2D, **GLOBAL, **KERNEL_2D},
    "LateralInteractions3D": {**SIZE, **DIFFERENCE_3D, **GLOBAL, **KERNEL_3D},
    "LateralInteractionsShifted1D": {**SIZE, **DIFFERENCE_1D, **GLOBAL, "shift": 0.0, **KERNEL_1D},
    "LateralInteractionsDiscrete": {**SIZE, "amplitudeExc": 0.0, **GLOBAL},
    "KernelFFT": {**SIZE, **FOURIER, "circular": None, "normalized": True, "paddingFactor": 5.0},
    "FastFourierTransform": SIZE,
    "KernelInverseFFT": {**SIZE, **FOURIER, "normalized": True},
    "Convolution": {**SIZE, "flipFirst": False, "flipSecond": False, "shape": "same"},
    "GaussStimulus1D": {**SIZE, **GAUSS_1D, **RING_1D},
    "GaussStimulus2D": {**SIZE, **GAUSS_2D, **RING_2D},
    "GaussStimulus3D": {**SIZE, **GAUSS_3D, **RING_3D},
    "BoostStimulus": {"amplitude": 0.0},
    "CustomStimulus": {"pattern": None},
    "CustomStimulusSequence": {"stimulusPatterns": None, "startTimes": None},
    "TimedGaussStimulus1D": {**SIZE, **GAUSS_1D, "onTimes": None, **RING_1D},
    "TimedGaussStimulus2D": {**SIZE, **GAUSS_2D, "onTimes": None, **RING_2D},
    "TimedCustomStimulus": {"stimulusPattern": None, "onTimes": None},
    "TimedBoost": {"amplitude": 0.0, "onTimes": None},
    "TimedSwitch": {**SIZE, "onTimes": None},
    "NormalNoise": {**SIZE, "amplitude": 0.0},
    "SumInputs": SIZE,
    "ScaleInput": {**SIZE, "amplitude": 0.0},
    "PointwiseProduct": SIZE,
    "HalfWaveRectification": SIZE,
    "Sigmoid": {**SIZE, "beta": 1.0, "threshold": 0.0},
    "Transpose": SIZE,
    "SumDimension": {"sumDimensions": (1,), **SIZE, "amplitude": 1.0, "dimensionOrder": None},
    "SumAllDimensions": SIZE,
    "ExpandDimension2D": {"expandDimension": 1, **SIZE},
    "ExpandDimension": {"inputSize": (1, 1), "outputSize": (1, 1), "dimensionMapping": 2},
    "DiagonalExpansion": {"inputSize": (1, 1), "amplitude": 0.0},
    "DiagonalSum": {"inputSize": (1, 1), "amplitude": 0.0},
    "ShiftInput": {**SIZE, "shiftValue": (0, 0), "amplitude": 0.0, "circular": False, "fillValue": 0.0},
    "Interpolation1D": {"interpolationPoints": None, "method": "linear", "extrapValue": 0.0},
    "ScalarToGaussian": {
        **{**SIZE, "inputScale": 1.0, "inputOffset": 0.0, "sigma": 1.0, "amplitude": 0.0},
        **RING_1D,
    },
    "WeightMatrix": {"weights": None},
    "AdaptiveWeightMatrix": {**SIZE, "learningRate": 0.1},
    "HebbianConnection": {
        **{"learningRate": 0.1, "rewardDuration": (-1.0, -1.0), "tau": 1.0, "tauDecay": 1.0},
        **{"biDirectional": "FALSE", "instar": 0, "manualWeights": None},
    },
    "History": {**SIZE, "storingTimes": None},
    "RunningHistory": {**SIZE, "timeSlots": 1, "interval": 1.0},
    "LFP": {"timeSlots": 1, "interval": 1.0},
    "ImageLoader": {"filePath": "", "fileNames": None, **SIZE, "currentSelection": 1},
    "CameraGrabber": {"deviceNumber": 0, **SIZE},
    "ColorExtraction": {
        **{"roiX": None, "roiY": None, **SIZE, "hueToIndexMap": None},
        **{"saturationThreshold": None, "valueThreshold": None},
    },
    "MobileRobotArena": {
        **{"sensorOutputSize": (1, 180), "sensorOutputZeroPosition": 90.0, "flipSensorOutput": True},
        **{"robotPoseInit": (100.0, 20.0, 0.0), "sensorNoiseLevel": 0.1},
    },
    "DynamicRobotController": {"minWheelVelocity": None, "maxWheelVelocity": None},
}
"""The classes by name. None is a default that follows from other arguments, or no default at all."""

OUTPUTS: Mapping[str, str] = {
    "AttractorDynamics": "phiDot",
    "CameraGrabber": "image",
    "DynamicRobotController": "orientation",
    "DynamicVariable": "state",
    "ImageLoader": "image",
    "MobileRobotArena": "robotPhi",
    "SumAllDimensions": "fullSum",
}
"""The components that are read where none is named; of all other classes it is `output`."""

PATTERNS = {
    "CustomStimulus": "pattern",
    "TimedCustomStimulus": "stimulusPattern",
    "WeightMatrix": "weights",
    "Interpolation1D": "interpolationPoints",
}
"""The parameter whose shape is the size."""


def parameters_of(kind: str, arguments: Sequence[Any]) -> dict[str, Any]:
    """Return the parameters of an element after its constructor: arguments, and defaults for the others.

    Arguments are arrays of at least two dimensions, or text. A size of one number becomes a row, as in all
    constructors of cosivina.

    Args:
        kind: the class; of an unknown class the first argument is its size if it can be one.
        arguments: the arguments after the label.
    """
    if kind not in CONSTRUCTORS:
        return {"size": row(arguments[0])} if arguments and _is_size(arguments[0]) else {}
    names = CONSTRUCTORS[kind]
    values: dict[str, Any] = {**names, **dict(zip(names, arguments, strict=False))}
    for name in ("size", "inputSize", "outputSize", "sensorOutputSize"):
        if name in values:
            values[name] = row(values[name])
    if kind in PATTERNS and isinstance(values[PATTERNS[kind]], np.ndarray):
        values["size"] = values[PATTERNS[kind]].shape
    if kind in FOLLOWING:
        FOLLOWING[kind](values)
    return {name: value for name, value in values.items() if value is not None}


def row(size: Any) -> Any:
    """Return a size as at least two numbers: one number is the length of a row."""
    if isinstance(size, np.ndarray) and size.size == 1 and size.dtype.kind in "fib":
        return (1, size.item())
    return size


def _is_size(value: Any) -> bool:
    return (
        isinstance(value, np.ndarray)
        and value.dtype.kind in "fib"
        and 1 <= value.size <= 4
        and bool((value == np.round(value)).all() and (value >= 1).all())
    )


def _numbers(value: Any) -> list[float]:
    """Return the numbers of an array or a tuple; none for anything else."""
    try:
        return [float(v) for v in np.asarray(value).reshape(-1)]
    except (TypeError, ValueError):
        return []


def _memory_trace(values: dict[str, Any]) -> None:
    if values["tauDecay"] is None:
        values["tauDecay"] = values["tauBuild"]


def _sum_dimension(values: dict[str, Any]) -> None:
    if values["dimensionOrder"] is None:
        values["dimensionOrder"] = tuple(range(1, len(_numbers(values["size"])) + 1))


def _transform(values: dict[str, Any]) -> None:
    size = _numbers(values["size"])
    count = 1 if len(size) == 2 and 1 in size else len(size)
    for name in ("sigmaExc", "sigmaInh", "circular"):
        if name in values:
            flags = values[name]
            values[name] = np.ones((count, 1)) if flags is None else np.asarray(flags).reshape(-1, 1)


def _expand_dimension(values: dict[str, Any]) -> None:
    """A vector may give one number: the dimension that it becomes."""
    input_size, mapping = _numbers(values["inputSize"]), _numbers(values["dimensionMapping"])
    if input_size and all(n == 1 for n in input_size):
        values["dimensionMapping"] = tuple(range(1, len(input_size) + 1))
    elif len(mapping) == 1 and len(input_size) == 2:
        place = 2.0 if mapping[0] == 1 else 1.0
        values["dimensionMapping"] = tuple(mapping[0] if n > 1 else place for n in input_size)


def _diagonal_sum(values: dict[str, Any]) -> None:
    size = _numbers(values["inputSize"])
    if len(size) == 2 and size[0] == 1:
        values["inputSize"] = (size[1], size[1])


def _shift_input(values: dict[str, Any]) -> None:
    values["shiftValue"] = (0.0, *_numbers(values["shiftValue"]))


def _sequence(values: dict[str, Any]) -> None:
    patterns = values["stimulusPatterns"]
    if isinstance(patterns, np.ndarray):
        planes = patterns.ndim == 3
        values["stimulusSize"] = patterns.shape[:2] if planes else (1, patterns.shape[1])
        if values["startTimes"] is None:
            values["startTimes"] = tuple(range(1, patterns.shape[2 if planes else 0] + 1))


def _convolution(values: dict[str, Any]) -> None:
    first, second = (any(_numbers(values.pop(name))) for name in ("flipFirst", "flipSecond"))
    values["flipInputs"] = int(first) + 2 * int(second)


FOLLOWING: Mapping[str, Callable[[dict[str, Any]], None]] = {
    "MemoryTrace": _memory_trace,
    "SumDimension": _sum_dimension,
    "KernelFFT": _transform,
    "KernelInverseFFT": _transform,
    "ExpandDimension": _expand_dimension,
    "DiagonalSum": _diagonal_sum,
    "ShiftInput": _shift_input,
    "CustomStimulusSequence": _sequence,
    "Convolution": _convolution,
}
"""What the constructors derive from other arguments."""


def is_fixed(kind: str, parameter: str) -> bool:
    """Return whether `loadSettings` leaves a parameter of a class as it is."""
    return parameter in FIXED.get(kind, SIZES)
