"""Convert experiments of older versions to the present version: plain data in, plain data out.

Version 1: the path of a field alone meant its output. Since version 2 it means the activation. Version 3
renames parameters. In version 4, as in version 4 of documents, a stimulus with an empty list of time windows
is never on, null means always, and `cell` is another rule.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import Any, cast

from deodar import file_version
from deodar.codec import Json, JsonObject
from deodar.model.document import Document
from deodar.model.migrations import KindOf, kind_lookup, recorded, value_of_3, values_of_3

VERSION = 4
"""Version of experiments, in their files and in the identity of their rows."""

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


def migrate(experiment: Mapping[str, Json], doc: Document | None) -> JsonObject:
    """Convert an experiment of an older version; one of the present version is returned unchanged.

    Data of an unexpected form are not changed: the reader reports them.

    Args:
        experiment: the plain data of the experiment.
        doc: the document of its model, which resolves paths; None: those of version 1 are not converted, and
            values by the names of their parameters alone.

    Raises:
        DocumentError: it is of a later version.
    """
    require_readable(experiment)
    version, out = experiment.get("experiment"), dict(experiment)
    if version == 1 and doc is not None:
        out = _from_1(out, doc)
    if version in (1, 2):
        out = _parts(out, _renamed)
    if version in (1, 2, 3):
        out = _from_3(out, kind_lookup(doc)) | {"experiment": VERSION}
    return out


def require_readable(experiment: Mapping[str, Json]) -> None:
    """Raise DocumentError if an experiment is of a later version; one that states none is of the first."""
    file_version.require_readable("an experiment", experiment.get("experiment", 1), VERSION, experiment)


def _from_1(experiment: JsonObject, doc: Document) -> JsonObject:
    def convert(kind: str, values: dict[str, Any]) -> dict[str, Any]:
        paths = PATHS.get(kind, ())
        return {key: _rewritten(value, doc) if key in paths else value for key, value in values.items()}

    record = {"record": _rewritten(experiment["record"], doc)} if "record" in experiment else {}
    return _parts(experiment, convert) | record


def _renamed(kind: str, values: dict[str, Any]) -> dict[str, Any]:
    names = RENAMED_AFTER_2.get(kind, {})
    return {names.get(key, key): value for key, value in values.items()}


def _from_3(experiment: JsonObject, kind_of: KindOf) -> JsonObject:
    """Convert the values that actions and the levels of factors set."""
    out = _parts(experiment, functools.partial(_set_of_3, kind_of))
    factors = experiment.get("factors")
    if isinstance(factors, dict):
        rows = cast("dict[str, Any]", factors)
        out["factors"] = {name: _factor_of_3(kind_of, factor) for name, factor in rows.items()}
    return out


def _set_of_3(kind_of: KindOf, kind: str, values: dict[str, Any]) -> dict[str, Any]:
    if kind != "Set" or "value" not in values:
        return values
    return values | {"value": value_of_3(values.get("path"), values["value"], kind_of)}


def _factor_of_3(kind_of: KindOf, factor: Any) -> Any:
    """Convert the levels of a factor.

    A list becomes named levels if a value changes: the rows of trials state the names that its values had.
    """
    settings = cast("dict[str, Any]", factor) if isinstance(factor, dict) else {}
    path, levels = settings.get("path", ""), settings.get("levels")
    if isinstance(levels, list):
        named = {str(level): level for level in cast("list[Any]", levels)}
        if all(value_of_3(path, level, kind_of) is level for level in named.values()):
            return factor
    elif isinstance(levels, dict):
        named = cast("dict[str, Any]", levels)
    else:
        return factor
    converted = {
        name: value_of_3(path, level, kind_of) if path else values_of_3(level, kind_of)
        for name, level in named.items()
    }
    return settings | {"levels": converted}


def _parts(experiment: JsonObject, convert: Convert) -> JsonObject:
    """Return an experiment whose conditions, actions and measures are converted one by one."""
    out = dict(experiment)
    for key, kind in (("conditions", ""), ("actions", ""), ("measures", "Measure")):
        parts = experiment.get(key)
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
    kind_name = values.get("kind", kind)
    return convert(kind_name, values) if isinstance(kind_name, str) else part


def _rewritten(value: Any, doc: Document) -> Any:
    if isinstance(value, list):
        return [_rewritten(path, doc) for path in cast("list[Any]", value)]
    return recorded(doc, value) if isinstance(value, str) else value
