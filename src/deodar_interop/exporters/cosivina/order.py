"""The order of the list of elements, which decides what is of this step and what is of the previous one.

A source that is read in the same step is listed before its reader, one that is read in the next step after
it. Where this is not possible for all (two fields that read each other), a relay reads the source in the
previous step and is listed before both.
"""

from __future__ import annotations

import dataclasses as dc
import heapq
from collections.abc import Sequence

from deodar_interop.exporters.cosivina.layout import size
from deodar_interop.exporters.cosivina.part import FilePart, ListPlace
from deodar_interop.importers._names import FreeNames


def ordered(parts: Sequence[FilePart], names: FreeNames) -> list[FilePart]:
    """Return the parts in an order that fits their links, near the preferred places; add relays where there
    is none.
    """
    waiting = _waiting(parts)
    followers: dict[FilePart, list[FilePart]] = {p: [] for p in parts}
    for p, before in waiting.items():
        for q in before:
            followers[q].append(p)
    number = {p: k for k, p in enumerate(parts)}
    ready: list[tuple[ListPlace, int, FilePart]] = [(p.place, number[p], p) for p in parts if not waiting[p]]
    heapq.heapify(ready)
    out: list[FilePart] = []
    left = dict.fromkeys(parts)
    while left:
        if not ready:
            p, relays = _relayed(list(left), waiting, names)
            out += relays
            waiting[p] = set()
            ready = [(p.place, number[p], p)]
        _, _, p = heapq.heappop(ready)
        if p not in left:
            continue
        del left[p]
        out.append(p)
        for q in followers[p]:
            if p in waiting[q]:
                waiting[q].discard(p)
                if not waiting[q] and q in left:
                    heapq.heappush(ready, (q.place, number[q], q))
    return out


def _waiting(parts: Sequence[FilePart]) -> dict[FilePart, set[FilePart]]:
    """Return for each part those that are listed before it."""
    waiting: dict[FilePart, set[FilePart]] = {p: set() for p in parts}
    for p in parts:
        for link in p.links:
            if link.part is p or link.after is None or link.part not in waiting:
                continue
            first, second = (p, link.part) if link.after else (link.part, p)
            waiting[second].add(first)
    return waiting


def _relayed(
    left: Sequence[FilePart], waiting: dict[FilePart, set[FilePart]], names: FreeNames
) -> tuple[FilePart, list[FilePart]]:
    """Return the first part that waits only for readers of its previous value, and the relays from which they
    now read it.
    """
    there = set(left)
    free = (p for p in sorted(left, key=lambda p: p.place) if _computable(p, there))
    p = next(free)
    relays: dict[str, FilePart] = {}
    for r in waiting[p] & there:
        for k, link in enumerate(r.links):
            if link.part is not p or not link.after:
                continue
            if link.component not in relays:
                relays[link.component] = FilePart(
                    names.new(f"{p.label} before"),
                    "SumInputs",
                    {"size": size(link.dims)},
                    p.place,
                    [dc.replace(link, slot=0)],
                    sums=True,
                )
            r.links[k] = dc.replace(link, part=relays[link.component], component="output", after=False)
    return p, list(relays.values())


def _computable(p: FilePart, left: set[FilePart]) -> bool:
    """Return whether everything that a part reads in the same step has been listed."""
    return not any(link.part in left and link.after is False for link in p.links)
