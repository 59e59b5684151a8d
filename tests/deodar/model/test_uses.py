"""Groups that stay linked to a template: a change of it changes every use, and nothing around them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.errors import DocumentError, ModelError, UnknownName
from deodar.model import document_files
from deodar.model.check import problems


def template() -> dd.Model:
    """Return two nodes, a coupling and one document parameter."""
    model = dd.Model("switch")
    a, b = model.add(dd.Field("a", [], resting_level=-2)), model.add(dd.Field("b", []))
    a >> model.add(dd.Gain(2, name="drives")) >> b
    model.parameter("tempo", 20.0)
    model.link("a.tau", "tempo")
    return model


def host() -> dd.Model:
    """Return a model with two uses, one copy, and elements around them."""
    model = dd.Model("host")
    for name in ("left", "right"):
        model.insert(template(), name, link=True)
    model.insert(template(), "copy")
    out = model.add(dd.Field("out", []))
    model["left.b"] >> out
    model["right.b"] >> dd.Gain(-1, name="less") >> model["left.a"]
    return model


def edges(model: dd.Model) -> set[tuple[str, str]]:
    by = model.document.by_id()
    return {(by[c.source].path, by[c.target].path) for c in model.document.connections}


def test_a_change_reaches_every_use_and_no_copy() -> None:
    model, changed = host(), template()
    changed.set("a.resting_level", -3)
    model.refresh(changed)
    assert [model.get(f"{name}.a.resting_level") for name in ("left", "right", "copy")] == [-3, -3, -2]
    assert not problems(model.document)


def test_refreshing_without_a_change_changes_nothing() -> None:
    model = host()
    ids, before = {e.path: e.id for e in model.document.entries}, edges(model)
    record = dd.simulate(model, 100, every=10)
    model.refresh(template())
    assert {e.path: e.id for e in model.document.entries} == ids and edges(model) == before
    again = dd.simulate(model, 100, every=10)
    assert all(np.array_equal(record[name], again[name]) for name in record.data_vars)


def test_a_refresh_adds_new_elements_removes_missing_ones_and_keeps_the_others() -> None:
    model, changed = host(), template()
    changed.remove("drives")
    changed["a"] >> changed.add(dd.Field("middle", []), group="inner") >> changed["b"]
    ids = {name: model[f"{name}.a"].id for name in ("left", "right")}
    model.refresh(changed)
    inside = {(f"{n}.a", f"{n}.inner.middle") for n in ("left", "right")} | {
        (f"{n}.inner.middle", f"{n}.b") for n in ("left", "right")
    }
    around = {
        ("left.b", "out"),
        ("right.b", "less"),
        ("less", "left.a"),
        ("copy.a", "copy.drives"),
        ("copy.drives", "copy.b"),
    }
    assert edges(model) == inside | around
    assert {name: model[f"{name}.a"].id for name in ids} == ids
    assert "left.drives" not in model and "copy.drives" in model


def test_elements_of_a_template_may_exchange_names() -> None:
    changed, model = template(), host()
    first, second = model["left.a"].id, model["left.b"].id
    changed.rename("a", "c")
    changed.rename("b", "a")
    changed.rename("c", "b")
    model.refresh(changed)
    assert (model["left.b"].id, model["left.a"].id) == (first, second)
    assert ("less", "left.b") in edges(model) and model.get("left.b.resting_level") == -2


def test_document_parameters_keep_their_values_and_drive_new_elements() -> None:
    model, changed = host(), template()
    model.set("tempo", 50)
    model.parameter("low", -7.0)
    model.link("left.b.resting_level", "low")
    changed.link("b.tau", "tempo")
    changed.parameter("strength", 4.0)
    changed.link("drives.factor", "strength")
    model.refresh(changed)
    assert {model.get(f"{n}.{e}.tau") for n in ("left", "right") for e in "ab"} == {50.0}
    assert (
        model.get("left.b.resting_level") == -7
        and model.get("right.drives.factor") == model.get("strength") == 4
    )
    assert model.get("copy.drives.factor") == 2


def test_uses_follow_their_group_and_their_file(tmp_path: Path) -> None:
    model, changed = host(), template()
    model.rename("left", "first")
    model.move("right", "second.part")
    dd.save(model, tmp_path / "host.json")
    loaded = dd.load(tmp_path / "host.json")
    assert loaded.document.uses == model.document.uses
    changed.set("a.resting_level", -3)
    loaded.refresh(changed)
    assert loaded.get("first.a.resting_level") == loaded.get("second.part.right.a.resting_level") == -3


def test_a_template_of_templates_stays_linked_at_both_levels() -> None:
    outer, model = dd.Model("outer"), dd.Model("host")
    outer.insert(template(), "inner", link=True)
    model.insert(outer, "x", link=True)
    changed = template()
    changed.set("a.resting_level", -3)
    model.refresh(changed)
    assert model.get("x.inner.a.resting_level") == -3
    outer.refresh(changed)
    outer.add(dd.Field("more", []))
    model.refresh(outer)
    assert "x.more" in model
    changed.set("a.resting_level", -4)
    model.refresh(changed)
    assert model.get("x.inner.a.resting_level") == -4


def test_an_ungrouped_or_removed_group_is_no_longer_linked() -> None:
    model = host()
    model.ungroup("left")
    model.remove("right")
    assert model.document.uses == ()
    with pytest.raises(UnknownName, match="no group is linked to a template 'switch'"):
        model.refresh(template())
    with pytest.raises(UnknownName, match="Did you mean 'switch'"):
        host().refresh(dd.Model("swich"))
    model = host()
    model.insert(dd.Model("memory"), "third", link=True)
    with pytest.raises(UnknownName, match="Did you mean 'memory'"):
        model.refresh(dd.Model("memery"))


def test_a_refresh_can_be_undone() -> None:
    model, changed = host(), template()
    changed.set("a.resting_level", -3)
    before = model.document
    model.refresh(changed)
    assert model.undo() and model.document == before


def test_a_template_without_a_required_element_or_port_is_refused() -> None:
    model, changed = host(), template()
    changed.remove("b")
    before = model.document
    with pytest.raises(
        ModelError, match=r"left\.b\.output -> out\.input: the template 'switch' no longer has 'b'"
    ) as caught:
        model.refresh(changed)
    assert len(caught.value.problems) >= 1 and model.document == before


@pytest.mark.parametrize(
    ("uses", "problem"),
    [
        ({"left": 1}, "needs a template"),
        ({"left": {"template": "switch", "elements": {"00000000": "nothing"}}}, "nothing"),
        ({"lost": {"template": "switch", "elements": {}}}, "there is no group 'lost'"),
    ],
)
def test_invalid_uses_in_a_document_are_reported(uses: object, problem: str) -> None:
    document, _ = document_files.to_data(host().document)
    with pytest.raises(DocumentError, match=problem):
        document_files.from_data(document | {"uses": uses}, {})
