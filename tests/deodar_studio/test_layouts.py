"""The layout of a document as pages get it, and what stays of it when a page changes it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
import pytest

import deodar as dd
from deodar.model import building, edit
from deodar.model.document import Document
from deodar_studio.views import layouts
from tests.deodar_studio.page import Page, play, studio

TOP = Path(__file__).parents[2]
FILES = sorted(
    path
    for folder in ("tests/old_files", "examples")
    for path in (TOP / folder).rglob("*.json")
    if "elements" in json.loads(path.read_text(encoding="utf-8"))
)
PIN = {"element": "u", "parameter": "tau"}
TILE = {"element": "u", "kind": "curve", "port": "output", "settings": {"range": [0, 1]}}


def document(layout: Any) -> Document:
    model = dd.Model("m")
    model.add(dd.Field("u", []))
    return edit.arrange(model.document, layout)


def view_of(layout: Any) -> Any:
    return json.loads(msgspec.json.encode(layouts.layout(document(layout))))


EMPTY = view_of({})


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_plot_of_an_old_file_is_a_tile(path: Path) -> None:
    stored = json.loads(path.read_text(encoding="utf-8")).get("layout", {})
    panels = stored.get("panels", {}).get("panels", {}).values()
    plots = [panel["params"] for panel in panels if panel["contentComponent"] == "plot"]
    places = [(plot["element"], plot.get("kind"), plot["port"]) for plot in plots]
    layout = layouts.layout(dd.load(path, trust=True).document)
    tiles = (layout.tiles or {}).get("build", [])
    assert [(tile.element, tile.kind, tile.port) for tile in tiles] == places
    assert len(layout.pins) == len(stored.get("pins", []))
    assert [preset.name for preset in layout.presets] == [
        entry["name"] for entry in stored.get("presets", [])
    ]


def test_the_old_files_have_plots() -> None:
    stored = [json.loads(path.read_text(encoding="utf-8")).get("layout", {}) for path in FILES]
    assert (
        sum("panels" in layout for layout in stored) >= 3 and sum("pins" in layout for layout in stored) >= 2
    )


@pytest.mark.parametrize(
    "odd", [None, 3, "text", [], [None, 3, [1]], {}, {"u": None, "v": 3, "w": {"x": "1"}}]
)
@pytest.mark.parametrize("key", ["boxes", "comments", "pins", "presets", "tiles", "plots", "view", "panels"])
def test_what_is_invalid_is_omitted(key: str, odd: Any) -> None:
    assert view_of({key: odd}) == EMPTY


def test_of_an_entry_only_the_invalid_fields_are_omitted() -> None:
    pins = [
        {**PIN, "lower": "low", "upper": 3, "label": "", "switch": 1, "colour": "red"},
        {**PIN, "lower": 1},
        {"element": 1, "parameter": "tau"},
        {"element": "", "parameter": "gain", "lower": float("nan"), "label": "pace", "switch": True},
    ]
    assert view_of({"pins": pins})["pins"] == [
        {**PIN, "upper": 3},
        {"element": "", "parameter": "gain", "label": "pace", "switch": True},
    ]
    boxes = {"u": {"x": 1, "y": 2.5, "z": 3}, "v": {"x": float("inf"), "y": 0}, "w": {"x": True, "y": 0}}
    assert view_of({"boxes": boxes})["boxes"] == {"u": {"x": 1, "y": 2.5}}
    comments = {"c": {"text": "why", "x": 1, "y": 2, "width": "wide"}, "d": {"x": 1, "y": 2}}
    assert view_of({"comments": comments})["comments"] == {
        "c": {"text": "why", "x": 1, "y": 2, "width": 200, "height": 72}
    }
    tiles = {"build": [{"element": "u", "kind": 3}, {"kind": "heat"}], "run": 3, "other": [TILE]}
    assert view_of({"tiles": tiles})["tiles"] == {
        "build": [{"element": "u", "port": "", "kind": None, "settings": {}}]
    }


def test_tiles_come_before_the_panels_of_version_0_1() -> None:
    panels = {"grid": {}, "panels": {"a": {"contentComponent": "plot", "params": TILE}, "graph": {}}}
    assert view_of({"panels": panels})["tiles"] == {"build": [TILE]}
    assert view_of({"panels": panels, "tiles": {"run": []}})["tiles"] == {"run": []}
    assert layouts.changed({"panels": panels}, {"tiles": {"run": []}}) == {
        "tiles": {"run": []},
        "panels": None,
    }


LATER = {
    "pins": [{**PIN, "colour": "red"}, {"group": "all"}, {"element": "v", "parameter": "tau", "note": 1}],
    "presets": [{"name": "on", "group": "g", "values": {"u": {"tau": 3}}}, {"names": ["a", "b"]}],
    "tiles": {"build": [{**TILE, "height": 3}, {"picture": "eye"}, {**TILE, "height": 4}], "teach": [TILE]},
    "boxes": {"u": {"x": 1, "y": 2, "colour": "red"}, "v": {"at": [1, 2]}},
    "weather": "fine",
}
"""A layout with keys and entries that this version does not know."""


def test_what_later_versions_store_stays_when_the_same_list_changes() -> None:
    page = view_of(LATER)
    change = {
        "pins": [*page["pins"][:1], {"element": "", "parameter": "gain"}],
        "presets": page["presets"],
        "tiles": {"build": [page["tiles"]["build"][1], {**TILE, "kind": "heat"}]},
        "boxes": {"u": {"x": 5, "y": 6}},
        "folded": ["g"],
    }
    assert layouts.changed(LATER, change) == {
        "pins": [LATER["pins"][0], change["pins"][1], LATER["pins"][1]],
        "presets": LATER["presets"],
        "tiles": {
            "build": [{**TILE, "height": 3}, {**TILE, "kind": "heat"}, {"picture": "eye"}],
            "teach": [TILE],
        },
        "boxes": {"u": {"x": 5, "y": 6, "colour": "red"}},
        "folded": ["g"],
    }


def test_the_last_entry_that_a_page_knows_goes_without_the_others() -> None:
    assert layouts.changed(LATER, {"pins": []})["pins"] == [{"group": "all"}]
    assert layouts.changed({"pins": [PIN]}, {"pins": []}) == {"pins": None}
    assert layouts.changed(LATER, {"boxes": None, "pins": 3}) == {"boxes": None, "pins": [{"group": "all"}]}


def test_a_preset_without_a_group_is_removed_and_one_without_values_stays() -> None:
    near, far = {"name": "near", "values": {"u": {"tau": 3}}}, {"name": "far", "group": "g", "values": {}}
    hidden = [{"name": "odd", "values": 3}, {"name": "strange", "group": 3, "values": {}}]
    stored = {"presets": [near, far, *hidden]}
    page = view_of(stored)["presets"]
    assert page == [{"name": "near", "group": ""}, {"name": "far", "group": "g"}]
    assert layouts.changed(stored, {"presets": page}) == {"presets": [{**near, "group": ""}, far, *hidden]}
    assert layouts.changed(stored, {"presets": page[1:]}) == {"presets": [far, *hidden]}
    assert layouts.changed(stored, {"presets": page[:1]}) == {"presets": [{**near, "group": ""}, *hidden]}
    assert layouts.changed({"presets": [near]}, {"presets": []}) == {"presets": None}


def test_a_preset_that_a_page_stores_again_has_the_new_values() -> None:
    stored = {"presets": [{"name": "near", "group": "", "values": {"u": {"tau": 3}}, "colour": "red"}]}
    newer = {"name": "near", "group": "", "values": {"u": {"tau": 5}}}
    assert layouts.changed(stored, {"presets": [newer]})["presets"] == [{**newer, "colour": "red"}]


def test_an_invalid_field_of_a_pin_stays_until_a_page_sends_it() -> None:
    stored: Any = {"pins": [{**PIN, "lower": {"x": 1}, "upper": 3}, {**PIN, "element": "v"}]}
    pins = view_of(stored)["pins"]
    assert pins[0] == {**PIN, "upper": 3}
    assert layouts.changed(stored, {"pins": pins})["pins"] == stored["pins"]
    # the upper end that a page takes away was valid
    assert layouts.changed(stored, {"pins": [PIN, pins[1]]})["pins"][0] == {**PIN, "lower": {"x": 1}}
    assert layouts.changed(stored, {"pins": [{**PIN, "lower": 0}]})["pins"] == [{**PIN, "lower": 0}]


def test_of_equal_pins_the_first_is_shown_in_its_place() -> None:
    second = {**PIN, "element": "v"}
    stored = {"pins": [{**PIN, "upper": 3}, second, {**PIN, "lower": 1}, second]}
    assert view_of(stored)["pins"] == [{**PIN, "upper": 3}, second]


def test_a_box_that_moves_keeps_what_later_versions_store() -> None:
    doc = building.placed(document(LATER), {"u": (7, 8)})
    assert doc.layout["boxes"] == {"u": {"x": 7, "y": 8, "colour": "red"}, "v": {"at": [1, 2]}}


def test_a_file_of_a_later_version_keeps_its_entries_through_edits_and_undo(root: Path) -> None:
    stored = json.loads((root / "selection.json").read_text(encoding="utf-8"))
    (root / "later.json").write_text(json.dumps({**stored, "layout": LATER}), encoding="utf-8")

    def saved() -> Any:
        return json.loads((root / "later.json").read_text(encoding="utf-8"))["layout"]

    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("place", positions={p.element("left"): [3, 4]})
        await p.do("arrange", layout={"folded": ["g"]}, undoable=False)
        await p.do("arrange", layout={"tiles": p.document["layout"]["tiles"]})
        await p.do("save")
        layout = saved()
        assert layout.pop("boxes") == {**LATER["boxes"], p.element("left"): {"x": 3, "y": 4}}  # type: ignore[dict-item]
        assert layout.pop("folded") == ["g"]
        first, picture, second = LATER["tiles"]["build"]  # type: ignore[index,call-overload]
        assert layout.pop("tiles") == {"build": [first, second, picture], "teach": [TILE]}
        assert layout == {key: LATER[key] for key in ("pins", "presets", "weather")}
        await p.do("arrange", layout={"pins": []})
        assert p.document["layout"]["pins"] == []
        await p.do("undo")
        await p.do("save")
        assert saved()["pins"] == LATER["pins"] and len(p.document["layout"]["pins"]) == 2

    with studio(root, root / "later.json") as address:
        play(address, scene)
