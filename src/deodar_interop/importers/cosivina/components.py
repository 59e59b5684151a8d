"""The components that each class of cosivina offers to elements, plots and scripts, in cosivina's order.

A class that is not listed has one component, `output`.
"""

from __future__ import annotations

from collections.abc import Mapping

KERNEL = ("kernel", "output")
SUMS = ("horizontalSum", "verticalSum", "fullSum")
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
