"""Write a document as a file of cosivina: its elements, their inputs and order, and a report.

The order of the list decides what is of this step and what is of the previous one. A source that is read in
the same step is listed before its reader, one that is read in the next step after it. Where this is not
possible for all (two fields that read each other), a relay reads the source in the previous step and is
listed before both.
"""

from __future__ import annotations

import dataclasses as dc
import heapq
import math
from collections.abc import Sequence
from typing import Any, cast

import numpy as np

from deodar import codec
from deodar.couplings.convolutions import Convolve
from deodar.elements.changing_stimuli import Noise
from deodar.exporters.exported import Exported
from deodar.importers.report import ImportReport, Line
from deodar.model.document import Connection, Document
from deodar.model.document_graph import graph
from deodar.model.model import Model
from deodar.model.paths import display
from deodar_interop.exporters.cosivina.classes import KINDS
from deodar_interop.exporters.cosivina.conversion import NoConversion, conversion
from deodar_interop.exporters.cosivina.draft import (
    Draft,
    FilePart,
    Given,
    ListPlace,
    PartInput,
    PartLink,
    PartOutput,
    Unwritable,
)
from deodar_interop.exporters.cosivina.layout import size
from deodar_interop.exporters.cosivina.tracing import Traced
from deodar_interop.importers._foreign import FreeNames


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


WORDS = {math.inf: "_Inf_", -math.inf: "-_Inf_"}
"""Infinite numbers as JSONLab writes them."""


def write(model: Model, name: str) -> Exported:
    """Return the file of a model, and the report.

    Args:
        model: the model.
        name: name of the file, for the report.

    Raises:
        ModelError: the model has problems; the error lists all.
    """
    doc = model.document
    nodes = graph(doc).required().nodes
    draft = Draft(doc, {n.id: n for n in nodes})
    for entry in doc.entries:
        if entry.id in draft.claimed:
            continue
        b = Given(draft, entry)
        writer = KINDS.get(type(entry.element))
        if writer is None:
            b.drop(f"cosivina has no {type(entry.element).__name__}")
            continue
        try:
            writer(b, entry.element)
        except Unwritable as error:
            b.drop(str(error))
        else:
            b.finish()
    for c in doc.connections:
        _connect(draft, c)
    for part in list(draft.parts):
        _add_up(draft, part)
    draft.lines += _surroundings(doc)
    parts = ordered(draft.parts, draft.names)
    return Exported(_text(doc, parts), ImportReport("cosivina", name, draft.lines))


def _surroundings(doc: Document) -> list[Line]:
    """Report what a file of cosivina does not have: groups, shared parameters, templates, units."""
    lines = [Line("", "file", "deltaT", "carried"), Line("", "file", "tZero", "carried")]
    if doc.time_unit not in ("ms", "abstract"):
        lines.append(Line("", "file", "time_unit", "dropped", f"times of the file are in {doc.time_unit}"))
    lines += [
        Line(display(g), "group", g[-1], "dropped", "the labels of its elements begin with its name")
        for g in doc.groups
    ]
    lines += [
        Line(p.name, "parameter", p.name, "dropped", "the elements have its value, and share it no more")
        for p in doc.parameters
    ]
    return lines


def _connect(draft: Draft, c: Connection) -> None:
    """Add the inputs of a connection to the parts that take them, and report it."""
    if c.target in draft.claimed and (c.target, c.target_port) not in draft.inlets:
        return  # the parts of another element contain it
    target = draft.doc.by_id()[c.target].path
    if draft.claimed.get(c.source) and (c.source, c.source_port) not in draft.outlets:
        return
    found = draft.wires.trace(c)
    if found is None:
        return  # a zero where a file has no input
    source = draft.doc.by_id()[found.source].path
    what = source if found.port == "output" else f"{source}.{found.port}"
    outlet = draft.outlets.get((found.source, found.port))
    inlets = draft.inlets.get((c.target, c.target_port), [])
    if outlet is None or not inlets:
        why = f"{what if outlet is None else f'the input {c.target_port}'} is not in the file"
        draft.lines.append(Line(target, "connection", what, "dropped", why))
        return
    try:
        for inlet in inlets:
            _link(draft, outlet, inlet, found)
    except NoConversion as error:
        draft.lines.append(Line(target, "connection", what, "dropped", str(error)))
        return
    draft.lines.append(Line(target, "connection", what, "carried"))


