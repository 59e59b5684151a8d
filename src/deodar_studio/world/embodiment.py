"""The world that the sensors of the open document read and its motors move."""

from __future__ import annotations

import base64
import binascii
import contextlib
import dataclasses as dc
import tempfile
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np

from deodar import registry
from deodar.credentials import masked
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import DeodarError, EditFix, MissingExtra, Problem, WorldError, WorldFix, did_you_mean
from deodar.kinds.world_settings import require_settings
from deodar.model import document_files, proposed
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.numerics.axes import Axes, Axis, shape
from deodar.proposed_edit import ProposedEdit, SetAxis, SetValues
from deodar.recording.opened import opened
from deodar.recording.provenance import described
from deodar.session import agreement
from deodar.session.exchange import used
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of
from deodar.worlds._settings import arguments
from deodar_studio.messages.to_page import OfferedSignals, WorldPreview
from deodar_studio.world import offered, scene

MOST_BYTES = 32 * 2**20
PREVIEW = (Axis("x", 0, 159, 160), Axis("y", 0, 119, 120), Axis("channel", 0, 2, 3))


@dc.dataclass(frozen=True)
class _OfferedFor:
    """What an offer of sensors and motors was made for. Only the signals of the document matter."""

    document: Document
    present: World | None
    chosen: World | None
    signals: Collection[str]
    driven: Collection[str]

    def holds(self, doc: Document, present: World | None, chosen: World | None) -> bool:
        """Return whether the offer was made for this very document, in these worlds."""
        return self.document is doc and self.present is present and self.chosen is chosen

    def holds_signals(self, latest: _OfferedFor) -> bool:
        """Return whether another document uses the same signals, in the same worlds."""
        same = self.present is latest.present and self.chosen is latest.chosen
        return same and self.signals == latest.signals and self.driven == latest.driven


