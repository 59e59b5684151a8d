"""Convert experiments of older versions to the present version: plain data in, plain data out.

Version 1: the path of a field alone meant its output. Since version 2 it means the activation.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

from deodar.codec import Json, JsonObject
from deodar.model.document import Document
from deodar.model.migrations import recorded

PATHS: Mapping[str, tuple[str, ...]] = {
    "Crosses": ("of",),
    "Within": ("of", "goal"),
    "Leaves": ("of",),
    "Snapshot": ("of",),
    "Measure": ("of",),
}
"""Parameters that are paths of ports, by kind."""


def migrate(data: Mapping[str, Json], doc: Document) -> JsonObject:
    """Convert an experiment of version 1; one of another version is returned unchanged.

    Data of an unexpected form are not changed: the reader reports them.

    Args:
        data: the plain data of the experiment.
        doc: the document of its model, which resolves paths.
    """
    if data.get("experiment") != 1:
        return dict(data)
    out = {**data, "experiment": 2}
    if "record" in data:
        out["record"] = _rewritten(data["record"], doc)
    for key, kind in (("conditions", ""), ("actions", ""), ("measures", "Measure")):
        parts = data.get(key)
        if isinstance(parts, dict):
            out[key] = {name: _part(part, doc, kind) for name, part in cast("dict[str, Any]", parts).items()}
        elif isinstance(parts, list):
            out[key] = [_part(part, doc, kind) for part in cast("list[Any]", parts)]
    return out


def _part(part: Any, doc: Document, kind: str) -> Any:
    if not isinstance(part, dict):
        return part
    values = cast("dict[str, Any]", part)
    found = values.get("kind", kind)
    paths = PATHS.get(found, ()) if isinstance(found, str) else ()
    return {key: _rewritten(value, doc) if key in paths else value for key, value in values.items()}


def _rewritten(value: Any, doc: Document) -> Any:
    if isinstance(value, list):
        return [_rewritten(item, doc) for item in cast("list[Any]", value)]
    return recorded(doc, value) if isinstance(value, str) else value
