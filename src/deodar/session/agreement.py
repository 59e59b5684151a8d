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
from collections.abc import Iterator, Sequence

from deodar.couplings.delay import Delay
from deodar.couplings.gain import Gain
from deodar.couplings.peak_position import PeakPosition
from deodar.couplings.space_code import SpaceCode
from deodar.couplings.steered_shift import SteeredShift
from deodar.couplings.sum import Sum
from deodar.couplings.weights import Weights
from deodar.elements.attractor import Attractor
from deodar.elements.motor import Motor
from deodar.elements.sensor import Sensor
from deodar.errors import Problem, RunWarning
from deodar.leaves import per_axis
from deodar.model.document import Document
from deodar.model.resolve import Node, resolve
from deodar.numerics import units
from deodar.numerics.axes import Axis, barely_overlap, cell
from deodar.numerics.units import MetricUnit
from deodar.parameters import FrozenArray
from deodar.worlds._base import Signal, World
from deodar.worlds._failure import errors_of


@dc.dataclass(frozen=True)
class PositionUnit:
    """A number that a model receives or sends as a position or an angle.

    Attributes:
        quantity: `length` or `angle`.
        size: metres or radians for an increase by 1.
        bounds: its smallest and largest value; None: unknown.
    """

    quantity: str
    size: float
    bounds: tuple[float, float] | None = None

    def scaled(self, factor: float) -> PositionUnit | None:
        """Return the position that is `factor` times this number; None for a factor of 0."""
        if not factor or not math.isfinite(factor):
            return None
        one, other = (None, None) if self.bounds is None else (factor * b for b in self.bounds)
        bounds = None if one is None or other is None else (min(one, other), max(one, other))
        return PositionUnit(self.quantity, self.size / abs(factor), bounds)


@dc.dataclass(frozen=True)
class PortPositions:
    """The numbers at a port that are positions, one for each sample, and the element that they come from."""

    source: Node
    samples: tuple[PositionUnit | None, ...]


def judge(doc: Document, world: World | None) -> list[Problem]:
    """Return the problems and the warnings of a document in a world that has all of its signals."""
    if not isinstance(world, World):
        return []
    with errors_of(world, "validate"):
        found = list(world.validate())
    found += [
        p for e in doc.entries if isinstance(e.element, Sensor) for p in _axes(e.path, e.element, world)
    ]
    if _exchanges_positions(doc, world):
        nodes, problems = resolve(doc)
        found += [] if problems else _Tracer(nodes, world).judge()
    return found


def warn(doc: Document, world: World | None, stacklevel: int) -> None:
    """Issue a `RunWarning` for each warning about a document in a world."""
    for p in judge(doc, world):
        if p.severity == "warning":
            warnings.warn(str(p), RunWarning, stacklevel=stacklevel + 1)


def _axes(path: str, sensor: Sensor, world: World) -> Iterator[Problem]:
    """Yield what is wrong with the axes of a sensor."""
    signal = world.sensors.get(sensor.sensor)
    if signal is None:  # a user's world may accept any name
        return
    with errors_of(world, "validate_axes"):
        found = list(world.validate_axes(sensor.sensor, tuple(sensor.axes)))
    yield from (dc.replace(p, where=path) for p in found)
    given = units.parse(signal.unit)
    for axis in sensor.axes if signal.shape is not None else ():
        stated = units.parse(axis.unit)
        if given is not None and stated is not None and _differ(given, stated):
            what = (
                f"its axis {axis.name!r} states the unit {axis.unit}, and the world gives {sensor.sensor!r}"
                f" in {signal.unit}"
            )
            yield Problem(path, what, _choose(world, stated) or f"Write unit={signal.unit!r} for the axis")


def _exchanges_positions(doc: Document, world: World) -> bool:
    sensors = {e.element.sensor for e in doc.entries if isinstance(e.element, Sensor)}
    motors = {e.element.motor for e in doc.entries if isinstance(e.element, Motor)}
    used = [s for n, s in world.sensors.items() if n in sensors] + [
        s for n, s in world.motors.items() if n in motors
    ]
    return any(_units(s) for s in used)


def _units(signal: Signal) -> tuple[MetricUnit | None, ...]:
    """Return the unit of each sample of a signal; empty if it has no unit of length or angle."""
    if signal.shape is None:
        return ()
    found = [units.parse(text) for text in signal.unit.split(",")]
    count = math.prod(signal.shape)
    every = found * count if len(found) == 1 else found
    return tuple(every) if len(every) == count and any(every) else ()


