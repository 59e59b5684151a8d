"""The strength of a connection: a Gain that is made and removed with it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import deodar as dd
from deodar.element import Element
from deodar.errors import ModelError, ParameterError, UnknownName
from deodar.model import building, document_files, edit, uses
from deodar.model.building import EndPorts, placed
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.model.stated_ports import STATED
from deodar.model.strength import set_strength, strength_path

X = dd.Axis("x", 0, 100, samples=101)


def triple() -> Model:
    """Return three fields in a group, with the connection u -> v between two others."""
    model = Model("triple")
    u, v, w = (model.add(dd.Field(name, [X]), group="maps") for name in "uvw")
    model.connect(w, u)
    model.connect(u, v, reads="delayed")
    model.connect(v, w)
    return model


def plain(model: Model, source: str = "maps.u", target: str = "maps.v") -> EndPorts:
    return (model[source].id, "", model[target].id, "")


def stored(doc: Document) -> str:
    return document_files.dumps(doc, "d")[0]


def into(ident: str | None, model: Model) -> EndPorts:
    assert ident is not None
    return (model["maps.u"].id, "", ident, "")


def wires(doc: Document) -> list[tuple[str, str, str]]:
    by = doc.by_id()
    return [(by[c.source].path, by[c.target].path, c.reads) for c in doc.connections]


@pytest.mark.parametrize("factor", [3.0, -4.0, 0.0])
def test_another_strength_is_a_gain_in_the_connection_and_1_gives_the_same_bytes(factor: float) -> None:
    model = triple()
    before = model.document
    doc, gain = set_strength(before, plain(model), factor)
    assert wires(doc) == [
        ("maps.w", "maps.u", ""),
        ("maps.u", "maps.u>Gain", "delayed"),
        ("maps.u>Gain", "maps.v", ""),
        ("maps.v", "maps.w", ""),
    ]
    assert gain is not None and doc.by_id()[gain].element == dd.Gain(factor, name="u>Gain")
    weaker, same = set_strength(doc, into(gain, model), 2.5)
    assert same == gain and weaker.by_id()[gain].element == dd.Gain(2.5, name="u>Gain")
    back, none = set_strength(weaker, into(gain, model), 1)
    assert none is None and stored(back) == stored(before) and back == before


def test_strength_1_of_a_plain_connection_is_the_same_document() -> None:
    model = triple()
    assert set_strength(model.document, plain(model), 1.0) == (model.document, None)


def test_a_gain_of_a_script_without_a_name_is_the_strength_of_its_connection() -> None:
    model = triple()
    model["maps.v"] >> dd.Gain(2.0) >> model["maps.u"]
    gain = model["maps.v>Gain"].id
    doc, none = set_strength(model.document, (model["maps.v"].id, "", gain, ""), 1)
    assert none is None and ("maps.v", "maps.u", "") in wires(doc)


def test_the_strength_belongs_to_its_connection_also_after_the_source_has_another_name() -> None:
    model = triple()
    doc, gain = set_strength(model.document, plain(model), 3)
    renamed = edit.move(doc, model["maps.u"].id, ("maps", "saccade"))
    back, none = set_strength(renamed, into(gain, model), 1)
    assert none is None and back == edit.move(model.document, model["maps.u"].id, ("maps", "saccade"))


def test_a_drag_through_1_keeps_the_gain_until_it_ends() -> None:
    model = triple()
    doc, gain = set_strength(model.document, plain(model), 1.05)
    doc, same = set_strength(doc, into(gain, model), 1, keeps=True)
    assert same == gain and gain in doc.by_id()
    assert set_strength(doc, into(gain, model), 1)[0] == model.document


def _named(doc: Document, gain: str) -> Document:
    return edit.move(doc, gain, ("maps", "boost"))


def _slow(doc: Document, gain: str) -> Document:
    return edit.every(doc, gain, 10)


def _placed(doc: Document, gain: str) -> Document:
    return placed(doc, {gain: (0.0, 0.0)})


def _pinned(doc: Document, gain: str) -> Document:
    return edit.arrange(doc, {"pins": [{"element": gain, "parameter": "factor"}]})


def _beside(doc: Document, gain: str) -> Document:
    u, v = (doc.by_names()["maps", name] for name in "uv")
    return edit.connect(doc, u, "", v, "")


def _moved(doc: Document, gain: str) -> Document:
    return edit.move(doc, gain, ("task", "u>Gain"))


@pytest.mark.parametrize("change", [_named, _slow, _placed, _pinned, _beside, _moved])
def test_a_gain_that_is_more_than_a_number_stays_at_1(change: Callable[[Document, str], Document]) -> None:
    model = triple()
    doc, gain = set_strength(model.document, plain(model), 3)
    assert gain is not None
    after, last = set_strength(change(doc, gain), into(gain, model), 1)
    assert last == gain and after.by_id()[gain].element in (
        dd.Gain(1, name="u>Gain"),
        dd.Gain(1, name="boost"),
    )


def test_a_gain_that_another_element_reads_too_keeps_its_factor() -> None:
    model = triple()
    doc, gain = set_strength(model.document, plain(model), 3)
    assert gain is not None
    doc = edit.connect(doc, doc.by_id()[gain], "", doc.by_names()["maps", "w"], "")
    after, second = set_strength(doc, into(gain, model), 2)
    assert second not in (gain, None) and after.by_id()[gain].element == doc.by_id()[gain].element


def test_what_is_no_strength_or_no_connection_is_refused() -> None:
    model = triple()
    with pytest.raises(UnknownName, match="is not connected"):
        set_strength(model.document, plain(model, "maps.u", "maps.w"), 2)
    with pytest.raises(ParameterError, match="finite"):
        set_strength(model.document, plain(model), float("nan"))
    doc, gain = set_strength(model.document, plain(model), 3)
    assert gain is not None
    linked = edit.link(edit.document_parameter(doc, "drive", 3), gain, "factor", "drive")
    with pytest.raises(ParameterError, match="driven by the document parameter"):
        set_strength(linked, into(gain, model), 1)


def test_a_gain_gets_a_name_that_no_group_and_no_document_parameter_has() -> None:
    model = triple()
    doc = edit.group(model.document, ("maps", "u>Gain"))
    doc = edit.document_parameter(doc, 'maps."u>Gain2"', 3.0)
    doc = edit.document_parameter(doc, "maps.u>Gain2", 3.0)
    doc = edit.document_parameter(doc, "maps.u>Gain3.factor", 3.0)
    after, gain = set_strength(doc, plain(model), 3)
    assert gain is not None and after.by_id()[gain].names == ("maps", "u>Gain4")
    assert set_strength(after, into(gain, model), 1)[0] == doc


def test_a_strength_inside_a_linked_group_is_one_of_its_template() -> None:
    template = Model("pair")
    template.add(dd.Field("a", [X])) >> template.add(dd.Field("b", [X]))
    model = Model("m")
    model.insert(template, "g", link=True)
    model.add(dd.Field("w", [X])) >> model["g.a"]
    with pytest.raises(ModelError, match=r"linked to the template 'pair'.*Change its strength"):
        set_strength(model.document, plain(model, "g.a", "g.b"), 3)
    doc, gain = set_strength(model.document, plain(model, "w", "g.a"), 3)
    refreshed = uses.refresh(doc, template.document)
    assert gain in refreshed.by_id() and len(refreshed.connections) == len(model.document.connections) + 1


def remembered(quadrature: str = "cell") -> Model:
    """Return a field whose output a memory trace reads."""
    model = Model("remembered")
    axis = dd.Axis("x", 0, 100, samples=21)
    stimulus = model.add(dd.GaussianStimulus("s", [axis], amplitude=12, sigma=4.0))
    field = model.add(dd.Field("u", [axis], resting_level=-5.0, quadrature=quadrature))
    stimulus >> field
    field >> model.add(dd.MemoryTrace("trace", [axis], tau_build=200))
    return model


def traced(doc: Document) -> np.ndarray:
    session = dd.Session(Model(document=doc))
    session.step(1000)
    return session.read("trace.output")


def test_a_trace_reads_the_same_numbers_through_a_strength() -> None:
    model = remembered()
    doc, gain = set_strength(model.document, plain(model, "u", "trace"), 1.0001)
    assert gain is not None
    assert np.allclose(traced(doc), traced(model.document), atol=2e-4)
    for ends in ((model["u"].id, port, gain, "") for port in ("", "output", "bounded")):
        back, none = set_strength(doc, ends, 1)
        assert none is None and stored(back) == stored(model.document)


def test_a_drag_keeps_the_port_that_a_trace_reads_until_it_ends() -> None:
    model = remembered()
    doc, gain = set_strength(model.document, plain(model, "u", "trace"), 2, keeps=True)
    assert gain is not None and doc.connections[1].source_port == "output"
    doc, _ = set_strength(doc, (model["u"].id, "output", gain, ""), 3, keeps=True)
    assert doc.connections[1].source_port == "output"
    ended, _ = set_strength(doc, (model["u"].id, "output", gain, ""), 3)
    assert ended.connections[1].source_port == "bounded"
    assert ended == set_strength(model.document, plain(model, "u", "trace"), 3)[0]


def test_two_ports_that_a_trace_reads_keep_their_own_strengths() -> None:
    model = remembered()
    model["u"]["bounded"] >> model["trace"]
    doc, gain = set_strength(model.document, (model["u"].id, "bounded", model["trace"].id, ""), 2)
    assert gain is not None
    back, _ = set_strength(doc, (model["u"].id, "bounded", gain, ""), 1)
    assert stored(back) == stored(model.document)


def test_a_connection_that_states_the_bounded_port_states_it_again() -> None:
    usual, bounded = remembered(), remembered()
    bounded.disconnect(bounded["u"], bounded["trace"])
    bounded["u"]["bounded"] >> bounded["trace"]
    for model, port in ((usual, "output"), (bounded, "bounded")):
        doc, gain = set_strength(model.document, (model["u"].id, port, model["trace"].id, ""), 2, keeps=True)
        doc, _ = set_strength(doc, (model["u"].id, port, gain or "", ""), -3)
        assert wires(doc)[1:] == [("u", "u>Gain", ""), ("u>Gain", "trace", "")]
        assert doc.connections[1].source_port == "bounded"
        back, none = set_strength(doc, (model["u"].id, "", gain or "", ""), 1)
        assert none is None and stored(back) == stored(model.document)


def _stated_odd(doc: Document, gain: str) -> Document:
    return edit.arrange(doc, {STATED: ["bounded", gain]})


def test_another_content_of_the_layout_under_that_key_is_passed_over() -> None:
    model = remembered()
    doc, gain = set_strength(model.document, plain(model, "u", "trace"), 2)
    back, none = set_strength(_stated_odd(doc, gain or ""), (model["u"].id, "", gain or "", ""), 1)
    assert none is None and back.connections == model.document.connections


def test_the_stated_port_is_forgotten_with_its_gain() -> None:
    model = remembered()
    model.disconnect(model["u"], model["trace"])
    model["u"]["bounded"] >> model["trace"]
    u, trace = model["u"].id, model["trace"].id
    doc, gain = set_strength(model.document, (u, "bounded", trace, ""), 2)
    assert gain is not None and doc.layout == {STATED: {gain: "bounded"}}
    assert not building.remove(doc, [u, trace, gain]).layout
    two = edit.arrange(doc, {STATED: {gain: "bounded", "other": "bounded"}})
    assert building.remove(two, [gain]).layout == {STATED: {"other": "bounded"}}


@pytest.mark.parametrize("removed", [building.remove, edit.remove])
def test_a_plain_connection_in_the_place_of_one_that_states_a_port_is_plain_at_strength_1(
    removed: Callable[[Document, list[str]], Document],
) -> None:
    model = remembered()
    usual = model.document
    model.disconnect(model["u"], model["trace"])
    model["u"]["bounded"] >> model["trace"]
    u, trace = model["u"].id, model["trace"].id
    doc, gain = set_strength(model.document, (u, "bounded", trace, ""), 2)
    doc = building.connect(removed(doc, [gain or ""]), (u, "", trace, ""))
    doc, second = set_strength(doc, (u, "", trace, ""), 2)
    assert second == gain, "ids are hashes of paths"
    back, none = set_strength(doc, (u, "", second or "", ""), 1)
    assert none is None and back.connections == usual.connections and not back.layout


def coupled(coupling: Element) -> Model:
    """Return two fields that a coupling without a name connects, with a stimulus."""
    model = Model("coupled")
    stimulus = model.add(dd.GaussianStimulus("s", [X], amplitude=12, sigma=4.0))
    u, v = (model.add(dd.Field(name, [X], resting_level=-5.0)) for name in "uv")
    stimulus >> u
    u >> coupling >> v
    return model


@pytest.mark.parametrize(
    "coupling",
    [
        dd.Convolve([dd.Gaussian(amplitude=6, sigma=4), dd.Gaussian(amplitude=-2, sigma=12)]),
        dd.Weights(3 * np.eye(101), [X]),
    ],
)
def test_several_kernels_and_weights_are_scaled_together_and_1_gives_the_same_bytes(
    coupling: Element,
) -> None:
    model = coupled(coupling)
    name = f"u>{type(coupling).__name__}"
    ends = (model[name].id, "", model["v"].id, "")
    doc, gain = set_strength(model.document, ends, 2)
    assert wires(doc)[2:] == [(name, f"{name}>Gain", ""), (f"{name}>Gain", "v", "")]
    doc, _ = set_strength(doc, (model[name].id, "", gain or "", ""), -0.5)
    weaker, unchanged = dd.Session(Model(document=doc)), dd.Session(model)
    for session in (weaker, unchanged):
        session.step(300)
    arriving = unchanged.read(f"{name}.output")
    assert np.abs(arriving).max() > 1
    assert np.allclose(weaker.read(f"{name}>Gain.output"), -0.5 * arriving, atol=1e-5)
    back, none = set_strength(doc, (model[name].id, "", gain or "", ""), 1)
    assert none is None and stored(back) == stored(model.document) and back == model.document


@pytest.mark.parametrize(
    ("element", "path"),
    [
        (dd.Gain(2), "factor"),
        (dd.Convolve([dd.Gaussian(amplitude=-3)]), "kernel.0.amplitude"),
        (dd.Convolve([dd.Gaussian(), dd.Gaussian(amplitude=-1)]), ""),
        (dd.Convolve([dd.MexicanHat()]), ""),
        (dd.Weights(np.eye(101), [X]), ""),
        (dd.GaussianStimulus("s", [X], amplitude=3), ""),
        (dd.Field("u", [X]), ""),
    ],
)
def test_the_number_that_is_the_strength_of_a_coupling(element: Element, path: str) -> None:
    assert strength_path(element) == path


def test_a_running_session_keeps_its_activation_and_follows_the_new_strength() -> None:
    model = Model("pair")
    u, v = model.add(dd.Field("u", [X], resting_level=2.0)), model.add(dd.Field("v", [X], resting_level=-5.0))
    u >> v
    session = dd.Session(model)
    session.step(200)
    before = session.read("v.activation")
    doc, gain = set_strength(model.document, (u.id, "", v.id, ""), -2.0)
    session.edit(doc)
    assert np.array_equal(session.read("v.activation"), before)
    session.step(400)
    inhibited = session.read("v.activation")
    assert inhibited.max() < before.min()
    assert gain is not None
    session.edit(set_strength(doc, (u.id, "", gain, ""), 1.0)[0])
    assert np.array_equal(session.read("v.activation"), inhibited) and session.document == model.document
