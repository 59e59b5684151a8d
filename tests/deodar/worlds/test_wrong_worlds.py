"""A wrong world of a user is an error that names its class, its line, and the rule that it breaks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError
from tests.deodar.errors.refused import refused


class Host(dd.World):
    """A world on the host whose reading is wrong in one way."""

    sensors = {"light": dd.Signal("brightness", (3,))}
    period = 2.0

    def __init__(self, reading: object) -> None:
        self.reading = reading

    def sense(self, sensor: str, axes: dd.Axes, time: float) -> Any:
        return self.reading


@dataclass(frozen=True)
class Pose:
    angle: float = 0.0


class Turning(dd.World):
    """A world on the host that assigns to a frozen object of its own."""

    sensors = {"light": dd.Signal("brightness", (3,))}
    period = 2.0

    def sense(self, sensor: str, axes: dd.Axes, time: float) -> np.ndarray:
        Pose().angle = 1.0  # type: ignore[misc]
        return np.zeros(3)


class Senseless(dd.World):
    sensors = {"light": dd.Signal("brightness", (3,))}


class Pure(dd.PureWorld):
    """A world inside the step, one function of which is wrong."""

    sensors = {"light": dd.Signal("brightness", (3,))}
    motors = {"lamp": dd.Signal("brightness", ())}
    period = 2.0

    def __init__(self, wrong: str) -> None:
        self.wrong = wrong

    def start(self, shared: Any, arrays: Any) -> Any:
        return jnp.zeros(3)

    def read(self, shared: Any, arrays: Any, state: Any, sensor: str, axes: dd.Axes) -> Any:
        return state[:2] if self.wrong == "read" else state

    def advance(self, shared: Any, arrays: Any, state: Any, motors: Any) -> Any:
        if self.wrong == "grows":
            return jnp.zeros(5)
        return state + 1 if state.sum() > 0 else state


@jax.tree_util.register_pytree_node_class
class Light:
    """A state that is a class of the user, without `__eq__`."""

    def __init__(self, level: jax.Array) -> None:
        self.level = level

    def tree_flatten(self) -> tuple[tuple[jax.Array], None]:
        return (self.level,), None

    @classmethod
    def tree_unflatten(cls, _: None, children: tuple[jax.Array]) -> Light:
        return cls(*children)


class Lamp(Pure):
    """A world whose state is a `Light`, with the level `after` once it advances."""

    def __init__(self, after: jax.Array) -> None:
        self.after = after

    def start(self, shared: Any, arrays: Any) -> Light:
        return Light(jnp.zeros(3))

    def read(self, shared: Any, arrays: Any, state: Light, sensor: str, axes: dd.Axes) -> jax.Array:
        return state.level

    def advance(self, shared: Any, arrays: Any, state: Light, motors: Any) -> Light:
        return Light(self.after)


def seeing(moving: bool = False) -> dd.Model:
    model = dd.Model("seeing")
    model.add(dd.Sensor("eye", [dd.Axis("x", 0, 2, samples=3)], "light"))
    if moving:
        model.add(dd.Motor("hand", [], "lamp"))
    return model


WORLDS: list[tuple[Any, tuple[str, ...]]] = [
    (lambda: Host(np.zeros(2)), ("light", "Host.sense in test_wrong_worlds.py", "shape [2]", "it needs [3]")),
    (lambda: Host(np.full(3, np.nan)), ("light", "Host.sense in test_wrong_worlds.py", "finite: False")),
    (lambda: Host("bright"), ("light", "Host.sense in test_wrong_worlds.py", "it needs [3]")),
    (Turning, ("Turning", "raised FrozenInstanceError in sense", "cannot assign to field 'angle'")),
    (Senseless, ("Senseless in test_wrong_worlds.py", "has no method sense")),
    (lambda: Pure("read"), ("Pure.read in test_wrong_worlds.py", "[2] in place of [3]")),
    (
        lambda: Pure("asks"),
        ("Pure.advance in test_wrong_worlds.py, line", "asks whether a value is true or greater"),
    ),
]


@pytest.mark.parametrize("trials", [None, 2])
@pytest.mark.parametrize(("world", "says"), WORLDS, ids=range(len(WORLDS)))
def test_a_wrong_world_is_named_with_its_line_and_the_rule(
    world: Callable[[], dd.World], says: tuple[str, ...], trials: int | None
) -> None:
    wrong = world()
    model = seeing(moving=isinstance(wrong, Pure))
    refused(lambda: dd.simulate(model, 6, record="eye.output", world=wrong, trials=trials), WorldError, *says)


def test_a_state_of_a_world_inside_the_step_keeps_its_shape() -> None:
    says = "Pure.advance in test_wrong_worlds.py", "[5]", "it began with [3]"
    refused(
        lambda: dd.simulate(seeing(), 6, record="eye.output", world=Pure("grows"), trials=2),
        WorldError,
        *says,
    )


@pytest.mark.parametrize("trials", [None, 2])
def test_a_state_may_be_a_class_of_the_user(trials: int | None) -> None:
    def run(after: jax.Array) -> np.ndarray:
        seen = dd.simulate(seeing(), 6, record="eye.output", world=Lamp(after), trials=trials)
        return seen["eye.output"].values[..., -1, :]

    assert np.all(run(jnp.ones(3)) == 1)
    says = "Lamp.advance in test_wrong_worlds.py", "[5]", "it began with [3]"
    refused(lambda: run(jnp.ones(5)), WorldError, *says)
