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
from deodar.numerics.kernel_shape import kernel_shape
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
class Ring(dd.Kernel):
    """A kernel that `samples` alone defines: it depends on the distance, not on each axis by itself."""

    amplitude: Annotated[float, dd.Live("activation")] = 0.1
    radius: Annotated[float, dd.Rebuild("axis", lower=1e-6)] = 4.0

    def samples(self, axes: dd.Axes, dtype: Any) -> Any:
        lags = [a.step * jnp.arange(-9, 10, dtype=dtype) for a in axes]
        distance = jnp.sqrt(sum(lag**2 for lag in jnp.meshgrid(*lags, indexing="ij")))
        return jnp.exp(-((distance - self.radius) ** 2))


@dataclass(frozen=True)
class Disc(dd.Kernel):
    """A kernel of an array, without a parameter."""

    def samples(self, axes: dd.Axes, dtype: Any) -> Any:
        return jnp.full([3] * len(axes), 0.1, dtype)


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


@pytest.mark.parametrize(
    "kind", [Halving, Exponential, Ring, Disc, Softsign, Lamp], ids=lambda kind: kind.__name__
)
def test_a_kind_that_keeps_the_rules_has_no_problems(kind: Any) -> None:
    assert dd.check_kind(dd.register(kind)) == []


X = dd.Axis("x", 0, 20, samples=21)
Y = dd.Axis("y", 0, 8, samples=9)


@pytest.mark.parametrize("kind", [Ring, Disc])
@pytest.mark.parametrize("axes", [(X,), (X, Y)], ids=len)
def test_a_kernel_of_samples_acts_as_its_array_does(kind: Any, axes: dd.Axes) -> None:
    kernel = dd.register(kind)()
    array = np.asarray(kernel.samples(axes, np.float32))
    custom = dd.Custom(array, amplitude=getattr(kernel, "amplitude", 1.0))
    shapes, ends = list[np.ndarray](), list[np.ndarray]()
    for k in (kernel, custom):
        model = dd.Model("m")
        source = dd.GaussianStimulus("s", axes, center=4, sigma=2, amplitude=6)
        model.add(source) >> model.add(dd.Field("u", axes, kernel=[k]))
        ends.append(dd.simulate(model, 50, record="u.activation")["u.activation"].values[-1])
        shapes.append(kernel_shape([k], axes)[1])
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-5)
    np.testing.assert_array_equal(shapes[0], shapes[1])
    assert kernel.polarity() == "±"


def test_a_node_has_no_kernel_of_samples_and_none_is_shifted() -> None:
    model = dd.Model("m")
    model.add(dd.Field("n", kernel=[dd.register(Ring)()]))
    [problem] = model.check()
    assert problem.where.startswith("n (") and problem.severity == "problem"
    assert problem.what.startswith("kernel.0: is an array over the axes of a field, and a node has none")
    with pytest.raises(dd.errors.ParameterError, match="an array of weights cannot be shifted"):
        dd.Shifted(Ring())


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
