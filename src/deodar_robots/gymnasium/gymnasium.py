"""An environment of Gymnasium as a world."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from deodar import codec
from deodar.codec import Json, JsonObject
from deodar.errors import WorldError, did_you_mean
from deodar.numerics.axes import Axes, Axis
from deodar.parameters import show
from deodar.registry import register
from deodar.worlds._base import Signal, World
from deodar.worlds._settings import number
from deodar_robots.gymnasium import space_parts
from deodar_robots.gymnasium.package import errors_in, made, package, parse_argument, require_registered
from deodar_robots.gymnasium.space_parts import SpacePart

AT_END = ("reset", "hold")
REWARD, DONE = "reward", "done"
OWN_SENSORS = {
    REWARD: Signal("reward of the last period", (), each=True),
    DONE: Signal("1 if an episode ended in the last period, else 0", (), each=True),
}
EXAMPLE = "MountainCarContinuous-v0"


@dataclass
class _Copy:
    """An environment of one copy of the model, and all that follows from its actions.

    Attributes:
        env: the environment.
        episode: number of the episode.
        actions: values of the motors since the episode began, as one row for each period.
        observation: the last observation.
        reward: reward of the last period.
        done: whether an episode ended in the last period; with `hold`, or before.
        over: whether the episode is over and is held.
    """

    env: Any
    episode: int = 0
    actions: list[list[float]] = field(default_factory=list[list[float]])
    observation: Any = None
    reward: float = 0.0
    done: bool = False
    over: bool = False


@register
class Gymnasium(World):
    r"""An environment of Gymnasium: one step of it is one period.

    An observation that is a dictionary has a sensor for each key, others are the sensor `observation`. The
    motor `action`, or a motor for each key, is limited to the bounds of its space. A motor for a Discrete
    space (or for each number of a MultiDiscrete one) is rounded to the nearest whole number and then limited,
    so that 0.4 is action 0 and 0.6 is action 1; a number of a MultiBinary space is 1 above 0.5. The value of
    a motor that no element drives is 0. Each trial has an environment of its own; the seed of its episode
    number e follows from the seed of the run, the trial and e.

    Equation:
        o_{k+1}, r_{k+1} = \mathrm{step}(\mathrm{limited}(m_k)), \quad t = k \cdot \mathrm{period}

    Parameters:
        environment: name of a registered environment, or a function without arguments that returns one; it is
            called for each trial.
        period: ms between two exchanges with the model, in which the environment takes one step.
        at_end: what happens when an episode ends. `reset`: the next one begins at once; the sensors show its
            first observation, and the reward and `done` of the one that ended. `hold`: the last observation
            stays and `done` remains 1; the reward is 0 from the next period on.
        settings: arguments for `gymnasium.make`, by name.

    Shapes:
        A sensor or motor has the shape of its space; one number for the shape (1,), for Discrete, and for
        `reward` and `done`. Values are those of the environment, in its units.

    Reference:
        Towers et al. (2024), Gymnasium: a standard interface for reinforcement learning environments,
        arXiv:2407.17032.
    """

    sensors: Mapping[str, Signal] = {
        "observation": Signal("observation of the environment", each=True),
        **OWN_SENSORS,
    }
    motors: Mapping[str, Signal] = {"action": Signal("action in the environment", each=True)}
    stands_in = False
    short = "gym"

    def __init__(
        self,
        environment: str | Callable[[], Any],
        period: float = 20.0,
        at_end: str = "reset",
        settings: Mapping[str, Any] | None = None,
    ) -> None:
        self.period = number("period", period, above=0.0)
        if at_end not in AT_END:
            raise WorldError(
                f"at_end is {show(at_end)}; expected reset or hold", fix=did_you_mean(str(at_end), AT_END)
            )
        self.at_end, self.settings = at_end, dict(settings or {})
        if not isinstance(environment, str) and (self.settings or not callable(environment)):
            raise WorldError(
                f"environment is {show(environment)}; expected a name, or a function without settings"
            )
        self.environment = environment
        self.name = environment if isinstance(environment, str) else _name(environment)
        self._seed, self._trials = 0, (0,)
        self._copies = [_Copy(self._made())]
        env = self._copies[0].env
        self._parts = space_parts.parts(env.observation_space, "observation", self.name)
        self._actions = space_parts.parts(env.action_space, "action", self.name)
        taken = [name for name in OWN_SENSORS if name in self._parts]
        if taken:
            raise WorldError(
                f"the observation has the key {taken[0]!r}, the name of another sensor",
                where=self.name,
                fix="Rename it by a wrapper",
            )
        seen = {name: part.signal("observation") for name, part in self._parts.items()}
        self.sensors = {**seen, **OWN_SENSORS}
        self.motors = {name: part.signal("action") for name, part in self._actions.items()}

    def _made(self) -> Any:
        """Return a new environment."""
        if isinstance(self.environment, str):
            return made(self.environment, self.settings)
        with errors_in(self.name, "its function"):
            env = self.environment()
        if not isinstance(env, package().Env):
            raise WorldError(f"the function returned {show(env)}; expected a gymnasium.Env", where=self.name)
        return env

    # ------------------------------------------------------------------------------------------- the episodes

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        self._seed, self._trials = seed, tuple(trials)
        for copy in self._copies[len(trials) :]:
            copy.env.close()
        envs = [copy.env for copy in self._copies[: len(trials)]]
        envs += [self._made() for _ in range(len(trials) - len(envs))]
        self._copies = [_Copy(env) for env in envs]
        for k in range(len(trials)):
            self._begin(k, 0)

    def _begin(self, k: int, episode: int) -> None:
        """Begin an episode of a copy; reward and `done` stay."""
        copy = self._copies[k]
        seed = np.random.SeedSequence([self._seed, self._trials[k], episode]).generate_state(1)[0]
        copy.episode, copy.actions, copy.over = episode, [], False
        with errors_in(self.name, "reset"):
            copy.observation, _ = copy.env.reset(seed=int(seed))

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        for k in range(len(self._copies)):
            values = [np.ravel(motors[m][k]) if m in motors else np.zeros(n) for m, n in self._sizes()]
            self._step(k, np.concatenate(values).astype(float).tolist())

    def _sizes(self) -> list[tuple[str, int]]:
        return [(name, int(np.prod(part.shape))) for name, part in self._actions.items()]

    def _step(self, k: int, numbers: list[float]) -> None:
        """Take one step of the environment of a copy; an episode that ended is held or followed by another.

        `numbers` are the values of all motors.
        """
        copy = self._copies[k]
        if copy.over:
            copy.reward = 0.0
            return
        given, at = dict[str, np.ndarray](), 0
        for name, size in self._sizes():
            given[name] = np.reshape(numbers[at : at + size], self._actions[name].shape)
            at += size
        with errors_in(self.name, "step"):
            found = copy.env.step(space_parts.joined(self._actions, given))
            copy.observation, reward, terminated, truncated, _ = found
            copy.reward = float(reward)
        copy.actions.append(numbers)
        copy.done = bool(terminated or truncated)
        if copy.done and self.at_end == "hold":
            copy.over = True
        elif copy.done:
            self._begin(k, copy.episode + 1)

    # ------------------------------------------------------------------------------------------- the readings

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        self.require(sensor)
        if self._copies[0].observation is None:
            raise WorldError("the world Gymnasium has not begun", fix="Type: world.reset(seed)")
        if sensor in OWN_SENSORS:
            return np.array([float(getattr(copy, sensor)) for copy in self._copies])
        part: SpacePart = self._parts[sensor]
        return np.stack([part.reading(copy.observation) for copy in self._copies])

    def keep(self) -> Any:
        """Return the episode of each copy and its actions, which repeat it: environments have no state that
        can be read.
        """
        rows = [[c.episode, c.actions, c.reward, c.done, c.over] for c in self._copies]
        return {"episodes": codec.line(rows)}

    def put(self, kept: Any) -> None:
        if kept is None:
            return
        rows: Any = codec.parse(str(kept["episodes"]))
        for k, (episode, actions, reward, done, over) in enumerate(rows):
            copy = self._copies[k]
            self._begin(k, int(episode))
            for numbers in actions:
                self._step(k, numbers)
            copy.reward, copy.done, copy.over = float(reward), bool(done), bool(over)

    def __getstate__(self) -> dict[str, Any]:
        """Leave out the environments, which another process makes again."""
        return {**self.__dict__, "_copies": []}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._copies = [_Copy(self._made())]

    # ---------------------------------------------------------------------------------------- names and files

    def describe(self) -> JsonObject:
        said: JsonObject = {
            "world": "Gymnasium",
            "environment": self.name,
            "period": self.period,
            "at_end": self.at_end,
            "gymnasium": str(package().__version__),
        }
        try:
            return {**said, "settings": codec.parse(codec.line(self.settings))}
        except (TypeError, ValueError):  # such as a wrapper: the world cannot be opened again
            return said

    @classmethod
    def open(cls, argument: str) -> Gymnasium:
        name, own, settings = parse_argument(argument)
        return cls(name, settings=settings, **own)

    @classmethod
    def again(cls, described: Mapping[str, Json]) -> Gymnasium:
        name, settings = str(described["environment"]), described.get("settings")
        require_registered(name, "the record's world")
        if not isinstance(settings, Mapping):
            raise WorldError("the settings of the environment are not in the record", where=name)
        period: Any = described["period"]
        return cls(name, period, str(described["at_end"]), settings)

    @classmethod
    def example(cls) -> Gymnasium:
        return cls(EXAMPLE)

    @staticmethod
    def example_axes(sensor: str) -> Axes:
        return () if sensor in OWN_SENSORS else (Axis("of", 0, 1, 2),)


def _name(function: Any) -> str:
    """Return the name of a function that returns environments; its colon makes it no registered name."""
    return f"{getattr(function, '__module__', '')}:{getattr(function, '__qualname__', show(function))}"
