"""The import report that a document contains."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import deodar as dd
from deodar.codec import JsonObject
from deodar.importers import stored_report
from deodar.importers.report import ImportReport, Line
from deodar.model import building, document_files, edit
from deodar.model.document import Document
from deodar_interop.importers import cedar

HERE = Path(__file__).parent
SAMPLES = (
    HERE / "cedar/data/elementaryBehavior.json",
    HERE / "cosivina/presetOneLayerField_memory.json",
    HERE / "dnf_composer/syn-couplings.dnf",
)
LINES = [
    Line("", "file", "step", "approximated", "20 ms"),
    Line("a", "element", "Field of two  words", "carried", "Field"),
    Line("thread", "parameter", "time step", "dropped", "it has\nno counterpart"),
    Line("a", "parameter", "tau: 5, why", "carried"),
    Line("a", "connection", "a line\nbreak", "dropped", "x"),
    Line("a", "key", "", "carried"),
]
REPORT = ImportReport("cedar", "memory.json", LINES, ["it drops slices"])


def document() -> Document:
    model = dd.Model("m")
    model.add(dd.Field("a", []))
    return model.document


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.name)
def test_a_saved_document_contains_every_line_of_the_report(sample: Path, tmp_path: Path) -> None:
    done = dd.read(sample)
    doc = stored_report.with_report(done.model.document, done.report)
    document_files.save(doc, tmp_path / "model.json")
    report = stored_report.report_of(document_files.load(tmp_path / "model.json"))
    assert report is not None
    assert (report.tool, report.file, list(report.bugs)) == (
        done.report.tool,
        sample.name,
        list(done.report.bugs),
    )
    before = stored_report.located(done.report, done.model.document)
    assert sorted(report.lines, key=repr) == sorted(before.lines, key=repr)
    assert report.summary() == done.report.summary()


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.name)
def test_every_element_line_has_the_id_of_its_element(sample: Path) -> None:
    done = dd.read(sample)
    ids = {entry.id for entry in done.model.document.entries}
    lines = stored_report.located(done.report, done.model.document).lines
    assert [line for line in lines if line.part == "element" and line.element not in ids] == []
    assert {line.element for line in lines if not line.where} == {""}


def test_names_and_reasons_of_any_text_are_kept() -> None:
    report = stored_report.report_of(stored_report.with_report(document(), REPORT))
    assert report is not None
    ident = document().entries[0].id
    assert [(line.where, line.element, line.what, line.why) for line in report.lines] == [
        ("", "", "step", "20 ms"),
        ("a", ident, "Field of two  words", "Field"),
        ("a", ident, "tau: 5, why", ""),
        ("a", ident, "a line break", "x"),  # a name has no line break
        ("a", ident, "", ""),
        ("thread", "", "time step", "it has\nno counterpart"),
    ]


def test_a_renamed_element_keeps_its_lines() -> None:
    doc = stored_report.with_report(document(), REPORT)
    [entry] = doc.entries
    report = stored_report.report_of(building.rename(doc, entry.id, "b"))
    assert report is not None and report.lines[1].element == entry.id


def grouped() -> Document:
    """Return a document with an element, a group in a group, and an empty group."""
    model = dd.Model("m")
    for name in ("a", "g.h.u", "g.v"):
        model.add(dd.Field(name.rpartition(".")[2], []), group=name.rpartition(".")[0])
    return edit.group(model.document, ("empty",))


def test_a_line_of_a_group_has_its_names_and_the_id_of_its_first_element() -> None:
    doc = grouped()
    u, v = doc.by_names()["g", "h", "u"].id, doc.by_names()["g", "v"].id
    labels = ("g", "g.h", "g.v", "empty", "g.w", "")
    lines = [Line(label, "connection", "x", "dropped") for label in labels]
    annotated = stored_report.with_report(doc, ImportReport("cedar", "memory.json", lines))
    report = stored_report.report_of(annotated)
    assert report is not None
    assert [(line.where, line.element, line.group) for line in report.lines] == [
        ("g", u, ("g",)),
        ("g.h", u, ("g", "h")),
        ("g.v", v, ()),
        ("empty", "", ("empty",)),
        ("g.w", "", ()),
        ("", "", ()),
    ]
    data = [line.data() for line in report.lines]
    assert [line.get("group") for line in data] == [["g"], ["g", "h"], None, ["empty"], None, None]
    assert [line.get("element") for line in data] == [u, u, v, None, None, None]


def test_an_element_with_the_path_of_a_group_has_the_lines() -> None:
    doc = grouped()
    [entry] = [e for e in doc.entries if e.names == ("a",)]
    doc = edit.group(doc, ("a.b",))
    lines = [Line("a", "element", "x", "carried"), Line("a.b", "connection", "x", "dropped")]
    located = stored_report.located(ImportReport("cedar", "memory.json", lines), doc).lines
    assert [(line.element, line.group) for line in located] == [(entry.id, ()), ("", ("a.b",))]


def test_a_group_of_cedar_with_a_broken_connection_has_its_line() -> None:
    text = SAMPLES[0].read_text()
    broken = text.replace('"source": "new Projection.output"', '"source": "new Projection"', 1)
    assert broken != text
    done = cedar.read(broken.encode(), "broken.json")
    lines = stored_report.located(done.report, done.model.document).lines
    [line] = [line for line in lines if "does not name two slots" in line.why]
    assert line.group == ("Elementary behavior",)
    first = next(entry for entry in done.model.document.entries if entry.group == line.group)
    assert line.element == first.id


def test_the_report_leaves_the_rest_of_the_layout_as_it_is() -> None:
    doc = edit.arrange(document(), {"boxes": {"a": {"x": 1, "y": 2}}})
    annotated = stored_report.with_report(doc, REPORT)
    assert {key: value for key, value in annotated.layout.items() if key != stored_report.KEY} == doc.layout
    assert stored_report.without_report(annotated) == doc
    assert stored_report.without_report(doc) is doc


GOOD: JsonObject = {"tool": "cedar", "file": "a.json", "items": [{"lines": ["carried file step"]}]}


@pytest.mark.parametrize(
    "data",
    [
        None,
        "cedar",
        {},
        GOOD | {"tool": 5},
        GOOD | {"items": {}},
        GOOD | {"items": [{"where": "a"}]},
        GOOD | {"items": [{"lines": ["carried"]}]},
        GOOD | {"items": [{"lines": ["invented file step"]}]},
        GOOD | {"items": [{"lines": [["carried", "file"]]}]},
    ],
)
def test_anything_else_under_its_key_is_no_report(data: Any) -> None:
    assert stored_report.report_of(edit.arrange(document(), {stored_report.KEY: GOOD})) is not None
    assert stored_report.report_of(edit.arrange(document(), {stored_report.KEY: data})) is None
