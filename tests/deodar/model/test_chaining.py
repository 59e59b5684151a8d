"""`a >> Gain(2) >> b`: couplings are named after the preceding element."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import deodar as dd
from deodar.couplings.arithmetic import Product
from deodar.errors import ModelError, UnknownName
from deodar.model.check import problems

X = dd.Axis("x", 0, 10, samples=11)


@pytest.fixture
def model() -> dd.Model:
    model = dd.Model("m")
    model.add(dd.Field("a", [X]))
    model.add(dd.Field("b", [X]))
    return model


def _paths(model: dd.Model) -> list[str]:
    return [h.path for h in model]


def _edges(model: dd.Model) -> list[tuple[str, str, str, str]]:
    by = model.document.by_id()
    return [
        (by[c.source].path, c.source_port, by[c.target].path, c.target_port)
        for c in model.document.connections
    ]


def test_couplings_are_named_after_their_source(model: dd.Model) -> None:
    a, b = model["a"], model["b"]
    a >> dd.Gain(2) >> b
    a >> dd.Gain(3) >> b
    a >> dd.Gain(4) >> b
    assert _paths(model) == ["a", "b", "a>Gain", "a>Gain2", "a>Gain3"]
    assert [model.get(f"a>Gain{n}.factor") for n in ("", "2", "3")] == [2, 3, 4]
    assert not problems(model.document)


def test_a_chain_of_couplings_is_connected_in_order(model: dd.Model) -> None:
    model["a"] >> dd.Gain(2) >> dd.Project([X]) >> model["b"]
    assert _paths(model)[2:] == ["a>Gain", "a>Gain>Project"]
    assert [(s, t) for s, _, t, _ in _edges(model)] == [
        ("a", "a>Gain"),
        ("a>Gain", "a>Gain>Project"),
        ("a>Gain>Project", "b"),
    ]


def test_a_coupling_keeps_the_name_that_is_given(model: dd.Model) -> None:
    model["a"] >> dd.Gain(2, name="push") >> model["b"]
    assert _paths(model)[2] == "push"


def test_couplings_are_in_the_group_of_their_source() -> None:
    model = dd.Model("m")
    a = model.add(dd.Field("a", [X]), group="g")
    b = model.add(dd.Field("b", [X]))
    a >> dd.Gain(2) >> b
    assert _paths(model) == ["g.a", "b", "g.a>Gain"]


def test_ports_are_connected_by_name(model: dd.Model) -> None:
    product = model.add(Product(name="p"))
    model["a"]["activation"] >> product["input"]
    model["b"] >> product["factor"]
    assert _edges(model) == [("a", "activation", "p", "input"), ("b", "output", "p", "factor")]
    assert not problems(model.document)


def test_connect_accepts_paths_and_handles(model: dd.Model) -> None:
    model.connect("a.activation", "b.input")
    assert _edges(model) == [("a", "activation", "b", "input")]


def test_the_arrow_returns_the_handle_on_its_right(model: dd.Model) -> None:
    gain = model["a"] >> dd.Gain(2)
    assert gain.path == "a>Gain"
    assert repr(gain) == "<Gain a>Gain: factor=2.0>"


@pytest.mark.parametrize("other", ["b", 2.0, None, dd.Gaussian(), dd.Gain])
def test_a_value_that_is_not_an_element_is_refused(model: dd.Model, other: object) -> None:
    before = model.document
    with pytest.raises(ModelError, match="is not an element"):
        model["a"] >> other  # type: ignore[operator]
    assert model.document is before


def test_an_unknown_port_suggests_the_nearest(model: dd.Model) -> None:
    with pytest.raises(UnknownName, match=r"a has no port 'activaton'.*Did you mean 'activation'"):
        model["a"]["activaton"]


def test_each_arrow_is_one_change_of_the_history() -> None:
    model = dd.Model("m")
    x = dd.Axis("x", 0, 10, samples=11)
    u, v = model.add(dd.Field("u", [x])), model.add(dd.Field("v", [x]))
    before = model.document
    u >> dd.Gain(2) >> v
    assert model.undo() and model.undo() and model.document is before


@pytest.mark.parametrize("chain", [lambda u: dd.Gain(2) >> u, lambda u: dd.GaussianStimulus("s", []) >> u])
def test_an_element_without_a_model_is_an_error(chain: Callable[[Any], Any]) -> None:
    model = dd.Model("m")
    with pytest.raises(ModelError, match="has not been added to a model"):
        chain(model.add(dd.Field("u", [])))


def test_a_document_parameter_and_a_parameter_never_share_a_path() -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", []))
    model.parameter("v.tau", 30)
    model.link("u.tau", "v.tau")
    for change in (lambda: model.add(dd.Field("v", [])), lambda: model.rename("u", "v")):
        with pytest.raises(ModelError, match=r"document parameter is called .v\.tau."):
            change()


def test_a_long_chain_in_any_order_of_its_elements_has_axes() -> None:
    model, count = dd.Model("chain"), 400
    for k in range(count):
        model.add(dd.Gain(1.0, name=f"g{k}"))
    model.add(dd.Field("u", [X]))
    for k in range(1, count):
        model.connect(f"g{k}", f"g{k - 1}")
    model.connect("u", f"g{count - 1}")
    assert not problems(model.document)
