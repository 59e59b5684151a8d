"""Frames of a record, as one page watches them."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import itertools
import math
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from deodar import registry
from deodar.element import Element
from deodar.elements.world_ports import Sensor
from deodar.errors import DeodarError, Problem
from deodar.numerics.axes import Axes
from deodar.recording.record import about
from deodar.recording.repeat import world_of
from deodar.recording.replay import Copy, RecordReader
from deodar.session.port_reader import PortKey
from deodar.worlds._base import World
from deodar.worlds._scene import Scene, SceneBody
from deodar_studio.files.file_thread import in_file_thread
from deodar_studio.live.published import PublishedState
from deodar_studio.live.ring import TimeSpan
from deodar_studio.live.trace import Trace, TraceRequest, capacity, extremes, farthest
from deodar_studio.live.track import MOST, Trail
from deodar_studio.streams.source import FoundFrame, element_of
from deodar_studio.streams.stream import median

MOST_SAMPLES = capacity(1) // 2
"""Largest number of samples of a time course.

A longer record is divided into intervals, of which the smallest and the largest sample are kept, so that no
peak is left out; of rows of values the value of each column that is farthest from the median is kept.
"""

FEW = 64
"""Number of rows from which that median is computed (a guess)."""

PLACES = ("pose", "place")
"""Sensors whose readings are the position of the body of a world, the more complete one first."""

NOT_RECORDED = "The position of the body was not recorded: record a sensor of its pose or place."

_numbers = itertools.count(1)


def opened(path: Path) -> tuple[RecordReader, tuple[Scene | None, str]]:
    """Open a record and the view of its world, with a sentence on what that does not contain.

    Raises:
        DeodarError: the record cannot be opened.
    """
    record = RecordReader(path)
    try:
        scene = _scene(record)
    except DeodarError as error:
        return record, (None, error.problems[0].at("page"))
    except Exception as error:  # worlds of other packages may raise any exception
        return record, (None, f"The world of the record cannot be opened ({type(error).__name__}: {error}).")
    missing = scene is not None and position_port(record) is None
    return record, (scene, NOT_RECORDED if missing else "")


def _scene(record: RecordReader) -> Scene | None:
    made = about(record.data).get("world")
    kind = registry.kinds("worlds").get(str(made.get("world"))) if isinstance(made, dict) else None
    if kind is None or kind.scene is World.scene:
        return None  # not even opened: it might be a camera
    world = world_of(record.data)
    if world is None:
        return None
    world.reset(0)
    scene = world.scene()
    if scene is None:
        return None
    boxes, marks = (tuple(dc.replace(o, fixed=True) for o in items) for items in (scene.boxes, scene.marks))
    return dc.replace(scene, boxes=boxes, marks=marks)


class RecordFrames:
    """Frames of a record for one page, which chooses the trial and the point of a sweep.

    Args:
        record: the record.
        scene: the view of the record's world at its start; None: it has none.
        progress: called in another thread when a time course has more samples.
    """

    ready = True

    def __init__(self, record: RecordReader, scene: Scene | None, progress: Callable[[], None]) -> None:
        self.record = record
        self.copy: Copy = {}
        self._scene, self._progress = scene, progress
        self._key: object = None
        self._last: FoundFrame | None = None
        self._length = 0
        self._problems: dict[PortKey, Problem] = {}
        self._traces: dict[tuple[TraceRequest, object, int], Trace] = {}
        self._track: tuple[object, Trail, np.ndarray] | None = None

    @property
    def identity(self) -> object:
        return self.record

    @property
    def time_unit(self) -> tuple[str, float]:
        times = self.record.times
        step = float(np.diff(times[: min(len(times), 1000)]).min()) if len(times) > 1 else 1.0
        return self.record.document.time_unit, step

    def choose(self, copy: Mapping[str, int]) -> None:
        """Show another trial or point of a sweep."""
        sizes = {d: len(values) for d, values in self.record.copies.items()}
        self.copy = {d: min(max(k, 0), sizes[d] - 1) for d, k in {**self.copy, **copy}.items() if d in sizes}

    def axes(self, place: PortKey) -> Axes:
        return self.record.axes(place)

    def document_axes(self, place: PortKey) -> Axes:
        return self.record.document_axes(place)

    def element(self, ident: str) -> Element:
        return element_of(self.record.document, ident)

    def absent(self, place: PortKey) -> Problem:
        return self._problems.get(place, Problem("", "has no sample at this moment"))

    def present(self) -> PublishedState | None:
        return None

    def span(self) -> TimeSpan | None:
        times = self.record.times
        if not len(times):
            return None
        return TimeSpan(float(times[0]), float(times[-1]), len(times), float(times[0]))

    async def at(self, time: float, further: int, places: Iterable[PortKey]) -> FoundFrame | None:
        """Return as a `FrameSource` does; a page at the end of a record that grows stays at the end."""
        length, last = len(self.record.times), self._last
        if not length:
            return None
        k = min(max(self.record.index(time) + further, 0), length - 1)
        if last is not None and further == 0 and time == last[1].time and self._length == last[0] + 1:
            k = length - 1
        wanted = frozenset(places)
        key = k, wanted, tuple(self.copy.items()), length
        if key != self._key or last is None:
            self._problems, state = await in_file_thread(
                lambda: self._state(k, wanted), str(self.record.path)
            )
            last = self._last = k, state
            self._key, self._length = key, length
        return last

    def _state(self, k: int, places: Iterable[PortKey]) -> tuple[dict[PortKey, Problem], PublishedState]:
        problems: dict[PortKey, Problem] = {}
        arrays: dict[PortKey, np.ndarray] = {}
        for place in places:
            try:
                array = self.record.frame(place, k, self.copy)
            except DeodarError as error:
                problems[place] = error.problems[0]
            else:
                if array is not None:
                    arrays[place] = array
        trail, poses = self._path()
        scene = self._scene
        if scene is not None:
            bodies = scene.bodies[:1] if len(poses) else ()
            scene = dc.replace(scene, bodies=tuple(_moved(b, poses[k]) for b in bodies))
        passed = len(trail.places) * (k + 1) // max(1, len(poses)) if len(poses) else 0
        time = float(self.record.times[k])
        return problems, PublishedState(next(_numbers), time, k, arrays, scene, trail, passed)

    def _path(self) -> tuple[Trail, np.ndarray]:
        """Return the path of the body, and its position at each moment."""
        key = tuple(self.copy.items()), len(self.record.times)
        if self._track is None or self._track[0] != key:
            place = position_port(self.record)
            poses = np.zeros((0, 2))
            if self._scene is not None and place is not None:
                parts = list(self.record.samples(place, self.copy, len(self.record.times)))
                if parts:
                    times, values = (np.concatenate([part[i] for part in parts]) for i in range(2))
                    at = np.searchsorted(times, self.record.times, "right") - 1
                    poses = values[np.maximum(at, 0)]
            stride = max(1, math.ceil(len(poses) / MOST))
            trail = Trail([(float(x), float(y)) for x, y in poses[::stride, :2]])
            self._track = key, trail, poses
        return self._track[1], self._track[2]

    def trace(self, request: TraceRequest) -> Trace | None:
        """Return a time course of the whole record; a thread reads it, chunk by chunk."""
        key = request, tuple(self.copy.items()), len(self.record.times)
        if key not in self._traces:
            trace, copy = Trace(), dict(self.copy)
            self._traces = {known: t for known, t in self._traces.items() if known[0] != request}
            self._traces[key] = trace

            def read() -> None:
                # the stream reports a port without frames, and the frame a chunk that cannot be read
                with contextlib.suppress(DeodarError):
                    for times, values in self._course(request, copy):
                        if self._traces.get(key) is not trace:
                            return
                        for time, value in zip(times, values, strict=True):
                            trace.add(float(time), value)
                        self._progress()

            threading.Thread(target=read, name="deodar-course", daemon=True).start()
        return self._traces[key]

    def _course(
        self, request: TraceRequest, copy: Copy
    ) -> Iterator[tuple[Sequence[float], Sequence[float | np.ndarray]]]:
        """Yield the times and values of a time course, chunk by chunk."""
        record, place = self.record, request.place
        axes, times = record.axes(place), record.sample_times(place)
        if request.section is not None:
            drawn = request.section.split(axes)[0]
            section = request.section
            most = min(MOST_SAMPLES, capacity(math.prod(a.samples for a in drawn)))
            some = [section.take(frames, axes) for _, frames in record.samples(place, copy, FEW)]
            parts = (
                (
                    times[first:last],
                    section.take(record.block(place, copy, first, last), axes).reshape(last - first, -1),
                )
                for first, last in record.chunks(place)
            )
            yield from farthest(parts, math.ceil(len(times) / most), median(np.concatenate(some)))
            return
        interval = 2 * math.ceil(len(times) / MOST_SAMPLES) if len(times) > MOST_SAMPLES else 1
        for first, last in record.chunks(place):
            values = np.asarray([request.value(f, axes) for f in record.block(place, copy, first, last)])
            kept = extremes(values, first, interval)
            yield times[first:last][kept].tolist(), values[kept].tolist()


def position_port(record: RecordReader) -> PortKey | None:
    """Return the recorded port with the position of the body; None: it was not recorded."""
    found = {
        e.element.sensor: (e.id, "output")
        for e in record.document.entries
        if isinstance(e.element, Sensor) and (e.id, "output") in record.ports
    }
    return next((found[sensor] for sensor in PLACES if sensor in found), None)


def _moved(body: SceneBody, pose: np.ndarray) -> SceneBody:
    heading = float(pose[2]) if len(pose) > 2 else body.heading
    return SceneBody(body.name, (float(pose[0]), float(pose[1])), heading, body.radius)
