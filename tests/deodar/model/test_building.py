"""Edits as a mouse makes them: new elements with axes, wires, groups, copies."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar import registry
from deodar.element import Element
from deodar.errors import DeodarError, DocumentError, ModelError, ParameterError, UnknownName
from deodar.model import building, clipboard, document_files, edit, new_elements
from deodar.model.building import Around
from deodar.model.check import problems
from deodar.model.document import Document
from deodar.model.model import Model

X, HUE = dd.Axis("x", 0, 100, samples=101), dd.Axis("hue", 0, 360, samples=36, periodic=True)
KINDS = [name for name, cls in registry.kinds().items() if issubclass(cls, Element)]


def pair() -> Model:
    """Return two fields with a coupling between them, in a group."""
    model = Model("pair")
    u = model.add(dd.Field("u", [X]), group="a")
    v = model.add(dd.Field("v", [X]), group="a.b")
    u >> dd.Gain(2.0) >> v
    model.connect(v, u, reads="delayed")
    return model


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_can_be_added_to_an_empty_document_and_read_back(kind: str) -> None:
    doc, (ident,) = building.add(Document("m"), kind, {})
    assert type(doc.by_id()[ident].element).__name__ == kind
    text, packed = document_files.dumps(doc, "m")
    assert document_files.loads(text.encode(), lambda name: packed) == doc


@pytest.mark.parametrize("kind", [kind for kind in KINDS if not registry.kind(kind).example().ports()])
def test_a_kind_without_inputs_runs_at_once(kind: str) -> None:
    doc, (ident,) = building.add(Document("m"), kind, {})
    assert not doc.by_id()[ident].element.ports() and problems(doc) == []


def test_the_first_field_has_one_new_axis_and_the_next_one_the_axes_of_the_first() -> None:
    doc, (u,) = building.add(Document("m"), "Field", {})
    assert doc.by_id()[u].element.axes == (new_elements.FIRST,)  # type: ignore[attr-defined]
    document = edit.add(Document("m"), dd.Field("u", [HUE]))[0]
    doc, (s,) = building.add(document, "GaussianStimulus", {})
    assert doc.by_id()[s].element.axes == (HUE,)  # type: ignore[attr-defined]


def test_a_new_element_has_the_axes_of_what_it_is_connected_with() -> None:
    model = Model("m")
    model.add(dd.Field("u", [X]))
    v = model.add(dd.Field("v", [HUE]))
    node = model.add(dd.Field("n"))
    doc, (s,) = building.add(model.document, "GaussianStimulus", {}, around=Around(target=(v.id, "input")))
    assert doc.by_id()[s].element.axes == (HUE,)  # type: ignore[attr-defined]
    assert doc.connections[-1].ends == (s, "output", v.id, "input")
    doc, (w,) = building.add(doc, "Field", {}, around=Around(source=(node.id, "")))
    assert doc.by_id()[w].element.axes == () and doc.connections[-1].ends[0] == node.id  # type: ignore[attr-defined]


@pytest.mark.parametrize("axes", [[X], [HUE], [X, HUE], [dd.Axis("d", -1, 1, samples=51, unit="m")]])
def test_a_field_and_two_stimuli_that_were_added_form_one_peak(axes: list[dd.Axis]) -> None:
    doc = edit.add(Document("m"), dd.Boost("pad", axes, amplitude=0.0))[0]
    doc, (u,) = building.add(doc, "Field", {})
    places = [[a.lower + share * a.range for a in axes] for share in (0.3, 0.7)]
    for place, amplitude in zip(places, (6.0, 5.7), strict=True):
        values = {"center": place, "windows": [{"kind": "Window", "start": 0, "stop": 400}]}
        values |= {} if amplitude == 6.0 else {"amplitude": amplitude}
        doc, _ = building.add(doc, "GaussianStimulus", values, around=Around(target=(u, "")))
    record = dd.simulate(Model(document=doc), 1000, record=["field.activation"], every=200)
    activation = record["field.activation"].values
    spots = [
        tuple(int(np.abs(a.points - p).argmin()) for a, p in zip(axes, at, strict=True)) for at in places
    ]
    assert activation[1][spots[0]] > 0 > activation[1][spots[1]], "the stronger input alone has a peak"
    assert activation[-1].max() < 0, "the peak decays without its input"


def test_given_values_are_kept_and_wrong_ones_are_refused_without_an_element() -> None:
    doc, (u,) = building.add(Document("m"), "Field", {"axes": [], "kernel": [], "resting_level": -3})
    element = doc.by_id()[u].element
    assert (element.axes, element.kernel, element.resting_level) == ((), (), -3)  # type: ignore[attr-defined]
    with pytest.raises(ParameterError, match="tau"):
        building.add(Document("m"), "Field", {"tau": -1})
    with pytest.raises(UnknownName, match="Field"):
        building.add(Document("m"), "Feild", {})
    with pytest.raises(ParameterError, match="expected an element"):
        building.add(Document("m"), "Gaussian", {})


def test_an_element_dropped_on_a_wire_stands_in_it() -> None:
    doc = pair().document
    gain = doc.by_names()["a", "u>Gain"].id
    v = doc.by_names()["a", "b", "v"].id
    new, (s,) = building.add(doc, "Sigmoid", {}, around=Around(wire=(gain, "", v, "")))
    ends = {c.ends for c in new.connections}
    assert (gain, "output", s, "input") in ends and (s, "output", v, "input") in ends
    assert (gain, "output", v, "input") not in ends and problems(new) == []
    u = doc.by_names()["a", "u"].id
    new, (g,) = building.add(doc, "Gain", {}, around=Around(wire=(v, "", u, "")))
    assert next(c for c in new.connections if c.target == g).reads == "delayed"


def test_a_wire_keeps_what_it_reads_while_its_source_stays() -> None:
    model = pair()
    w = model.add(dd.Field("w", [X]))
    doc, by = model.document, model.document.by_names()
    v, u = by["a", "b", "v"].id, by["a", "u"].id
    moved = building.reconnect(doc, (v, "output", u, "input"), (v, "output", w.id, "input"))
    assert (moved.connections[-1].ends, moved.connections[-1].reads) == (
        (v, "output", w.id, "input"),
        "delayed",
    )
    moved = building.reconnect(doc, (v, "", u, ""), (w.id, "", u, ""))
    assert moved.connections[-1].reads == ""


def test_removed_elements_leave_no_position_for_those_that_get_their_ids() -> None:
    doc, (u,) = building.add(Document("m"), "Field", {}, "u", at=(5, 6))
    gone = building.remove(doc, [u])
    assert gone.layout == {} and gone.entries == ()
    restored, (same,) = building.add(gone, "Field", {}, "u")
    assert same == u and building.positions(restored) == {}


def test_removal_of_a_group_removes_its_content_and_connections() -> None:
    doc = pair().document
    gone = building.remove(doc, [], [("a", "b")])
    assert [e.path for e in gone.entries] == ["a.u", "a.u>Gain"] and len(gone.connections) == 1
    assert gone.groups == (("a",),)
    with pytest.raises(UnknownName, match="no group"):
        building.remove(doc, [], [("c",)])


def test_a_group_is_made_where_all_members_lie() -> None:
    doc = pair().document
    by = doc.by_names()
    new, path = building.group(doc, [by["a", "u"].id], [("a", "b")], "pool", at=(10, 20))
    assert path == ("a", "pool")
    assert [e.names for e in new.entries] == [("a", "pool", "u"), ("a", "pool", "b", "v"), ("a", "u>Gain")]
    assert new.connections == doc.connections and {e.id for e in new.entries} == {e.id for e in doc.entries}
    with pytest.raises(ModelError, match="nothing is selected"):
        building.group(doc, [], [])


def test_members_of_a_group_keep_their_arrangement_when_it_is_placed() -> None:
    doc = pair().document
    u, v = doc.by_names()["a", "u"].id, doc.by_names()["a", "b", "v"].id
    doc = building.placed(doc, {u: (100, 200), v: (300, 250)})
    new, _ = building.group(doc, [u, v], [], at=(0, 0))
    assert building.positions(new) == {u: (0, 0), v: (200, 50)}


def test_an_ungrouped_element_may_have_the_name_of_its_group_and_of_others() -> None:
    model = Model("m")
    for group in ("u", ""):
        model.add(dd.Field("v"), group=group)
    model.add(dd.Field("u"), group="u")
    model.add(dd.Field("w"), group="u.u2")
    new = building.ungroup(model.document, ("u",))
    assert {e.names for e in new.entries} == {("v2",), ("v",), ("u",), ("u2", "w")}
    assert new.groups == (("u2",),)


def test_a_group_of_the_same_name_takes_the_place_of_its_ungrouped_parent() -> None:
    unit = Model("unit")
    unit.add(dd.Field("u", [X]))
    model = Model("m")
    model.group("a.a.b")
    model.insert(unit, "a.a", link=True)
    new = building.ungroup(model.document, ("a",))
    assert new.groups == (("a",), ("a", "b"))
    assert [e.names for e in new.entries] == [("a", "u")]
    assert [u.group for u in new.uses] == [("a",)]


def test_moving_into_a_group_moves_each_thing_once_and_frees_names() -> None:
    model = pair()
    model.add(dd.Field("u"))
    doc, by = model.document, model.document.by_names()
    inside = by["a", "b", "v"].id
    new = building.move_into(doc, [by[("u",)].id, inside], [("a", "b")], ("a",))
    assert {e.names for e in new.entries} == {("a", "u"), ("a", "u2"), ("a", "b", "v"), ("a", "u>Gain")}
    up = building.move_into(doc, [by["a", "u"].id], [], ())
    assert {e.names for e in up.entries} >= {("u",), ("u2",)}
    with pytest.raises(ModelError, match="into itself"):
        building.move_into(doc, [], [("a",)], ("a", "b"))


def test_groups_are_moved_and_dissolved_with_their_content_uses_and_free_names() -> None:
    unit = Model("unit")
    unit.add(dd.Field("u", [X]), group="inner")
    model = Model("m")
    model.insert(unit, "a.b", link=True)
    model.insert(unit, "c.b", link=True)
    doc = building.move_into(model.document, [], [("c", "b")], ("a",))
    assert [e.path for e in doc.entries] == ["a.b.inner.u", "a.b2.inner.u"]
    assert doc.groups == (("a",), ("a", "b"), ("a", "b", "inner"), ("c",), ("a", "b2"), ("a", "b2", "inner"))
    assert [u.group for u in doc.uses] == [("a", "b"), ("a", "b2")]
    doc = building.ungroup(doc, ("a",))
    assert [e.path for e in doc.entries] == ["b.inner.u", "b2.inner.u"]
    assert [u.group for u in doc.uses] == [("b",), ("b2",)]
    doc = building.ungroup(doc, ("b",))
    assert [e.path for e in doc.entries] == ["inner.u", "b2.inner.u"]
    assert [u.group for u in doc.uses] == [("b2",)]
    with pytest.raises(ModelError, match="cannot be moved into itself"):
        edit.relocate(doc, {}, {("b2",): ("b2", "inner", "b2")})
    with pytest.raises(ModelError, match="already"):
        edit.relocate(doc, {}, {("b2", "inner"): ("inner",)})


def test_a_copy_is_a_document_of_its_own_and_pastes_the_same_content() -> None:
    model = pair()
    model.parameter("gain", 3.0)
    model.link("a.u>Gain.factor", "gain")
    doc = building.placed(model.document, {model.document.entries[0].id: (40, 50)})
    text = clipboard.text(building.excerpt(doc, [], [("a",)]))
    read = clipboard.read(text)
    assert [e.path for e in read.entries] == ["a.u", "a.b.v", "a.u>Gain"] and problems(read) == []
    new, pasted = building.paste(doc, read, at=(0, 10))
    assert [new.by_id()[i].path for i in pasted] == ["a2.u", "a2.b.v", "a2.u>Gain"]
    assert building.positions(new)[pasted[0]] == (0, 10)
    assert len(new.connections) == 6 and len(new.parameters[0].links) == 2
    alone, pasted = building.paste(Document("other"), read)
    assert [c.reads for c in alone.connections] == ["", "", "delayed"]
    assert (
        document_files.to_data(alone)[0]["elements"].keys()
        == document_files.to_data(read)[0]["elements"].keys()
    )


def test_a_copy_of_elements_of_several_groups_begins_at_the_group_of_all() -> None:
    doc = pair().document
    excerpt = building.excerpt(doc, [doc.by_names()["a", "u"].id, doc.by_names()["a", "b", "v"].id])
    assert [e.path for e in excerpt.entries] == ["u", "b.v"]
    assert [c.reads for c in excerpt.connections] == ["delayed"], "the coupling between them was not copied"


def test_a_clipboard_text_contains_its_arrays() -> None:
    model = Model("m")
    weights = np.random.default_rng(0).normal(size=(101, 101))
    model.add(dd.Field("u", [X])) >> dd.Weights(weights, [X], name="w") >> model.add(dd.Field("v", [X]))
    text = clipboard.text(building.excerpt(model.document, [e.id for e in model.document.entries]))
    pasted, ids = building.paste(Document("m"), clipboard.read(text))
    np.testing.assert_array_equal(pasted.by_id()[ids[1]].element.weights.data, weights)  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "hello",
        "[1, 2]",
        '{"deodar": 3}',
        '{"deodar": 99, "elements": {}}',
        '{"deodar": 3, "elements": {"u": {"kind": "Field", "tau": -1}}}',
        '{"deodar": 3, "elements": {}, "arrays": {"file": "a.npz", "sha256": "", "content": "%%"}}',
        '{"deodar": 3, "elements": {}, "arrays": {"file": "a.npz", "sha256": "0", "content": "AAAA"}}',
        '{"deodar": 3, "elements": {}, "arrays": {"file": "../a.npz", "sha256": "0", "content": ""}}',
        '{"name": "page", "version": "1.0.0", "dependencies": {}}',
        '{"simulator": {"deltaT": 1, "nElements": 0, "elements": []}}',
        '{"deodar": 3, "elements": {"__proto__": {"kind": "__import__"}}}',
        '{"deodar": 3, "elements": {"u": {"kind": "Field", "axes": ["x"]}}, "axes": {"x": {"samples": 9e9}}}',
        "\ud800",
        "[" * 100_000,
        " " * (document_files.MOST_BYTES + 1),
    ],
    ids=lambda text: text[:60],
)
def test_text_that_is_no_document_is_refused(text: str) -> None:
    with pytest.raises(DocumentError):
        clipboard.read(text)


def test_paste_into_a_document_where_a_name_cannot_be_used_changes_nothing() -> None:
    model = Model("m")
    model.parameter("u.tau", 3.0)
    document = edit.add(Document("o"), dd.Field("u"))[0]
    with pytest.raises(DeodarError):
        building.paste(model.document, document)
    assert model.document.entries == ()


def test_a_new_element_is_over_the_axis_that_was_made_for_it() -> None:
    angle = dd.Axis("angle", -180, 180, samples=72, periodic=True, unit="deg")
    doc = edit.add_axis(edit.add_axis(Document("new"), angle), dd.Axis("y", 0, 1, samples=3))
    for kind in ("Field", "GaussianStimulus"):
        added, _ = building.add(doc, kind, {}, "u")
        (entry,) = added.entries
        assert entry.axes == (angle,) and "x" not in document_files.axes(added)
