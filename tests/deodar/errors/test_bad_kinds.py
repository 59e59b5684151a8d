"""A wrong kind of a user is an error, and a problem of `check`, in the words of the rule that it breaks."""

from __future__ import annotations

import dataclasses as dc
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import jax
import jax.numpy as jnp
import pytest

import deodar as dd
from deodar.errors import KindError
from deodar.kind_errors import errors_of_kind
from tests.deodar.errors import wrong_kinds
from tests.deodar.errors.refused import paragraph, refused
from tests.deodar.errors.wrong_kinds import WRONG, Asking, Leaking, Raising, Throwing, Undeclared, X, model_of

RUNS: Mapping[str, Callable[[dd.Model], object]] = {
    "simulate": lambda model: dd.simulate(model, 3, record="wrong.output"),
    "trials": lambda model: dd.simulate(model, 3, record="wrong.output", trials=3),
    "sweep": lambda model: dd.simulate(model, 3, record="wrong.output", sweep={"s.amplitude": [1.0, 2.0]}),
    "Session": lambda model: dd.Session(model).step(2),
    "float64": lambda model: dd.simulate(model, 3, record="wrong.output", precision="float64"),
    "trials of an experiment": lambda model: dd.Trials(model, dd.TrialPlan(3, ["wrong.output"])).run([0, 1]),
}


@pytest.mark.parametrize("kind", WRONG, ids=lambda kind: kind.__name__)
def test_a_run_of_a_wrong_kind_names_its_class_its_line_and_the_rule(kind: type[Any]) -> None:
    text = refused(lambda: RUNS["simulate"](model_of(kind)), KindError, *WRONG[kind])
    assert text.startswith("wrong: ") and "Tracer" not in text


@pytest.mark.parametrize("kind", WRONG, ids=lambda kind: kind.__name__)
def test_check_names_it_without_a_run(kind: type[Any]) -> None:
    model = model_of(kind)
    [problem] = [p for p in model.check() if p.severity == "problem"]
    paragraph(str(problem))
    for piece in WRONG[kind]:
        assert piece in str(problem)
    assert problem.where.startswith("wrong") and not model.programs


@pytest.mark.parametrize("run", RUNS)
@pytest.mark.parametrize("kind", [Asking, Leaking, Raising, Undeclared], ids=lambda kind: kind.__name__)
def test_every_way_to_run_it_names_the_rule(kind: type[Any], run: str) -> None:
    refused(lambda: RUNS[run](model_of(kind)), KindError, *WRONG[kind])


def test_the_exception_of_the_user_is_the_cause() -> None:
    with pytest.raises(KindError) as caught:
        RUNS["simulate"](model_of(Raising))
    assert isinstance(caught.value.__cause__, RuntimeError) and caught.value.kind == "Raising"


def test_a_kind_that_computes_another_function_in_each_call_is_a_problem() -> None:
    [problem] = model_of(Throwing).check()
    assert "Throwing in wrong_kinds.py" in str(problem) and "random numbers, a clock or a counter" in str(
        problem
    )
    assert "`at.noise`" in problem.fix


@dataclass(frozen=True)
class LiveGain(dd.Coupling):
    gain: Annotated[float, dd.Live()] = 2.0

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": self.gain * at.inputs["input"]}


