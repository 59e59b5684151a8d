"""An edit is sent as a difference, and a document after it is the whole one."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

import deodar as dd
from deodar.model import building, edit
from deodar.model.building import Around
from deodar.model.document import Document
from deodar_studio.project.recent_changes import MOST
from deodar_studio.views import converted, view
from tests.deodar_studio.models import weighted
from tests.deodar_studio.page import Page, applied, page, play, studio


def whole(doc: Document) -> Any:
    return json.loads(msgspec.json.encode(view.document(doc, "", False, 0, 0)))


def sent(old: Document, new: Document) -> bytes | None:
    before = converted.convert(old)
    found = converted.changes(before, converted.convert(new, before))
    return None if found is None else msgspec.json.encode(found)


def same(old: Document, new: Document) -> bool:
    """Return whether the difference of two documents gives the second one, but for warnings, which follow."""
    content = sent(old, new)
    if content is None:
        return False
    result, expected = applied(whole(old), json.loads(content)), whole(new)
    return all(result[key] == expected[key] for key in expected if key != "problems")


def many(pairs: int) -> Document:
    """Return a document of fields, each with a stimulus, in groups, with positions."""
    model = dd.Model("many")
    x = dd.Axis("x", 0, 100, samples=101)
    for k in range(pairs):
        u = model.add(dd.Field(f"u{k}", [x], kernel=[dd.Gaussian(1.0, 5.0)]), group=f"g{k // 20}")
        model.add(dd.GaussianStimulus(f"s{k}", [x], amplitude=3.0), group=f"g{k // 20}") >> u
    doc = model.document
    return building.placed(doc, {e.id: (float(k), 2.0 * k) for k, e in enumerate(doc.entries)})


def test_a_difference_gives_the_whole_document() -> None:
    doc = many(12)
    u, s, v = doc.entries[0].id, doc.entries[1].id, doc.entries[2].id
    y = dd.Axis("y", 0, 1, samples=11)
    wide = edit.add(doc, dd.Field("wide", [doc.entries[0].element.axes[0], y]))[0]  # type: ignore[attr-defined]
    steps = [
        doc,
        building.add(doc, "Gain", {}, "", ("g0",), (1, 2), Around(wire=(s, "", u, "")))[0],
        building.connect(doc, (s, "", v, "")),
        building.disconnect(doc, [(s, "", u, "")]),
        building.remove(doc, [u]),
        building.rename_group(doc, ("g0",), "first"),
        building.ungroup(doc, ("g0",)),
        building.placed(doc, {u: (3, 3), s: None}),
        building.paste(doc, building.excerpt(doc, [u, s]))[0],
        edit.put(doc, u, "kernel.0.sigma", 3.0),
        edit.replace_axis(doc, doc.entries[0].element.axes[0], y),  # type: ignore[attr-defined]
        edit.link(edit.document_parameter(doc, "k", 3.0), u, "tau", "k"),
        edit.describe(doc, name="n", notes="read", dt=0.5),
        edit.arrange(doc, {"pins": [1]}),
        wide,
        building.connect(wide, (wide.entries[-1].id, "", u, "")),
    ]
    for a in steps:
        for b in steps:
            assert same(a, b)


def test_an_edit_of_one_element_sends_less_than_a_kilobyte_of_500() -> None:
    doc = many(250)
    ids = [e.id for e in doc.entries]
    assert len(ids) == 500 and len(msgspec.json.encode(view.document(doc, "", False, 0, 0))) > 300_000
    edits = [
        building.add(doc, "Field", {}, at=(1, 2))[0],
        building.connect(doc, (ids[0], "", ids[2], "")),
        building.remove(doc, ids[:1]),
        building.rename(doc, ids[3], "new"),
        building.placed(doc, {ids[0]: (5, 5)}),
        edit.put(doc, ids[0], "resting_level", -3.0),
    ]
    for new in edits:
        content = sent(doc, new)
        assert content is not None and len(content) < 1100
        back = sent(new, doc)
        assert back is not None and len(back) < 1500, "undo"


def test_another_path_of_many_elements_is_a_small_difference() -> None:
    doc = many(250)
    group = [e.id for e in doc.entries if e.group == ("g0",)]
    assert len(group) == 40
    edits = [
        building.rename_group(doc, ("g0",), "renamed"),
        building.move_into(doc, group, [], ("g1",)),
        building.ungroup(doc, ("g0",)),
    ]
    for new in edits:
        for content in (sent(doc, new), sent(new, doc)):
            assert content is not None and len(content) < 6000
        assert same(doc, new) and same(new, doc)


def test_an_array_that_gets_another_name_is_sent_again() -> None:
    """Keys of arrays follow from the order of the elements."""
    model = weighted()
    other = dd.Weights(np.random.default_rng(2).normal(size=(10, 10)), [dd.Axis("x", 0, 9, samples=10)])
    model["u"] >> other >> model["u"]
    doc = model.document
    first = next(e.id for e in doc.entries if type(e.element).__name__ == "Weights")
    fewer = building.remove(doc, [first])
    assert sent(doc, fewer) is None, "the array of the second coupling is called as that of the first was"
    assert same(doc, edit.put(doc, first, "weights", np.ones((10, 10))))


def test_a_page_that_edits_has_the_document_of_a_page_that_connects_later(root: Path) -> None:
    async def main(address: str) -> None:
        async with page(address) as p, page(address) as visitor:
            await p.runs()
            u, left, right = p.element("u"), p.element("left"), p.element("right")
            opened = sum(m["type"] == "opened" for m in p.all)
            edits: list[tuple[str, dict[str, Any]]] = [
                ("add_element", {"kind": "Gain", "wire": {"source": left, "target": u}, "at": [1, 2]}),
                ("set", {"element": u, "parameter": "tau", "value": 33}),
                ("group", {"elements": [left, right]}),
                ("set", {"element": u, "parameter": "kernel", "value": []}),
                ("describe", {"notes": "read", "dt": 0.5}),
                ("add_document_parameter", {"name": "k", "element": u, "parameter": "tau"}),
                ("remove", {"elements": [left]}),
                ("undo", {}),
                ("undo", {}),
                ("redo", {}),
            ]
            for type, message in edits:
                await p.do(type, **message)
                async with page(address) as late:
                    await late.until(lambda late=late: late.said.get("opened"))
                    expected = {k: v for k, v in late.document.items() if k != "problems"}
                await visitor.until(lambda expected=expected: expected.items() <= visitor.document.items())
                assert expected.items() <= p.document.items()
            assert sum(m["type"] == "opened" for m in p.all) == opened, "every edit was sent as a difference"

    with studio(root, root / "selection.json") as address:
        asyncio.run(main(address))


def test_a_page_that_lags_too_far_receives_the_whole_document(root: Path) -> None:
    async def main(address: str) -> None:
        async with page(address) as p, page(address, draws=False) as stalled:
            await p.runs()
            await stalled.until(lambda: stalled.document)
            u, before = p.element("u"), len(stalled.all)
            for k in range(MOST + 5):
                await p.do("place", positions={u: [k, k]})
            stalled.draws = True
            await stalled.send(type="drawn", frame=stalled.clock["frame"])
            await stalled.until(lambda: stalled.document == p.document)
            kinds = [m["type"] for m in stalled.all[before:]]
            assert kinds.count("opened") == 1 and kinds.count("edited") <= 1

    with studio(root, root / "selection.json") as address:
        asyncio.run(main(address))


def test_a_problem_of_the_structure_is_sent_with_the_edit_and_disappears_with_it(root: Path) -> None:
    async def scene(p: Page) -> None:
        await p.runs()
        await p.do("add_element", kind="Gain")
        (problem,) = [q for q in p.document["problems"] if q["severity"] == "problem"]
        assert "nothing is connected to gain.input" in problem["what"]
        await p.do("connect", source=p.element("u"), target=p.element("gain"))
        assert not [q for q in p.document["problems"] if q["severity"] == "problem"]

    with studio(root, root / "selection.json") as address:
        play(address, scene)