class Embodiment:
    """The world that the user chose, or an example.

    An example is used if no world was chosen, or the chosen one lacks a sensor or motor of the document; it
    is of a kind that has all of them.
    """

    def __init__(self, chosen: World | None = None) -> None:
        self.chosen = chosen
        self._example_axes = offered.ExampleAxes()
        self._offered: tuple[_OfferedFor, OfferedSignals] | None = None
        self._dropped: tempfile.TemporaryDirectory[str] | None = None
        self._name = (
            ""
            if chosen is None
            else _named(type(chosen).__name__, str((described(chosen) or {}).get("file", "")))
        )

    def world(self, doc: Document, present: World | None = None) -> World | None:
        """Return the world for a document; `present` is the one in use, which stays if it fits.

        Return None if the document has no sensors and motors, or if no world was chosen and no example fits;
        `problems` then says what is missing.
        """
        wanted = signals(doc)
        if not wanted:
            return None
        for world in (present, self.chosen):
            if world is not None and not missing(world, doc):
                return world
        for cls in _standing().values():
            if wanted <= {*cls.sensors, *cls.motors}:
                # without the extra of a world there is no example of it
                with contextlib.suppress(MissingExtra), errors_of(cls, "examples"):
                    return _best(cls.examples(), doc)
        return self.chosen

    def label(self, world: World | None) -> str:
        """Return a phrase for a world in use."""
        if world is None:
            return ""
        return self._name if world is self.chosen else _named(type(world).__name__, "an example")

    def starting_values(
        self, kind: str, stated: Mapping[str, Any], doc: Document, present: World | None = None
    ) -> dict[str, Any]:
        """Return the values of a new element: a sensor or motor is one that the world of the document has.

        Args:
            kind: kind of the element.
            stated: values that were chosen; with axes they stay as they are.
            doc: the document that the element is made for.
            present: the world in use.
        """
        for name, world in () if "axes" in stated else self._signals(kind, stated, doc, present):
            values = offered.values(kind, name, world, self._example_axes)
            if values is not None:
                return {**stated, **values}
        return dict(stated)

    def _signals(
        self, kind: str, stated: Mapping[str, Any], doc: Document, present: World | None
    ) -> Iterator[tuple[str, World | type[World]]]:
        """Yield the signals that a new element can have, the best first, each with its world: that which is
        stated, else the default of the kind, else any of a world that the document can use. A motor has one
        driver.
        """
        usable = [world for _, world in self._usable(doc, present)]
        name = stated.get("sensor", stated.get("motor"))
        usual = {Sensor.__name__: Sensor().sensor, Motor.__name__: Motor().motor}.get(kind)
        if name is not None:
            worlds = [*usable, *_standing().values()]
            yield from ((name, w) for w in worlds if name in offered.of_kind(kind, w))
            return
        driven = offered.driven(doc) if kind == Motor.__name__ else set[str]()
        pairs = [(n, w) for w in usable for n in offered.of_kind(kind, w) if n not in driven]
        yield from sorted(pairs, key=lambda pair: pair[0] != usual)

    def offered(self, doc: Document, present: World | None = None) -> OfferedSignals:
        """Return the sensors and motors that a document can use; `present` is the world in use."""
        before = self._offered
        if before is not None and before[0].holds(doc, present, self.chosen):
            return before[1]
        names, motors = signals(doc), offered.driven(doc)
        latest = _OfferedFor(doc, present, self.chosen, names, motors)
        if before is not None and before[0].holds_signals(latest):
            self._offered = (latest, before[1])
            return before[1]
        listed = [
            offered.world_signals(title, world, motors, self._example_axes)
            for title, world in self._usable(doc, present)
        ]
        self._offered = (latest, OfferedSignals(worlds=[w for w in listed if w.signals]))
        return self._offered[1]

    def _usable(self, doc: Document, present: World | None) -> list[tuple[str, World | type[World]]]:
        """Return the world of a document, or those that may become it, with their titles."""
        names = signals(doc)
        world = present if present is not None and names else self.chosen
        usable: list[tuple[str, World | type[World]]] = []
        usable += [] if world is None else [(self.label(world), world)]
        if world is not None and not missing(world, doc):
            return usable
        usable += [(name, cls) for name, cls in _standing().items() if names <= {*cls.sensors, *cls.motors}]
        return usable or [*_standing().items()]  # no world has all: another sensor or motor is to be chosen

    def kind(self, name: str) -> type[World]:
        """Return the class of a world."""
        kinds = registry.kinds("worlds")
        if name not in kinds:
            raise WorldError(f"there is no world {name!r}", fix=did_you_mean(name, kinds))
        return kinds[name]

    def open(self, kind: str, argument: str, name: str, settings: Mapping[str, Any]) -> World:
        """Return a world of a kind, made from an argument; `name` is the name that messages show."""
        cls = self.kind(kind)
        require_settings(cls, settings)
        try:
            if not settings:
                return opened(cls, argument)
            make = cast("Callable[..., World]", cls)
            with errors_of(cls, "open", argument):
                first = int(argument) if not cls.opens and argument.isdecimal() else argument
                return make(first, **arguments(cls, settings))
        except WorldError as error:
            raise WorldError(
                error.problems[0].what, where=masked(name), fix=error.problems[0].fix
            ) from error.__cause__

    def open_content(self, kind: str, name: str, content: str, settings: Mapping[str, Any]) -> World:
        """Return a world of a kind, made from the content (base64) of the file `name`."""
        try:
            data = base64.b64decode(content, validate=True)
        except (binascii.Error, ValueError):
            raise WorldError("the content is not base64", where=name) from None
        if len(data) > MOST_BYTES:
            raise WorldError(f"is larger than {MOST_BYTES // 2**20} MiB", where=name)
        # worlds may read their files later, too
        self._dropped = self._dropped or tempfile.TemporaryDirectory(prefix="deodar-")
        path = Path(tempfile.mkdtemp(dir=self._dropped.name)) / f"dropped{Path(name).suffix}"
        path.write_bytes(data)
        return self.open(kind, str(path), name, settings)

    def close(self) -> None:
        """Remove the files that were dropped on the page."""
        if self._dropped is not None:
            self._dropped.cleanup()
            self._dropped = None

    def choose(self, world: World, kind: str, name: str, doc: Document) -> None:
        """Choose a world for a document.

        Raises:
            WorldError: the world lacks a sensor or motor of the document; the world in use stays.
        """
        self.require(world, kind, name, doc)
        self.chosen = world
        self._name = _named(kind, masked(name))

    def require(self, world: World, kind: str, name: str, doc: Document) -> None:
        """Raise WorldError if a world lacks a sensor or motor of a document."""
        if lacking := missing(world, doc):
            raise WorldError(
                f"the world {kind} has no {', '.join(map(repr, lacking))}",
                where=masked(name),
                fix="Choose a world with all sensors and motors of the model",
            )


def _standing() -> dict[str, type[World]]:
    """Return the worlds of which an example may be used when none was chosen."""
    return {name: cls for name, cls in registry.kinds("worlds").items() if cls.stands_in}


def _best(worlds: Iterable[World], doc: Document) -> World:
    """Return the first world without problems and warnings, or else the one with the fewest; problems count
    first.
    """
    counts: list[tuple[tuple[int, int], World]] = []
    for world in worlds:
        if not missing(world, doc):
            counts.append(((len(problems(doc, world)), len(agreement.judge(doc, world))), world))
            if counts[-1][0] == (0, 0):
                break
    return min(counts, key=lambda one: one[0])[1]


def missing(world: World, doc: Document) -> list[str]:
    """Return the sensors and motors of a document that a world does not have."""
    return sorted(signals(doc) - {*world.sensors, *world.motors})


def problems(doc: Document, world: World | None) -> Sequence[Problem]:
    """Return why a document cannot run in a world: signals that it lacks, or has over other axes."""
    lacking = [
        _lacking(e.path, e.element, world)
        for e in doc.entries
        if isinstance(e.element, (Sensor, Motor)) and _lacks(e.element, world)
    ]
    if lacking:
        return lacking
    return [_with_its_axes(p, doc, world) for p in _refusals(doc, world)]