class _Tracer:
    """The positions at the ports of a resolved document."""

    def __init__(self, nodes: Sequence[Node], world: World) -> None:
        self.nodes = {n.id: n for n in nodes}
        self.world = world
        self._found: dict[tuple[str, str], PortPositions | None] = {}

    def judge(self) -> list[Problem]:
        """Return the problems and warnings of all elements that receive a position of the world."""
        return [p for n in self.nodes.values() for p in self._judged(n)]

    def _judged(self, n: Node) -> Iterator[Problem]:
        e = n.element
        if isinstance(e, SpaceCode):
            axes = tuple(e.axes)
            yield from self._encoded(n, "input", axes, per_axis(e.gain, axes), per_axis(e.offset, axes))
        elif isinstance(e, SteeredShift):
            known = {a.name: a for a in n.ins["input"]}
            axes = tuple(known[name] for name in e.along if name in known)
            yield from self._encoded(n, "by", axes, [e.gain] * len(axes), None)
        elif isinstance(e, Motor):
            yield from self._commanded(n, e)

    def _encoded(
        self,
        n: Node,
        port: str,
        axes: Sequence[Axis],
        gains: Sequence[float],
        offsets: Sequence[float] | None,
    ) -> Iterator[Problem]:
        """Yield the problem and the warnings of an element that uses numbers as positions on axes.

        Args:
            n: the element.
            port: its input port, with one number for each axis.
            axes: the axes.
            gains: axis units per unit of each number.
            offsets: position for a number of 0, in axis units; None: the numbers are distances.
        """
        arriving = self._arriving(n, port)
        if arriving is None or len(arriving.samples) != len(axes) or not _is_sensor(arriving):
            return
        there = [p and p.scaled(float(g)) for p, g in zip(arriving.samples, gains, strict=True)]
        wrong = [
            (axis, ratio)
            for axis, p in zip(axes, there, strict=True)
            if p is not None and (ratio := _ratio(p, axis.unit)) is not None
        ]
        if wrong:
            yield self._problem(n, arriving.source, axes, wrong, gains)
            return
        for axis, p, offset in zip(axes, there, offsets or (), strict=offsets is not None):
            if p is not None and p.bounds is not None and not axis.periodic:
                low, high = (b + offset for b in p.bounds)
                read = f"the positions that {arriving.source.path} reads"
                unit = units.of_size(p.quantity, p.size)
                given = "" if axis.unit or unit is None else unit.symbol
                for what, fix in barely_overlap(axis, (low, high), read, given):
                    yield Problem(n.path, what, fix, "warning")

    def _problem(
        self,
        n: Node,
        source: Node,
        axes: Sequence[Axis],
        wrong: Sequence[tuple[Axis, float]],
        gains: Sequence[float],
    ) -> Problem:
        axis, ratio = wrong[0]
        signal = self.world.sensors[_sensor(source)]
        names = " and ".join(repr(a.name) for a, _ in wrong)
        given = ", ".join(f"{g:g}" for g in dict.fromkeys(map(float, gains)))
        what = (
            f"uses {source.path}, which is read in {signal.unit}, with a gain of {given} on"
            f" {'the axis' if len(wrong) == 1 else 'the axes'} {names} in {axis.unit}: all values are"
            f" {_times(ratio)}"
        )
        factors = [dict(wrong).get(a, 1.0) for a in axes]
        new = [f"{g * f:.6g}" for g, f in zip(gains, factors, strict=True)]
        value = new[0] if len(set(new)) == 1 else f"[{', '.join(new)}]"
        change = f"Set its gain: model.set({f'{n.path}.gain'!r}, {value})"
        read = units.parse(signal.unit)
        fitting = None if read is None else units.of_size(read.quantity, read.size / ratio)
        choose = "" if fitting is None else _choose(self.world, fitting)
        return Problem(n.path, what, f"{choose}. Or: {change[0].lower()}{change[1:]}" if choose else change)

    def _commanded(self, n: Node, motor: Motor) -> Iterator[Problem]:
        signal, arriving = self.world.motors.get(motor.motor), self._arriving(n, "input")
        if signal is None or arriving is None or _is_sensor(arriving):
            return
        for wanted, p in zip(_units(signal), arriving.samples, strict=False):
            ratio = None if wanted is None or p is None else _ratio(p, wanted.symbol)
            if wanted is not None and ratio is not None:
                what = (
                    f"the motor {motor.motor!r} takes {wanted.symbol}, and the position that"
                    f" {arriving.source.path} reads out makes all commands {_times(ratio)}"
                )
                yield Problem(n.path, what, f"Connect it through a gain: dd.Gain({ratio:.6g})")
                return

    def _arriving(self, n: Node, port: str) -> PortPositions | None:
        """Return the positions at an input port: those of all sources that have the same unit."""
        slots = n.reads.get(port, [])
        known = [f for source, p, _ in slots if (f := self._leaving(self.nodes[source], p)) is not None]
        if not known:
            return None
        first = known[0]
        if any(not _alike(first, other) for other in known[1:]):
            return None
        # the sum of several inputs has other bounds
        return first if len(slots) == 1 else PortPositions(first.source, _unbounded(first.samples))

    def _leaving(self, n: Node, port: str) -> PortPositions | None:
        """Return the positions at an output port."""
        if (n.id, port) not in self._found:
            self._found[n.id, port] = None  # for loops
            self._found[n.id, port] = self._computed(n, port)
        return self._found[n.id, port]

    def _computed(self, n: Node, port: str) -> PortPositions | None:
        e = n.element
        if isinstance(e, Sensor):
            return self._read(n, e)
        if isinstance(e, (PeakPosition, Attractor)) and port == "output" and len(n.ins["input"]) == 1:
            unit = units.parse(n.ins["input"][0].unit)
            read = None if unit is None else PositionUnit(unit.quantity, unit.size)
            factor = e.gain if isinstance(e, Attractor) else 1.0
            return None if read is None else PortPositions(n, (read.scaled(factor),))
        arriving = self._arriving(n, "input") if isinstance(e, (Gain, Delay, Sum, Weights)) else None
        if arriving is None or isinstance(e, (Delay, Sum)):
            return arriving
        if isinstance(e, Gain):
            return PortPositions(arriving.source, tuple(p and p.scaled(e.factor) for p in arriving.samples))
        return _weighted(n, e, arriving) if isinstance(e, Weights) else None

    def _read(self, n: Node, sensor: Sensor) -> PortPositions | None:
        signal = self.world.sensors.get(sensor.sensor)
        found = () if signal is None else _units(signal)
        if signal is None or not found:
            return None
        bounds = signal.bounds or [None] * len(found)
        return PortPositions(
            n,
            tuple(
                None if unit is None else PositionUnit(unit.quantity, unit.size, b)
                for unit, b in zip(found, bounds, strict=False)
            ),
        )


