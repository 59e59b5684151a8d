"""Conditions side by side: shares with intervals, and distributions as boxes, one panel for each group."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullLocator

from deodar.analysis.statistics import wilson
from deodar.figures import _style


def shares_figure(
    panels: Mapping[str, Sequence[tuple[int, int]]], labels: Sequence[str], ours: int, what: str
) -> Figure:
    """Draw shares as bars with 95 % intervals.

    Args:
        panels: for each panel its title and (hits, n) of each condition.
        labels: names of the conditions.
        ours: number of leading conditions that belong to the tested method; the others are baselines.
        what: label of the vertical axis.
    """
    with _style.style():
        figure, axes = _panels(len(panels))
        for ax, (title, found) in zip(axes, panels.items(), strict=True):
            for k, (hits, n) in enumerate(found):
                interval = wilson(hits, n)
                if interval is not None:
                    colour, ink = (
                        (_style.COLOR.claim, "white")
                        if k < ours
                        else (_style.COLOR.baseline, _style.COLOR.interval)
                    )
                    ax.bar(k, hits / n, color=colour, width=0.8)
                    ax.plot([k, k], interval, color=_style.COLOR.interval, linewidth=_style.MEDIUM)
                    ax.text(k, 0.03, f"{hits}/{n}", ha="center", color=ink, fontsize=_style.SMALL)
            ax.set_ylim(0, 1.02)
            _conditions(ax, labels, title, what)
    return figure


def boxes_figure(
    panels: Mapping[str, Sequence[np.ndarray]], labels: Sequence[str], reference: float, what: str
) -> Figure:
    """Draw distributions as boxes on a logarithmic axis: median, quartiles, whiskers of 1.5 interquartile
    ranges, points beyond.

    Args:
        panels: for each panel its title and the values of each condition.
        labels: names of the conditions.
        reference: value at which a line is drawn.
        what: label of the vertical axis.
    """
    with _style.style():
        figure, axes = _panels(len(panels))
        for ax, (title, found) in zip(axes, panels.items(), strict=True):
            there = [k for k, v in enumerate(found) if len(v)]
            if there:
                values = [found[k] for k in there]
                thin: dict[str, Any] = {"linewidth": _style.MEDIUM}
                ax.boxplot(
                    values,
                    positions=there,
                    widths=0.6,
                    flierprops={"marker": ".", "markersize": _style.DOT},
                    medianprops={"color": _style.COLOR.claim, "linewidth": _style.THICK},
                    boxprops=thin,
                    whiskerprops=thin,
                    capprops=thin,
                )
            ax.axhline(reference, **_style.THRESHOLD_LINE)
            ax.set_yscale("log")
            ax.yaxis.set_major_locator(LogLocator(subs=(1, 1.5, 2, 3, 5)))
            ax.yaxis.set_minor_locator(NullLocator())
            ax.yaxis.set_major_formatter(FormatStrFormatter("%g"))
            _conditions(ax, labels, title, what)
    return figure


def _panels(n: int) -> tuple[Figure, Sequence[Axes]]:
    figure = _style.figure(_style.DOUBLE, 2.4)
    axes: Any = figure.subplots(1, n, squeeze=False)
    return figure, list(axes[0])


def _conditions(ax: Axes, labels: Sequence[str], title: str, what: str) -> None:
    ax.set_xticks(range(len(labels)), labels)
    ax.set_xlim(-0.6, len(labels) - 0.4)
    ax.set_title(title)
    ax.set_ylabel(what)
