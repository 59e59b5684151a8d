"""The layout of a file: places of boxes, notes, and the switches of boosts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from deodar.codec import Json
from deodar.elements.boost import Boost
from deodar.importers.cedar.file import CedarGroup, StepPath, items, members, text
from deodar.importers.cedar.values import StepValues, number
from deodar.model.document import Entry

SPREAD = 1.6
"""Distances of boxes here and in cedar: its boxes are smaller (a guess by eye)."""


def layout(root: CedarGroup, by: Mapping[StepPath, Entry]) -> dict[str, Json]:
    """Return the layout of a document: boxes at cedar's places, notes as comments, and a switch for each
    boost.
    """
    boxes: dict[str, Json] = {}
    comments: dict[str, Json] = {}
    _places(root, 0.0, 0.0, by, boxes, comments)
    out: dict[str, Json] = {}
    if boxes:
        out["boxes"] = boxes
    if comments:
        out["comments"] = comments
    pins = _pins(root, by)
    if pins:
        out["pins"] = pins
    return out


def _places(
    group: CedarGroup,
    left: float,
    top: float,
    by: Mapping[StepPath, Entry],
    boxes: dict[str, Json],
    comments: dict[str, Json],
) -> None:
    for entry in items(group.values.get("ui")):
        body = members(entry)
        match text(body.get("type")):
            case "step":
                found = by.get((*group.path, text(body.get("step"))))
                x, y = number(body.get("positionX")), number(body.get("positionY"))
                if found is not None and x is not None and y is not None:
                    boxes[found.id] = {"x": SPREAD * (left + x), "y": SPREAD * (top + y)}
            case "stickyNote":
                comment = _comment(body, left, top)
                if comment is not None:
                    comments[f"note {len(comments) + 1}"] = comment
            case _:
                continue
    for inside in group.groups.values():
        own = members(inside.values.get("ui generic"))
        x, y = number(own.get("positionX")) or 0.0, number(own.get("positionY")) or 0.0
        _places(inside, left + x, top + y, by, boxes, comments)


def _comment(body: Mapping[str, Any], left: float, top: float) -> dict[str, Json] | None:
    x, y = number(body.get("x")), number(body.get("y"))
    words = text(body.get("text"))
    if x is None or y is None or not words:
        return None
    return {"text": words, "x": SPREAD * (left + x), "y": SPREAD * (top + y)}


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
