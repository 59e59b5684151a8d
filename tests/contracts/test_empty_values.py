"""An empty list is not read as if nothing had been given: it is refused, or means what it says."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.errors import DeodarError
from deodar.parameters import parameters
from deodar.registry import kinds
from tests.contracts.build import KINDS, around, example, node

LISTS = ("texts", "parts", "array", "per_axis", "numbers", "pairs")
"""Forms of parameters that hold several values; an empty list of axes means one number."""

OPTIONAL = sorted(
    (kind, p.name)
    for kind, cls in KINDS.items()
    for p in parameters(cls)
    if p.optional and p.form in LISTS and not p.if_empty
)
"""Parameters of elements and couplings that may be None, without a word for an empty list."""

OF_KERNELS = sorted(
    (kind, p.name)
    for kind, cls in kinds("numerics.kernels").items()
    for p in parameters(cls)
    if p.optional and p.form in LISTS
)

X = dd.Axis("x", 0, 20, samples=21)


def model() -> dd.Model:
    """Return a field with a stimulus."""
    built = dd.Model("m")
    built.add(dd.GaussianStimulus("s", [X], center=5, amplitude=6, sigma=2)) >> built.add(dd.Field("u", [X]))
    return built


def accepts_empty(kind: str, name: str) -> bool:
    """Return whether an element over axes may have an empty list; without axes, an empty list has the one
    value for each of them.
    """
    try:
        built = around(dc.replace(example(kind), **{name: []}))  # type: ignore[arg-type]
    except (DeodarError, AssertionError):  # no source gives a model without problems
        return False
    resolved = node(built)
    return any([*resolved.ins.values(), *resolved.outs.values()])


@pytest.mark.parametrize(("kind", "name"), OPTIONAL)
def test_an_element_refuses_an_empty_list_that_it_has_no_word_for(kind: str, name: str) -> None:
    assert not accepts_empty(kind, name)


@pytest.mark.parametrize(("kind", "name"), OF_KERNELS)
def test_a_kernel_refuses_an_empty_list(kind: str, name: str) -> None:
    built = dd.Model("m")
    with pytest.raises(DeodarError, match=name):
        kernel = dc.replace(kinds("numerics.kernels")[kind].example(), **{name: []})
        built.add(dd.Field("u", [X], kernel=[kernel]))
        dd.simulate(built, 1)


CALLS: dict[str, Callable[[], Any]] = {
    "the record of simulate": lambda: dd.simulate(model(), 5, record=[]),
    "the trials of simulate": lambda: dd.simulate(model(), 5, trials=[]),
    "the points of a sweep": lambda: dd.simulate(model(), 5, sweep=[]),
    "the values of a sweep": lambda: dd.simulate(model(), 5, sweep={"u.tau": []}),
    "the record of a session": lambda: dd.Session(model()).record("never", []),
    "the trials of a plan": lambda: dd.Trials(model(), dd.TrialPlan(5)).run([]),
    "the values of trials": lambda: dd.Trials(model(), dd.TrialPlan(5)).run(
        [0, 1], values={"s.amplitude": []}
    ),
    "the events of an event": lambda: dd.All("a", []),
    "the ports of a snapshot": lambda: dd.Snapshot(10, "then", []),
    "the place of an event": lambda: dd.Appears("a", "u", near=[]),
    "the place of a measure": lambda: dd.Measure("a", "u", near=[]),
    "the levels of a factor": lambda: dd.Factor("f", [], "u.tau"),
    "the axes of peaks": lambda: dd.peaks(np.zeros(21), axes=[]),
    "the center of an isolated field": lambda: dd.isolate(model(), "u", center=[]),
    "the width of an isolated field": lambda: dd.isolate(model(), "u", sigma=[]),
    "the windows of an object": lambda: dd.Arena("blocks").place("p", (1, 1), (1, 1), windows=[]),
    "the height of an object": lambda: dd.Arena("blocks").place("p", (1, 1), (1, 1), height=[]),
    "the start of a vehicle": lambda: dd.Arena("blocks", start=[]),
    "the goal of a vehicle": lambda: dd.Arena("blocks", goal=[]),
}


@pytest.mark.parametrize("of", CALLS)
def test_a_call_refuses_an_empty_list(of: str) -> None:
    with pytest.raises(DeodarError):
        CALLS[of]()


def test_what_an_empty_list_means_is_kept() -> None:
    """No port is watched, and no trial."""
    plan = dd.TrialPlan(10, watch=["u"], every=5)
    (watched,) = dd.Trials(model(), plan).results([0], watched=None)
    (unwatched,) = dd.Trials(model(), plan).results([0], watched=[])
    assert watched.values and not unwatched.values
    (nothing,) = dd.Trials(model(), dc.replace(plan, watch=[])).run([0])
    assert not nothing.values


@pytest.mark.parametrize("tau", [None, -5.0, "fast"])
def test_an_action_with_a_value_that_the_parameter_cannot_have_is_a_problem(tau: object) -> None:
    plan = dd.TrialPlan(20, actions=[dd.Set(5, "u.tau", tau)])
    [problem] = dd.Experiment("e", model(), plan).check()
    assert problem.where.startswith("actions.0") and "tau" in str(problem)
