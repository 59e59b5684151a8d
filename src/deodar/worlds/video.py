"""A video file as a world."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from deodar import regular_file
from deodar.codec import JsonObject
from deodar.errors import WorldError
from deodar.numerics.axes import Axes
from deodar.parameters import real, show
from deodar.registry import register
from deodar.worlds import _capture
from deodar.worlds._base import Signal, World
from deodar.worlds._image import PICTURE, frame, sampled


@register
class Video(World):
    r"""A video file: one sensor, `picture`, over two dimensions and the channels red, green and blue.

    The video plays in the time of the model. Values are means over the pixels of the picture at time t, 0 to
    1. After its end the video shows its last picture, or starts again.

    Equation:
        y(x, y, c, t) = \langle \text{channel } c \rangle_{\text{cell of } (x, y)}

    Parameters:
        file: path of a video file, such as .mp4, .avi, .mov, .mkv or .webm.
        period: ms between two readings; a whole number of steps of the model. The video may have another
            rate.
        loop: whether the video starts again after its end.

    Shapes:
        x runs over columns from the left, y over rows from the top.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 2.5.1 (camera images as
        input).
    """

    sensors: Mapping[str, Signal] = {"picture": PICTURE}
    stands_in = False
    opens = _capture.VIDEO_ENDINGS

    def __init__(self, file: str | Path, period: float = 40.0, loop: bool = False) -> None:
        parsed = real(period)
        if parsed is None or not 0 < parsed < math.inf:
            raise WorldError(f"period is {show(period)}; expected a number of ms above 0")
        self.period, self.loop, self.name = float(parsed), bool(loop), str(file)
        self._reader = _capture.VideoReader(Path(file))
        self.size = self._reader.size

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        self._reader.rewind()

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        return sampled(self.picture(time), axes, sensor)

    def picture(self, time: float) -> np.ndarray:
        """Return the picture (height, width, 3) of bytes at a time in ms."""
        return self._reader.picture(max(time, 0.0), self.loop)

    def to_pixels(self, axes: Axes, x: float, y: float) -> tuple[float, float]:
        """Return the column and row of the picture at a position on the axes."""
        return frame(self.size, axes).to_pixels(axes, x, y)

    def close(self) -> None:
        """Close the file; the next reading opens it again."""
        self._reader.close()

    def describe(self) -> JsonObject:
        description = {
            "world": "Video",
            "file": self.name,
            "size": list(self.size),
            "period": self.period,
            "loop": self.loop,
        }
        with regular_file.open_binary(self.name) as file:
            return {**description, "sha256": hashlib.file_digest(file, "sha256").hexdigest()}

    @classmethod
    def open(cls, argument: str) -> Video:
        return cls(argument)

    @classmethod
    def again(cls, described: Mapping[str, Any]) -> Video:
        return cls(str(described["file"]), described["period"], described["loop"])

    @classmethod
    def example(cls) -> Video:
        """Return a video of a red square that crosses a grey ground in one second.

        Each call writes a new file into the folder of temporary files.
        """
        return cls(_capture.example(), loop=True)

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return _capture.EXAMPLE_AXES
