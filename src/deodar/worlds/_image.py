"""Sampling of pictures over axes: the mean colour of the pixels in each cell; black outside the picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from deodar.errors import WorldError
from deodar.numerics.axes import Axes
from deodar.worlds._base import Signal

CHANNELS = 3

MOST_PIXELS = 100_000_000
"""Largest number of pixels of a picture with the black beside it: 0.4 GB."""

PICTURE = Signal("colour over two dimensions; the last axis is red, green, blue")
"""Signal of the sensor `picture` in all worlds that have one."""


@dataclass(frozen=True)
class Frame:
    """Position of a picture on axes.

    The picture keeps its aspect ratio, fills the axes' area along one dimension, and is centred along the
    other.

    Attributes:
        across, down: column and row of the outer edge of the first cell.
        scale: axis units per pixel.
    """

    across: float
    down: float
    scale: float

    def to_pixels(self, axes: Axes, x: float, y: float) -> tuple[float, float]:
        """Return the column and row of the picture at a position on the axes."""
        return (
            self.across + (x - axes[0].lower + axes[0].step / 2) / self.scale,
            self.down + (y - axes[1].lower + axes[1].step / 2) / self.scale,
        )


def frame(size: tuple[int, int], axes: Axes) -> Frame:
    """Compute the position on axes of a picture with `size` pixels (width, height)."""
    width, height = size
    extent = [a.samples * a.step for a in axes[:2]]
    scale = min(extent[0] / width, extent[1] / height)
    return Frame((width - extent[0] / scale) / 2, (height - extent[1] / scale) / 2, scale)


def sampled(pixels: np.ndarray, axes: Axes, sensor: str) -> np.ndarray:
    """Sample a picture (height, width, 3) of bytes over axes (x, y, channel); values are from 0 to 1."""
    if len(axes) != 3 or axes[2].samples != CHANNELS:
        raise WorldError(
            f"a picture has two dimensions and three channels, not {len(axes)} axes", where=sensor
        )
    # start-up time
    from PIL import Image

    at = frame((pixels.shape[1], pixels.shape[0]), axes)
    box = (
        at.across,
        at.down,
        at.across + axes[0].samples * axes[0].step / at.scale,
        at.down + axes[1].samples * axes[1].step / at.scale,
    )
    seen = _resized(Image.fromarray(pixels), box, (axes[0].samples, axes[1].samples))
    return np.asarray(seen, dtype=np.float32).transpose(1, 0, 2) / 255.0


def _resized(picture: Any, box: tuple[float, float, float, float], size: tuple[int, int]) -> Any:
    # start-up time
    from PIL import Image

    # pad each side with whole black pixels, so that the box lies inside the sheet
    pad = [int(np.ceil(max(0.0, -box[0]))) + 1, int(np.ceil(max(0.0, -box[1]))) + 1]
    wide = picture.width + pad[0] + int(np.ceil(max(0.0, box[2] - picture.width))) + 1
    high = picture.height + pad[1] + int(np.ceil(max(0.0, box[3] - picture.height))) + 1
    if wide * high > MOST_PIXELS:
        raise WorldError(
            f"a picture of {picture.width} x {picture.height} pixels needs {wide} x {high} over these axes,"
            f" more than {MOST_PIXELS:,}",
            fix="Crop it, or give it fewer pixels",
        )
    sheet = Image.new("RGB", (wide, high))
    sheet.paste(picture, (pad[0], pad[1]))
    moved = (box[0] + pad[0], box[1] + pad[1], box[2] + pad[0], box[3] + pad[1])
    return sheet.resize(size, Image.Resampling.BOX, box=moved)
