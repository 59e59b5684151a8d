"""Ordinal nodes during a transition: rates of change at three moments, and activation over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from deodar.figures._style import COLOR, COLORS, DOUBLE, MEDIUM, SMALL, THICK, THIN, THRESHOLD_LINE, style
from deodar.figures._style import figure as sheet

STATES = -8.0, 10.0
"""Activation at both ends of an axis, unless a stable state lies lower."""

LETTERS = 0.2
"""Space above the curves for the letters of the moments, as a share of the range of the curves."""


@dataclass(frozen=True)
class OrdinalMoment:
    """What acts on the ordinal nodes at one moment.

    Attributes:
        title: what happens, in words.
        time: the moment, ms.
        inputs: input of each node from all others, in the order of the nodes.
    """

    title: str
    time: float
    inputs: Sequence[float]


@dataclass(frozen=True)
class OrdinalTransition:
    """A transition between two ordinal nodes.

    Attributes:
        times: times of the samples, ms.
        nodes: activation of the ordinal nodes, (times, nodes).
        item: number of the node that is switched off, from 1.
        on, off: times at which the condition of satisfaction is detected, and at which its peak has decayed,
            ms.
        moments: the three moments.
        resting_level, self_excitation, steepness: of the ordinal nodes.
    """

    times: np.ndarray
    nodes: np.ndarray
    item: int
    on: float
    off: float
    moments: Sequence[OrdinalMoment]
    resting_level: float
    self_excitation: float
    steepness: float

    def rate(self, states: np.ndarray, received: float) -> np.ndarray:
        """Return tau times the rate of change of a node, -d + h_d + c0 f(d) + input."""
        output = 1.0 / (1.0 + np.exp(-np.clip(self.steepness * states, -50.0, 50.0)))
        return -states + self.resting_level + self.self_excitation * output + received

    def attractors(self, received: float) -> list[float]:
        """Return the stable states of a node: the rate of change falls through zero there."""
        states = np.linspace(-100.0, 30.0, 130_001)
        above = self.rate(states, received) > 0
        found = np.flatnonzero(above[:-1] & ~above[1:])
        return [round(float(states[k : k + 2].mean()), 3) for k in found]


def transition_figure(result: OrdinalTransition) -> Figure:
    """Draw the rate of change of the ordinal nodes at three moments, with a circle at each stable state, and
    below it their activation over time; grey: between both events of the condition of satisfaction.
    """
    with style():
        out = sheet(DOUBLE, 4.6)
        grid = out.add_gridspec(2, 3)
        for k, moment in enumerate(result.moments):
            axes = out.add_subplot(grid[0, k])
            _rates(axes, result, moment)
            axes.set_title(f"{'abc'[k]}  {moment.title}", loc="left")
            if k == 0:
                axes.set_ylabel("tau x rate of change")
        _course(out.add_subplot(grid[1, :]), result)
    return out


def _drawn(result: OrdinalTransition) -> list[tuple[int, str, dict[str, Any]]]:
    """Return index, name and line style of each node, the two of the transition last."""
    count, item = result.nodes.shape[1], result.item
    others = [k for k in range(count) if k not in (item - 1, item)]
    thin = {"color": COLOR.moment, "linewidth": THIN}
    return [
        *((k, "other nodes" if k == others[0] else "", thin) for k in others),
        (item - 1, f"node {item}", {"color": COLORS[0], "linewidth": THICK}),
        (item, f"node {item + 1}", {"color": COLORS[1], "linewidth": THICK}),
    ]


def _rates(axes: Axes, result: OrdinalTransition, moment: OrdinalMoment) -> None:
    axes.axhline(0, **THRESHOLD_LINE)
    axes.axvline(0, **THRESHOLD_LINE)
    stable = [result.attractors(received) for received in moment.inputs]
    low = min(STATES[0], 1.2 * min(min(found) for found in stable))
    states = np.linspace(low, STATES[1], 2001)
    for k, _, line in _drawn(result):
        axes.plot(states, result.rate(states, moment.inputs[k]), **line)
        axes.plot(stable[k], np.zeros(len(stable[k])), "o", color=line["color"], markersize=4, zorder=3)
    axes.set_xlim(low, STATES[1])
    axes.set_xlabel("activation")


def _course(axes: Axes, result: OrdinalTransition) -> None:
    begin = result.on
    times = result.times - begin
    axes.axvspan(0.0, result.off - begin, color=COLOR.window, linewidth=0)
    for k, name, line in _drawn(result):
        axes.plot(times, result.nodes[:, k], label=name or None, **line)
    axes.axhline(0, **THRESHOLD_LINE)
    axes.set_xlim(times[0], times[-1])
    low, high = float(result.nodes.min()), float(result.nodes.max())
    # the letters of the moments are above the curves, inside the panel
    axes.set_ylim(low - 1.0, high + LETTERS * (high - low))
    for letter, moment in zip("abc", result.moments, strict=False):
        axes.axvline(moment.time - begin, color=COLOR.moment, linewidth=MEDIUM, linestyle=":")
        axes.annotate(
            letter,
            (moment.time - begin, 1.0),
            xycoords=axes.get_xaxis_transform(),
            xytext=(3, -3),
            textcoords="offset points",
            va="top",
            fontsize=SMALL,
        )
    for at, words, side in ((0.0, "CoS on", "right"), (result.off - begin, "CoS off", "left")):
        axes.annotate(
            words,
            (at, axes.get_ylim()[0]),
            xytext=(-4 if side == "right" else 4, 8),
            textcoords="offset points",
            ha=side,
            fontsize=SMALL,
        )
    axes.set_xlabel("time after the condition of satisfaction is detected (ms)")
    axes.set_ylabel("activation")
    axes.legend(loc="lower right", fontsize=SMALL)
