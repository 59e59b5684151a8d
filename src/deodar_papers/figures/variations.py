"""Parameters that were varied alone: completed runs and duration of actions, one line for each parameter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

from deodar.figures._style import BLACK, COLOR, DOUBLE, MEDIUM, SMALL, THICK, THRESHOLD_LINE, style
from deodar.figures._style import figure as sheet

LINE, EDGES = 0.155, 0.75
"""Height of the line of one parameter, and of title and axis together, inches."""

LOWER: dict[str, Any] = {
    "marker": "o",
    "markersize": 4.6,
    "markerfacecolor": "white",
    "markeredgecolor": BLACK,
}
HIGHER: dict[str, Any] = {
    "marker": "o",
    "markersize": 2.4,
    "markerfacecolor": BLACK,
    "markeredgecolor": BLACK,
}
"""Marks of both changes: they differ without colours, and both are visible at one place."""


class DrawnRuns(Protocol):
    """Runs with one value of a parameter: their number, how many were complete and wrong, and the median
    duration of an action, s; None if there was none.
    """

    @property
    def runs(self) -> int: ...
    @property
    def complete(self) -> int: ...
    @property
    def wrong(self) -> int: ...
    @property
    def action(self) -> float | None: ...


class DrawnVariation(Protocol):
    """A parameter, and its runs with a lower and with a higher value; None where nothing was run."""

    @property
    def name(self) -> str: ...
    @property
    def lower(self) -> DrawnRuns | None: ...
    @property
    def higher(self) -> DrawnRuns | None: ...


def variations_figure(
    parameters: Sequence[DrawnVariation], unvaried: float | None, lower: str, higher: str
) -> Figure:
    """Draw for each parameter, from the top down in the given order, the number of complete runs and the
    median duration of an action, each with both values of the parameter. Numbers beside marks count runs with
    a wrong order.

    Args:
        parameters: the parameters.
        unvaried: median duration of an action without a change, s, at which a line is drawn.
        lower: name of the change to the lower values, for the legend.
        higher: name of the change to the higher values.
    """
    with style():
        out = sheet(DOUBLE, EDGES + LINE * len(parameters))
        axes: Any = out.subplots(1, 2, sharey=True, width_ratios=[1.0, 1.0])
        complete, action = axes
        for y, parameter in enumerate(parameters):
            both = [(parameter.lower, LOWER), (parameter.higher, HIGHER)]
            there = [(runs, mark) for runs, mark in both if runs is not None]
            _line(complete, y, [(runs.complete, mark) for runs, mark in there])
            took = [(runs.action, mark) for runs, mark in there if runs.action is not None]
            _line(action, y, took)
            wrong = [(runs.complete, runs.wrong) for runs, _ in there if runs.wrong]
            for at, count in wrong:
                complete.annotate(
                    f"{count} wrong",
                    (at, y),
                    (6, 0),
                    textcoords="offset points",
                    va="center",
                    fontsize=SMALL,
                    bbox={"facecolor": "white", "linewidth": 0, "pad": 0.5},
                )
        most = max((r.runs for p in parameters for r in (p.lower, p.higher) if r is not None), default=1)
        complete.set_xlim(-0.03 * most, 1.03 * most)
        complete.axvline(most, **THRESHOLD_LINE)
        complete.set_xlabel(f"complete runs, of {most}")
        complete.xaxis.set_major_locator(MaxNLocator(integer=True, steps=[1, 2, 5, 10]))
        complete.set_yticks(range(len(parameters)), [p.name for p in parameters])
        complete.set_ylim(len(parameters) - 0.4, -0.6)
        action.set_xscale("log")
        action.margins(x=0.04)
        action.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        action.xaxis.set_major_formatter("{x:g}")
        action.xaxis.set_minor_formatter(NullFormatter())
        action.set_xlabel("median duration of an action (s)")
        if unvaried is not None:
            action.axvline(unvaried, **THRESHOLD_LINE)
        for ax in (complete, action):
            ax.tick_params(axis="y", length=0)
        for mark, words in ((LOWER, lower), (HIGHER, higher)):
            complete.plot([], [], linestyle="", label=words, **mark)
        out.legend(loc="outside upper left", ncols=2)
    return out


def _line(axes: Axes, y: int, marks: Sequence[tuple[float, dict[str, Any]]]) -> None:
    """Draw the marks of one parameter, joined by a line."""
    axes.axhline(y, color=COLOR.window, linewidth=MEDIUM / 2, zorder=0)
    if len(marks) == 2:
        axes.plot([x for x, _ in marks], [y, y], color=COLOR.moment, linewidth=THICK, zorder=1)
    for order, (x, mark) in enumerate(marks, 2):
        axes.plot(x, y, linestyle="", clip_on=False, zorder=order, **mark)
