"""The document as sent to the page."""

from __future__ import annotations

import json
from typing import Any

import msgspec
import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.errors import Problem
from deodar.kinds.description import descriptions
from deodar.model import plain_values
from deodar.model.document import Document
from deodar.numerics.kernels.custom import Custom
from deodar_studio.messages.to_page import Kind
from deodar_studio.requests.run_requests import _blob
from deodar_studio.views import view
from tests.deodar_studio.page import applied

X = dd.Axis("x", 0, 100, samples=101, unit="deg")
Y = dd.Axis("y", 0, 1, samples=11)


def model() -> dd.Model:
    network = dd.Model("m")
    u = network.add(dd.Field("u", [X], kernel=[dd.Gaussian(1, 5), Custom(np.ones(3))]), group="g")
    network.add(dd.GaussianStimulus("s", [X], center=30)) >> dd.Gain(2.0) >> u
    network.add(dd.Field("v", [Y]), ticks=2)
    network.add(Boost("b", []))
    network.parameter("gain", 3.0)
    network.link("g.u.tau", "gain")
    return network


def shown(network: dd.Model) -> Any:
    return view.document(network.document, "m.json", False, 0, 0)


def test_the_view_contains_elements_with_values_ports_and_axes() -> None:
    seen = {e.path: e for e in shown(model()).elements}
    u, s = seen["g.u"], seen["s"]
    assert (u.name, u.group, u.kind, u.inputs, u.outputs) == (
        "u",
        ["g"],
        "Field",
        ["input"],
        ["output", "activation", "interaction", "bounded"],
    )
    assert u.axes == {port: ["x"] for port in (*u.inputs, *u.outputs)}
    assert u.values["tau"] == 3 and u.values["axes"] == ["x"] and u.values["kernel"][0]["sigma"] == 5
    assert u.values["kernel"][1]["weights"] == {"array": "array", "shape": [3], "min": 1, "max": 1}
    assert u.pushable and not s.pushable and not seen["v"].pushable and seen["v"].every == 2
    assert u.effect == "+"
    assert {a.key: a.unit for a in shown(model()).axes} == {"x": "deg", "y": ""}


def test_the_view_states_the_sign_that_an_element_gives_to_its_connections() -> None:
    network = dd.Model("signs")
    network.add(dd.GaussianStimulus("low", [X], center=3, sigma=1, amplitude=-2))
    network.add(dd.Gain(-1.0, name="minus"))
    network.add(dd.Gain(2.0, name="plus"))
    network.add(dd.TransientDetector("change", [X]))
    effects = {e.path: e.effect for e in shown(network).elements}
    assert effects == {"low": "-", "minus": "-", "plus": "+", "change": "+"}


def test_the_view_contains_document_parameters_and_connections_by_id() -> None:
    network = model()
    seen = shown(network)
    assert [(k.name, k.value, [(x.element, x.parameter) for x in k.links]) for k in seen.parameters] == [
        ("gain", 3, [(network["g.u"].id, "tau")])
    ]
    assert {(c.source, c.target) for c in seen.connections} == {
        (c.source, c.target) for c in network.document.connections
    }


def test_problems_are_listed_with_their_elements() -> None:
    doc = model().document
    by_path = {e.path: e.id for e in doc.entries}
    wrong = [Problem("g.u.tau", "one"), Problem("s (script.py:3)", "two"), Problem("nowhere", "three")]
    problems = view.problems(wrong, doc, paths=())
    assert [p.element for p in problems] == [by_path["g.u"], by_path["s"], ""]
    problems = view.problems([Problem("", "stopped")], doc, paths=("g.u.output", "v"))
    assert [p.element for p in problems] == [by_path["g.u"], by_path["v"]]


def test_the_view_of_a_document_with_problems_lists_them() -> None:
    network = model()
    network.connect("g.u", "v")
    seen = shown(network)
    assert seen.problems and len(seen.elements) == 5


