"""The first sliders of a model are chosen by what its parameters are for."""

from __future__ import annotations

from typing import cast

import pytest

import deodar as dd
from deodar.errors import ModelError
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.model.usual_pins import MOST, PINS, with_usual_pins

X = dd.Axis("x", 0, 100, samples=101)


def pinned(doc: Document) -> list[str]:
    """Return the paths of the pinned parameters."""
    pins = cast("list[dict[str, str]]", doc.layout[PINS])
    paths = {e.id: f"{e.path}." for e in doc.entries}
    return [paths.get(pin["element"], "") + pin["parameter"] for pin in pins]


def competing() -> Model:
    """Return two fields and two stimuli, whose fields a kernel couples."""
    model = Model("competing")
    kernel = dd.MexicanHat()
    left, right = (
        model.add(dd.Field(n, [X], kernel=[kernel], global_inhibition=1.0)) for n in ("left", "right")
    )
    for name in ("near", "far"):
        model.add(dd.GaussianStimulus(name, [X], amplitude=6.0)) >> left
    left >> dd.Convolve([dd.Gaussian(amplitude=2.0)]) >> right
    return model


def test_roles_take_turns_in_the_order_of_the_elements() -> None:
    doc = with_usual_pins(competing().document)
    assert pinned(doc) == [
        "left.resting_level",
        "left.kernel.0.excitation",
        "near.amplitude",
        "left.global_inhibition",
        "right.resting_level",
    ]


def test_what_is_pinned_stays_first_and_is_pinned_once() -> None:
    model = competing()
    first = [
        {"element": model["far"].id, "parameter": "amplitude"},
        {"element": model["near"].id, "parameter": "amplitude", "label": "distance"},
    ]
    doc = with_usual_pins(edit.arrange(model.document, {PINS: first, "folded": []}))
    assert pinned(doc)[:2] == ["far.amplitude", "near.amplitude"] and len(pinned(doc)) == MOST + 1
    assert doc.layout["folded"] == [] and pinned(with_usual_pins(doc)) == pinned(doc)


def test_a_document_parameter_is_pinned_in_the_place_of_what_it_drives() -> None:
    model = competing()
    doc = edit.document_parameter(model.document, "rest", -5.0)
    for name in ("left", "right"):
        doc = edit.link(doc, model[name].id, "resting_level", "rest")
    assert pinned(with_usual_pins(doc)).count("rest") == 1


def test_strengths_of_couplings_are_pinned_where_nothing_else_is() -> None:
    model = Model("nodes")
    a, b = (model.add(dd.RateNode(name)) for name in "ab")
    a >> dd.Gain(3.0) >> b
    assert "a>Gain.factor" in pinned(with_usual_pins(model.document))
    with pytest.raises(ModelError, match="no resting level, amplitude or inhibition"):
        with_usual_pins(Model("empty").document)
