"""Every parameter that is a time declares what kind of time it is, and no Euler step is longer than a time constant."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import pytest

import deodar as dd
from deodar.elements.memory_trace import MemoryTrace
from deodar.errors import TimeError
from deodar.leaves import replace, time_constants
from deodar.parameters import TIME_ROLES, Live, Part, parameters
from tests.contracts.build import KINDS, PARTS, around, example

WITH_CONSTANTS = sorted(kind for kind in KINDS if any(True for _ in time_constants(example(kind))))


@pytest.mark.parametrize("kind", sorted({**KINDS, **PARTS}))
def test_a_parameter_in_units_of_time_declares_its_role(kind: str) -> None:
    for p in parameters({**KINDS, **PARTS}[kind]):
        if p.unit.startswith("time"):
            assert p.role in TIME_ROLES, p.name
        else:
            assert p.role == "", p.name
        if p.name.startswith("tau"):
            assert p.role in ("time constant", "time scale"), p.name


def test_a_declaration_in_units_of_time_without_a_role_is_refused() -> None:
    @dataclass(frozen=True)
    class Slow(Part):
        speed: Annotated[float, Live("time")] = 1.0

    with pytest.raises(TypeError, match=r"Slow\.speed.*role"):
        Slow()


def test_the_kinds_with_time_constants_are_these() -> None:
    assert WITH_CONSTANTS == ["Field", "MemoryTrace", "RateNode", "SoftWinnerTakeAll", "TransientDetector"]


@pytest.mark.parametrize("every", [1, 3])
@pytest.mark.parametrize("kind", WITH_CONSTANTS)
def test_a_step_longer_than_any_time_constant_is_refused(kind: str, every: int) -> None:
    for path, value in time_constants(example(kind)):
        element = replace(example(kind), path, value / 4)
        model = around(element, every=every)
        longest = min(tau for _, tau in time_constants(element)) / every
        dd.Session(model, dt=longest)
        short = replace(element, path, 0.99 * longest * every)
        with pytest.raises(TimeError, match=rf"example: .*longer than the time constant {path} = "):
            dd.simulate(around(short, every=every), 0, dt=longest)


def test_a_memory_trace_is_guarded_in_both_directions() -> None:
    for given in ({"tau_build": 0.4}, {"tau_decay": 0.4}):
        model = dd.Model("m")
        model.add(MemoryTrace("p", **given))
        with pytest.raises(TimeError, match=rf"p: the step of 1 ms is longer than the time constant {next(iter(given))} = 0\.4"):
            dd.simulate(model, 10, record="p.output")


def test_a_live_change_below_the_step_is_refused_for_every_time_constant() -> None:
    model = dd.Model("m")
    model.add(MemoryTrace("p", tau_build=100))
    session = dd.Session(model)
    with pytest.raises(TimeError, match=r"longer than the time constant tau_build = 0\.5"):
        session.set("p.tau_build", 0.5)
    assert session.get("p.tau_build") == 100


def test_a_sweep_below_the_step_is_refused_for_every_time_constant() -> None:
    model = dd.Model("m")
    model.add(MemoryTrace("p"))
    with pytest.raises(TimeError, match=r"longer than the time constant tau_decay = 0\.5"):
        dd.simulate(model, 10, record="p.output", sweep={"p.tau_decay": [100, 0.5]})


def test_roles_do_not_depend_on_the_name() -> None:
    declared = {p.name: p.role for kind in ("MemoryTrace", "DelayLine", "TimeSeries", "Attractor") for p in parameters(KINDS[kind])}
    wanted = {"tau_build": "time constant", "delay": "duration", "times": "moment", "period": "duration", "tau": "time scale"}
    assert {name: declared[name] for name in wanted} == wanted
