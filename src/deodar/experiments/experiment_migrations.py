"""Convert experiments of older versions to the present version: plain data in, plain data out.

Version 1: the path of a field alone meant its output. Since version 2 it means the activation. Version 3
renames parameters.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
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

RENAMED_AFTER_2: Mapping[str, Mapping[str, str]] = {
    kind: {"thing": "object"} for kind in ("Place", "Move", "Remove")
}
"""Parameters of versions 1 and 2 that version 3 renamed, by kind: old name to new name."""

Convert = Callable[[str, dict[str, Any]], dict[str, Any]]
"""A function of the kind and the parameters of a part."""


def migrate(data: Mapping[str, Json], doc: Document | None) -> JsonObject:
    """Convert an experiment of an older version; one of another version is returned unchanged.

    Data of an unexpected form are not changed: the reader reports them.

    Args:
        data: the plain data of the experiment.
        doc: the document of its model, which resolves the paths of version 1; None: they are not converted.
    """
    version, out = data.get("experiment"), dict(data)
    if version == 1 and doc is not None:
        out = _from_1(out, doc)
    if version in (1, 2):
        out = _parts(out, _renamed) | {"experiment": 3}
    return out


def _from_1(data: JsonObject, doc: Document) -> JsonObject:
    def convert(kind: str, values: dict[str, Any]) -> dict[str, Any]:
        paths = PATHS.get(kind, ())
        return {key: _rewritten(value, doc) if key in paths else value for key, value in values.items()}

    record = {"record": _rewritten(data["record"], doc)} if "record" in data else {}
    return _parts(data, convert) | record


def _renamed(kind: str, values: dict[str, Any]) -> dict[str, Any]:
    names = RENAMED_AFTER_2.get(kind, {})
    return {names.get(key, key): value for key, value in values.items()}


def _parts(data: JsonObject, convert: Convert) -> JsonObject:
    """Return an experiment whose conditions, actions and measures are converted one by one."""
    out = dict(data)
    for key, kind in (("conditions", ""), ("actions", ""), ("measures", "Measure")):
        parts = data.get(key)
        if isinstance(parts, dict):
            rows = cast("dict[str, Any]", parts)
            out[key] = {name: _part(part, kind, convert) for name, part in rows.items()}
        elif isinstance(parts, list):
            out[key] = [_part(part, kind, convert) for part in cast("list[Any]", parts)]
    return out


def _part(part: Any, kind: str, convert: Convert) -> Any:
    if not isinstance(part, dict):
        return part
    values = cast("dict[str, Any]", part)
    found = values.get("kind", kind)
    return convert(found, values) if isinstance(found, str) else part


def _rewritten(value: Any, doc: Document) -> Any:
    if isinstance(value, list):
        return [_rewritten(item, doc) for item in cast("list[Any]", value)]
    return recorded(doc, value) if isinstance(value, str) else value