def test_other_numbers_are_not_traced_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of elements whose numbers alone differ, one is traced."""
    model = model_of(LiveGain)
    model.check()
    monkeypatch.setattr(jax, "make_jaxpr", None)
    model.set("wrong.gain", 3.5)
    model.connect(model["s"], model.add(LiveGain(name="other", gain=4.5)))
    assert not [p for p in model.check() if p.severity == "problem"]


def test_two_wrong_kinds_are_two_problems() -> None:
    model = model_of(Asking)
    model.connect(model["s"], model.add(dc.replace(wrong_kinds.Narrow(), name="other")))
    assert [p.where.split()[0] for p in model.check()] == ["wrong", "other"]


@pytest.mark.parametrize("kind", [dd.Gain(), None])
def test_an_exception_without_a_kind_of_a_user_keeps_its_type(kind: object) -> None:
    with pytest.raises(RuntimeError, match="here"), errors_of_kind(kind):
        raise RuntimeError("here")


# ------------------------------------------------------------------------------- what is asked before a run


@dataclass(frozen=True)
class Portless(dd.Coupling):
    def outputs(self, ins: Mapping[str, dd.Axes]) -> Mapping[str, dd.Axes]:
        return {"output": ins["drive"]}


@dataclass(frozen=True)
class Misjudging(dd.Coupling):
    def validate_axes(self, ins: Mapping[str, dd.Axes]) -> Any:
        raise ZeroDivisionError("no axes")

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"]}


@dataclass(frozen=True)
class Warning_(dd.Coupling):
    def warnings(self, ins: Mapping[str, dd.Axes]) -> Any:
        raise ZeroDivisionError("no warning")

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"]}


@dataclass(frozen=True)
class Wide(dd.Kernel):
    def widths(self) -> Any:
        raise ZeroDivisionError("no width")

    def terms(self) -> Any:
        return ()


@pytest.mark.parametrize(
    ("kind", "says"),
    [
        (Portless, "Portless.outputs in test_bad_kinds.py"),
        (Misjudging, "Misjudging.validate_axes in test_bad_kinds.py"),
        (Warning_, "Warning_.warnings in test_bad_kinds.py"),
    ],
)
def test_check_reports_an_exception_of_what_it_asks(kind: type[Any], says: str) -> None:
    [problem] = model_of(kind).check()
    assert says in str(problem) and problem.where.startswith("wrong")


@pytest.mark.parametrize(
    ("kind", "says"), [(Portless, ".outputs"), (Misjudging, ".validate_axes"), (Wide, ".widths")]
)
def test_a_run_reports_it_too(kind: type[Any], says: str) -> None:
    refused(lambda: RUNS["simulate"](model_of(kind)), dd.errors.ModelError, "wrong", f"{kind.__name__}{says}")


# --------------------------------------------------------------------------------------- what is no mistake


KEY = jax.random.key(0)


@dataclass(frozen=True)
class Spread(dd.Boost):
    amplitude: Annotated[float, dd.Live("activation")] = 1.0

    def pattern(self, at: dd.Setting) -> Any:
        return self.amplitude


@dataclass(frozen=True)
class One(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": 1.0}  # type: ignore[dict-item]


@dataclass(frozen=True)
class Half(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"].astype(jnp.float16)}


@dataclass(frozen=True)
class Stateful(dd.Element):
    """A state of complex numbers, keys of random numbers, and arrays in an inner dict and a list."""

    axes: Sequence[dd.Axis] = (X,)

    def init(self, at: dd.Setting) -> Any:
        start = jax.random.normal(KEY, (X.samples,))
        return {"turning": jnp.ones(3, complex), "key": KEY, "inner": {"a": start, "b": [start]}}

    def output(self, at: dd.Setting) -> dd.Arrays:
        inner: Any = at.state["inner"]
        return {"output": inner["b"][0] + at.state["turning"].real.sum()}

    def advance(self, at: dd.Setting) -> Any:
        key, drawn = jax.random.split(at.state["key"])
        a = jax.random.normal(drawn, (X.samples,))
        return {"turning": 1j * at.state["turning"], "key": key, "inner": {"a": a, "b": [a]}}


@pytest.mark.parametrize("run", RUNS)
@pytest.mark.parametrize("kind", [Spread, One, Half, Stateful])
def test_what_a_program_can_use_is_no_mistake(kind: type[Any], run: str) -> None:
    model = dd.Model("right")
    stimulus = model.add(dd.GaussianStimulus("s", [X], center=10, amplitude=2))
    wrong = model.add(kind(name="wrong", axes=[X]) if hasattr(kind, "axes") else kind(name="wrong"))
    if issubclass(kind, dd.Coupling):
        model.connect(stimulus, wrong)
    assert not [p for p in model.check() if p.severity == "problem"]
    RUNS[run](model)


# ------------------------------------------------------------------------------------------------- start-up


def test_check_of_kinds_of_deodar_traces_nothing(tmp_path: Path) -> None:
    """In a new process, so that nothing has been traced before."""
    script = tmp_path / "checks.py"
    script.write_text(
        "import deodar as dd, jax\n"
        "jax.make_jaxpr = jax.eval_shape = None\n"
        "m = dd.Model('m'); m.add(dd.Field('u', [dd.Axis('x', 0, 1, samples=3)])); assert not m.check()\n"
    )
    ended = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
