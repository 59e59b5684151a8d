"""Edits: undo and redo restore the identical document; ids persist unless an element is new."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.errors import DeodarError, ModelError, ParameterError, UnknownName
from deodar.model import document_files, edit
from deodar.model.document import Document
from deodar.model.script import script

X, Y = dd.Axis("x", 0, 10, samples=11), dd.Axis("y", 0, 20, samples=21)


def make() -> dd.Model:
    """Return a group with two connected fields, a stimulus outside, and a document parameter that drives
    one tau.
    """
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X], kernel=[dd.Gaussian()]), group="g")
    v = model.add(dd.Field("v", [X]), group="g.inner")
    left = model.add(dd.GaussianStimulus("left", [X]))
    u >> dd.Gain(2) >> v
    left >> u
    model.parameter("gain", 3.0)
    model.link("g.u.tau", "gain")
    return model


OPERATIONS: dict[str, Callable[[dd.Model], object]] = {
    "add": lambda m: m.add(dd.Field("new", [X])),
    "add into a group": lambda m: m.add(dd.Field("new", [X]), group="a.b", ticks=2),
    "connect": lambda m: m.connect("left", "g.inner.v", reads="delayed"),
    "disconnect": lambda m: m.disconnect("left", "g.u"),
    "remove": lambda m: m.remove("g.u"),
    "remove a group": lambda m: m.remove("g"),
    "rename": lambda m: m.rename("g.u", "w"),
    "rename a group": lambda m: m.rename("g", "h"),
    "move": lambda m: m.move("left", "g"),
    "move to the top": lambda m: m.move("g.u", ""),
    "move a group": lambda m: m.move("g.inner", ""),
    "group": lambda m: m.group("empty"),
    "ungroup": lambda m: m.ungroup("g"),
    "copy": lambda m: m.copy("g", "h"),
    "insert": lambda m: m.insert(make(), "twin"),
    "set": lambda m: m.set("g.inner.v.tau", 5),
    "set a part": lambda m: m.set("g.u.kernel.0.sigma", 2),
    "set a document parameter": lambda m: m.set("gain", 7),
    "ticks": lambda m: m.set_ticks("left", 3),
    "parameter": lambda m: m.parameter("other", 1.0),
    "link": lambda m: m.link("g.inner.v.tau", "gain"),
    "unlink": lambda m: m.unlink("g.u.tau"),
    "describe": lambda m: m.describe(name="other", notes="a note", time_unit="s", dt=0.5, t0=3),
}


@pytest.mark.parametrize("name", OPERATIONS)
def test_undo_and_redo_give_the_identical_document(name: str) -> None:
    model = make()
    before = model.document
    OPERATIONS[name](model)
    after = model.document
    assert after != before, "the operation does something"
    assert model.undo()
    assert model.document is before
    assert model.redo()
    assert model.document is after
    assert not model.redo()
    assert model.undo() and model.document is before, "a change that was done again can be undone again"


def test_undo_reverts_every_change_to_the_start() -> None:
    model = dd.Model("m")
    start = model.document
    seen = [start]
    for operation in (
        lambda: model.add(dd.Field("u", [X])),
        lambda: model.set("u.tau", 5),
        lambda: model.rename("u", "w"),
        lambda: model.remove("w"),
    ):
        operation()
        seen.append(model.document)
    for expected in reversed(seen[:-1]):
        assert model.undo()
        assert model.document is expected
    assert not model.undo()
    for expected in seen[1:]:
        assert model.redo()
        assert model.document is expected


def test_a_new_change_discards_undone_changes() -> None:
    model = make()
    model.set("g.u.resting_level", -4)
    model.undo()
    model.set("g.u.resting_level", -3)
    assert not model.redo()
    assert model.get("g.u.resting_level") == -3


def test_an_axis_is_replaced_in_the_parts_that_have_it_and_in_no_other() -> None:
    y, finer = dd.Axis("y", 0, 1, samples=3), dd.Axis("y", 0, 1, samples=5)
    model = make()
    model.add(dd.AxisWeights(np.ones((11, 3)), X, "y", name="onto x"))
    model.add(dd.AxisWeights(np.ones((3, 11)), y, "x", name="onto y"))
    x = dd.Axis("x", 0, 20, samples=11)
    model.commit(edit.replace_axis(model.document, X, x))
    assert model.get("onto x.axis") == x and model.get("onto y.axis") == y
    assert model.get("g.u.axes") == (x,)
    with pytest.raises(ModelError, match="no element has the axis y"):
        edit.replace_axis(make().document, y, finer)


REFUSED: dict[str, tuple[type[DeodarError], Callable[[dd.Model], object]]] = {
    "a name twice": (ModelError, lambda m: m.add(dd.Field("left", [X]))),
    "a name that is a group": (ModelError, lambda m: m.add(dd.Field("g", [X]))),
    "inside an element": (ModelError, lambda m: m.add(dd.Field("new", [X]), group="left")),
    "a connection twice": (ModelError, lambda m: m.connect("left", "g.u")),
    "no such connection": (UnknownName, lambda m: m.disconnect("left", "g.inner.v")),
    "no such element": (UnknownName, lambda m: m.remove("unknown")),
    "rename onto another": (ModelError, lambda m: m.rename("left", "g")),
    "rename to nothing": (ModelError, lambda m: m.rename("left", "")),
    "rename a group to nothing": (ModelError, lambda m: m.rename("g", "")),
    "rename a group onto an element": (ModelError, lambda m: m.rename("g", "left")),
    "rename a group onto a group": (ModelError, lambda m: m.rename("g.inner", "g") or m.move("g.g", "")),
    "move a group into itself": (ModelError, lambda m: m.move("g", "g.inner")),
    "move into an element": (ModelError, lambda m: m.move("g", "left")),
    "a group without a name": (ModelError, lambda m: m.group("")),
    "a group where an element is": (ModelError, lambda m: m.group("left")),
    "a group inside an element": (ModelError, lambda m: m.group("left.inner")),
    "ungroup what is none": (UnknownName, lambda m: m.ungroup("gg")),
    "copy onto itself": (ModelError, lambda m: m.copy("g", "g")),
    "copy to the top": (ModelError, lambda m: m.copy("g", "")),
    "insert over something": (ModelError, lambda m: m.insert(make(), "left")),
    "a parameter that does not exist": (UnknownName, lambda m: m.set("g.u.tua", 1)),
    "a value out of range": (ParameterError, lambda m: m.set("g.u.noise", -1)),
    "the name": (ParameterError, lambda m: m.set("g.u.name", "w")),
    "a driven parameter": (ParameterError, lambda m: m.set("g.u.tau", 5)),
    "a document parameter outside the range of its links": (ParameterError, lambda m: m.set("gain", -1)),
    "ticks 0": (ParameterError, lambda m: m.set_ticks("left", 0)),
    "ticks half": (ParameterError, lambda m: m.set_ticks("left", 0.5)),  # type: ignore[arg-type]
    "ticks without an end": (ParameterError, lambda m: m.set_ticks("left", 10**400)),
    "a time unit": (ParameterError, lambda m: m.describe(time_unit="hours")),
    "a name of numbers": (ParameterError, lambda m: m.describe(name=5)),
    "a property": (UnknownName, lambda m: m.describe(note="x")),
    "a start that is not a number": (ParameterError, lambda m: m.describe(t0=float("nan"))),
    "a step of nothing": (ParameterError, lambda m: m.describe(dt=0)),
    "a step that is a list": (ParameterError, lambda m: m.describe(dt=[1])),
    "no element": (ModelError, lambda m: m.add(dd.Gaussian())),  # type: ignore[arg-type]
    "a class": (ModelError, lambda m: m.add(dd.Field)),  # type: ignore[arg-type]
    "no handle": (ModelError, lambda m: m.connect(1, "g.u")),  # type: ignore[arg-type]
    "remove a number": (ModelError, lambda m: m.remove(1)),  # type: ignore[arg-type]
    "another model": (ModelError, lambda m: m.connect(make()["left"], m["g.u"])),
    "reads what is not": (ParameterError, lambda m: m.connect("left", "g.inner.v", reads="later")),
    "a parameter as a port": (UnknownName, lambda m: m.connect("left", "g.u.tau")),
    "into a stimulus": (ModelError, lambda m: m.connect("g.u", "left")),
    "from an input": (UnknownName, lambda m: m.connect("g.u.input", "g.inner.v")),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_refused_edit_does_not_change_the_document(name: str) -> None:
    error, operation = REFUSED[name]
    model = make()
    before = model.document
    with pytest.raises(error) as caught:
        operation(model)
    assert str(caught.value)
    while model.document is not before:  # a refusal after a valid first edit: only that edit remains
        assert model.undo()
    assert model.document is before


def _ids(doc: Document) -> dict[str, str]:
    return {e.path: e.id for e in doc.entries}


def test_ids_survive_rename_move_group_and_ungroup() -> None:
    model = make()
    u, links, ids = model["g.u"], model.document.connections, _ids(model.document)
    model.rename("g.u", "w")
    model.move("g.w", "far.away")
    model.rename("far", "near")
    model.move("near.away", "g")
    model.ungroup("g.away")
    model.ungroup("g")
    assert u.path == "w"
    assert u.element.name == "w"
    assert model.document.connections == links
    assert model.document.links() == {(u.id, "tau"): "gain"}
    paths = {"w": "g.u", "inner.v": "g.inner.v", "left": "left", "u>Gain": "g.u>Gain"}
    assert _ids(model.document) == {path: ids[before] for path, before in paths.items()}


def test_handles_follow_their_element_and_report_its_removal() -> None:
    model = make()
    u = model["g.u"]
    model.rename("g", "other")
    assert u.path == "other.u"
    model.remove(u)
    with pytest.raises(UnknownName, match="was removed"):
        u.path  # noqa: B018


def test_ids_do_not_depend_on_the_order_of_declaration() -> None:
    def build(names: list[str]) -> dict[str, str]:
        model = dd.Model("m")
        for name in names:
            model.add(dd.Field(name, [X]))
        return _ids(model.document)

    assert build(["a", "b", "c"]) == build(["c", "a", "b"])


def test_a_name_given_again_gets_another_id() -> None:
    model = dd.Model("m")
    first = model.add(dd.Field("u", [X]))
    model.rename("u", "w")
    second = model.add(dd.Field("u", [X]))
    assert first.id != second.id


def test_removing_an_element_removes_its_connections_and_links() -> None:
    model = make()
    u = model["g.u"]
    model.remove("g.u")
    assert all(u.id not in (c.source, c.target) for c in model.document.connections)
    assert not model.document.links()
    model.set("gain", 9)  # it drives nothing now, and may have any value
    assert model.get("gain") == 9


def test_the_document_is_immutable() -> None:
    model = make()
    with pytest.raises(AttributeError):
        model.document.name = "other"  # type: ignore[misc]
    with pytest.raises(AttributeError):
        model["g.u"].element.tau = 5  # type: ignore[misc]


def test_layout_is_separate_from_the_model() -> None:
    doc = make().document
    arranged = edit.arrange(doc, {"left": [1, 2]})
    assert (arranged.entries, arranged.connections, arranged.parameters) == (
        doc.entries,
        doc.connections,
        doc.parameters,
    )
    assert arranged.layout == {"left": [1, 2]} and doc.layout == {}


def test_setting_the_same_value_is_a_change_of_the_history() -> None:
    model = dd.Model("m")
    model.add(Boost("b", [X]))
    model.set("b.amplitude", 2)
    model.set("b.amplitude", 2)
    assert model.undo() and model.undo()
    assert model.get("b.amplitude") == 1.0


def test_indices_of_a_document_are_extended_as_elements_are_added():
    """If they were computed again for each element, the time would grow with the square of the number of
    names.
    """
    model, seen = dd.Model("many"), []
    for k in range(3):
        model.add(dd.Field(f"u{k}", []))
        seen.append(model.document)
    for n, doc in enumerate(seen, 1):
        assert {"_by_id", "_by_names"} <= set(vars(doc)) and len(doc.by_id()) == len(doc.by_names()) == n
    model["u0"] >> model["u1"]
    model.add(dd.Field("v", []))
    assert len(vars(model.document)["_ends"]) == len(model.document.ends()) == 1
    assert [len(doc.by_names()) for doc in seen] == [1, 2, 3]


def test_a_layout_changes_in_every_document_and_past_ones_keep_their_folded_groups() -> None:
    first = edit.arrange(Document("d"), {"folded": ["old", "other"], "panels": 1})
    history = edit.UndoHistory(first)
    history.commit(edit.arrange(edit.describe(first, notes="renamed"), {"folded": ["new", "other"]}))
    history.commit(edit.describe(history.document, notes="undone"))
    history.undo()
    edit.arrange_everywhere(history, {"folded": ["new", "more"], "panels": None})
    assert (history.depth, history.ahead) == (1, 1)
    assert [doc.layout["folded"] for doc in history.documents] == [
        ["old", "more"],
        ["new", "more"],
        ["new", "more"],
    ]
    assert [doc.notes for doc in history.documents] == ["", "renamed", "undone"]
    assert not any("panels" in doc.layout for doc in history.documents)


def test_an_axis_stays_in_the_document_without_an_element(tmp_path: Path) -> None:
    x, y = dd.Axis("x", 0, 100, samples=11), dd.Axis("y", -5, 5, samples=21, unit="mm")
    model = dd.Model("axes")
    model.add_axis(y)
    assert list(document_files.axes(model.document)) == ["y"]
    with pytest.raises(ModelError, match="already has the axis y"):
        model.add_axis(y)
    dd.save(model, tmp_path / "axes.json")
    assert dd.load(tmp_path / "axes.json").document == model.document
    namespace: dict[str, Any] = {}
    exec(script(model.document, "axes.json"), namespace)
    assert namespace["make"]().document == model.document
    model.set_axis("y", samples=31)
    assert model.document.spare_axes == (dd.Axis("y", -5, 5, samples=31, unit="mm"),)
    model.add(dd.Field("u", [x, *model.document.spare_axes]))
    assert model.document.spare_axes == (), "an element has it"
    model.undo()
    model.remove_axis("y")
    assert document_files.axes(model.document) == {}
    with pytest.raises(UnknownName, match="no axis 'y'"):
        model.remove_axis("y")


def test_what_is_no_axis_is_neither_added_nor_removed() -> None:
    model = dd.Model("axes")
    unchecked: Any = model
    for wrong in ("x", 3, None):
        with pytest.raises(ParameterError, match="expected an Axis, got"):
            unchecked.add_axis(wrong)
    model.add_axis(X)
    with pytest.raises(ParameterError, match="expected an Axis or its name, got 3"):
        unchecked.remove_axis(3)
    with pytest.raises(UnknownName, match=r"no axis y"):
        model.remove_axis(Y)
    model.remove_axis(X)
    assert model.document.spare_axes == ()


def test_a_removed_axis_takes_the_values_for_it_along() -> None:
    x, y = dd.Axis("x", 0, 100, samples=11), dd.Axis("y", -5, 5, samples=21)
    model = dd.Model("axes")
    model.add(dd.GaussianStimulus("s", [x, y], center=(50, 1), sigma=(5, 2), amplitude=3))
    model.add(dd.Field("u", [y, x], kernel=[dd.Gaussian(amplitude=1, sigma=(1, 7))]))
    model.add(dd.Field("v", [x]))
    model.remove_axis("y")
    assert model.get("s.axes") == model.get("u.axes") == model.get("v.axes") == (x,)
    assert model.get("s.center") == (50,) and model.get("s.sigma") == (5,)
    assert model.get("u.kernel.0.sigma") == (7,)
    assert [p for p in model.check() if p.severity == "problem"] == []
    model.undo()
    assert model.get("s.center") == (50, 1), "one step of undo"
    model.remove_axis("x")
    assert model.get("v.axes") == () and model.get("u.axes") == (y,)


def test_an_axis_that_an_element_needs_is_not_removed() -> None:
    x = dd.Axis("x", 0, 100, samples=11)
    model = dd.Model("axes")
    model.add(dd.SampledHistory("past", [], x))
    model.add(dd.PeakPosition(x, name="peak"))
    before = model.document
    with pytest.raises(ParameterError, match=r"past\.slots: needs the axis x") as error:
        model.remove_axis("x")
    assert "Choose another axis there" in str(error.value) and model.document is before


def test_links_to_values_of_a_removed_axis_end_and_later_ones_move() -> None:
    x, y = dd.Axis("x", 0, 10, samples=11), dd.Axis("y", 0, 20, samples=21)
    for removed, driven in (("x", {"second": "u.kernel.0.sigma.0"}), ("y", {"first": "u.kernel.0.sigma.0"})):
        model = dd.Model("axes")
        model.add(dd.Field("u", [x, y], kernel=[dd.Gaussian(amplitude=1, sigma=(1, 2))]))
        for name, leaf in (("first", "sigma.0"), ("second", "sigma.1"), ("third", "amplitude")):
            model.parameter(name, 3)
            model.link(f"u.kernel.0.{leaf}", name)
        model.remove_axis(removed)
        model.set({"first": 4, "second": 5, "third": 6})
        values = {"first": 4, "second": 5}
        assert {name: model.get(path) for name, path in driven.items()} == {n: values[n] for n in driven}
        assert model.get("u.kernel.0.amplitude") == 6
        assert document_files.loads(model.to_json().encode(), lambda name: None) == model.document


def _at_u(model: dd.Model, element: Any) -> None:
    model.connect(model["u"], model.add(element))


@pytest.mark.parametrize(
    ("add", "where"),
    [
        (lambda m: m.add(dd.Pattern("p", [X, Y], values=np.zeros((11, 21)))), "p"),
        (lambda m: _at_u(m, dd.PeakPosition(axis=Y, name="p")), "p.axis"),
        (lambda m: m.add(dd.SpaceCode([Y], name="p")), "p.axes"),
        (lambda m: _at_u(m, dd.Weights(np.zeros((21, 11, 21)), axes=[Y], name="p")), "p"),
    ],
)
def test_an_element_that_does_not_work_without_an_axis_keeps_it(
    add: Callable[[dd.Model], Any], where: str
) -> None:
    model = dd.Model("axes")
    model.add(dd.Field("u", [X, Y]))
    add(model)
    before = model.document
    with pytest.raises(ParameterError) as caught:
        model.remove_axis("y")
    assert caught.value.problems[0].where == where and model.document is before


def test_words_for_an_axis_and_its_name_go_with_it() -> None:
    model = dd.Model("axes")
    kernel = dd.Gaussian(amplitude=1, sigma=(1, 2), boundary=("periodic", "zero"))
    u = model.add(dd.Field("u", [X, Y], kernel=[kernel]))
    _at_u(model, dd.Project([X], rename={"x": "x", "y": "z"}, name="p"))
    _at_u(model, dd.SteeredShift(along=("x", "y"), name="s"))
    assert edit.remove_axis(model.document, Y).by_id()[u.id].axes == (X,)
    after = dd.Model(document=edit.remove_axis(model.document, Y))
    assert after.get("u.kernel.0.boundary") == ("periodic",)
    assert after.get("p.rename") == (("x", "x"),) and after.get("s.along") == ("x",)


def test_many_axes_of_one_name_are_numbered_in_their_order() -> None:
    model = dd.Model("m")
    axes = [dd.Axis("a", 0, k + 1, samples=3) for k in range(3)] + [dd.Axis("a_2", 0, 9, samples=3)]
    for axis in (axes[1], axes[3]):
        model.add_axis(axis)
    model.add(dd.Field("u", [axes[0], axes[1]]))
    model.add_axis(axes[2])
    assert document_files.axes(model.document) == {
        "a": axes[0],
        "a_2": axes[1],
        "a_2_2": axes[3],
        "a_3": axes[2],
    }
    stored = document_files.loads(model.to_json().encode(), lambda name: None)
    assert stored.spare_axes == model.document.spare_axes == (axes[3], axes[2])
