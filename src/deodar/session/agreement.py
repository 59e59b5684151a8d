"""The agreement of a model with its world: units and bounds of the positions that both exchange.

A reading of a position, such as that of a sensor `place`, states its unit; so do the axes on which a model
encodes it. The unit is followed from the sensor through couplings that scale or pass on numbers, and in the
same way from the read-out of a peak to a motor.
"""

from __future__ import annotations

import dataclasses as dc
import inspect
import math
import warnings
from collections.abc import Iterator, Mapping, Sequence

from deodar.element import Element
from deodar.errors import ConnectionFix, EditFix, Fix, Problem, RunWarning, WorldFix, option
from deodar.model import proposed
from deodar.model.checks.motionless import motionless
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.model.proposed import CheckedDocument
from deodar.model.resolve import Node
from deodar.numerics import units
from deodar.numerics.axes import Axis, barely_overlap
from deodar.numerics.positions import PositionCode, PositionUnit, PositionUnits
from deodar.numerics.units import MetricUnit
from deodar.proposed_edit import SetValues, rounded
from deodar.worlds._base import Signal, World
from deodar.worlds._failure import errors_of


def judge(doc: Document, world: World | None) -> list[Problem]:
    """Return the problems and the warnings of a document in a world that has all of its signals."""
    if not isinstance(world, World):
        return []
    with errors_of(world, "validate"):
        problems_of_world = list(world.validate())
    problems_of_world += [
        p for e in doc.entries if e.element.sensor_name() for p in _axes(e.path, e.element, world)
    ]
    if _exchanges_positions(doc, world):
        found = graph(doc)
        problems_of_world += [] if found.problems else _Tracer(found.nodes, world).judge()
    checked = CheckedDocument(doc)
    return [proposed.bound(checked, p) for p in problems_of_world]


def warn(doc: Document, world: World | None, stacklevel: int) -> None:
    """Issue a `RunWarning` for each warning about a document in a world."""
    for p in judge(doc, world):
        if p.severity == "warning":
            warnings.warn(str(p), RunWarning, stacklevel=stacklevel + 1)


def warn_of_rounding(doc: Document, step: float, precision: str, stacklevel: int) -> None:
    """Issue a `RunWarning` for each element that does not move at a step in single precision."""
    for p in motionless(doc, step) if precision == "float32" else ():
        warnings.warn(str(p), RunWarning, stacklevel=stacklevel + 1)


def _axes(path: str, sensor: Element, world: World) -> Iterator[Problem]:
    """Yield what is wrong with the axes of a sensor."""
    name, axes = sensor.sensor_name(), tuple(sensor.input_axes(sensor.external, None) or ())
    signal = world.sensors.get(name)
    if signal is None:  # a user's world may accept any name
        return
    with errors_of(world, "validate_axes"):
        problems = list(world.validate_axes(name, axes))
    yield from (dc.replace(p, where=path) for p in problems)
    unit = units.parse(signal.unit)
    for axis in axes if signal.shape is not None else ():
        stated = units.parse(axis.unit)
        if unit is not None and stated is not None and unit.quantity == stated.quantity and unit != stated:
            problem = (
                f"its axis {axis.name!r} states the unit {axis.unit}, and the world gives {name!r}"
                f" in {signal.unit}"
            )
            write = Fix(
                f"Write unit={signal.unit!r} for the axis", page=f"Give the axis the unit {signal.unit}"
            )
            yield Problem(path, problem, _choose(world, stated) or write)


def _exchanges_positions(doc: Document, world: World) -> bool:
    sensors = {e.element.sensor_name() for e in doc.entries}
    motors = {e.element.motor_name() for e in doc.entries}
    used = [s for n, s in world.sensors.items() if n in sensors] + [
        s for n, s in world.motors.items() if n in motors
    ]
    return any(_units(s) for s in used)


def _units(signal: Signal) -> tuple[MetricUnit | None, ...]:
    """Return the unit of each sample of a signal; empty if it has no unit of length or angle."""
    if signal.shape is None:
        return ()
    sample_units = [units.parse(text) for text in signal.unit.split(",")]
    count = math.prod(signal.shape)
    every = sample_units * count if len(sample_units) == 1 else sample_units
    return tuple(every) if len(every) == count and any(every) else ()


