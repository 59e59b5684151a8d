"""Groups as templates: copies have their own ids, and the connections, links and nesting of the original."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar.errors import UnknownName
from deodar.model.check import problems

X = dd.Axis("x", 0, 10, samples=11)


def behaviour() -> dd.Model:
    """Return an elementary behaviour: intention, condition of satisfaction, and one document parameter for
    both.
    """
    model = dd.Model("behaviour")
    intention = model.add(dd.Field("intention", [X]))
    satisfied = model.add(dd.Field("satisfied", [X]), group="end")
    intention >> dd.Gain(2) >> satisfied
    satisfied >> dd.Gain(-3) >> intention
    model.parameter("tau", 30.0)
    model.link("intention.tau", "tau")
    model.link("end.satisfied.tau", "tau")
    return model


def _paths(model: dd.Model) -> list[str]:
    return [e.path for e in model.document.entries]


def _edges(model: dd.Model, group: str) -> set[tuple[str, str]]:
    by = model.document.by_id()
    cut = len(group) + 1
    return {
        (by[c.source].path[cut:], by[c.target].path[cut:])
        for c in model.document.connections
        if by[c.source].path.startswith(group + ".")
    }


def test_four_equal_behaviours_share_one_document_parameter() -> None:
    model = dd.Model("four")
    for name in ("reach", "grasp", "lift", "drop"):
        model.insert(behaviour(), name)
    assert len(model.document.entries) == 16
    assert len({e.id for e in model.document.entries}) == 16
    assert [k.name for k in model.document.parameters] == ["tau"]
    model.set("tau", 55)
    assert {model.get(f"{g}.intention.tau") for g in ("reach", "grasp", "lift", "drop")} == {55.0}
    assert {model.get(f"{g}.end.satisfied.tau") for g in ("reach", "grasp", "lift", "drop")} == {55.0}
    assert not problems(model.document)


def test_an_inserted_template_is_a_copy() -> None:
    template, model = behaviour(), dd.Model("m")
    model.insert(template, "one")
    template.set("intention.resting_level", -9)
    assert model.get("one.intention.resting_level") == -5
    assert ("one", "end") in model.document.groups


def test_a_copied_group_has_the_connections_inside_and_not_those_outside() -> None:
    model = dd.Model("m")
    model.insert(behaviour(), "a")
    left = model.add(dd.GaussianStimulus("left", [X]))
    left >> model["a.intention"]
    model.copy("a", "b")
    assert _edges(model, "a") == _edges(model, "b")
    by = model.document.by_id()
    assert [
        (by[c.source].path, by[c.target].path)
        for c in model.document.connections
        if by[c.source].path == "left"
    ] == [("left", "a.intention")]
    model.set("tau", 12)
    assert model.get("b.intention.tau") == 12
    assert ("b", "end") in model.document.groups


def test_copies_have_ids_of_their_own_and_the_originals_keep_theirs() -> None:
    model = dd.Model("m")
    model.insert(behaviour(), "a")
    before = {e.path: e.id for e in model.document.entries}
    model.copy("a", "b")
    after = {e.path: e.id for e in model.document.entries}
    assert {p: after[p] for p in before} == before
    assert not set(before.values()) & {i for p, i in after.items() if p.startswith("b.")}


def test_copying_keeps_the_steps_of_parts() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X]), group="a", ticks=4)
    model.copy("a", "b")
    assert model.document.by_names()["b", "u"].every == 4


def test_nested_groups_are_moved_and_ungrouped() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", [X]), group="a.b.c")
    assert model.document.groups == (("a",), ("a", "b"), ("a", "b", "c"))
    model.move("a.b", "")
    assert _paths(model) == ["b.c.u"]
    model.ungroup("b.c")
    assert _paths(model) == ["b.u"]
    assert model.document.groups == (("a",), ("b",))
    model.remove("a")
    assert model.document.groups == (("b",),)


def test_removing_a_group_removes_its_elements() -> None:
    model = dd.Model("m")
    model.insert(behaviour(), "a")
    model.insert(behaviour(), "ab")
    model.remove("a")
    assert {p.partition(".")[0] for p in _paths(model)} == {"ab"}


def test_empty_groups_are_saved_and_loaded() -> None:
    from deodar.model import document_files

    model = dd.Model("m")
    model.group("a.b")
    assert document_files.from_data(document_files.to_data(model.document)[0], {}).groups == (
        ("a",),
        ("a", "b"),
    )


def test_an_unknown_group_suggests_the_nearest() -> None:
    model = dd.Model("m")
    model.insert(behaviour(), "reach")
    with pytest.raises(UnknownName, match=r"no group 'raech'.*Did you mean 'reach'"):
        model.copy("raech", "other")
