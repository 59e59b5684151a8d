"""Figure of a sequence that is taught and produced, as figure 11 of the paper."""

from __future__ import annotations

import colorsys
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from deodar.architectures.color_search import HUES
from deodar.figures._style import (
    COLOR,
    DIVERGING,
    DOUBLE,
    MEDIUM,
    SEQUENTIAL,
    SMALL,
    THIN,
    THRESHOLD_LINE,
    style,
)
from deodar.figures._style import figure as sheet

RANGE = 6.0
"""Activation at both ends of the colour scale."""

HEADROOM = 2.0
"""Upper end of the axis of the nodes, as a multiple of their largest activation: phases are named there."""

BRIEF = 0.05
"""Share of a phase below which the number of a node is as wide as the time for which the node is active."""

TICKS = (-5, 0, 5)
"""Ticks of that scale."""

LOWEST = -10.0
"""Lower end of the axis of the nodes; inhibition at a change of the mode exceeds it."""


class DrawnSearch(Protocol):
    """A sequence of colours that was taught and produced.

    `hues` are samples of hue by letter; times are in ms, None for a block that did not come into view.
    """

    @property
    def record(self) -> xarray.Dataset: ...
    @property
    def sequence(self) -> str: ...
    @property
    def begins(self) -> float: ...
    @property
    def produced(self) -> str: ...
    @property
    def found(self) -> Sequence[float]: ...
    @property
    def seen(self) -> Sequence[float | None]: ...
    @property
    def hues(self) -> Mapping[str, float]: ...


def line_colour(hue: float) -> tuple[float, float, float]:
    """Return a colour in which a line is visible on white: a sample of hue, dark."""
    return colorsys.hsv_to_rgb(hue / HUES, 1.0, 0.75)


def sequence_figure(result: DrawnSearch) -> Figure:
    """Draw the ordinal nodes, both fields over hue, and the colour-space field over image columns, over time.

    Triangles mark the times at which blocks were found, and those at which they came into view.
    """
    r = result
    with style():
        out = sheet(DOUBLE, 6.2)
        rows: Any = out.subplots(4, 1, sharex=True)
        draw_nodes(rows[0], r)
        for axes, name, title in (
            (rows[1], "action", "action field"),
            (rows[2], "satisfaction", "field of the condition of satisfaction; triangles: a block is found"),
        ):
            image = draw_hues(axes, r, name)
            axes.set_title(title, loc="left")
            out.colorbar(image, ax=axes, label="activation", pad=0.01, aspect=12, ticks=TICKS)
        _columns(rows[3], r, out)
        _marks(rows[2], r, r.found, r.produced)
        came = [(t, letter) for t, letter in zip(r.seen, r.produced, strict=True) if t is not None]
        _marks(rows[3], r, [t for t, _ in came], "".join(letter for _, letter in came))
        for axes in rows:
            axes.axvline(r.begins / 1000, color=COLOR.threshold, linewidth=MEDIUM)
        rows[3].set_xlabel("time (s)")
        out.align_ylabels(list(rows))
    return out


def draw_nodes(axes: Axes, r: DrawnSearch) -> None:
    """Draw the activation of the ordinal nodes, each in the colour that it was taught.

    A node is dashed if an earlier one has its colour; the node behind the sequence is grey.
    """
    times = r.record["time"].values / 1000
    begin = int(np.searchsorted(times, r.begins / 1000))
    for k, letter in enumerate(r.sequence, 1):
        u = r.record[f"item {k}.node.activation"].values
        again = letter in r.sequence[: k - 1]
        axes.plot(
            times,
            u,
            color=line_colour(r.hues[letter]),
            linewidth=MEDIUM,
            linestyle=(0, (2, 1)) if again else "-",
        )
        for phase in (slice(None, begin), slice(begin, None)):
            _number(axes, times[phase], u[phase], k, line_colour(r.hues[letter]))
    count = len(r.sequence) + 1
    last = r.record[f"item {count}.node.activation"].values
    axes.plot(times, last, color=COLOR.moment, linewidth=THIN)
    _number(axes, times[begin:], last[begin:], count, COLOR.moment)
    axes.axhline(0, **THRESHOLD_LINE)
    top = max(
        float(np.max(r.record[f"item {k}.node.activation"].values)) for k in range(1, len(r.sequence) + 1)
    )
    axes.set_ylim(LOWEST, HEADROOM * top)
    axes.set_ylabel("activation")
    axes.set_title("ordinal nodes, in the colours that they were taught", loc="left")
    for at, words in ((times[0], "teaching"), (times[begin], "production")):
        axes.annotate(
            words,
            (at, 1),
            xycoords=axes.get_xaxis_transform(),
            xytext=(4, -8),
            textcoords="offset points",
            fontsize=SMALL,
            color=COLOR.threshold,
        )


def _number(axes: Axes, times: np.ndarray, u: np.ndarray, number: int, colour: Any) -> None:
    """Write the number of a node above the longest time for which it is active."""
    active = np.flatnonzero(u > 0)
    if len(active):
        middle = _longest(active)
        brief = len(active) < BRIEF * len(u)
        axes.annotate(
            f"{number}",
            # above the pulse that starts the first node, if both are at one place
            (times[middle], float(u[active].max() if brief else np.median(u[active]))),
            xytext=(0, 2),
            textcoords="offset points",
            ha="center",
            fontsize=SMALL,
            color=colour,
        )


def _longest(active: np.ndarray) -> int:
    """Return the middle of the longest row of successive samples."""
    pieces = np.split(active, np.flatnonzero(np.diff(active) > 1) + 1)
    piece = max(pieces, key=len)
    return int(piece[len(piece) // 2])


def draw_hues(axes: Axes, r: DrawnSearch, name: str) -> Any:
    """Draw the activation of a field over hue, and return the image."""
    u = r.record[f"{name}.activation"].values
    times = r.record["time"].values / 1000
    # the circle of hue is cut between violet and red, so that red is whole
    turned = np.roll(u, HUES // 12, axis=1)
    low = -HUES // 12 - 0.5
    image = axes.imshow(
        turned.T,
        extent=(times[0], times[-1], low, low + HUES),
        cmap=DIVERGING,
        vmin=-RANGE,
        vmax=RANGE,
        aspect="auto",
    )
    axes.set_yticks(list(r.hues.values()), list(r.hues))
    axes.set_ylabel("hue")
    return image


def _columns(axes: Axes, r: DrawnSearch, out: Figure) -> None:
    field, times = r.record["columns of the peak.output"], r.record["time"].values / 1000
    half = -float(field["column"].values[0]) * field.sizes["column"] / (field.sizes["column"] - 1)
    image = axes.imshow(
        field.values.T,
        extent=(times[0], times[-1], -half, half),
        cmap=SEQUENTIAL,
        vmin=0.0,
        vmax=1.0,
        aspect="auto",
    )
    axes.set_yticks([-half, 0, half])
    axes.set_ylabel("column (px)")
    axes.set_title("colour-space field over image columns; triangles: a block comes into view", loc="left")
    out.colorbar(image, ax=axes, label="output", pad=0.01, aspect=12)


def _marks(axes: Axes, r: DrawnSearch, times: Sequence[float], letters: str) -> None:
    for time, letter in zip(times, letters, strict=True):
        axes.plot(
            time / 1000,
            1.0,
            marker="v",
            color=line_colour(r.hues[letter]),
            transform=axes.get_xaxis_transform(),
            clip_on=False,
            markersize=4.5,
        )
