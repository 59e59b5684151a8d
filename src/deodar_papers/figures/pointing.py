"""Figures 8 and 11 of Lomp et al. (2016): an arm points at the object that a colour and a side name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec

from deodar.architectures.pointing import CUES
from deodar.figures._style import ACTIVATION, COLOR, COLORS, DOUBLE, GREY, style
from deodar.figures._style import figure as sheet
from deodar.numerics.axes import Axis

LOWEST, HIGHEST = -5.0, 4.0
"""Activation at the ends of the colour scale."""


class DrawnDisc(Protocol):
    """An object: its middle and radius (m), and its colour."""

    @property
    def x(self) -> float: ...
    @property
    def y(self) -> float: ...
    @property
    def radius(self) -> float: ...
    @property
    def rgb(self) -> tuple[float, float, float]: ...


class DrawnTableView(Protocol):
    """A moment: the camera's picture, the maximum of the perceptual field along hue, the tool's place."""

    @property
    def title(self) -> str: ...
    @property
    def picture(self) -> np.ndarray: ...
    @property
    def map(self) -> np.ndarray: ...
    @property
    def tool(self) -> tuple[float, float]: ...


class DrawnMoment(Protocol):
    """Largest activations of both fields, and the activation of each cue node, at a time (ms)."""

    @property
    def time(self) -> float: ...
    @property
    def perceptual(self) -> float: ...
    @property
    def satisfaction(self) -> float: ...
    @property
    def nodes(self) -> Sequence[float]: ...


def pointing_figure(
    views: Sequence[DrawnTableView],
    moments: Sequence[DrawnMoment],
    cycles: Sequence[tuple[float, str]],
    distances: Sequence[float],
    discs: Sequence[DrawnDisc],
    plane: tuple[Axis, Axis],
) -> Figure:
    """Draw the pictures and maps of moments (figure 8), and below them the time courses (figure 11).

    Args:
        views: the moments.
        moments: activations over time.
        cycles: start (s) and name of each cycle.
        distances: distance of the tool from the object of the cycle at each of `moments`, m.
        discs: the objects.
        plane: x and y axis of the maps, m.
    """
    with style():
        count = len(views)
        drawn = sheet(DOUBLE, 5.0)
        grid = drawn.add_gridspec(4, count, height_ratios=(0.75, 0.85, 1.3, 1.3))
        x, y = plane
        extent = (x.lower - x.step / 2, x.upper + x.step / 2, y.lower - y.step / 2, y.upper + y.step / 2)
        shown = None
        for k, view in enumerate(views):
            at = drawn.add_subplot(grid[0, k])
            at.imshow(view.picture)
            at.set_title(view.title, fontsize=6)
            at.set_axis_off()
            at = drawn.add_subplot(grid[1, k])
            shown = at.imshow(
                view.map.T, origin="lower", extent=extent, vmin=LOWEST, vmax=HIGHEST, cmap=ACTIVATION
            )
            for disc in discs:
                turn = np.linspace(0, 2 * np.pi, 40)
                at.plot(
                    disc.x + disc.radius * np.cos(turn),
                    disc.y + disc.radius * np.sin(turn),
                    color=disc.rgb,
                    lw=0.8,
                )
            at.plot(*view.tool, marker="+", color="black", ms=5)
            at.set(xticks=[-0.4, 0, 0.4], yticks=[0, 0.6])
            at.tick_params(labelsize=5)
            if k == 0:
                at.set_ylabel("y (m)", fontsize=6)
            at.set_xlabel("x (m)", fontsize=6)
        if shown is not None:
            bar = drawn.colorbar(shown, ax=drawn.axes[1::2], shrink=0.9, pad=0.01)
            bar.set_label("activation, largest over hue", fontsize=5)
            bar.ax.tick_params(labelsize=5)
        _courses(drawn, grid, moments, cycles, distances)
        return drawn


def _courses(
    drawn: Figure,
    grid: GridSpec,
    moments: Sequence[DrawnMoment],
    cycles: Sequence[tuple[float, str]],
    distances: Sequence[float],
) -> None:
    times = np.array([m.time for m in moments]) / 1000
    upper = drawn.add_subplot(grid[2, :])
    upper.plot(times, [m.perceptual for m in moments], color=COLORS[0], label="perceptual field, max")
    upper.plot(times, [m.satisfaction for m in moments], color=COLORS[1], label="CoS field, max")
    lower = drawn.add_subplot(grid[3, :], sharex=upper)
    styles = ("-", "-", "--", "--")
    shades = (COLORS[1], COLORS[2], COLORS[0], COLORS[4])
    for n, name in enumerate(CUES):
        lower.plot(times, [m.nodes[n] for m in moments], styles[n], color=shades[n], lw=0.8, label=name)
    far = lower.twinx()
    far.plot(times, 100 * np.array(distances), color=GREY, lw=1.0)
    far.set_ylabel("tool to object (cm)", color=GREY, fontsize=6)
    for at in (upper, lower):
        at.axhline(0, color=COLOR.threshold, lw=0.5, ls=":")
        at.set_ylabel("activation", fontsize=6)
        at.legend(fontsize=5, loc="lower right", bbox_to_anchor=(1, 0.98), ncols=4, frameon=False)
        at.set_xlim(times[0], times[-1])
        for start, name in cycles:
            at.axvline(start, color=COLOR.moment, lw=0.6)
            if at is upper:
                at.text(start, at.get_ylim()[0], f" {name}", fontsize=6, va="bottom")
    upper.tick_params(labelbottom=False)
    lower.set_xlabel("time (s)", fontsize=6)
