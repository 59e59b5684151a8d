"""The layout of a file: places of boxes, notes, and the switches of boosts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from deodar.codec import Json
from deodar.element import Coupling
from deodar.elements.stimuli import Boost
from deodar.model.document import Connection, Entry
from deodar_interop.importers.cedar.file import CedarGroup, StepPath, items, members, text
from deodar_interop.importers.cedar.values import StepValues, number

BOX = (180.0, 124.0)
"""Width and height that a box takes in the studio; most of cedar's are icons of 40 x 40."""

SPREAD = (1.0, 4.0)
"""Smallest and largest factor of distances: as few boxes as possible overlap, and none is far away."""

MOST_BOXES = 1000
"""Number of boxes up to which all pairs are compared."""


def layout(
    root: CedarGroup, by: Mapping[StepPath, Entry], connections: Sequence[Connection]
) -> dict[str, Json]:
    """Return the layout of a document: boxes at cedar's places, notes as comments, and a switch for each
    boost.

    Places are scaled apart until boxes do not overlap. A coupling with one connection into it and one out of
    it is drawn on the connection, without a box.
    """
    places: dict[str, tuple[float, float]] = {}
    notes: list[tuple[str, float, float]] = []
    _places(root, 0.0, 0.0, by, places, notes)
    into, out_of = Counter(c.target for c in connections), Counter(c.source for c in connections)
    boxed = {
        entry.id
        for entry in by.values()
        if not isinstance(entry.element, Coupling) or (into[entry.id], out_of[entry.id]) != (1, 1)
    }
    factor = _spread([place for ident, place in places.items() if ident in boxed])
    out: dict[str, Json] = {}
    if places:
        out["boxes"] = {ident: {"x": factor * x, "y": factor * y} for ident, (x, y) in places.items()}
    if notes:
        out["comments"] = {
            f"note {k + 1}": {"text": words, "x": factor * x, "y": factor * y}
            for k, (words, x, y) in enumerate(notes)
        }
    pins = _pins(root, by)
    if pins:
        out["pins"] = pins
    return out


def _spread(places: list[tuple[float, float]]) -> float:
    """Return the smallest factor at which no boxes overlap, within limits."""
    low, high = SPREAD
    if not 1 < len(places) <= MOST_BOXES:
        return low
    at = np.array(places)
    apart = (abs(at[:, None] - at[None, :]) / BOX).max(axis=-1)[np.triu_indices(len(at), 1)]
    apart = apart[apart > 0]
    return float(np.clip(1 / apart.min(), low, high)) if apart.size else low


def _places(
    group: CedarGroup,
    left: float,
    top: float,
    by: Mapping[StepPath, Entry],
    places: dict[str, tuple[float, float]],
    notes: list[tuple[str, float, float]],
) -> None:
    """Collect the places of boxes by id, and the notes, of a group whose corner is at (left, top)."""
    for entry in items(group.values.get("ui")):
        body = members(entry)
        match text(body.get("type")):
            case "step":
                step = by.get((*group.path, text(body.get("step"))))
                x, y = number(body.get("positionX")), number(body.get("positionY"))
                if step is not None and x is not None and y is not None:
                    places[step.id] = (left + x, top + y)
            case "stickyNote":
                x, y, words = number(body.get("x")), number(body.get("y")), text(body.get("text"))
                if words and x is not None and y is not None:
                    notes.append((words, left + x, top + y))
            case _:
                continue
    for inside in group.groups.values():
        generic = members(inside.values.get("ui generic"))
        x, y = number(generic.get("positionX")) or 0.0, number(generic.get("positionY")) or 0.0
        _places(inside, left + x, top + y, by, places, notes)


def _pins(root: CedarGroup, by: Mapping[StepPath, Entry]) -> list[Json]:
    """Return a switch for each boost, as cedar's boost control has it."""
    pins: list[Json] = []
    for step in root.all_steps():
        entry = by.get(step.path)
        if step.short != "Boost" or entry is None or not isinstance(entry.element, Boost):
            continue
        strength = StepValues(step.values, step.label).number("strength", 1.0)
        if strength:
            low, high = sorted((0.0, strength))
            pins.append(
                {
                    "element": entry.id,
                    "parameter": "amplitude",
                    "lower": low,
                    "upper": high,
                    "label": step.path[-1],
                    "switch": True,
                }
            )
    return pins
