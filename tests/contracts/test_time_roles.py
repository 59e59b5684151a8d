"""Every parameter whose unit has time in it declares its role, and no Euler step exceeds the limit of a
role, at check and at run.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Annotated

import pytest

import deodar as dd
from deodar.couplings.hebbian import Hebbian
from deodar.couplings.learning import AdaptiveWeights
from deodar.declarations import LIMITING, TIME_ROLES
from deodar.elements.memories import MemoryTrace
from deodar.elements.variables import Attractor, Integrator
from deodar.errors import TimeError
from deodar.leaves import replace, step_limits
from deodar.model.check import check
from deodar.parameters import Live, Part, parameters
from deodar.session.run import require_step
from tests.contracts.build import KINDS, PARTS, around, example
from tests.house.test_docstrings import read

LIMITED = {
    kind: {p.name: p.role for p in parameters(cls) if p.role in LIMITING} for kind, cls in KINDS.items()
}
LIMITS = [(kind, name) for kind, found in LIMITED.items() for name in found]
SPEAKS_OF_TIME = re.compile(r"document's time|document time|\bspeed of\b|how fast")


def test_a_parameter_whose_unit_has_time_in_it_declares_its_role() -> None:
    by_name = {"rate": ("rate", "speed"), "decay": ("rate", "speed")}
    wrong: list[str] = []
    for kind, cls in {**KINDS, **PARTS}.items():
        for p in parameters(cls):
            timed = bool(re.search(r"\btime\b", p.unit))
            named = ("time constant", "time scale") if p.name.startswith("tau") else by_name.get(p.name)
            if (p.role in TIME_ROLES) != timed or (named and p.role not in named):
                wrong.append(f"{kind}.{p.name}: the role {p.role!r}, the unit {p.unit!r}")
    assert not wrong, wrong


def test_a_parameter_that_is_described_as_a_time_has_a_unit_of_time() -> None:
    """A docstring that mentions a time requires a unit with time in it, unless the numbers are times and
    others, which are exact, or speeds of a motor.
    """
    speaking = [
        (kind, p)
        for kind, cls in KINDS.items()
        for p in parameters(cls)
        if SPEAKS_OF_TIME.search(read(cls).entries("Parameters").get(p.name, ""))
        and p.form in ("number", "per_axis", "array")
    ]
    wrong = [f"{kind}.{p.name}" for kind, p in speaking if not (p.role or p.exact or p.unit == "motor")]
    assert len(speaking) > 20 and not wrong, wrong


def test_a_declaration_in_units_of_time_without_a_role_is_refused() -> None:
    @dataclass(frozen=True)
    class Slow(Part):
        speed: Annotated[float, Live("time")] = 1.0

    with pytest.raises(TypeError, match=r"Slow\.speed.*role"):
        Slow()


def test_limits_of_the_step_follow_from_the_roles() -> None:
    known = {
        "AdaptiveWeights": {"rate": "rate"},
        "Attractor": {"tau": "time scale"},
        "AttractorVelocity": {"tau": "time scale"},
        "Field": {"tau": "time constant"},
        "GainAdaptation": {"tau": "time scale"},
        "Hebbian": {"rate": "rate", "decay": "rate"},
        "MemoryTrace": {"tau_build": "time constant", "tau_decay": "time constant"},
        "RateNode": {"tau": "time constant"},
        "SoftWinnerTakeAll": {"tau": "time constant", "tau_inhibition": "time constant"},
        "TransientDetector": {"tau": "time constant"},
    }
    assert {kind: LIMITED[kind] for kind in known} == known
    assert not any(LIMITED[kind] for kind in ("Gain", "DelayLine", "Integrator", "TimeSeries"))


@pytest.mark.parametrize("every", [1, 3])
@pytest.mark.parametrize(("kind", "name"), LIMITS)
def test_a_longer_step_is_refused_at_check_and_at_run_with_one_sentence(
    kind: str, name: str, every: int
) -> None:
    rate, step = LIMITED[kind][name] == "rate", 0.001
    message = f"1/{name} = " if rate else f"the {LIMITED[kind][name]} {name} = "
    for factor, fits in ((1.0, True), (0.99, False)):
        longest = factor * step * every
        model = around(replace(example(kind), name, 1 / longest if rate else longest), every=every)
        model.describe(dt=step)
        found = [
            p for p in check(model.document) if p.where == "example" and p.what.startswith("the step of ")
        ]
        if fits:
            assert not found
            require_step(model.document, step)
            continue
        [problem] = found
        assert problem.severity == "problem" and message in problem.what and name in problem.fix
        with pytest.raises(TimeError) as caught:
            require_step(model.document, step)
        (refused,) = caught.value.problems
        assert (refused.where, refused.what) == (problem.where, problem.what)
        assert problem.fix.endswith(refused.fix)  # the check of a document proposes an edit of it, too


def test_a_run_and_a_session_refuse_every_role() -> None:
    x = dd.Axis("x", 0, 10, samples=11)
    for element, message in (
        (
            Attractor("e", x, tau=0.5),
            r"e: the step of 1 ms is longer than the time scale tau = 0\.5\. Use dt <= 0\.5",
        ),
        (
            Hebbian([x], rate=4.0, name="e"),
            r"e: the step of 1 ms is longer than 1/rate = 0\.25\. Use dt <= 0\.25, .* a smaller rate",
        ),
    ):
        model = dd.Model("m")
        u = model.add(dd.Field("u", [x]))
        handle = model.add(element)
        u >> handle
        if "post" in element.ports():
            model.connect(u, handle["post"])
        with pytest.raises(TimeError, match=message):
            dd.simulate(model, 10, record="e.output")
        with pytest.raises(TimeError, match=message):
            dd.Session(model)


def test_a_speed_and_a_rate_of_0_do_not_limit_the_step() -> None:
    x = dd.Axis("x", 0, 10, samples=11)
    assert list(step_limits(Integrator("i", [], rate=50.0))) == []
    assert [limit.longest for limit in step_limits(Hebbian([x], rate=0.0, decay=0.0))] == [math.inf, math.inf]


def test_the_step_is_limited_by_both_time_constants_of_a_memory_trace() -> None:
    for given in ({"tau_build": 0.4}, {"tau_decay": 0.4}):
        model = dd.Model("m")
        model.add(MemoryTrace("p", **given))
        with pytest.raises(
            TimeError,
            match=rf"p: the step of 1 ms is longer than the time constant {next(iter(given))} = 0\.4",
        ):
            dd.simulate(model, 10, record="p.output")


def test_a_live_rate_that_is_too_high_for_the_step_is_refused() -> None:
    x = dd.Axis("x", 0, 10, samples=11)
    model = dd.Model("m")
    u = model.add(dd.Field("u", [x]))
    w = model.add(AdaptiveWeights([x], name="w"))
    u >> w
    model.connect(u, w["post"])
    session = dd.Session(model)
    with pytest.raises(TimeError, match=r"longer than 1/rate = 0\.5"):
        session.set("w.rate", 2.0)
    assert session.get("w.rate") == 0.1


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
    declared = {
        p.name: p.role
        for kind in ("MemoryTrace", "DelayLine", "TimeSeries", "Attractor")
        for p in parameters(KINDS[kind])
    }
    expected = {
        "tau_build": "time constant",
        "delay": "duration",
        "times": "moment",
        "period": "duration",
        "tau": "time scale",
    }
    assert {name: declared[name] for name in expected} == expected