def warnings(doc: Document, world: World | None) -> list[Problem]:
    """Return the warnings about a document in a world; those of the world itself have no element."""
    paths = {e.path for e in doc.entries}
    return [
        p if p.where in paths else dc.replace(p, fix=WorldFix(p.fix_at("page")))
        for p in agreement.judge(doc, world)
        if p.severity == "warning"
    ]


def _with_its_axes(problem: Problem, doc: Document, world: World | None) -> Problem:
    """Return a problem of a sensor or motor; where its samples are not those of the world, their axes are the
    fix.
    """
    element = next((e.element for e in doc.entries if e.path == problem.where), None)
    if world is None or not isinstance(element, (Sensor, Motor)) or problem.edits:
        return problem
    kind = Sensor if isinstance(element, Sensor) else Motor
    name = element.sensor if isinstance(element, Sensor) else element.motor
    signal = offered.of_kind(kind.__name__, world).get(name)
    if signal is None or signal.shape in (None, shape(element.axes)):
        return problem
    axes = offered.axes(kind.__name__, name, world, offered.ExampleAxes())
    if axes is None:
        return problem
    edits = _changed_axes(doc, tuple(element.axes), axes)
    if not edits or not _solve(doc, edits, problem, world):
        edits = [SetValues((("axes", axes),), problem.where)]
    use = EditFix("Use its axes", edits, problem.fix)
    return proposed.bound(proposed.CheckedDocument(doc), dc.replace(problem, fix=use))


def _changed_axes(doc: Document, old: Axes, new: Axes) -> list[ProposedEdit]:
    """Return the edits that give axes the values of others in all elements that have them; the names stay.

    Empty if they are not as many.
    """
    keys = {axis: key for key, axis in document_files.axes(doc).items()}
    edits: list[ProposedEdit] = []
    for before, after in zip(old, new, strict=True) if len(old) == len(new) else ():
        values = {f.name: getattr(after, f.name) for f in dc.fields(after) if f.name != "name"}
        changes = tuple((name, v) for name, v in values.items() if getattr(before, name) != v)
        edits += [SetAxis(keys[before], changes)] if changes else []
    return edits


def _solve(doc: Document, edits: Sequence[ProposedEdit], problem: Problem, world: World) -> bool:
    """Return whether edits solve a problem of a document in a world, and bring no other one."""
    try:
        solved = proposed.apply(doc, edits)
    except DeodarError:
        return False
    before, after = ({p.where for p in _refusals(d, world)} for d in (doc, solved))
    return not graph(solved).problems and after <= before - {problem.where}


def _refusals(doc: Document, world: World | None) -> Sequence[Problem]:
    """Return why elements of a document cannot exchange signals with a world."""
    try:
        used(doc, world)
    except WorldError as error:
        return error.problems
    return ()


def _lacks(element: Sensor | Motor, world: World | None) -> bool:
    """Return whether a world does not have the sensor or motor of an element."""
    if isinstance(element, Sensor):
        return world is None or element.sensor not in world.sensors
    return world is not None and element.motor not in world.motors


def _lacking(path: str, element: Sensor | Motor, world: World | None) -> Problem:
    what, name = ("sensor", element.sensor) if isinstance(element, Sensor) else ("motor", element.motor)
    lacks = "no world was chosen that has" if world is None else f"the world {type(world).__name__} lacks"
    having = [kind for kind, cls in registry.kinds("worlds").items() if name in {**cls.sensors, **cls.motors}]
    such = f", such as {' or '.join(having)}" if having else ""
    return Problem(path, f"{lacks} the {what} {name!r}", WorldFix(f"Choose a world that has it{such}"))


def preview(world: World, doc: Document | None) -> WorldPreview:
    """Return what a world looks like: from above, or its own preview, or else what its first sensor of any
    shape reads.
    """
    picture = np.zeros((0, 0, 3))
    try:
        with errors_of(type(world), "preview"):
            world.reset(0)
            seen = world.scene()
            free = [name for name, signal in world.sensors.items() if signal.shape is None]
            own = world.preview() if seen is None else None
            if own is not None:
                picture = own
            elif seen is None and free:
                # a robot is recognised by its name; its first sensor may be read over other axes only
                with contextlib.suppress(*() if world.link() is None else (WorldError,)):
                    picture = world.sense(free[0], PREVIEW, 0.0).transpose(1, 0, 2)
    finally:
        world.close()
    pixels = (np.clip(picture, 0, 1) * 255).astype(np.uint8)
    return WorldPreview(
        sensors=list(world.sensors),
        motors=list(world.motors),
        missing=[] if doc is None else missing(world, doc),
        limits=scene.motor_limits(world) if world.can_narrow else [],
        scene=scene.scene(seen).scene,
        width=pixels.shape[1],
        height=pixels.shape[0],
        pixels=base64.b64encode(pixels.tobytes()).decode(),
    )


def signals(doc: Document) -> set[str]:
    """Return the names of the sensors that a document reads and of the motors that it drives."""
    sensors = {e.element.sensor for e in doc.entries if isinstance(e.element, Sensor)}
    return sensors | {e.element.motor for e in doc.entries if isinstance(e.element, Motor)}


def _named(kind: str, name: str) -> str:
    return f"{kind}: {name}" if name else kind
