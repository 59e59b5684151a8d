"""A camera as a world."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from deodar.codec import Json
from deodar.errors import WorldError
from deodar.numerics.axes import Axes
from deodar.parameters import real, show
from deodar.registry import register
from deodar.worlds import _capture
from deodar.worlds._base import Signal, World
from deodar.worlds._image import PICTURE, frame, sampled


@register
class Camera(World):
    r"""A camera: one sensor, `picture`, over two dimensions and the channels red, green and blue.

    Values are means over the pixels of the newest picture, 0 to 1. The camera follows the wall clock: pace
    the model to it (`session.run_live`). A run with a camera cannot be repeated; record the output of the
    sensor and replay it (`Recording`).

    Equation:
        y(x, y, c, t) = \langle \text{channel } c \rangle_{\text{cell of } (x, y)}

    Parameters:
        number: number of the camera, 0 for the first; or the network address of one, as OpenCV accepts it.
        period: ms between two readings; a whole number of steps of the model.
        patience: seconds without a new picture after which a reading raises an error.

    Shapes:
        x runs over columns from the left, y over rows from the top.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 2.5.1.
    """

    sensors: Mapping[str, Signal] = {"picture": PICTURE}
    stands_in = False
    repeatable = False
    wall_clock = True

    def __init__(self, number: int | str = 0, period: float = 40.0, patience: float = 3.0) -> None:
        known = isinstance(number, (int, np.integer)) and not isinstance(number, bool) and number >= 0
        if not known and not (isinstance(number, str) and number):
            raise WorldError(
                f"the number of a camera is {show(number)}; expected a whole number, 0 for the first"
            )
        for name, given in (("period", period), ("patience", patience)):
            value = real(given)
            if value is None or not 0 < value < math.inf:
                raise WorldError(f"{name} is {show(given)}; expected a number above 0")
        self.number = number if isinstance(number, str) else int(number)
        self.period, self.patience = float(period), float(patience)
        self._reader: _capture.CameraReader | None = None

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        self._open()

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        return sampled(self.picture(), axes, sensor)

    def picture(self) -> np.ndarray:
        """Return the newest picture (height, width, 3) of bytes."""
        return self._open().picture()

    def close(self) -> None:
        """Release the camera for other programs; the next reading opens it again."""
        if self._reader is not None:
            self._reader.close()
            self._reader = None

    def to_pixels(self, axes: Axes, x: float, y: float) -> tuple[float, float]:
        """Return the column and row of the picture at a position on the axes."""
        return frame(self._open().size, axes).to_pixels(axes, x, y)

    def describe(self) -> dict[str, Json]:
        return {
            "world": "Camera",
            "number": self.number,
            "size": list(self._open().size),
            "period": self.period,
        }

    @classmethod
    def open(cls, argument: str) -> Camera:
        return cls(int(argument) if argument.isdigit() else argument)

    @classmethod
    def again(cls, described: Mapping[str, Json]) -> Camera:
        raise WorldError(
            "the pictures of a camera are not stored",
            fix="Record its sensor and replay the record: --world recording:RECORD",
        )

    def _open(self) -> _capture.CameraReader:
        if self._reader is None:
            self._reader = _capture.CameraReader(self.number, self.patience)
        return self._reader

    @classmethod
    def example(cls) -> Camera:
        """Return a camera that reads a video file of a constant scene."""
        return cls(str(_capture.example(moves=False)), patience=600.0)

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return _capture.EXAMPLE_AXES