class _Tracer:
    """The positions at the ports of a resolved document."""

    def __init__(self, nodes: Sequence[Node], world: World) -> None:
        self.nodes = {n.id: n for n in nodes}
        self.world = world
        self._positions: dict[str, Mapping[str, PositionUnits]] = {}

    def judge(self) -> list[Problem]:
        """Return the problems and warnings of all elements that receive a position of the world."""
        return [p for n in self.nodes.values() for p in self._judged(n)]

    def _judged(self, n: Node) -> Iterator[Problem]:
        for port, code in n.element.position_codes(n.ins).items():
            yield from self._encoded(n, port, code)
        if name := n.element.motor_name():
            yield from self._commanded(n, name)

    def _encoded(self, n: Node, port: str, code: PositionCode) -> Iterator[Problem]:
        """Yield the problem and the warnings of an element that uses numbers as positions on axes."""
        arriving = self.arriving(n, port)
        source = self._source(arriving)
        if source is None or len(arriving) != len(code.axes) or not source.element.sensor_name():
            return
        scaled = [p and p.scaled(float(g)) for p, g in zip(arriving, code.gains, strict=True)]
        wrong = [
            (axis, ratio)
            for axis, p in zip(code.axes, scaled, strict=True)
            if p is not None and (ratio := _ratio(p, axis.unit)) is not None
        ]
        if wrong:
            yield self._problem(n, source, code, wrong)
            return
        offsets = code.offsets
        for axis, p, offset in zip(code.axes, scaled, offsets or (), strict=offsets is not None):
            if p is not None and p.bounds is not None and not axis.periodic:
                low, high = (b + offset for b in p.bounds)
                read = f"the positions that {source.path} reads"
                unit = units.of_size(p.quantity, p.size)
                symbol = "" if axis.unit or unit is None else unit.symbol
                for problem, fix in barely_overlap(axis, (low, high), read, symbol):
                    yield Problem(n.path, problem, fix, "warning")

    def _problem(
        self, n: Node, source: Node, code: PositionCode, wrong: Sequence[tuple[Axis, float]]
    ) -> Problem:
        axis, ratio = wrong[0]
        signal = self.world.sensors[source.element.sensor_name()]
        name, names = code.parameter, " and ".join(repr(a.name) for a, _ in wrong)
        gains = ", ".join(f"{g:g}" for g in dict.fromkeys(map(float, code.gains)))
        problem = (
            f"uses {source.path}, which is read in {signal.unit}, with a {name} of {gains} on"
            f" {'the axis' if len(wrong) == 1 else 'the axes'} {names} in {axis.unit}: all values are"
            f" {_times(ratio)}"
        )
        factors = [dict(wrong).get(a, 1.0) for a in code.axes]
        new = tuple(rounded(g * f, 6) for g, f in zip(code.gains, factors, strict=True))
        change = SetValues(((name, new[0] if len(set(new)) == 1 else new),), n.path)
        read = units.parse(signal.unit)
        fitting = None if read is None else units.of_size(read.quantity, read.size / ratio)
        choose = None if fitting is None else _choose(self.world, fitting, "Or choose")
        return Problem(n.path, problem, EditFix(f"Set its {name}", [change], choose or ""))

    def _commanded(self, n: Node, name: str) -> Iterator[Problem]:
        """Yield the problem of an element whose inputs are a command in another unit than the motor's."""
        signal = self.world.motors.get(name)
        for port in n.ins if signal is not None else ():
            arriving = self.arriving(n, port)
            source = self._source(arriving)
            if signal is None or source is None or source.element.sensor_name():
                continue
            for unit, p in zip(_units(signal), arriving, strict=False):
                ratio = None if unit is None or p is None else _ratio(p, unit.symbol)
                if unit is not None and ratio is not None:
                    problem = (
                        f"the motor {name!r} takes {unit.symbol}, and the position that {source.path} reads"
                        f" out makes all commands {_times(ratio)}"
                    )
                    gain = f"Connect it through a gain: dd.Gain({ratio:.6g})"
                    page = f"Connect it through a Gain of {ratio:.6g}"
                    yield Problem(n.path, problem, self._between(n, port, Fix(gain, page=page)))
                    return

    def _between(self, n: Node, port: str, fix: Fix) -> Fix:
        """Return a fix of what a port reads, with the ends of the connection if there is one alone."""
        slots = n.reads.get(port, [])
        sources = [(self.nodes[ident], out) for ident, out, _ in slots if self.nodes[ident].declared]
        if len(slots) != 1 or not sources:
            return fix
        ((source, out),) = sources
        return ConnectionFix(fix, fix.page, (source.path, out, n.path, port), fix.shell)

    def _source(self, positions: PositionUnits) -> Node | None:
        """Return the element that positions come from; None if there are none."""
        return next((self.nodes[p.source] for p in positions if p is not None), None)

    def arriving(self, n: Node, port: str) -> PositionUnits:
        """Return the positions at an input port: those of all sources that have the same unit."""
        if port == n.element.external:
            return self._reading(n)
        slots = n.reads.get(port, [])
        positions = [p for source, name, _ in slots if (p := self._leaving(self.nodes[source], name))]
        if not positions or any(not _alike(positions[0], other) for other in positions[1:]):
            return ()
        # the sum of several inputs has other bounds
        return positions[0] if len(slots) == 1 else tuple(p and p.unbounded() for p in positions[0])

    def _leaving(self, n: Node, port: str) -> PositionUnits:
        """Return the positions at an output port."""
        if n.id not in self._positions:
            self._positions[n.id] = {}  # for loops
            self._positions[n.id] = n.element.position_units(n.ins, _Arriving(self, n))
        positions = self._positions[n.id].get(port, ())
        return tuple(p and dc.replace(p, source=p.source or n.id) for p in positions)

    def _reading(self, n: Node) -> PositionUnits:
        """Return the positions in the reading of a sensor."""
        signal = self.world.sensors.get(n.element.sensor_name())
        sample_units = () if signal is None else _units(signal)
        if signal is None or not sample_units:
            return ()
        bounds = signal.bounds or [None] * len(sample_units)
        return tuple(
            None if unit is None else PositionUnit(unit.quantity, unit.size, b)
            for unit, b in zip(sample_units, bounds, strict=False)
        )


