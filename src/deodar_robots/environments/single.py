"""A closed loop as one environment of Gymnasium."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np

from deodar.session.session import require_seed
from deodar_robots.environments.episodes import Episodes
from deodar_robots.environments.loop import ClosedLoop
from deodar_robots.environments.spaces import action_space, element, observation_space


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
