"""A picture as a world."""

from __future__ import annotations

import hashlib
import os
import struct
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from deodar import regular_file
from deodar.codec import Json
from deodar.errors import WorldError, reading
from deodar.guarded.guarded_file import GuardedFile
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import show
from deodar.registry import register
from deodar.worlds._base import Signal, World
from deodar.worlds._image import CHANNELS, PICTURE, frame, sampled

if TYPE_CHECKING:
    from PIL.Image import Image as OpenedPicture

DEEPEST = 65535.0
"""Largest value of a picture of 16 bits."""

MOST_PIXELS = 100_000_000


PICTURE_ENDINGS = (".png", ".jpg", ".jpeg", ".bmp", ".gif", ".webp", ".tif", ".tiff")
"""Endings of the files that are offered as pictures."""

NAME_A_PICTURE = f"Name a picture: {', '.join(PICTURE_ENDINGS)}"


@register
class Picture(World):
    r"""A constant picture: one sensor, `picture`, over two dimensions and the channels red, green and blue.

    Values are 0 to 1, and 0 outside the picture. A picture of a phone is turned as its file states (EXIF).
    The picture keeps its aspect ratio: it fills the axes' area along one dimension and is centred along the
    other.

    Equation:
        y(x, y, c) = \langle \text{channel } c \rangle_{\text{cell of } (x, y)}

    Parameters:
        file: path of a picture file that Pillow can read, or an array (height, width, 3), values 0 to 255 or
            0 to 1.

    Shapes:
        x runs over columns from the left, y over rows from the top.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 2.5.1.
    """

    sensors: Mapping[str, Signal] = {"picture": PICTURE}
    opens = PICTURE_ENDINGS

    def __init__(self, file: str | Path | np.ndarray) -> None:
        if not isinstance(file, (str, Path, np.ndarray)):
            raise WorldError(f"a picture is a file or an array of height x width x 3, not {show(file)}")
        self.name = "array" if isinstance(file, np.ndarray) else str(file)
        self.pixels: np.ndarray = _array(file) if isinstance(file, np.ndarray) else _read(Path(file))

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self.pixels.shape[1], self.pixels.shape[0]

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        return sampled((self.pixels * 255).round().astype(np.uint8), axes, sensor)

    def to_pixels(self, axes: Axes, x: float, y: float) -> tuple[float, float]:
        """Return the column and row of the picture at a position on the axes."""
        return frame(self.size, axes).to_pixels(axes, x, y)

    def describe(self) -> dict[str, Json]:
        digest = hashlib.sha256(self.pixels.tobytes()).hexdigest()
        return {"world": "Picture", "file": self.name, "size": list(self.size), "sha256": digest}

    @classmethod
    def open(cls, argument: str) -> Picture:
        return cls(argument)

    @classmethod
    def example(cls) -> Picture:
        """Return a small picture of four colours."""
        colours = np.array([[[1, 0, 0], [0, 1, 0]], [[0, 0, 1], [1, 1, 0]]], float)
        return cls(colours.repeat(8, axis=0).repeat(8, axis=1))

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return (Axis("x", 0, 15, 16), Axis("y", 0, 15, 16), Axis("channel", 0, 2, 3))


def _array(pixels: np.ndarray) -> np.ndarray:
    if pixels.ndim != 3 or pixels.shape[2] != CHANNELS or 0 in pixels.shape:
        raise WorldError(f"a picture is an array of height x width x 3, not {list(pixels.shape)}")
    if pixels.dtype.kind not in "iufb":
        raise WorldError(f"a picture holds numbers, not {pixels.dtype}")
    values = pixels.astype(np.float64) / (255.0 if pixels.dtype.kind in "iu" else 1.0)
    if not np.isfinite(values).all() or values.min() < 0 or values.max() > 1:
        raise WorldError("a picture holds values of 0 to 255 (whole numbers) or 0 to 1")
    return values


def _read(path: Path) -> np.ndarray:
    regular_file.refuse_special(path, WorldError)
    if not os.path.isfile(path):
        raise WorldError(
            "there is no such picture",
            where=str(path),
            fix=NAME_A_PICTURE,
        )
    pixels = GuardedFile(WorldError, str(path)).call(pixels_of, str(path))
    with reading(path, WorldError):
        return _array(pixels if pixels.ndim == 3 else np.repeat(pixels[:, :, None], CHANNELS, axis=2))


def pixels_of(path: str) -> np.ndarray:
    """Return the pixels of a file as `_channels` does; in a child process.

    Raises:
        WorldError: it is no picture, or has more than MOST_PIXELS pixels.
    """
    # start-up time
    from PIL import Image, UnidentifiedImageError

    try:
        with warnings.catch_warnings():
            # MOST_PIXELS replaces Pillow's limit
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            opened = Image.open(path)
        with opened as picture:
            if picture.width * picture.height > MOST_PIXELS:
                raise WorldError(
                    f"has {picture.width} x {picture.height} pixels; at most {MOST_PIXELS} are read",
                    where=path,
                )
            return _channels(picture)
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError, struct.error, EOFError) as error:
        raise WorldError(
            f"cannot be read as a picture ({type(error).__name__}: {error})", where=path, fix=NAME_A_PICTURE
        ) from None
    except Image.DecompressionBombError:
        raise WorldError("has too many pixels", where=path) from None


def _channels(picture: OpenedPicture) -> np.ndarray:
    """Return the pixels, the way up that the file states: bytes, height x width x 3.

    Of a grey picture of 16 or 32 bits, or of floating-point numbers, they are 0 to 1, height x width. A file
    of the last two does not state its white: that is 1, 255 or 65535, the first that no value exceeds.
    """
    from PIL import ImageOps  # start-up time

    upright = ImageOps.exif_transpose(picture)
    if upright.mode[0] not in "IF":
        return np.asarray(upright.convert("RGB"))
    grey = np.array(upright, np.float32)
    largest = grey.max(initial=0.0)
    if upright.mode.startswith("I;16") or largest > 255:
        grey /= DEEPEST
    elif upright.mode == "I" or largest > 1:
        grey /= 255
    return grey
