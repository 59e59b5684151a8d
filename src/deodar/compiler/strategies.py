"""The convolution strategy of every kernel of a model, and the couplings that are summed as spectral modes.

A convolution is cheap in spectral modes. If fields over the same axes are coupled by Gaussian kernels, each
field is therefore transformed once, all kernels are applied to its modes, the inputs of a field are summed as
modes, and one inverse transform follows. `strategies` decides before compiling, by the costs of
`numerics.choice` and the declarations of elements (`role`); `sharing` implements the decision.
"""

from __future__ import annotations

import dataclasses as dc
import functools
from collections import Counter, defaultdict
from collections.abc import Collection, Hashable, Iterator, Mapping, Sequence
from typing import Literal

from deodar.compiler.functions import convolved_axes
from deodar.element import Element
from deodar.leaves import structure
from deodar.model.resolve import Node, reach
from deodar.numerics import interaction
from deodar.numerics.axes import Axes
from deodar.numerics.choice import Choice, Shards, by_matrices, together


@dc.dataclass(frozen=True)
class Strategy:
    """How one element applies its kernels.

    Attributes:
        choices: for each kind of boundaries the choice, where it is not matrices.
        shared: the kind of boundaries whose waves it shares with others, or "".
        apart: whether its matrices are not multiplied by the amplitudes of the kernels, so that copies which
            differ by amplitudes alone have the same matrices.
    """

    choices: tuple[tuple[str, Choice], ...] = ()
    shared: str = ""
    apart: bool = False


EXACT = Strategy()
WORTH = 1.1
"""Largest relative cost of a step that is accepted for a program with fewer groups, which compiles faster."""

SharingRole = Literal["", "source", "filter", "gain"]

Cycle = tuple[list[Node], str, Choice]
"""Nodes, the kind of boundaries, and the waves that they share."""


def role(n: Node) -> SharingRole:
    """Return the role of an element in a sum of spectral modes, from its declarations: a `source`, whose
    dynamics also receive modes, a `filter`, or a `gain`.
    """
    return _role(type(n.element))


@functools.cache
def _role(cls: type[Element]) -> SharingRole:
    """Return the role of a class; a class that overrides a function must repeat the declaration."""
    convolution = cls.convolution if _holds(cls, "convolution") else None
    if convolution is None:
        return "gain" if cls.scaled_by and _holds(cls, "scaled_by") else ""
    if (convolution.of, convolution.into) == ("output", "input") and cls.stateful:
        return "source"
    return "filter" if (convolution.of, convolution.into) == ("input", "output") and not cls.stateful else ""


def _holds(cls: type[Element], fact: str) -> bool:
    for base in cls.__mro__:
        if fact in vars(base):
            return True
        if not {"output", "advance"}.isdisjoint(vars(base)):
            return False
    return False


def acted_axes(n: Node) -> Axes:
    """Return the axes over which an element convolves or scales."""
    return convolved_axes(n) or (n.outs["output"] if role(n) else ())


def strategies(
    nodes: Sequence[Node],
    still: Mapping[str, bool],
    exact: Collection[str],
    copies: int = 1,
    shards: Shards | None = None,
) -> dict[str, Strategy]:
    """Return the strategy of every node.

    Args:
        nodes: the resolved nodes of the model.
        still: for each node whether it is constant during a chunk.
        exact: ids of nodes that use matrices.
        copies: number of copies of the whole model that run at once.
        shards: the axis that devices divide.
    """
    alike = Counter(_likeness(n) for n in nodes)
    out: dict[str, Strategy] = {}
    for n in nodes:
        choices = (
            {}
            if n.id in exact
            else interaction.choices(n.element.kernels(), acted_axes(n), copies * alike[_likeness(n)], shards)
        )
        out[n.id] = Strategy(_sorted(choices))
    free = [n for n in nodes if role(n) and not still[n.id] and n.id not in exact and acted_axes(n)]
    for members, key, choice in _merged(list(_cycles(free, out, copies, shards)), free, out, copies, shards):
        for n in members:
            out[n.id] = Strategy(_sorted({**dict(out[n.id].choices), key: choice}), key)
    return out