class _Arriving(Mapping[str, PositionUnits]):
    """The positions at the input ports of an element; only those that it asks for are followed."""

    def __init__(self, tracer: _Tracer, node: Node) -> None:
        self.tracer, self.node = tracer, node

    def __getitem__(self, port: str) -> PositionUnits:
        return self.tracer.arriving(self.node, port)

    def __iter__(self) -> Iterator[str]:
        return iter(self.node.ins)

    def __len__(self) -> int:
        return len(self.node.ins)


def _alike(first: PositionUnits, second: PositionUnits) -> bool:
    """Return whether two ports have the same units, whatever their bounds and their sources."""
    plain = [
        [p and dc.replace(p, bounds=None, source="") for p in positions] for positions in (first, second)
    ]
    return plain[0] == plain[1]


def _ratio(p: PositionUnit, unit: str) -> float | None:
    """Return the factor by which a number is too small for a unit of the same quantity.

    Return None if they agree, and if the factor converts between no two units: the number then is a
    coordinate of the user's own.
    """
    stated = units.parse(unit)
    if stated is None or stated.quantity != p.quantity:
        return None
    ratio = p.size / stated.size
    if p.quantity == "length":
        power = round(math.log10(ratio))
        return 10.0**power if power and math.isclose(ratio, 10.0**power, rel_tol=1e-6) else None
    return ratio if stated != units.of_size(p.quantity, p.size) is not None else None


def _times(ratio: float) -> str:
    return f"{ratio:.4g} times too small" if ratio > 1 else f"{1 / ratio:.4g} times too large"


def _choose(world: World, unit: MetricUnit, verb: str = "Choose") -> WorldFix | None:
    """Return what to type for a world with lengths in another unit; None without such an argument."""
    kind = type(world).__name__
    if "unit" not in inspect.signature(type(world)).parameters:
        return None
    name = str(world.describe().get("file", "")) or "..."
    words = option(
        f"{verb} the unit of the world:",
        "world",
        f'"{kind.lower()}:{name}, unit={unit.symbol}"',
        f'dd.{kind}("{name}", unit="{unit.symbol}")',
        unit.symbol,
    )
    return WorldFix(words, words.shell, words.page)