def _link(draft: Draft, outlet: PartOutput, inlet: PartInput, found: Traced) -> None:
    """Connect an outlet to an inlet, through the elements that its dimensions need."""
    part, component, dims, after = outlet.part, outlet.component, outlet.dims, _after(draft, outlet, found)
    steps = [] if found.fits else conversion(dims, inlet.dims)
    for kind, values, there in steps:
        label = draft.names.new(f"{part.label} to {inlet.part.label}")
        place = (inlet.part.place[0], inlet.part.place[1] - 1)
        between = FilePart(label, kind, values, place, [PartLink(part, component, 0, after, dims)])
        draft.parts.append(between)
        part, component, dims, after = between, "output", there, False
    inlet.part.links += [PartLink(part, component, inlet.slot, after, dims)] * found.count


def _after(draft: Draft, outlet: PartOutput, found: Traced) -> bool | None:
    """Return whether a source is listed after its reader; None if the order has no effect."""
    if outlet.free or _noisy(draft, found.source):
        return None
    if found.delayed or found.reads == "delayed":
        return True
    return outlet.state and found.reads != "current"


def _noisy(draft: Draft, ident: str) -> bool:
    """Return whether an output is noise alone, of which one sample is as good as another."""
    element = draft.doc.by_id()[ident].element
    if isinstance(element, Noise):
        return True
    sources = draft.wires.into.get((ident, "input"), [])
    return isinstance(element, Convolve) and bool(sources) and all(_noisy(draft, c.source) for c in sources)


def _add_up(draft: Draft, part: FilePart) -> None:
    """Put a sum before an input that takes one array, where several are connected."""
    if part.sums:
        return
    for slot in {link.slot for link in part.links}:
        several = [link for link in part.links if link.slot == slot]
        if len(several) < 2:
            continue
        dims = max((link.dims for link in several), key=lambda d: math.prod(size(d)))
        total = FilePart(
            draft.names.new(f"inputs of {part.label}"),
            "SumInputs",
            {"size": size(dims)},
            (part.place[0], part.place[1] - 1),
            several,
            sums=True,
        )
        draft.parts.append(total)
        rest = [link for link in part.links if link.slot != slot]
        part.links = [*rest, PartLink(total, "output", slot, False, dims)]


def _text(doc: Document, parts: Sequence[FilePart]) -> bytes:
    elements = [_entry(p) for p in parts]
    body = {
        "deltaT": _plain(doc.step),
        "tZero": _plain(doc.t0),
        "nElements": len(parts),
        "elementLabels": [p.label for p in parts],
        "elements": elements,
    }
    return codec.text({"simulator": body}).encode() + b"\n"


def _entry(part: FilePart) -> dict[str, Any]:
    links = sorted(part.links, key=lambda link: link.slot)
    inputs = [{"label": link.part.label, "component": link.component} for link in links]
    return {
        "label": part.label,
        "class": part.kind,
        "param": {name: _plain(v) for name, v in part.values.items()},
        "nInputs": len(inputs),
        "input": inputs[0] if len(inputs) == 1 else inputs or None,
    }


def _plain(value: Any) -> Any:
    """Return a value as cosivina's files have it: switches as 0 and 1, whole numbers without a point."""
    if isinstance(value, (bool, np.bool_)):
        return int(value)
    if isinstance(value, (float, np.floating)):
        number = float(value)
        if number in WORDS:
            return WORDS[number]
        return int(number) if number.is_integer() and abs(number) < 1e15 else number
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in cast("list[Any]", value)]
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in cast("dict[str, Any]", value).items()}
    return value
