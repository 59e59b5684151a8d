"""Environments of Gymnasium, one or several copies at once, and the spaces of their values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from deodar.errors import ParameterError
from deodar.parameters import show
from deodar.session.session import require_seed
from deodar_robots.environments.episodes import Episodes
from deodar_robots.environments.loop import ClosedLoop


def action_space(loop: ClosedLoop) -> spaces.Box:
    """Return the space of actions: a number for each parameter."""
    low, high = np.array(list(loop.act.values()), np.float32).T
    return spaces.Box(low, high, dtype=np.float32)


def observation_space(loop: ClosedLoop) -> spaces.Box | spaces.Dict:
    """Return the space of observations: that of the port, or a dictionary by path if there are several."""
    boxes = {
        path: spaces.Box(-np.inf, np.inf, shape, np.dtype(loop.precision).type)
        for path, (*_, shape) in loop.see.items()
    }
    return next(iter(boxes.values())) if len(boxes) == 1 else spaces.Dict(dict(boxes))


def element(seen: Mapping[str, np.ndarray]) -> np.ndarray | dict[str, np.ndarray]:
    """Return observations by path as an element of the space."""
    return next(iter(seen.values())) if len(seen) == 1 else dict(seen)


class LoopEnv(gymnasium.Env[Any, Any]):
    """A closed loop as an environment.

    Attributes:
        loop: the closed loop.
    """

    def __init__(self, loop: ClosedLoop) -> None:
        self.loop = loop
        self.action_space = action_space(loop)
        self.observation_space = observation_space(loop)
        self._episodes = Episodes(loop, 1)
        self._seed, self._next = loop.seed, 0

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begin an episode.

        Args:
            seed: seed of all noise; the episode is its trial 0. None: the next trial of the present seed.
            options: under `trial` the number of the trial of the seed.
        """
        super().reset(seed=seed)
        if seed is not None:
            self._seed, self._next = require_seed(seed), 0
        trial = require_seed((options or {}).get("trial", self._next))
        self._episodes.begin(self._seed, trial)
        self._next = trial + 1
        return self._seen(), self._about()

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Set the parameters to `action`, limited to their bounds, and advance by a period."""
        rewards, ended, truncated = self._episodes.step(np.asarray(action)[None])
        return self._seen(), float(rewards[0]), bool(ended[0]), bool(truncated[0]), self._about()

    def _seen(self) -> Any:
        return element({path: values[0] for path, values in self._episodes.seen.items()})

    def _about(self) -> dict[str, Any]:
        return {"time": float(self._episodes.times[0]), "outcome": self._episodes.outcomes[0]}


class LoopVectorEnv(VectorEnv[Any, Any, Any]):
    """Copies of a closed loop as a vector environment.

    A copy whose episode has ended begins another one in the same step: its observation is the first one of
    that episode, and `final_obs` and `final_info` of the info have the last ones of the episode before.

    Attributes:
        loop: the closed loop.
    """

    metadata: dict[str, Any] = {"autoreset_mode": AutoresetMode.SAME_STEP}

    def __init__(self, loop: ClosedLoop, copies: int) -> None:
        self.loop, self.num_envs = loop, copies
        self.single_action_space = action_space(loop)
        self.single_observation_space = observation_space(loop)
        self.action_space = batch_space(self.single_action_space, copies)
        self.observation_space = batch_space(self.single_observation_space, copies)
        self._episodes = Episodes(loop, copies)
        self._seed, self._next = loop.seed, 0

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begin an episode in each copy.

        Args:
            seed: seed of all noise; copy k has its trial k. None: the next trials of the present seed.
            options: ignored.
        """
        if isinstance(seed, list):
            raise ParameterError(
                f"seed is {show(seed)}; expected one seed, of which each copy has another trial",
                fix=f"Type: reset(seed={next((s for s in seed if s is not None), 0)})",
            )
        super().reset(seed=seed)
        if seed is not None:
            self._seed, self._next = require_seed(seed), 0
        self._episodes.begin(self._seed, self._next)
        self._next += self.num_envs
        return element(self._episodes.seen), self._about(np.ones(self.num_envs, bool))

    def step(self, actions: Any) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Set the parameters of each copy to its action, limited to their bounds, and advance by a period."""
        rewards, ended, truncated = self._episodes.step(actions)
        over = ended | truncated
        info = self._about(~over)
        if over.any():
            info["final_obs"], info["_final_obs"] = element(self._episodes.seen), over
            info["final_info"], info["_final_info"] = self._about(over), over
            self._episodes.restart(over)
            self._next = max(self._next, self._episodes.last + 1)
            info["time"], info["_time"] = self._episodes.times, np.ones(self.num_envs, bool)
        return element(self._episodes.seen), rewards, ended, truncated, info

    def _about(self, which: np.ndarray) -> dict[str, Any]:
        outcomes = np.array(self._episodes.outcomes, object)
        return {"time": self._episodes.times, "_time": which, "outcome": outcomes, "_outcome": which}
