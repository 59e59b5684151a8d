"""Carry the states of elements over a change of a running model, along their axes; or say why that cannot be.

Every change passes here: other axes, another element in the place of one, an edit, a snapshot, what was
learned. docs/models.md states for each change what is carried.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import jax
import numpy as np

from deodar.compiler.arguments import ProgramState
from deodar.compiler.executable import Executable
from deodar.element import Setting
from deodar.errors import ParameterError, Problem
from deodar.leaves import same_structure
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.model.resolve import Node
from deodar.numerics import units
from deodar.numerics.axes import Axis
from deodar.session.run import Run, host
from deodar.session.session_snapshot import StateRow, rows

Dimension = Axis | int
"""What a dimension of a state is: an axis, or a number of rows, which have no positions."""

NEAR = 1e-6
"""Distance from a sample, in samples, below which a position is that of the sample."""


class Uncarried(Exception):
    """The reason why a state cannot be carried, as a part of a sentence."""


def nodes_of(program: Executable) -> dict[str, Node]:
    """Return the nodes of a program by id."""
    return {ident: program.plan.groups[g].nodes[r] for ident, (g, r) in program.plan.row.items()}


def nodes(doc: Document) -> dict[str, Node]:
    """Return the nodes of a document by id."""
    return {node.id: node for node in graph(doc).nodes}


def put_rows(
    program: Executable,
    state: ProgramState,
    states: Mapping[str, tuple[StateRow, StateRow]],
    before: Mapping[str, Node],
    copy: tuple[int, ...] = (),
) -> dict[str, str]:
    """Write states by id into arrays on the host.

    What cannot be carried stays as it is in `state`; return the reasons by id.

    Args:
        program: the program of `state`.
        state: its arrays, changed in place.
        states: the states by id.
        before: the nodes that had these states.
        copy: index of a copy in a batch.
    """
    after, reasons = nodes_of(program), dict[str, str]()
    for ident in after.keys() & states.keys() & before.keys():
        g, r = program.plan.row[ident]
        for row, target in zip(
            states[ident], (state["groups"][g], state["held"].get(str(g), {})), strict=True
        ):
            try:
                if before[ident] is after[ident]:
                    new = {name: row[name] for name in target}
                else:
                    fresh = {name: np.asarray(values[(*copy, r)]) for name, values in target.items()}
                    new = _carried(before[ident], row, after[ident], fresh)
            except Uncarried as reason:
                reasons[ident] = str(reason)
                continue
            for name, values in new.items():
                target[name][(*copy, r)] = values
    return reasons


def fill(run: Run, states: Mapping[str, tuple[StateRow, StateRow]], before: Mapping[str, Node]) -> None:
    """Write states by id, of the nodes `before`, into the present program; other elements start at their
    initial states.

    Noise follows from seed and tick.
    """
    fresh, run.keys = run.program.init(run.values, run.seed, run.trials)
    state = host(fresh)
    put_rows(run.program, state, states, before)
    run.state = state
    run.forget()


def put_states(run: Run, states: Mapping[str, tuple[StateRow, StateRow]], before: Mapping[str, Node]) -> None:
    """Replace the states of elements; time, noise, parameters, the world and its readings continue."""
    sensed, unread = run.sensed, run.exchange.unread
    fill(run, states, before)
    run.sensed, run.exchange.unread = sensed, unread


def require_carried(run: Run, doc: Document) -> None:
    """Raise ParameterError if a state of a run cannot be carried into another document.

    A state that is still that of the start is not lost, and needs no carrying.
    """
    before, problems = nodes_of(run.program), dict[str, Problem]()
    changed = [n for n in graph(doc).nodes if n.id in before and not _alike(before[n.id], n)]
    if not changed:
        return
    states = rows(run.program, host(run.state))
    for node in changed:
        try:
            _carried(before[node.id], states[node.id][0], node, _blank(node))
        except Uncarried as reason:
            problems[node.id] = Problem(
                node.path,
                f"the state that it has now cannot be carried: {reason}",
                "Reset the run first, which gives the state up",
            )
    if problems:
        fresh, _ = run.program.init(run.values, run.seed, run.trials)
        begun = rows(run.program, host(fresh))
        lost = [p for ident, p in problems.items() if not _equal(states[ident], begun[ident])]
        if lost:
            raise ParameterError(lost)


# ------------------------------------------------------------------------------------------------ one element


def _alike(a: Node, b: Node) -> bool:
    return a.ins == b.ins and a.outs == b.outs and same_structure(a.element, b.element)


def _equal(a: tuple[StateRow, StateRow], b: tuple[StateRow, StateRow]) -> bool:
    return all(
        np.array_equal(first[name], second[name])
        for first, second in zip(a, b, strict=True)
        for name in first
    )


def _blank(node: Node) -> StateRow:
    """Return a state of the shapes that an element begins with."""
    setting = Setting(node.ins, node.outs, np.float32)
    shapes = jax.eval_shape(lambda: node.element.init(setting))
    return {name: np.broadcast_to(np.float32(0), s.shape) for name, s in shapes.items()}


def _carried(before: Node, state: StateRow, after: Node, fresh: StateRow) -> StateRow:
    """Return the states that an element begins with in the place of another one.

    An element of another kind takes over the states of the same names; others are `fresh`.

    Raises:
        Uncarried: one of them has no place in the new element.
    """
    if type(before.element) is type(after.element) and (lacking := fresh.keys() - state.keys()):
        raise Uncarried(f"it now also stores {', '.join(sorted(lacking))}")
    was, becomes = _dimensions(before, state), _dimensions(after, fresh)
    return {
        name: _resampled(state[name], was[name], becomes[name], np.asarray(values))
        if name in state
        else values
        for name, values in fresh.items()
    }


def _dimensions(node: Node, state: StateRow) -> dict[str, Sequence[Dimension]]:
    """Return what the dimensions of each state are; a state that declares nothing is over the axes of the
    first output.
    """
    declared, first = node.element.state_axes(node.ins), next(iter(node.outs.values()), ())
    out: dict[str, Sequence[Dimension]] = {}
    for name, values in state.items():
        dimensions: Sequence[Dimension] = declared.get(name, first)
        samples = [d if isinstance(d, int) else d.samples for d in dimensions]
        out[name] = dimensions if samples == list(np.shape(values)) else np.shape(values)
    return out


# ------------------------------------------------------------------------------------------------- one array


def _resampled(
    values: np.ndarray, was: Sequence[Dimension], becomes: Sequence[Dimension], fresh: np.ndarray
) -> np.ndarray:
    """Return an array over other axes: linear between samples, `fresh` where the old axes have no value."""
    if list(was) == list(becomes):
        return values
    order = _partners(was, becomes)
    new, covered = np.transpose(values, order).astype(np.float64), np.ones((), bool)
    for d, (k, axis) in enumerate(zip(order, becomes, strict=True)):
        old = was[k]
        if isinstance(axis, int) or isinstance(old, int):
            covered = covered[..., None] & np.ones(new.shape[d], bool)
            continue
        lower, upper, share, inside = _neighbours(old, axis)
        if not inside.any():
            raise Uncarried(f"the axis {axis} has no position in common with {old}")
        share = share.reshape(-1, *(1 for _ in range(d + 1, new.ndim)))
        # equal to the sample where the share is 0, whatever its neighbour is
        a = np.take(new, lower, d)
        new = np.where(share == 0, a, a + share * (np.take(new, upper, d) - a))
        covered = covered[..., None] & inside
    return np.where(covered, new.astype(fresh.dtype), fresh)


def _partners(was: Sequence[Dimension], becomes: Sequence[Dimension]) -> list[int]:
    """Return for each new dimension the index of the old one that it continues.

    Axes continue those of their name, or one of equal bounds and another name; rows continue as many rows.
    """
    free = list(range(len(was)))
    partners: list[int | None] = []
    for n, d in enumerate(becomes):  # of several of one name that of the same place
        k = n if n < len(was) and _same_name(was[n], d) else None
        free = [m for m in free if m != k]
        partners.append(k)
    for n, d in enumerate(becomes):
        if partners[n] is None:
            partners[n] = k = next((k for k in free if _same_name(was[k], d)), None)
            free = [m for m in free if m != k]
    for n, d in enumerate(becomes):
        if partners[n] is None:
            k = next((k for k in sorted(free, key=lambda k: k != n) if _renamed(was[k], d)), None)
            if k is None:
                raise Uncarried(f"nothing is known along {_named(d)}")
            free.remove(k)
            partners[n] = k
    if free:
        raise Uncarried(f"it is no longer along {_named(was[free[0]])}")
    return [k for k in partners if k is not None]


def _same_name(a: Dimension, b: Dimension) -> bool:
    if isinstance(a, int) or isinstance(b, int):
        return isinstance(a, int) and isinstance(b, int) and a == b
    return a.name == b.name


def _renamed(a: Dimension, b: Dimension) -> bool:
    return isinstance(a, Axis) and isinstance(b, Axis) and a.fits(b)


def _named(d: Dimension) -> str:
    return f"{d} rows of it" if isinstance(d, int) else f"the axis {d.name}"


def _neighbours(old: Axis, new: Axis) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return for each sample of a new axis the samples of the old one below and above it, the share of the
    upper one, and whether the old axis has a value at it.
    """
    scale = _scale(old, new)
    place = (new.points * scale - old.lower) / old.step
    place = np.where(np.abs(place - np.round(place)) < NEAR, np.round(place), place)
    if old.periodic:
        if new.periodic and math.isclose(new.range * scale, old.range, rel_tol=1e-9):
            place %= old.samples
        inside = (place >= 0) & (place <= old.samples)
    else:
        inside = (place >= 0) & (place <= old.samples - 1)
    below = np.floor(place)
    lower = below.astype(int)
    upper = (lower + 1) % old.samples if old.periodic else np.clip(lower + 1, 0, old.samples - 1)
    lower = lower % old.samples if old.periodic else np.clip(lower, 0, old.samples - 1)
    return lower, upper, place - below, inside


def _scale(old: Axis, new: Axis) -> float:
    """Return how many units of the old axis are one of the new axis; one that states no unit has the same."""
    if old.unit == new.unit or not old.unit or not new.unit:
        return 1.0
    a, b = units.parse(old.unit), units.parse(new.unit)
    if a is None or b is None or a.quantity != b.quantity:
        raise Uncarried(f"the unit of the axis {new.name} was {old.unit}, and becomes {new.unit}")
    return b.size / a.size
