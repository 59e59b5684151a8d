"""cosivina in its own words: scripts of its Python port run with another import line.

`from deodar_interop.compat.cosivina import *` takes the place of `from cosivina.nonumba import *`. A
`Simulator` collects elements and connections as cosivina's JSON files hold them, the importer translates
them, and a session of deodar runs the result in double precision. A `StandardGUI` collects the controls of
a window, in the words of the toolbox for MATLAB, as pinned sliders and presets of a model.
"""

from __future__ import annotations

from deodar_interop.compat.cosivina import options
from deodar_interop.compat.cosivina.elements import (
    BoostStimulus,
    CustomStimulus,
    Element,
    ExpandDimension2D,
    GaussKernel1D,
    GaussKernel2D,
    GaussStimulus1D,
    GaussStimulus2D,
    KernelFFT,
    LateralInteractions1D,
    LateralInteractions2D,
    MexicanHatKernel1D,
    MexicanHatKernel2D,
    NeuralField,
    NormalNoise,
    PointwiseProduct,
    ScaleInput,
    SumAllDimensions,
    SumDimension,
    SumInputs,
    Transpose,
)
from deodar_interop.compat.cosivina.simulator import Simulator
from deodar_interop.compat.cosivina.window import (
    KernelPlot,
    MultiPlot,
    RGBImage,
    ScaledImage,
    SlicePlot,
    StandardGUI,
    StaticText,
    SurfacePlot,
    TilePlot,
    TimeDisplay,
    XYPlot,
)
from deodar_interop.compat.cosivina.window_controls import (
    GlobalControlButton,
    ParameterDropdownSelector,
    ParameterSlider,
    ParameterSwitchButton,
    PresetSelector,
)

__all__ = [
    "BoostStimulus",
    "CustomStimulus",
    "Element",
    "ExpandDimension2D",
    "GaussKernel1D",
    "GaussKernel2D",
    "GaussStimulus1D",
    "GaussStimulus2D",
    "GlobalControlButton",
    "KernelFFT",
    "KernelPlot",
    "LateralInteractions1D",
    "LateralInteractions2D",
    "MexicanHatKernel1D",
    "MexicanHatKernel2D",
    "MultiPlot",
    "NeuralField",
    "NormalNoise",
    "ParameterDropdownSelector",
    "ParameterSlider",
    "ParameterSwitchButton",
    "PointwiseProduct",
    "PresetSelector",
    "RGBImage",
    "ScaleInput",
    "ScaledImage",
    "Simulator",
    "SlicePlot",
    "StandardGUI",
    "StaticText",
    "SumAllDimensions",
    "SumDimension",
    "SumInputs",
    "SurfacePlot",
    "TilePlot",
    "TimeDisplay",
    "Transpose",
    "XYPlot",
    "options",
]
