"""Sums in Fourier space follow from the declarations of elements alone."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from typing import ClassVar

import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar.compiler.build import Build
from deodar.compiler.plan import plan
from deodar.compiler.strategies import role
from deodar.errors import ModelError
from deodar.model.document_graph import graph
from tests.deodar.compiler.programs import executable

SQUARE = [dd.Axis(name, 0, 40, samples=40, periodic=True) for name in "xy"]


@dc.dataclass(frozen=True)
class LinearField(dd.Field):
    """A field without lateral interaction: it approaches its input plus the resting level."""

    def advance(self, at: dd.Setting) -> dd.Arrays:
        u = at.state["activation"]
        return {"activation": dd.euler(u, -u + self.resting_level + at.inputs["input"], self.tau, at.time.dt)}


@dc.dataclass(frozen=True)
class Halved(dd.Field):
    """A field that acts on others by half of its output, and not on itself."""

    def output(self, at: dd.Setting) -> dd.Arrays:
        activation = super().output(at)
        return activation | {"output": 0.5 * activation["output"]}


@dc.dataclass(frozen=True)
class Doubled(dd.Field):
    """A field whose time course is twice as fast, with the interaction of any field."""

    convolution: ClassVar[dd.Convolution | None] = dd.Convolution("output", into="input")

    def advance(self, at: dd.Setting) -> dd.Arrays:
        u = at.state["activation"]
        rate = -u + self.resting_level + at.inputs["input"] + at.convolve(self.sigmoid(u))
        return {"activation": dd.euler(u, 2 * rate, self.tau, at.time.dt)}


@dc.dataclass(frozen=True)
class Twice(Doubled):
    """A field that breaks its declaration: it calls `convolve` twice."""

    convolution: ClassVar[dd.Convolution | None] = dd.Convolution("output", into="input")

    def advance(self, at: dd.Setting) -> dd.Arrays:
        u = at.state["activation"]
        rate = at.convolve(self.sigmoid(u)) + at.convolve(jnp.tanh(u)) + at.inputs["input"]
        return {"activation": dd.euler(u, rate, self.tau, at.time.dt)}


@dc.dataclass(frozen=True)
class Undeclared(Doubled):
    """A field that convolves without a declaration."""

    convolution: ClassVar[dd.Convolution | None] = None


def coupled(kind: type[dd.Field], axes: Sequence[dd.Axis] = SQUARE) -> dd.Model:
    """Return two fields that are coupled by Gaussians, the second one of a kind and with a stimulus."""
    model = dd.Model("two fields")
    kernel = [dd.Gaussian(15, 3, normalized=True)]
    u = model.add(dd.Field("u", axes, resting_level=-1, kernel=kernel))
    w = model.add(kind("w", axes, resting_level=-1, kernel=kernel))
    model.add(dd.GaussianStimulus("s", axes, center=[20, 20], sigma=3, amplitude=9)) >> w
    u >> dd.Convolve([dd.Gaussian(6, 3, normalized=True)]) >> dd.Gain(0.9) >> w
    w >> dd.Convolve([dd.Gaussian(6, 4, normalized=True)]) >> u
    return model


def roles(model: dd.Model) -> dict[str, str]:
    return {n.path: role(n) for n in graph(model.document).nodes}


def shares(model: dd.Model, path: str) -> bool:
    groups = plan(Build(model.document)).groups
    return next(bool(g.strategy.shared) for g in groups for n in g.nodes if n.path == path)


def test_roles_follow_from_declarations() -> None:
    roles_of_fields = roles(coupled(dd.Field))
    assert roles_of_fields["u"] == "source" and roles_of_fields["s"] == ""
    assert sorted(roles_of_fields.values()) == ["", "filter", "filter", "gain", "source", "source"]
    assert role(graph(_with(dd.Logarithm()).document).nodes[1]) == ""


def _with(coupling: dd.Coupling) -> dd.Model:
    model = dd.Model("one")
    model.add(dd.Field("u", SQUARE)) >> model.add(coupling)
    return model


@pytest.mark.parametrize("kind", [dd.Field, Doubled])
def test_elements_that_declare_a_convolution_share_transforms(kind: type[dd.Field]) -> None:
    assert shares(coupled(kind), "w")


@pytest.mark.parametrize("kind", [LinearField, Halved])
def test_a_subclass_with_other_functions_does_not_inherit_the_declaration(kind: type[dd.Field]) -> None:
    model = coupled(kind)
    assert roles(model)["w"] == "" and not shares(model, "w")


@pytest.mark.parametrize("kind", [Doubled, LinearField])
def test_custom_classes_compute_their_equations(kind: type[dd.Field]) -> None:
    model = coupled(kind)
    default, exact = (
        dd.simulate(model, 20, record=["w.activation"], precision=precision)["w.activation"].values[-1]
        for precision in ("float32", "float64")
    )
    assert exact.max() > 2 and np.abs(default - exact).max() < 1e-4


def test_fields_share_folded_transforms() -> None:
    axes = [dd.Axis(name, 0, 100, samples=100, periodic=True) for name in "xy"]
    model = coupled(dd.Field, axes)
    strategies = {g.strategy for g in plan(Build(model.document)).groups if g.strategy.shared}
    assert {tuple(w.classes for w in dict(s.choices)[s.shared].waves) for s in strategies} == {(4, 2)}
    default, exact = (
        dd.simulate(model, 50, record=["u.activation"], precision=precision)["u.activation"].values[-1]
        for precision in ("float32", "float64")
    )
    assert exact.max() > 2 and np.abs(default - exact).max() < 1e-4


def test_a_second_call_of_convolve_is_an_error() -> None:
    with pytest.raises(ModelError, match=r"Twice declares a convolution .* calls `at.convolve` 2 times"):
        executable(coupled(Twice)).chunk(())


def test_convolving_without_a_declaration_is_an_error() -> None:
    with pytest.raises(ModelError, match=r"declares no convolution.*dd.Convolution"):
        executable(coupled(Undeclared)).chunk(())
