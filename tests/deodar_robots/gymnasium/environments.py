"""Environments that are made for tests."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces


class Counting(gymnasium.Env[Any, Any]):
    """It counts its steps, from a number that follows from its seed, and ends after three."""

    def __init__(self, observation: Any = None, action: Any = None) -> None:
        self.observation_space = spaces.Box(0, 1e6, (1,)) if observation is None else observation
        self.action_space = spaces.Discrete(3, start=5) if action is None else action
        self.given: list[Any] = []

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        self.count, self.first = 0, float(self.np_random.integers(1000))
        return self.seen(), {}

    def seen(self) -> Any:
        if isinstance(self.observation_space, spaces.Dict):
            return {"eye": np.full((2, 3), self.count), "arm": {"angle": np.float32(self.count), "on": 1}}
        return np.array([self.first + self.count], np.float32)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        assert self.action_space.contains(action), action
        self.given.append(action)
        self.count += 1
        return self.seen(), 10.0 * self.count, self.count == 3, False, {}


class Wrong(Counting):
    """It returns observations of another shape than its space, and does not take action 6."""

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        if action == 6:
            raise RuntimeError("broken\nin two lines")
        _, *rest = super().step(action)
        return np.zeros(4, np.float32), *rest
