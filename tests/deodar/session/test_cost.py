"""The cost of each element: all are listed, the expensive ones first; the parts add up to the whole, and
the run is unchanged.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import jax
import numpy as np
import pytest
from jax.stages import Compiled

import deodar as dd
from deodar.compiler.arguments import WHOLE
from deodar.compiler.executable import Executable
from deodar.couplings.convolutions import Convolve
from deodar.elements.function import Function
from deodar.errors import TimeError
from deodar.session import cost
from deodar.session.cost import ElementCost, StepCost
from tests.deodar.session.models import mixed

X = dd.Axis("x", 0, 100, samples=100, periodic=True)
Y = dd.Axis("y", 0, 100, samples=80, periodic=True)
QUICK = 0.05
COUNTED: list[int] = []


def counted(state: Any, inputs: Any, time: Any) -> Any:
    """Return the state unchanged, and count each computation."""
    jax.debug.callback(lambda: COUNTED.append(1))
    return state + 0.0 * time.dt


def test_every_element_is_listed_once_with_its_group() -> None:
    session = dd.Session(mixed(extra=2))
    session.step(3)
    costs = session.costs(QUICK)
    by = {c.path: c for c in costs.elements}
    assert len(by) == len(costs.elements)
    assert {e.path for e in session.document.entries} <= set(by)
    assert {c.path: c.kind for c in costs.elements}["v>u"] == "Convolve"
    alike = [by[name] for name in ("u", "neighbour0", "neighbour1")]
    assert {c.alike for c in alike} == {3} and len({c.us for c in alike}) == 1, (
        "equal structure: they share the time"
    )
    assert [c.us for c in costs.elements] == sorted((c.us for c in costs.elements), reverse=True)
    assert all(c.us >= 0 for c in costs.elements) and sum(
        costs.share(c) for c in costs.elements
    ) == pytest.approx(1)


class Work:
    """A replacement of the clock: the operations of all called programs, as the compiler counts them,
    which do not depend on the load of the machine.
    """

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.done, self.known = 0.0, dict[int, float]()
        call = Executable.call

        def counted(program: Executable, executable: Any, *args: Any) -> Any:
            whole = len(args) == 7  # the step of the whole model, not of a part
            steps = (
                args[-2][WHOLE.index("head")] if whole else args[-1] if isinstance(args[-1], np.int32) else 0
            )
            compiled = isinstance(executable, Compiled)  # others run once, with NumPy
            analysis = (executable.cost_analysis() if compiled else None) or {}
            self.done += (
                1e-9 * (analysis.get("flops", 0.0) + analysis.get("transcendentals", 0.0)) * int(steps)
            )
            return call(program, executable, *args)

        monkeypatch.setattr(Executable, "call", counted)
        monkeypatch.setattr(cost, "time", SimpleNamespace(perf_counter=lambda: self.done))


@pytest.fixture
def work(monkeypatch: pytest.MonkeyPatch) -> Work:
    return Work(monkeypatch)


def test_a_plane_costs_more_than_a_node_and_constant_parts_cost_nothing(work: Work) -> None:
    model = dd.Model("m")
    plane = model.add(dd.Field("plane", [X, Y], kernel=[dd.Gaussian(1, 5), dd.Gaussian(-0.5, 9)]))
    model.add(dd.Field("node", [], kernel=[dd.Gaussian(2)]))
    model.add(dd.GaussianStimulus("still", [X], center=50, amplitude=3)) >> plane
    session = dd.Session(model)
    by = {c.path: c for c in session.costs(QUICK).elements}
    assert by["plane"].us > 10 * by["node"].us > 0
    assert by["still"].once and by["still"].us == 0 and not by["plane"].once


def test_a_part_with_a_longer_step_costs_less_per_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """The clock counts how often an element is computed."""
    model = dd.Model("m")
    for name, every in (("often", 1), ("rarely", 10)):
        model.add(Function(name, function=f"{__name__}:counted"), ticks=every)
    session = dd.Session(model)
    COUNTED.clear()
    monkeypatch.setattr(cost, "time", SimpleNamespace(perf_counter=lambda: 1e-4 * len(COUNTED)))
    by = {c.path: c.us for c in session.costs(1e-3).elements}
    assert by["often"] == pytest.approx(100) and by["rarely"] == pytest.approx(10)


def test_the_sum_of_the_parts_is_near_the_time_of_the_step(work: Work) -> None:
    """Only operations count here; `deodar run FILE --cost` shows times."""
    model = dd.Model("m")
    fields = [
        model.add(dd.Field(f"u{k}", [X, Y], kernel=[dd.Gaussian(1, 5), dd.Gaussian(-0.5, 9)]))
        for k in range(3)
    ]
    for k in range(3):
        fields[k] >> Convolve([dd.Gaussian(0.2, 3)]) >> fields[k - 1]
    costs = dd.Session(model).costs(QUICK)
    assert 0.7 < costs.sum / costs.step < 1.5


def test_a_coupling_without_readers_is_not_computed_and_costs_nothing(work: Work) -> None:
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X]))
    u >> model.add(dd.Gain(2, name="loose"))
    by = {c.path: c.us for c in dd.Session(model).costs(QUICK).elements}
    assert by["loose"] == 0 < by["u"]


def test_measuring_costs_does_not_change_the_run() -> None:
    one, other = (dd.Session(mixed(), seed=5, precision="float64") for _ in range(2))
    one.step(20)
    other.step(20)
    one.costs(QUICK)
    assert one.tick == 20 and not one.journal
    one.step(20)
    other.step(20)
    for path in ("u.activation", "v.activation", "slow.activation"):
        np.testing.assert_array_equal(one.read(path), other.read(path))


def test_costs_have_the_present_names_of_elements() -> None:
    model = dd.Model("m")
    model.add(dd.Field("before", [X]))
    session = dd.Session(model)
    model.rename("before", "after")
    session.edit(model.document)
    assert [c.path for c in session.costs(QUICK).elements] == ["after"]


def test_the_table_of_costs_prints_its_numbers() -> None:
    costs = StepCost(
        (
            ElementCost("1", "u", "Field", 3.0, 1, False),
            ElementCost("2", "v", "Field", 1.0, 2, False),
            ElementCost("3", "s", "BoxStimulus", 0.0, 1, True),
        ),
        4.5,
    )
    assert costs.sum == 4 and [costs.share(c) for c in costs.elements] == [0.75, 0.25, 0]
    text = str(costs).splitlines()
    assert (
        text[1].split() == ["u", "Field", "3.000", "75.0", "%"]
        and text[3].endswith("once a chunk")
        and "4.500 us" in text[-1]
    )
    summary = costs.data()
    assert summary["sum_us"] == 4 and summary["step_us"] == 4.5 and summary["elements"][1]["share"] == 0.25
    assert StepCost((), 0.0).sum == 0


@pytest.mark.parametrize("seconds", [0, -1, "long", float("inf")])
def test_an_invalid_measuring_time_is_refused(seconds: float) -> None:
    model = dd.Model("m")
    model.add(dd.Field("u", []))
    with pytest.raises(TimeError, match="seconds above 0"):
        dd.Session(model).costs(seconds)


def test_a_call_that_is_interrupted_does_not_end_the_search_for_a_long_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first calls take 2 ms longer than their steps; 1000 steps take 1 ms, on a clock of the test."""
    calls: list[int] = []
    clock = 0.0

    def call(n: int) -> tuple[int]:
        nonlocal clock
        calls.append(n)
        clock += 1e-6 + 1e-6 * n + (2e-3 if 0 < n <= 4 and calls.count(n) == 1 else 0.0)
        return (n,)

    monkeypatch.setattr(cost, "time", SimpleNamespace(perf_counter=lambda: clock))
    measured = cost._timed(call, 1, 0.01)
    assert max(calls) >= 1000 and measured == pytest.approx(1.0)
