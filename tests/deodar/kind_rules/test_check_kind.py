"""`dd.check_kind` judges one class of any family, and raises nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar import registry
from tests.deodar.errors.refused import paragraph
from tests.deodar.errors.wrong_kinds import Asking, Cutting, LiveWidth, Narrow, Throwing
from tests.deodar.experiments.test_wrong_measures import Ragged, Wordy


@pytest.fixture(autouse=True)
def register(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a test register kinds that no other test finds."""
    monkeypatch.setattr(registry, "_kinds", dict(registry.kinds()))


@dataclass(frozen=True)
class Halving(dd.Coupling):
    share: Annotated[float, dd.Live()] = 0.5

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": self.share * at.inputs["input"]}


@dataclass(frozen=True)
class Exponential(dd.Kernel):
    amplitude: Annotated[float, dd.Live("activation")] = 0.1
    width: Annotated[dd.PerAxis, dd.Rebuild("axis", lower=1e-6)] = 5.0

    def terms(self) -> Sequence[dd.Term]:
        def along(d: int, lag: Any, period: float | None, step: float) -> Any:
            return jnp.exp(-jnp.abs(lag) / dd.on_axis(self.width, d))

        return [dd.Term(self.amplitude, along)]


@dataclass(frozen=True)
class Softsign(dd.SigmoidFunction):
    beta: Annotated[float, dd.Live("1/activation")] = 1.0

    def __call__(self, u: Any) -> Any:
        return self.beta * u / (1 + jnp.abs(self.beta * u))


class Lamp(dd.World):
    """A lamp whose light is even."""

    sensors = {"light": dd.Signal("brightness", ())}
    period = 10.0

    def sense(self, sensor: str, axes: dd.Axes, time: float) -> np.ndarray:
        return np.asarray(1.0)

    @classmethod
    def example(cls) -> Lamp:
        return cls()

    @staticmethod
    def example_axes(sensor: str) -> dd.Axes:
        return ()


@pytest.mark.parametrize("kind", [Halving, Exponential, Softsign, Lamp], ids=lambda kind: kind.__name__)
def test_a_kind_that_keeps_the_rules_has_no_problems(kind: Any) -> None:
    assert dd.check_kind(dd.register(kind)) == []


@dataclass(frozen=True)
class Exploding(dd.Element):
    axes: Sequence[dd.Axis] = ()

    def init(self, at: dd.Setting) -> dd.Arrays:
        return {"z": at.full(tuple(self.axes), 1.0)}

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.state["z"]}

    def advance(self, at: dd.Setting) -> dd.Arrays:
        return {"z": 2 * at.state["z"]}


@dataclass(frozen=True)
class Idle(dd.Coupling):
    gain: Annotated[float, dd.Live()] = 2.0

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"]}


@dataclass(frozen=True)
class Rough(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"].astype("float32")}


@dataclass(frozen=True)
class Stateless(dd.Coupling):
    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"]}

    def advance(self, at: dd.Setting) -> dd.Arrays:
        return {}


@dataclass(frozen=True)
class Needy(dd.Coupling):
    strength: Annotated[float, dd.Live()] = dd.needed("1.0")

    def output(self, at: dd.Setting) -> dd.Arrays:
        return {"output": at.inputs["input"]}


class Flickering(Lamp):
    """A lamp whose light is another one each time."""

    def sense(self, sensor: str, axes: dd.Axes, time: float) -> np.ndarray:
        return np.random.default_rng().random()  # type: ignore[return-value]


class Dark(Lamp):
    """A lamp whose light is undefined."""

    def sense(self, sensor: str, axes: dd.Axes, time: float) -> np.ndarray:
        return np.asarray(np.nan)


class Exampleless(dd.World):
    """A world without `example`."""


class Together(dd.PureWorld):
    """A world inside the step that declares one reading for all copies."""

    sensors = {"level": dd.Signal("level", ())}

    @classmethod
    def example(cls) -> Together:
        return cls()


BROKEN: list[tuple[Any, str]] = [
    (Asking, "Asking.output in wrong_kinds.py, line"),
    (Narrow, "[3] in place of [21]"),
    (LiveWidth, "uses the live parameter kernel.0.width"),
    (Cutting, "one output for each activation"),
    (Throwing, "computes another function in each call"),
    (Exploding, "became infinite or undefined"),
    (Idle, "no output changes with its parameters (gain)"),
    (Rough, "returns float32 numbers for 'output' in a program of float64"),
    (Stateless, "Stateless in test_check_kind.py, line"),
    (Needy, "needs strength"),
    (Flickering, "reads other values for the sensor 'light' after a reset"),
    (Dark, "reads values that are not finite for the sensor 'light'"),
    (Together, "declare it with each=True"),
    (Exampleless, "has no class method example"),
    (Wordy, "Wordy.value in test_wrong_measures.py"),
    (Ragged, "Ragged.value in test_wrong_measures.py"),
    (int, "expected a class derived from dd.Element"),
    (5, "got 5"),
]


@pytest.mark.parametrize(("kind", "says"), BROKEN, ids=[str(getattr(k, "__name__", k)) for k, _ in BROKEN])
def test_a_kind_that_breaks_a_rule_has_a_problem_that_names_it(kind: Any, says: str) -> None:
    if getattr(kind, "__module__", "builtins") != "builtins":
        dd.register(kind)
    problems = dd.check_kind(kind)
    assert any(says in str(problem) for problem in problems), problems
    for problem in problems:
        paragraph(str(problem))
        assert problem.where.startswith(getattr(kind, "__name__", "check_kind"))


def test_a_kind_that_is_not_registered_has_a_problem() -> None:
    [problem] = dd.check_kind(Halving)
    assert "is not registered" in problem.what and "@dd.register" in problem.fix


def test_problems_of_a_class_show_themselves_in_a_notebook() -> None:
    [problem] = dd.check_kind(dd.register(Asking))
    assert "Asking.output" in repr(problem) and "Asking.output" in problem._repr_html_()  # pyright: ignore[reportPrivateUsage]


@pytest.mark.parametrize("name", ["Gain", "Gaussian", "Logistic", "Picture", "Measure"])
def test_kinds_of_deodar_keep_the_rules(name: str) -> None:
    assert dd.check_kind(getattr(dd, name)) == []
