"""The transitions of a sequence, from a record of `serial_order`, with the times of their instabilities."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from deodar.analysis.peaks import peaks

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class ActionTransition:
    """The transition from one action to the next, as times in the unit of the record; NaN: did not occur.

    Attributes:
        item: position in the sequence, from 1.
        place: position of the peak of the condition of satisfaction.
        satisfied: time at which the condition of satisfaction was detected.
        off: time at which the ordinal node switched off.
        action_off: time at which the peak of the action decayed.
        released: time at which the peak of the condition of satisfaction decayed.
        next_on: time at which the next ordinal node switched on.
        next_action: time at which the next action had a peak.
    """

    item: int
    place: float
    satisfied: float
    off: float
    action_off: float
    released: float
    next_on: float
    next_action: float

    @property
    def in_order(self) -> bool:
        """Whether the instabilities occurred in the order of section 4.4 of Sandamirskaya & Schöner (2010);
        the last item has no next node or action.
        """
        times = [self.satisfied, self.off, self.action_off, self.released, self.next_on, self.next_action]
        known = times if not np.isnan(self.next_on) else times[:4]
        return all(a < b for a, b in pairwise(known))


def cascade_paths(items: int) -> list[str]:
    """Return the paths to record for `cascade`."""
    return [
        *(f"item {k}.node.activation" for k in range(1, items + 1)),
        "action.activation",
        "satisfaction.activation",
    ]


def cascade(data: xarray.Dataset, begin: float, stop: float = np.inf) -> list[ActionTransition]:
    """Return the transitions within a time window of a single run, one each time an ordinal node switches
    off.

    Args:
        data: a record of `cascade_paths(...)` with every step.
        begin: start of the window.
        stop: end of the window, excluded.
    """
    part = data.sel(time=slice(begin, min(stop, float(data["time"][-1]))))
    time = part["time"].values
    count = sum(str(name).endswith(".node.activation") for name in part.data_vars)
    on = {k: part[f"item {k}.node.activation"].values > 0 for k in range(1, count + 1)}
    action, satisfaction = (part[f"{name}.activation"] for name in ("action", "satisfaction"))
    acting, satisfied = (u.max(str(u.dims[1])).values > 0 for u in (action, satisfaction))
    ended = sorted((i, k) for k in on for i in _switches(on[k], False))
    found: list[ActionTransition] = []
    for n, (i, k) in enumerate(ended):
        last = ended[n + 1][0] if n + 1 < len(ended) else len(time)
        came = [j for j in _switches(satisfied, True) if j <= i]
        following = [j for other in on if other != k for j in _switches(on[other], True) if i <= j < last]
        until = following[0] if following else last
        place = [p.position[0] for p in peaks(satisfaction.isel(time=min(i + 1, len(time) - 1)))]

        def first(switched: list[int], low: int, high: int) -> float:
            return next((float(time[j]) for j in switched if low <= j < high), np.nan)

        found.append(
            ActionTransition(
                k,
                place[0] if place else np.nan,
                float(time[came[-1]]) if came else np.nan,
                float(time[i]),
                first(_switches(acting, False), i, until + 1),
                first(_switches(satisfied, False), i, until + 1),
                first(following, i, last),
                first(_switches(acting, True), until, last),
            )
        )
    return found


def _switches(on: np.ndarray, to: bool) -> list[int]:
    """Return the indices at which a state changes to `to`."""
    return [int(j) + 1 for j in np.flatnonzero((on[1:] == to) & (on[:-1] != to))]