def _weighted(n: Node, e: Weights, arriving: PortPositions) -> PortPositions | None:
    """Return weighted sums of positions that have one unit each."""
    if not isinstance(e.weights, FrozenArray):
        return None
    rows = e.weights.data.reshape(-1, len(arriving.samples)) * cell(n.ins["input"])
    out: list[PositionUnit | None] = []
    for row in rows:
        used = [
            p and p.scaled(float(w)) for w, p in zip(row.tolist(), arriving.samples, strict=True) if w != 0
        ]
        first = used[0] if used else None
        same = first is not None and all(
            p is not None and p.quantity == first.quantity and math.isclose(p.size, first.size, rel_tol=1e-9)
            for p in used
        )
        out.append(first if same and len(used) == 1 else _unbounded((first,))[0] if same else None)
    return PortPositions(arriving.source, tuple(out))


def _unbounded(samples: Sequence[PositionUnit | None]) -> tuple[PositionUnit | None, ...]:
    return tuple(p and dc.replace(p, bounds=None) for p in samples)


def _alike(one: PortPositions, other: PortPositions) -> bool:
    return _unbounded(one.samples) == _unbounded(other.samples)


def _is_sensor(found: PortPositions) -> bool:
    return isinstance(found.source.element, Sensor)


def _sensor(source: Node) -> str:
    assert isinstance(source.element, Sensor)
    return source.element.sensor


def _differ(one: MetricUnit, other: MetricUnit) -> bool:
    return one.quantity == other.quantity and one != other


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


def _choose(world: World, unit: MetricUnit) -> str:
    """Return what to type for a world with lengths in another unit; "" if its class has no such argument."""
    kind = type(world).__name__
    if "unit" not in inspect.signature(type(world)).parameters:
        return ""
    name = str(world.describe().get("file", "")) or "..."
    return (
        f'Choose the unit of the world: dd.{kind}("{name}", unit="{unit.symbol}"), on the command line'
        f' --world "{kind.lower()}:{name}, unit={unit.symbol}"'
    )
