"""Presets that a document keeps: sets of values of parameters, each applied as one change.

They are in the layout, under the key `presets`, so that they are stored with the document and do not count as
part of the model.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence
from typing import Any, cast

from deodar.codec import Json
from deodar.errors import DeodarError, UnknownName, did_you_mean
from deodar.model import edit, find
from deodar.model.document import Document

PRESETS = "presets"
"""Key of the layout: `[{"name": "", "group": "", "values": {id: {path: value}}}]`."""


@dc.dataclass(frozen=True)
class KeptPreset:
    """A preset of a document.

    Attributes:
        name: its name.
        group: name of the menu or switch that it is a choice of, or "".
        values: values by element id and path; those of document parameters are under "".
    """

    name: str
    group: str
    values: Mapping[str, Mapping[str, Json]]


def kept_presets(doc: Document) -> list[KeptPreset]:
    """Return the presets of a document; invalid entries of the layout are skipped, and of equal names the
    first one counts.
    """
    listed = doc.layout.get(PRESETS)
    presets: dict[str, KeptPreset] = {}
    for entry in listed if isinstance(listed, list) else []:
        preset = preset_of(entry)
        if preset is not None:
            presets.setdefault(preset.name, preset)
    return list(presets.values())


def preset_of(entry: Json) -> KeptPreset | None:
    """Return the preset of an entry of the layout; None if the entry is invalid."""
    preset = cast("dict[str, Any]", entry) if isinstance(entry, dict) else {}
    name, group, values = preset.get("name"), preset.get("group", ""), preset.get("values")
    if not isinstance(name, str) or not name or not isinstance(group, str) or not isinstance(values, dict):
        return None
    plain = {
        ident: cast("dict[str, Json]", inner)
        for ident, inner in cast("dict[str, Any]", values).items()
        if isinstance(inner, dict)
    }
    return KeptPreset(name, group, plain)


def with_presets(doc: Document, presets: Sequence[KeptPreset]) -> Document:
    """Return a document with these presets in place of its own."""
    listed: list[Json] = [{"name": p.name, "group": p.group, "values": p.values} for p in presets]
    layout = (
        {**doc.layout, PRESETS: listed} if listed else {k: v for k, v in doc.layout.items() if k != PRESETS}
    )
    return edit.arrange(doc, layout)


def kept_preset(doc: Document, name: str) -> KeptPreset:
    """Return the preset of a name.

    Raises:
        UnknownName: the document has none of this name.
    """
    presets = {p.name: p for p in kept_presets(doc)}
    if name not in presets:
        raise UnknownName(f"the document has no preset {name!r}", fix=did_you_mean(name, list(presets)))
    return presets[name]


def take_preset(doc: Document, preset: KeptPreset) -> tuple[Document, list[tuple[str, str, str]]]:
    """Return a document with the values of a preset.

    Returns:
        The document, and for each value that differs from the present one the path of its element ("" for a
        document parameter), the path of the parameter, and why it was not taken, or "".
    """
    lines: list[tuple[str, str, str]] = []
    for ident, values in preset.values.items():
        entry = doc.by_id().get(ident)
        where = ident if entry is None else entry.path
        for path, value in values.items():
            try:
                if find.present(doc, ident, path) == (tuple(value) if isinstance(value, list) else value):
                    continue
                if ident:
                    doc = edit.put(doc, ident, path, value)
                else:
                    doc = edit.document_parameter(doc, path, cast(Any, value))
            except DeodarError as error:
                lines.append((where, path, error.problems[0].what))
            else:
                lines.append((where, path, ""))
    return doc, lines
