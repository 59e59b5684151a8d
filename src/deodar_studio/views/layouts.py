"""The layout of a document as pages show it, and how a page changes it.

A document may hold anything in its layout, also what later versions store. Pages do not get what is invalid
or unknown; it stays in the document when they change something else.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from typing import Any, TypeVar, cast, get_args

import msgspec

from deodar.codec import Json
from deodar.model.document import Document
from deodar.model.kept_presets import kept_presets, preset_of
from deodar_studio.messages.message import Data
from deodar_studio.messages.to_page import (
    BoxPlace,
    CommentView,
    KeptPresetView,
    LayoutView,
    PinView,
    PlottedPort,
    TileView,
    ViewName,
)

D = TypeVar("D", bound=Data)

VIEWS: tuple[ViewName, ...] = get_args(ViewName)
COMMENT = {"width": 200.0, "height": 72.0}
TILE: Mapping[str, Any] = {"kind": None, "port": "", "settings": {}}

PRESET = {"group": ""}


def layout(doc: Document) -> LayoutView:
    """Return the valid part of the layout of a document."""
    stored = doc.layout
    folded, view = stored.get("folded"), stored.get("view")
    pins: dict[object, PinView] = {}
    for pin in _entries(PinView, stored.get("pins")):
        pins.setdefault(_pin(pin), pin)
    return LayoutView(
        boxes=_by_key(BoxPlace, stored.get("boxes")),
        folded=[entry for entry in folded if isinstance(entry, str)] if isinstance(folded, list) else None,
        comments=_by_key(CommentView, stored.get("comments"), COMMENT),
        pins=list(pins.values()),
        presets=[KeptPresetView(name=preset.name, group=preset.group) for preset in kept_presets(doc)],
        tiles=_tiles(stored),
        plots=_entries(PlottedPort, stored.get("plots")),
        view=view if view in VIEWS else None,
        every_element=stored.get("every_element") is True,
    )


def _tiles(stored: Mapping[str, Json]) -> dict[str, list[TileView]] | None:
    """Return the plots by view; version 0.1 stored them among panels that a person arranged."""
    tiles, panels = _table(stored.get("tiles")), _table(stored.get("panels"))
    lists = {view: tiles[view] for view in VIEWS if isinstance(tiles.get(view), list)}
    views = {view: _entries(TileView, entries, TILE) for view, entries in lists.items()}
    if views or not isinstance(panels.get("grid"), dict):
        return views or None
    arranged = [_table(panel) for panel in _table(panels.get("panels")).values()]
    plots = [panel.get("params") for panel in arranged if panel.get("contentComponent") == "plot"]
    return {"build": _entries(TileView, plots, TILE)}


def changed(stored: Mapping[str, Json], change: Mapping[str, Any]) -> dict[str, Any]:
    """Return the new values of the keys that a page changes, with what pages do not get of the old ones.

    The plots of a page replace the panels of version 0.1.
    """
    new = {key: _completed(key, stored.get(key), value) for key, value in change.items()}
    return new | {"panels": None} if "tiles" in change and "panels" in stored else new


def _completed(key: str, stored: Json, new: Any) -> Any:
    if key == "pins":
        return _list(PinView, _pin, stored, new) or None
    if key == "presets":
        listed = stored if isinstance(stored, list) else []
        # more than the fields that a page gets decides whether it gets a preset
        valid = [entry for entry in listed if preset_of(entry) is not None]
        invalid = [entry for entry in listed if preset_of(entry) is None]
        return [*_list(KeptPresetView, _name, valid, new, PRESET), *invalid] or None
    if key == "tiles" and isinstance(new, dict):
        before = _table(stored)
        others = {view: tiles for view, tiles in before.items() if view not in VIEWS}
        views = cast("dict[str, Any]", new).items()
        return others | {view: _list(TileView, _plot, before.get(view), tiles, TILE) for view, tiles in views}
    if key == "boxes" and isinstance(new, dict):
        before = _table(stored)
        return {k: _table(before.get(k)) | box for k, box in cast("dict[str, Any]", new).items()}
    return new


def _list(
    kind: type[D],
    place: Callable[[D], object],
    stored: Json,
    new: Any,
    defaults: Mapping[str, Any] | None = None,
) -> list[Any]:
    """Return the entries of a page, and the invalid ones of the document.

    Each has the unknown keys of the stored entry, and its invalid fields that the page does not send.
    """
    unknown: dict[object, list[dict[str, Any]]] = {}
    invalid: list[Any] = []
    for entry in stored if isinstance(stored, list) else []:
        valid = _entry(kind, entry, defaults)
        if valid is None:
            invalid.append(entry)
        else:
            fields = _valid_fields(kind, entry)
            rest = {k: v for k, v in _table(entry).items() if k not in fields}
            unknown.setdefault(place(valid), []).append(rest)
    entries: list[Any] = []
    for entry in cast("list[Any]", new) if isinstance(new, list) else []:
        valid = _entry(kind, entry, defaults)
        known = [] if valid is None else unknown.get(place(valid), [])
        entries.append({**entry, **known.pop(0), **entry} if known else entry)
    return [*entries, *invalid]


def _pin(pin: PinView) -> object:
    return pin.element, pin.parameter


def _name(preset: KeptPresetView) -> object:
    return preset.name


def _plot(tile: TileView) -> object:
    return tile.element, tile.kind, tile.port


def _by_key(kind: type[D], stored: Json, defaults: Mapping[str, Any] | None = None) -> dict[str, D]:
    found = {key: _entry(kind, entry, defaults) for key, entry in _table(stored).items()}
    return {key: entry for key, entry in found.items() if entry is not None}


def _entries(kind: type[D], stored: Any, defaults: Mapping[str, Any] | None = None) -> list[D]:
    found = (_entry(kind, entry, defaults) for entry in (stored if isinstance(stored, list) else []))
    return [entry for entry in found if entry is not None]


def _entry(kind: type[D], stored: Any, defaults: Mapping[str, Any] | None = None) -> D | None:
    """Return an entry of a layout, whose invalid fields have their defaults; None: a field has none."""
    try:
        return kind(**{**(defaults or {}), **_valid_fields(kind, stored)})
    except TypeError:
        return None


def _valid_fields(kind: type[Data], stored: Any) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for field in _fields(kind):
        try:
            value = msgspec.convert(_table(stored)[field.name], field.type)
        except (KeyError, OverflowError, msgspec.ValidationError):
            continue
        if not isinstance(value, float) or math.isfinite(value):
            values[field.name] = value
    return values


@functools.cache  # msgspec evaluates annotations at each call; a document may have a thousand boxes
def _fields(kind: type[Data]) -> tuple[msgspec.structs.FieldInfo, ...]:
    return msgspec.structs.fields(kind)


def _table(stored: Any) -> dict[str, Any]:
    return cast("dict[str, Any]", stored) if isinstance(stored, dict) else {}
