"""A camera as a world."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

from deodar.codec import Json
from deodar.credentials import Hidden, masked
from deodar.errors import WorldError
from deodar.numerics.axes import Axes
from deodar.parameters import show
from deodar.registry import register
from deodar.worlds import _capture
from deodar.worlds._base import Signal, World
from deodar.worlds._camera_reader import CameraReader, CameraTimes, source_of
from deodar.worlds._image import PICTURE, frame, sampled
from deodar.worlds._settings import number


@register
class Camera(World):
    r"""A camera: one sensor, `picture`, over two dimensions and the channels red, green and blue.

    Values are means over the pixels of the newest picture, 0 to 1. The camera follows the wall clock: pace
    the model to it (`session.run_live`). A run with a camera cannot be repeated; record the output of the
    sensor and replay it (`Recording`).

    A file is played once, at its own rate; `Video` plays one in the time of the model. A camera that is
    absent or stops is an error that says why; if it comes back, the session continues. The user, the
    password and secret parameters of an address are in no record and no message, which show `***` instead.

    Equation:
        y(x, y, c, t) = \langle \text{channel } c \rangle_{\text{cell of } (x, y)}

    Parameters:
        source: number of a device, 0 for the first; its path; a video file; or an address, rtsp://, http://
            or https://, as OpenCV accepts it. A user of `***` stands for the login that ~/.netrc states for
            the host.
        period: ms between two readings; a whole number of steps of the model.
        patience: s without a new picture after which a reading raises an error.
        open_timeout: s in which the first picture of a device or an address has to come.
        size: width and height in pixels. A device is asked for it; pictures of another size are an error.
            None: any.
        rate: most pictures per second that are kept. A device is asked for it. None: all.

    Shapes:
        x runs over columns from the left, y over rows from the top.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, section 2.5.1.
    """

    sensors: Mapping[str, Signal] = {"picture": PICTURE}
    stands_in = False
    repeatable = False
    wall_clock = True

    def __init__(
        self,
        source: int | str = 0,
        period: float = 40.0,
        patience: float = 3.0,
        open_timeout: float = 5.0,
        size: Sequence[int] | None = None,
        rate: float | None = None,
    ) -> None:
        is_number = isinstance(source, (int, np.integer)) and not isinstance(source, bool) and source >= 0
        if not is_number and not (isinstance(source, str) and source):
            raise WorldError(
                f"the source of a camera is {show(source)}; expected a number, 0 for the first, a path or an"
                " address"
            )
        self.period = number("period", period, above=0.0)
        self.patience = number("patience", patience, above=0.0)
        self.open_timeout = number("open_timeout", open_timeout, above=0.0)
        self.rate = None if rate is None else number("rate", rate, above=0.0)
        self.size = None if size is None else _pixels(size)
        self._given = Hidden(source if isinstance(source, str) else int(source))
        self.source = masked(source) if isinstance(source, str) else int(source)
        self._reader: CameraReader | None = None

    @property
    def running(self) -> bool:
        """Whether it is open and new pictures may come."""
        return self._reader is not None and self._reader.running

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        if not self.running:
            self.close()  # it has stopped, and may be there again
        self._open()

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        return sampled(self.picture(), axes, sensor)

    def picture(self) -> np.ndarray:
        """Return the newest picture (height, width, 3) of bytes."""
        try:
            return self._open().picture()
        except WorldError:
            if self._reader is not None and self._reader.source.form != "file":
                self.close()  # it may come back: the next reading opens it again
            raise

    def close(self) -> None:
        """Release the camera for other programs; the next reading opens it again."""
        if self._reader is not None:
            self._reader.close()
            self._reader = None

    def to_pixels(self, axes: Axes, x: float, y: float) -> tuple[float, float]:
        """Return the column and row of the picture at a position on the axes."""
        return frame(self._open().size, axes).to_pixels(axes, x, y)

    def describe(self) -> dict[str, Json]:
        description: dict[str, Json] = {
            "world": "Camera",
            "source": self.source,
            "size": list(self._open().size),
            "period": self.period,
        }
        return description if self.rate is None else description | {"rate": self.rate}

    @classmethod
    def open(cls, argument: str) -> Camera:
        return cls(int(argument) if argument.isdigit() else argument)

    @classmethod
    def again(cls, described: Mapping[str, Json]) -> Camera:
        """Return a camera at the same place, whose pictures are other ones than those of the record. The user
        and password of an address come from ~/.netrc.
        """
        settings = cast("dict[str, Any]", described)
        source = settings["source"] if "source" in settings else settings["number"]  # in older records
        return cls(source, settings["period"], size=settings["size"], rate=settings.get("rate"))

    def _open(self) -> CameraReader:
        if self._reader is None:
            times = CameraTimes(self.open_timeout, self.patience, self.rate)
            self._reader = CameraReader(source_of(self._given.value), times, self.size)
        return self._reader

    @classmethod
    def example(cls) -> Camera:
        """Return a camera that reads a video file of a constant scene."""
        return cls(str(_capture.example(moves=False)), patience=600.0)

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return _capture.EXAMPLE_AXES


def _pixels(size: Sequence[int]) -> tuple[int, int]:
    """Return a width and a height."""
    pair = list(size) if isinstance(size, (list, tuple)) else []
    if len(pair) != 2 or not all(type(n) is int and 0 < n <= 2**15 for n in pair):
        raise WorldError(f"size is {show(size)}; expected a width and a height in pixels")
    return pair[0], pair[1]
