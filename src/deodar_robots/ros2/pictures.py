"""Pictures: the message types Image and CompressedImage."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from deodar.errors import WorldError
from deodar.numerics.axes import Axes
from deodar.worlds._base import Signal
from deodar.worlds._image import PICTURE, sampled
from deodar_robots.ros2.message_types import MOST_BYTES, Unreadable
from deodar_robots.ros2.reading import Reading, finite

COLOURS = {
    "rgb8": (3, (0, 1, 2)),
    "bgr8": (3, (2, 1, 0)),
    "mono8": (1, (0, 0, 0)),
    "rgba8": (4, (0, 1, 2)),
    "bgra8": (4, (2, 1, 0)),
}
"""Bytes of a pixel, and the places of red, green and blue among them."""

DEPTHS = {"32FC1": (np.dtype(np.float32), 1.0), "16UC1": (np.dtype(np.uint16), 0.001)}
"""Type of a depth, and its unit in m."""

COMPRESSED = ("JPEG", "PNG")


class PictureReading(Reading):
    """The colours of a sensor_msgs/Image, 0 to 1, or with `fields` "depth" its depths in m.

    Colours are means over the pixels of each sample of the axes, as of all pictures. Depths are over columns
    from the left and rows from the top, means over the pixels of each cell of `shape`.
    """

    settings = ("shape", "fields", "undefined")

    def declared(self) -> Signal:
        self.field = self.choice(("colour", "depth"))
        if self.field == "depth":
            shape = self.shape_of(2, "[64, 48]")
            return Signal(f"depth in {self.entry.topic} over columns and rows", shape, "m", self.entry.period)
        if self.entry.shape is not None or self.entry.undefined is not None:
            raise WorldError("colours have no shape, and none is undefined", self.where)
        return Signal(PICTURE.meaning, None, period=self.entry.period)

    def take(self, message: Any) -> np.ndarray:
        known = DEPTHS if self.field == "depth" else COLOURS
        if message.encoding not in known:
            fix = f"The field {self.field} has the encodings {', '.join(known)}"
            raise Unreadable(f"its encoding is {message.encoding!r}", fix)
        return self._depths(message) if self.field == "depth" else colours(message)

    def sampled(self, taken: np.ndarray, axes: Axes, sensor: str) -> np.ndarray:
        return sampled(taken, axes, sensor) if self.field == "colour" else taken

    def _depths(self, message: Any) -> np.ndarray:
        dtype, unit = DEPTHS[message.encoding]
        order = dtype.newbyteorder(">" if message.is_bigendian else "<")
        depths = rows(message, dtype.itemsize).view(order)
        across, down = self.signal.shape or (1, 1)
        if message.width % across or message.height % down:
            what = f"it has {message.width} x {message.height} pixels, no multiple of {across} x {down}"
            raise Unreadable(what, f'State their number or a part of it: "shape": [{message.width}, ...]')
        found = depths.astype(np.float32) * np.float32(unit)
        strange = ~(np.isfinite(found) & (found > 0))
        if strange.any():
            if self.entry.undefined is None:
                what = f"{int(strange.sum())} of its depths are undefined"
                raise Unreadable(what, 'State a depth in their place, in m: "undefined": 10')
            found[strange] = self.entry.undefined
        cells = found.reshape(down, message.height // down, across, message.width // across)
        return np.ascontiguousarray(finite(cells.mean((1, 3), float).T, "mean depth"))


class CompressedReading(Reading):
    """The colours of a sensor_msgs/CompressedImage, a JPEG or PNG file."""

    def declared(self) -> Signal:
        return Signal(PICTURE.meaning, None, period=self.entry.period)

    def take(self, message: Any) -> np.ndarray:
        # start-up time
        from PIL import Image

        try:
            with Image.open(io.BytesIO(message.data.tobytes()), formats=COMPRESSED) as picture:
                if picture.width * picture.height * 3 > MOST_BYTES:
                    raise Unreadable(f"its picture has {picture.width} x {picture.height} pixels")
                return np.asarray(picture.convert("RGB"))
        except Unreadable:
            raise
        except Exception:  # damaged files may raise any exception
            raise Unreadable(f"it is no JPEG or PNG file; it says {message.format!r}") from None

    def sampled(self, taken: np.ndarray, axes: Axes, sensor: str) -> np.ndarray:
        return sampled(taken, axes, sensor)


def colours(message: Any) -> np.ndarray:
    """Return the picture (height, width, 3) of an Image of colours, as bytes."""
    size, places = COLOURS[message.encoding]
    pixels = rows(message, size).reshape(message.height, message.width, size)
    return pixels if pixels.shape[2] == 3 and places == (0, 1, 2) else pixels[:, :, list(places)]


def rows(message: Any, size: int) -> np.ndarray:
    """Return the rows of an Image, without what follows the last pixel of each; `size` bytes are a pixel.

    Raises:
        Unreadable: the rows are shorter than the width, or the data does not fill them.
    """
    wide = message.width * size
    if not message.width or not message.height or message.step < wide:
        raise Unreadable(f"it has {message.width} x {message.height} pixels in rows of {message.step} bytes")
    if len(message.data) != message.step * message.height:
        raise Unreadable(f"it has {len(message.data)} bytes, not {message.height} rows of {message.step}")
    lines = np.asarray(message.data, np.uint8).reshape(message.height, message.step)
    return np.ascontiguousarray(lines[:, :wide])
