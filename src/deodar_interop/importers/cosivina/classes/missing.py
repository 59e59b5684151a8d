"""Classes without a counterpart: a placeholder keeps their place and connections, and states what is
missing.
"""

from __future__ import annotations

from deodar_interop.importers._axes import SizeLimit
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._missing import placeholder_piece, unknown
from deodar_interop.importers._piece import Dims, Piece
from deodar_interop.importers.cosivina.sizes import Dimensions, output_size

MISSING = {
    "AttractorDynamics": "turns a peak into the rate of change of a heading direction",
    "CameraGrabber": "reads a camera",
    "ColorExtraction": "counts colours in the columns of an image",
    "Convolution": "convolves its two inputs with each other",
    "DynamicRobotController": "drives an e-puck robot",
    "ImageLoader": "reads images from files",
    "Interpolation1D": "resamples its input at given points",
    "LFP": "records the mean input of a field",
    "MobileRobotArena": "simulates a vehicle among targets",
}
"""The function of each class that is not translated."""


def placeholder(e: Foreign, dimensions: Dimensions, kinds: list[str], why: str = "") -> Piece:
    """Return a placeholder for an element, with the reason."""
    missing = why or MISSING.get(e.kind, "") or unknown(e.kind, "an unknown class of cosivina", kinds)
    return placeholder_piece(e, _dims(e, dimensions), missing)


def _dims(e: Foreign, dimensions: Dimensions) -> Dims:
    try:
        return dimensions.of(output_size(e))
    except SizeLimit:
        return (None, None)
