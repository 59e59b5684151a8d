"""An exception of a world from outside deodar is an error that names the world, its method and the line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar.element import Arrays
from deodar.errors import WorldError
from deodar.numerics.axes import Axes
from deodar.numerics.pytree import PyTree
from deodar.worlds._base import Signal, World
from deodar.worlds._failure import errors_of
from deodar.worlds._pure import PureWorld


class Faulty(World):
    """A tank, one method of which raises an exception."""

    sensors: Mapping[str, Signal] = {"level": Signal("level", ())}
    motors: Mapping[str, Signal] = {"flow": Signal("flow", ())}
    period = 2.0

    def __init__(self, method: str, error: BaseException) -> None:
        self.method, self.error = method, error

    def _enter(self, method: str) -> None:
        if method == self.method:
            raise self.error

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        self._enter("reset")

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self._enter("sense")
        return np.asarray(0.0)

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        self._enter("act")

    def describe(self) -> dict[str, Any]:
        self._enter("describe")
        return super().describe()


class FaultyPure(PureWorld):
    """A world inside the step, whose functions raise exceptions while JAX traces them."""

    sensors: Mapping[str, Signal] = {"level": Signal("level", ())}
    motors: Mapping[str, Signal] = {"flow": Signal("flow", ())}
    period = 2.0
    noises = ("flow",)

    def __init__(self, method: str) -> None:
        self.method = method

    def shared(self) -> dict[str, np.ndarray]:
        return {"rate": np.asarray(0.1)}

    def start(self, shared: Arrays, own: PyTree) -> PyTree:
        return jnp.zeros(()) if self.method != "start" else {}["start"]

    def read(self, shared: Arrays, own: PyTree, state: PyTree, sensor: str, axes: Axes) -> Any:
        return state if self.method != "read" else {}["read"]

    def advance(self, shared: Arrays, own: PyTree, state: PyTree, motors: Arrays) -> PyTree:
        return state if self.method != "advance" else {}["advance"]


@pytest.fixture(scope="module")
def model() -> dd.Model:
    out = dd.Model("tank")
    out.add(dd.Sensor("eye", sensor="level")) >> out.add(dd.Motor("valve", motor="flow"))
    return out


@pytest.mark.parametrize("method", ["reset", "sense", "act", "describe"])
def test_an_exception_of_a_method_is_an_error_that_names_world_method_and_line(
    model: dd.Model, method: str
) -> None:
    error = KeyError("left")
    with pytest.raises(WorldError) as caught:
        dd.simulate(model, 4, record="eye.output", world=Faulty(method, error))
    line = next(
        k for k, text in enumerate(Path(__file__).read_text().splitlines(), 1) if "raise self" in text
    )
    assert str(caught.value) == (
        f"the world Faulty of the module {__name__} raised KeyError in {method} (test_failure.py, line"
        f" {line}): 'left'. Correct Faulty.{method}"
    )
    assert caught.value.__cause__ is error


@pytest.mark.parametrize("error", [KeyboardInterrupt(), SystemExit(3), WorldError("no tank"), MemoryError()])
def test_an_interrupt_an_exit_and_an_error_of_deodar_pass_unchanged(
    model: dd.Model, error: BaseException
) -> None:
    with pytest.raises(type(error)) as caught:
        dd.Session(model, world=Faulty("reset", error))
    assert caught.value is error


@pytest.mark.parametrize(("method", "trials"), [("start", None), ("read", None), ("advance", 2)])
def test_an_exception_of_a_world_inside_the_step_names_the_world(
    model: dd.Model, method: str, trials: int | None
) -> None:
    with pytest.raises(
        WorldError, match=rf"the world FaultyPure .* KeyError in {method} \(.*: '{method}'"
    ) as caught:
        dd.simulate(model, 4, record="eye.output", trials=trials, world=FaultyPure(method))
    assert isinstance(caught.value.__cause__, KeyError)


def test_an_exception_of_a_world_of_deodar_keeps_its_type() -> None:
    with pytest.raises(KeyError, match="here"), errors_of(dd.Picture, "sense"):
        raise KeyError("here")