def _merged(
    cycles: Sequence[Cycle],
    free: Sequence[Node],
    alone: Mapping[str, Strategy],
    copies: int,
    shards: Shards | None,
) -> Iterator[Cycle]:
    """Yield cycles, merged where that costs little more: cycles over the same axes with the same spectral
    modes, and fields that would use spectral modes on their own. This gives fewer groups.
    """
    places: dict[tuple[Axes, int, str], list[Cycle]] = {}
    for cycle in cycles:
        first = cycle[0][0]
        places.setdefault((acted_axes(first), first.every, cycle[1]), []).append(cycle)
    for (axes, every, key), alike in places.items():
        inside = {n.id for members, _, _ in alike for n in members}
        beside = [
            n
            for n in free
            if role(n) == "source" and n.id not in inside and (acted_axes(n), n.every) == (axes, every)
        ]
        beside = [n for n in beside if getattr(dict(alone[n.id].choices).get(key), "method", "") == "waves"]
        everyone = [n for n in free if n.id in inside | {n.id for n in beside}]
        choice = _waves_of(everyone, key, copies, shards)
        apart = sum(_shared_cost(members, key, cycle_choice) for members, _, cycle_choice in alike) + sum(
            _alone(n, key, alone, axes, copies) for n in beside
        )
        if _shared_cost(everyone, key, choice) <= WORTH * apart:
            yield everyone, key, choice
        else:
            yield from alike


def _cycles(
    free: Sequence[Node], alone: Mapping[str, Strategy], copies: int, shards: Shards | None
) -> Iterator[Cycle]:
    """Yield nodes that are linked through filters of one kind of boundaries, if sharing spectral modes is
    cheaper than using them separately.
    """
    keys = {n.id: _key(n) for n in free if role(n) == "filter"}
    taken: set[str] = set()
    for first, key in keys.items():
        if not key or first in taken:
            continue
        other_keys = {i for i, boundaries in keys.items() if boundaries != key}
        members = _reached(first, [n for n in free if n.id not in taken | other_keys])
        taken |= members
        cycle = [n for n in free if n.id in members]
        choice = _waves_of(cycle, key, copies, shards)
        apart = sum(_alone(n, key, alone, acted_axes(n), copies) for n in cycle if role(n) != "gain")
        if any(role(n) == "source" for n in cycle) and _shared_cost(cycle, key, choice) < apart:
            yield cycle, key, choice


def _reached(first: str, nodes: Sequence[Node]) -> set[str]:
    """Return the nodes that are linked to one of them, through any number of others."""
    by = {n.id: n for n in nodes}
    beside: dict[str, list[str]] = defaultdict(list)
    for n in nodes:
        for source, port, _ in n.reads["input"]:
            beside[source].append(n.id)
            beside[n.id] += [source] if port == "output" else []
    return reach([first], lambda i: [j for j in beside[i] if j in by and _linked(by[i], by[j])])


def _linked(a: Node, b: Node) -> bool:
    """Return whether two neighbours could share spectral modes: not two fields without a kernel between."""
    return acted_axes(a) == acted_axes(b) and a.every == b.every and not role(a) == role(b) == "source"


def _waves_of(members: Sequence[Node], key: str, copies: int, shards: Shards | None) -> Choice:
    """Return the spectral modes that all kernels of these nodes need."""
    axes = acted_axes(members[0])
    terms = [span for n in members for span in interaction.spans(n.element.kernels(), axes).get(key, ())]
    return together(axes, tuple(key.split()), interaction.covering(terms), copies * len(members), shards)


def _shared_cost(members: Sequence[Node], key: str, choice: Choice) -> float:
    """Return the cost of sharing: half a transform for each field whose output is needed as spectral modes,
    and half for each inverse transform.
    """
    axes = acted_axes(members[0])
    transformed = {s[0] for n in members if role(n) == "filter" for s in n.reads["input"]}
    total = 0.0
    for n in members:
        if role(n) == "source":
            lateral = key in interaction.spans(n.element.kernels(), axes)
            total += choice.nanoseconds * (0.5 * (lateral or n.id in transformed) + 0.5)
    return total


def _alone(n: Node, key: str, alone: Mapping[str, Strategy], axes: Axes, copies: int) -> float:
    choice = dict(alone[n.id].choices).get(key)
    if choice is not None:
        return choice.nanoseconds
    terms = interaction.spans(n.element.kernels(), axes).get(key)
    return by_matrices(axes, len(terms), copies).nanoseconds if terms else 0.0


def _sorted(choices: Mapping[str, Choice]) -> tuple[tuple[str, Choice], ...]:
    return tuple((key, choices[key]) for key in sorted(choices))


def _key(n: Node) -> str:
    """Return the common kind of boundaries of kernels that are Gaussians, or ""."""
    kernels = n.element.kernels()
    keys = {interaction.boundaries(k, acted_axes(n)) if k.widths() else "" for k in kernels}
    return keys.pop() if len(keys) == 1 else ""


def _likeness(n: Node) -> Hashable:
    return (n.every, structure(n.element), acted_axes(n)) if n.element.kernels() else n.id
