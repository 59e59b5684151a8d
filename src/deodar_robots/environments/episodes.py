"""Episodes of copies of a closed loop: observations, rewards and ends."""

from __future__ import annotations

from typing import Any

import numpy as np

from deodar.errors import ParameterError
from deodar.experiments.observations import Observations
from deodar.parameters import show
from deodar_robots.environments.copies import LoopCopies, PortValues
from deodar_robots.environments.loop import ClosedLoop


class Episodes:
    """Episodes of some copies of a loop.

    Attributes:
        seen: the present observations by path, with copies first.
        outcomes: for each copy the event that ended its episode; empty while it runs, or if it was truncated.
    """

    def __init__(self, loop: ClosedLoop, copies: int) -> None:
        self.loop, self.count = loop, copies
        self._copies = LoopCopies(loop, copies)
        self._observed = Observations(loop.until, (), copies)
        self._periods = np.zeros(copies, int)
        self._episode = np.arange(copies)
        self.seen: dict[str, np.ndarray] = {}
        self.outcomes = [""] * copies
        limits = np.array(list(loop.act.values()), float)
        self._low, self._high = limits[:, 0], limits[:, 1]

    def begin(self, seed: int, first: int) -> None:
        """Begin an episode in each copy: copy k has the episode number `first` + k of a seed."""
        self._episode = first + np.arange(self.count)
        values = self._copies.begin(seed, self._trials())
        self._observed = Observations(self.loop.until, (), self.count)
        self._periods[:] = 0
        self._keep(values)
        self._take(values, np.arange(self.count))

    def step(self, actions: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Advance by a period; return the rewards, which episodes ended, and which were truncated."""
        before = self.seen
        values = self._copies.step(self._checked(actions))
        self._periods += 1
        self._keep(values)
        self._take(values, np.arange(self.count))
        ended = np.array([bool(outcome) for outcome in self.outcomes])
        limit = self.loop.limit
        truncated = (self._periods >= limit) & ~ended if limit is not None else np.zeros(self.count, bool)
        return self._rewards(before, values), ended, truncated

    def restart(self, ended: np.ndarray) -> None:
        """Begin the next episode in some copies; their numbers are larger than those of all before."""
        following = [self.loop.trial(int(episode)) for episode in self._episode + self.count]
        self._episode[ended] += self.count
        values = self._copies.restart(ended, following)
        rows = np.flatnonzero(ended)
        self._periods[rows] = 0
        seen = {view: found[rows] for view, found in self._copies.views(values).items()}
        self._observed.restart(rows.tolist(), seen)
        self._keep(values)
        self._take(values, rows)

    @property
    def last(self) -> int:
        """The largest number of an episode so far."""
        return int(self._episode.max())

    @property
    def times(self) -> np.ndarray:
        """Document time since the start of the episode of each copy."""
        return self._periods * self.loop.steps * self.loop.dt

    def _trials(self) -> list[int]:
        return [self.loop.trial(int(episode)) for episode in self._episode]

    def _checked(self, actions: Any) -> np.ndarray:
        """Return actions inside the bounds, (copies, parameters)."""
        shape = (self.count, len(self.loop.act))
        try:
            given = np.asarray(actions, float)
        except (TypeError, ValueError):
            given = np.full(1, np.nan)
        if given.shape != shape or not np.isfinite(given).all():
            raise ParameterError(
                f"the action is {show(actions)}, of shape {list(given.shape)}; expected finite numbers of"
                f" shape {list(shape)} (copies, {', '.join(self.loop.act)})"
            )
        return np.clip(given, self._low, self._high)

    def _keep(self, values: PortValues) -> None:
        self.seen = {path: values[ident, port] for path, (ident, port, _) in self.loop.see.items()}

    def _take(self, values: PortValues, rows: np.ndarray) -> None:
        """Evaluate the events of some copies."""
        if self.loop.until:
            seen = {view: found[rows] for view, found in self._copies.views(values).items()}
            self._observed.take(rows.tolist(), np.zeros(1), seen, last=False)
        self.outcomes = list(self._observed.outcome)

    def _rewards(self, before: dict[str, np.ndarray], values: PortValues) -> np.ndarray:
        reward, place = self.loop.reward, self.loop.rewarded
        if place is not None:
            return np.asarray(values[place], float)
        if reward is None or isinstance(reward, str):
            return np.zeros(self.count)
        found = np.asarray(reward(before, self.seen), float)
        if found.shape != (self.count,) or not np.isfinite(found).all():
            raise ParameterError(
                f"the function of the reward returned {show(found)}; expected {self.count} finite numbers,"
                " one for each copy"
            )
        return found