def test_a_warning_has_the_severity_warning() -> None:
    network = dd.Model("m")
    network.add(dd.GaussianStimulus("s", [X], center=5, amplitude=6, windows=[(100, 100)])) >> network.add(
        dd.Field("u", [X])
    )
    (found,) = shown(network).problems
    assert found.severity == "warning" and found.element == network["s"].id


def value_in_page(doc: Document, element: str, parameter: str) -> Any:
    """Return a value as a page has it after the difference that sets it."""
    before = json.loads(msgspec.json.encode(view.document(doc, "", False, 0, 0)))
    difference = json.loads(msgspec.json.encode(view.one_parameter(doc, element, parameter)))
    (leaf,) = (e["values"] for e in applied(before, difference)["elements"] if e["id"] == element)
    for step in parameter.split("."):
        leaf = leaf[int(step)] if isinstance(leaf, list) else leaf[step]
    return leaf


@pytest.mark.parametrize(
    ("parameter", "value"),
    [
        ("tau", 12.5),
        ("kernel.0.sigma", 7),
        ("kernel.0.sigma", [7]),
        ("kernel", []),
        ("axes", ["y"]),
        ("axes", []),
        ("sigmoid", {"kind": "Step", "threshold": 1}),
        ("kernel.1", {"kind": "Gaussian", "amplitude": 2, "sigma": 3}),
    ],
)
def test_a_value_that_is_set_is_shown_unchanged(parameter: str, value: Any) -> None:
    network = model()
    network.unlink("g.u.tau")
    doc, entry = network.document, network.document.by_id()[network["g.u"].id]
    new = plain_values.put(doc, [entry.id], parameter, value)
    seen = value_in_page(new, entry.id, parameter)
    if isinstance(value, dict):
        assert {k: seen[k] for k in value} == value
    else:
        assert seen == value


def test_a_list_of_kernels_keeps_its_arrays() -> None:
    doc = model().document
    entry = doc.by_id()[model()["g.u"].id]
    kernels = value_in_page(doc, entry.id, "kernel")
    new = plain_values.put(doc, [entry.id], "kernel", [*reversed(kernels)])
    assert new.by_id()[entry.id].element.kernel[0].weights.data.tolist() == [1, 1, 1]


def test_every_description_of_a_kind_can_be_sent() -> None:
    kinds = view.kinds()
    assert [kind.name for kind in kinds] == [kind.name for kind in descriptions()]
    assert msgspec.json.decode(msgspec.json.encode(kinds), type=list[Kind]) == kinds
    field = next(kind for kind in kinds if kind.name == "Field")
    described = next(kind for kind in descriptions() if kind.name == "Field")
    assert field.equation == list(described.equation) and field.ports == described.ports
    assert [(p.name, p.symbol, p.default) for p in field.parameters] == [
        (p.name, p.symbol, p.default) for p in described.parameters
    ]


def test_a_pushed_input_is_a_gaussian_over_every_axis() -> None:
    ring = dd.Axis("ring", 0, 360, samples=36, periodic=True)

    def pushed(axes: Any, center: Any = None, sigma: Any = None) -> np.ndarray:
        return _blob(axes, 3.0, center, sigma)

    x, y, angle = X.points, Y.points, ring.points
    bell = 3 * np.exp(-0.5 * ((x - 40) / 5) ** 2)
    np.testing.assert_allclose(pushed((X,), center=[40.0], sigma=[5.0]), bell)
    np.testing.assert_allclose(pushed((X,), center=[40.0]), bell, err_msg="a twentieth of the axis")
    np.testing.assert_allclose(
        pushed((X, Y), center=[40.0, 0.5], sigma=[5.0, 0.2]),
        bell[:, None] * np.exp(-0.5 * ((y - 0.5) / 0.2) ** 2),
    )
    across = np.minimum(abs(angle - 350), 360 - abs(angle - 350))
    np.testing.assert_allclose(
        pushed((ring,), center=[350.0], sigma=[20.0]), 3 * np.exp(-0.5 * (across / 20) ** 2)
    )
    np.testing.assert_array_equal(pushed((X, Y)), np.full((101, 11), 3.0))
    assert pushed(()) == 3.0
