"""The ports that connections state without the `Gain` inside them, where another port is usual."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from deodar.codec import Json
from deodar.model import edit
from deodar.model.document import Document

STATED = "stated_ports"
"""Key of the layout: `{id of the Gain: port}`."""


def stated_ports(doc: Document) -> dict[str, Json]:
    """Return the stated ports by id of the `Gain`; another content of the layout is passed over."""
    ports = doc.layout.get(STATED)
    return dict(ports) if isinstance(ports, dict) else {}


def with_stated_ports(doc: Document, ports: Mapping[str, Json]) -> Document:
    """Return a document whose layout has other stated ports."""
    if ports == stated_ports(doc):
        return doc
    layout = layout_without_ports(doc)
    return edit.arrange(doc, {**layout, STATED: dict(ports)} if ports else layout)


def without_stated_ports(doc: Document, gains: Collection[str]) -> Document:
    """Return a document whose layout has no stated ports of these elements."""
    return with_stated_ports(doc, {i: port for i, port in stated_ports(doc).items() if i not in gains})


def layout_without_ports(doc: Document) -> dict[str, Json]:
    """Return the layout of a document without the stated ports."""
    return {key: part for key, part in doc.layout.items() if key != STATED}
