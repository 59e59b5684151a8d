"""The bounds that elements state for checks contain the values of runs."""

from __future__ import annotations

import math

import pytest

import deodar as dd
from deodar.element import Element
from deodar.model.document_graph import graph
from deodar.model.wiring import Wiring
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.separable import MexicanHat, TruncatedGaussian
from deodar.numerics.sigmoids import Absolute, Linear, SemiLinear, SigmoidFunction, Step
from tests.contracts.build import KINDS, around, example

X = dd.Axis("x", 0, 20, samples=21)
STATED = [kind for kind in KINDS if type(example(kind)).bounds is not Element.bounds]


def _inside(model: dd.Model, ports: list[str], duration: float = 60) -> float:
    """Require every value inside its interval; return the used share of the widest one."""
    wiring = Wiring(model.document, graph(model.document).nodes)
    record = dd.simulate(model, duration, dt=1, record=ports, every=1, precision="float64")
    used = 0.0
    for port in ports:
        path, _, name = port.rpartition(".")
        low, high = wiring.bounds[model[path].id].get(name, (-math.inf, math.inf))
        values = record[port].values
        assert low - 1e-9 <= values.min() and values.max() <= high + 1e-9, (
            port,
            low,
            values.min(),
            values.max(),
            high,
        )
        if math.isfinite(high - low) and high > low:
            used = max(used, float(values.max() - values.min()) / (high - low))
    return used


@pytest.mark.parametrize("kind", STATED)
def test_the_output_of_every_kind_lies_inside_its_bounds(kind: str) -> None:
    element: Element = example(kind)
    model = around(element)
    _inside(model, ["example.output"])


@pytest.mark.parametrize("kind", [dd.Pattern, dd.TimeSeries])
def test_without_an_array_the_output_of_a_stimulus_may_have_any_value(kind: type[Element]) -> None:
    element = kind("given later", [X], values=[], windows=[(0, 10)])  # type: ignore[call-arg]
    assert element.bounds({}, {}, {}) == {"output": (-math.inf, math.inf)}


def test_at_least_twenty_kinds_state_bounds() -> None:
    assert len(STATED) >= 20


@pytest.mark.parametrize(
    "sigmoid", [dd.Logistic(), Step(), Absolute(), SemiLinear(), Linear()], ids=lambda s: type(s).__name__
)
@pytest.mark.parametrize(
    "kernel",
    [dd.Gaussian(0.1, 2), MexicanHat(0.1, 2, 0.05, 4), TruncatedGaussian(0.1, 2)],
    ids=lambda k: type(k).__name__,
)
def test_a_field_stays_inside_its_bounds(sigmoid: SigmoidFunction, kernel: Kernel) -> None:
    model = dd.Model("m")
    up = model.add(dd.GaussianStimulus("up", [X], center=5, sigma=2, amplitude=7, windows=[(10, 40)]))
    down = model.add(dd.GaussianStimulus("down", [X], center=15, sigma=2, amplitude=-3))
    u = model.add(
        dd.Field("u", [X], tau=5, sigmoid=sigmoid, kernel=[kernel], global_inhibition=0.02, noise=0.2)
    )
    up >> u
    down >> u
    v = model.add(dd.Field("v", [X], tau=5))
    u >> dd.Gain(2.0, name="gain") >> v
    used = _inside(model, ["u.activation", "u.output", "u.interaction", "v.activation", "gain.output"], 80)
    assert used > 0.3 or isinstance(sigmoid, Linear), "bounds this wide say nothing"
