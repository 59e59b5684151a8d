"""A file of events, or a video turned into events, as a world."""

from __future__ import annotations

import atexit
import dataclasses as dc
import hashlib
import shutil
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from deodar import regular_file
from deodar.codec import Json, JsonObject
from deodar.errors import Problem, WorldError, instance_of
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import real, show
from deodar.registry import register
from deodar.worlds._base import Signal, World
from deodar.worlds._capture import VIDEO_ENDINGS
from deodar.worlds._settings import number, parse_argument
from deodar_robots.event_file import aedat2, aedat4, event_text
from deodar_robots.event_file.events import RecordedEvents, require_size
from deodar_robots.event_file.filmed import FilmedEvents
from deodar_robots.eye.event_camera import EventCamera, shares

FILMED_SIDE = 128
"""Columns and rows of the sensor before a video, if no size is stated."""

PREVIEWED = 20
"""Periods whose events the preview shows."""


@register
class EventFile(World):
    r"""A recording of an event camera, or a video that an event camera sees.

    It reads AEDAT2 files of a DVS128 or eDVS (.aedat), AEDAT4 files (.aedat4; extra `events`), text with a
    line `t x y p` for each event (seconds, column, row, and 1 for brighter or 0; a time without a decimal
    point is in microseconds) and videos (extra `vision`), and plays in the time of the model from the first
    event on. After the end there are no events, or the recording starts again.

    Events of a file are sorted if time goes back by 0.1 s or less; a file where it goes back further is
    refused, because the time of the camera was reset there. AEDAT2 counts time modulo 2^32 microseconds,
    which is undone, so that a pause without events must be shorter than 35 minutes. What is left of a file
    that is damaged or cut off is read. Each of these repairs is a `RunWarning`.

    Of a video the luma Y (0 to 255) is the light; between two pictures its logarithm changes linearly. All
    copies of a model see the same events, which follow from the seed.

    Equation:
        y(x, y, t) = \frac{\text{events in the cell of } (x, y) \text{ at } t - \mathrm{period} \le t' < t}
            {\text{pixels of the cell} \cdot \mathrm{period}}
        L = \ln(Y + 8) \text{ (log luminance of a video)}

    Parameters:
        file: path of the recording or video.
        period: ms between two readings; a whole number of steps of the model.
        loop: whether the recording starts again after its end.
        size: columns and rows of the sensor; None: those that the file states, for text without them those
            that its events need, 128 x 128 for AEDAT2 and videos. A video keeps its aspect ratio; the rest of
            the sensor is black.
        stream: position among the streams of events of an AEDAT4 file, 0 for the first.
        jaer: whether the addresses of AEDAT2 are those of a DVS128 in jAER: column 127 - x, row 127 - y, and
            bit 0 for brighter. Otherwise the column is x, the row y, and the bit 1.
        camera: the pixels before a video, an `EventCamera` (`deodar_robots.eye.event_camera`).

    Shapes:
        All sensors are sampled over two axes in pixels, columns from the left and rows from the top: the rate
        over the cell of each sample in the last period, per pixel and second.

    Reference:
        iniVation AG, file formats AEDAT 2.0 and AEDAT 4.0 (docs.inivation.com); Hu, Liu & Delbruck (2021),
        v2e, CVPR Workshops (events from videos).
    """

    sensors: Mapping[str, Signal] = {
        "events": Signal("rate of all events over columns and rows of the sensor", unit="1/s"),
        "on": Signal("rate of the events of brighter pixels", unit="1/s"),
        "off": Signal("rate of the events of darker pixels", unit="1/s"),
    }
    stands_in = False
    opens = (".aedat", ".aedat4", *VIDEO_ENDINGS)

    def __init__(
        self,
        file: str | Path,
        period: float = 10.0,
        loop: bool = False,
        size: Sequence[float] | None = None,
        stream: int = 0,
        jaer: bool = True,
        camera: EventCamera | None = None,
    ) -> None:
        if not isinstance(file, (str, Path)):
            raise WorldError(f"file is {show(file)}; expected the path of a recording or video")
        self.period = self._step = number("period", period, above=0.0)
        self.loop, self.jaer = bool(loop), bool(jaer)
        if isinstance(stream, bool) or real(stream) is None or stream < 0 or stream != int(stream):
            raise WorldError(f"stream is {show(stream)}; expected a whole number, 0 for the first")
        self.stream, self.name = int(stream), str(file)
        self.camera = EventCamera() if camera is None else instance_of(EventCamera, camera, "camera")
        sides = None if size is None else _sides(size)
        path = Path(file)
        self.format = _format(path)
        self._film: FilmedEvents | None = None
        self._events: RecordedEvents | None = None
        if self.format == "video":
            shape = sides or (FILMED_SIDE, FILMED_SIDE)
            self._film = FilmedEvents(path, shape, self.camera, self._step, self.loop)
            self.size = shape
            return
        if self.format == "text":
            self._events = event_text.read(path, sides)
        elif self.format == "AEDAT2":
            self._events = aedat2.read(path, sides, self.jaer)
        else:
            self._events = aedat4.read(path, sides, self.stream)
        self.size = self._events.size

    @property
    def duration(self) -> float | None:
        """Duration of a recording in ms, from its first event to its last; None for a video."""
        return None if self._events is None else self._events.duration / 1000

    @property
    def count(self) -> int | None:
        """Number of the events of a recording; None for a video."""
        return None if self._events is None else len(self._events.times)

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        if self._film is not None:
            self._film.reset(seed)

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        if len(axes) != 2:
            raise WorldError(f"has two axes, columns and rows; the model gives it {len(axes)}", where=sensor)
        on, off = self._counts(time)
        counts = on if sensor == "on" else off if sensor == "off" else on + off
        one, other = (shares(axis, pixels) for axis, pixels in zip(axes, self.size, strict=True))
        return one @ counts @ other.T * (1000.0 / self._step)

    def _counts(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the numbers of on and off events of each pixel in the period before a time in ms."""
        if self._events is None:
            assert self._film is not None
            return self._film.counts(float(time))
        start, stop = round((time - self._step) * 1000), round(time * 1000)
        return self._events.counts(start, stop, self.loop)

    def keep(self) -> Any:
        return None if self._film is None else self._film.keep()

    def put(self, kept: Any) -> None:
        if self._film is not None and kept is not None:
            self._film.put(kept)

    def preview(self) -> np.ndarray:
        """Return a picture (rows, columns, 3), 0 to 1, of the events in the first 20 periods: white where
        pixels became brighter, black where they became darker.
        """
        self.reset(0)
        readings = [self._counts(k * self._step) for k in range(1, PREVIEWED + 1)]
        more = np.sum([on - off for on, off in readings], axis=0)
        grey = 0.5 + 0.5 * more / max(1.0, float(np.abs(more).max()))
        return np.repeat(grey.T[:, :, None], 3, axis=2)

    def validate_axes(self, sensor: str, axes: Axes) -> Iterator[Problem]:
        if len(axes) != 2:
            yield Problem(sensor, f"has two axes, columns and rows; the model gives it {len(axes)}")
            return
        for axis, pixels in zip(axes, self.size, strict=True):
            if axis.points[-1] < 0 or axis.points[0] > pixels - 1:
                what = f"the axis {axis.name!r} lies outside of the sensor, 0 to {pixels - 1} px"
                yield Problem(sensor, what)

    def close(self) -> None:
        """Close a video; the next reading opens it again."""
        if self._film is not None:
            self._film.close()

    def describe(self) -> JsonObject:
        with regular_file.open_binary(self.name) as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
        camera: JsonObject = {**dc.asdict(self.camera)}
        return {
            "world": "EventFile",
            "file": self.name,
            "format": self.format,
            "size": list(self.size),
            "period": self.period,
            "loop": self.loop,
            **({"camera": camera} if self.format == "video" else {}),
            **({"jaer": self.jaer} if self.format == "AEDAT2" else {}),
            **({"stream": self.stream} if self.format == "AEDAT4" else {}),
            "sha256": digest,
        }

    @classmethod
    def open(cls, argument: str) -> EventFile:
        """Open a file, with settings after commas, such as `hand.aedat4,period=5,loop=yes`."""
        file, settings = parse_argument(cls, argument)
        return cls(file, **settings)

    @classmethod
    def again(cls, described: Mapping[str, Json]) -> EventFile:
        said: Mapping[str, Any] = described
        camera = EventCamera(**said["camera"]) if "camera" in said else None
        settings = {name: said[name] for name in ("stream", "jaer") if name in said}
        return cls(said["file"], said["period"], said["loop"], said["size"], camera=camera, **settings)

    @classmethod
    def example(cls) -> EventFile:
        """Return a recording of a bar that crosses the sensor in one second, again and again.

        Each call writes a new file into the folder of temporary files.
        """
        folder = Path(tempfile.mkdtemp(prefix="deodar-"))
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        (folder / "bar.aedat").write_bytes(_bar())
        return cls(folder / "bar.aedat", loop=True)

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return Axis("column", 1.5, 125.5, 32), Axis("row", 1.5, 125.5, 32)


def _format(path: Path) -> str:
    """Return what a file is, by its beginning, or raise WorldError if its ending says otherwise."""
    fix = "Name a recording (.aedat, .aedat4, or text with a line `t x y p` for each event) or a video"
    regular_file.refuse_special(path, WorldError)
    if not regular_file.is_file(path):  # reading a pipe would wait
        raise WorldError("there is no such file", where=str(path), fix=fix)
    try:
        with regular_file.open_binary(path) as file:
            head = file.read(1024)
    except OSError as error:
        raise WorldError(f"cannot be read: {error.strerror}", where=str(path), fix=fix) from None
    if head.startswith(aedat2.VERSION):
        return "AEDAT2"
    if head.startswith(aedat4.VERSION):
        return "AEDAT4"
    if head.startswith(b"#!AER-DAT"):
        version = head[9:12].decode("latin-1").strip()
        raise WorldError(
            f"is of the version {version!r} of AEDAT; versions 2 and 4 are read",
            where=str(path),
            fix="Save it as AEDAT4, with the program of the camera's maker",
        )
    if path.suffix.lower() in (".aedat", ".aedat4"):
        what = "is empty" if not head else "is not a recording of events: it does not begin with '#!AER-DAT'"
        raise WorldError(what, where=str(path), fix="Name a recording in AEDAT2 or AEDAT4")
    if not event_text.is_text(head):
        return "video"
    if path.suffix.lower() in EventFile.opens:  # OpenCV shows text as a video of its letters
        raise WorldError("cannot be read as a video", where=str(path), fix=fix)
    return "text"


def _sides(size: Any) -> tuple[int, int]:
    """Return columns and rows, or raise WorldError."""
    values = [real(value) for value in size] if isinstance(size, (list, tuple, np.ndarray)) else []
    whole = [int(value) for value in values if value is not None and 1 <= value < 2**31 and value % 1 == 0]
    if len(values) != 2 or len(whole) != 2:
        raise WorldError(f"size is {show(size)}; expected columns and rows, such as (346, 260)")
    require_size((whole[0], whole[1]), "size")
    return whole[0], whole[1]


def _bar() -> bytes:
    """Return a recording of a bright bar, 8 columns wide, that moves by 128 columns in a second."""
    k = np.arange(2 * 128 * 32)
    front, row, column = k % 2 == 0, k // 2 % 32, k // 64
    times = column * 7812 + row * 200
    return aedat2.encoded(times, np.where(front, column, (column - 8) % 128), 48 + row, front)
