"""Figures 8 and 11 of the paper, from a run of the demonstration."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from deodar.architectures.pointing import CUES
from deodar.figures._style import COLOR, COLORS, DOUBLE, GREY, style
from deodar.figures._style import figure as sheet
from deodar.papers.pointing.narrative import Pointed, discs, distance, plane

LOWEST, HIGHEST = -5.0, 4.0
"""Activation at the ends of the colour scale."""


def figure(result: Pointed) -> Figure:
    """Draw the pictures and maps of the moments (figure 8), and below them the time courses (figure 11)."""
    with style():
        count = len(result.views)
        drawn = sheet(DOUBLE, 5.0)
        grid = drawn.add_gridspec(4, count, height_ratios=(0.75, 0.85, 1.3, 1.3))
        x, y = plane()
        extent = (x.lower - x.step / 2, x.upper + x.step / 2, y.lower - y.step / 2, y.upper + y.step / 2)
        shown = None
        for k, view in enumerate(result.views):
            at = drawn.add_subplot(grid[0, k])
            at.imshow(view.picture)
            at.set_title(view.title, fontsize=6)
            at.set_axis_off()
            at = drawn.add_subplot(grid[1, k])
            shown = at.imshow(
                view.map.T, origin="lower", extent=extent, vmin=LOWEST, vmax=HIGHEST, cmap="RdBu_r"
            )
            for disc in discs():
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
        _courses(drawn, grid, result)
        return drawn


def _courses(drawn: Figure, grid: object, result: Pointed) -> None:
    times = np.array([m.time for m in result.moments]) / 1000
    upper = drawn.add_subplot(grid[2, :])  # type: ignore[index]
    upper.plot(times, [m.perceptual for m in result.moments], color=COLORS[0], label="perceptual field, max")
    upper.plot(times, [m.satisfaction for m in result.moments], color=COLORS[1], label="CoS field, max")
    lower = drawn.add_subplot(grid[3, :], sharex=upper)  # type: ignore[index]
    styles = ("-", "-", "--", "--")
    shades = (COLORS[1], COLORS[2], COLORS[0], COLORS[4])
    for n, name in enumerate(CUES):
        lower.plot(
            times, [m.nodes[n] for m in result.moments], styles[n], color=shades[n], lw=0.8, label=name
        )
    far = lower.twinx()
    far.plot(times, 100 * np.array(distance(result)), color=GREY, lw=1.0)
    far.set_ylabel("tool to object (cm)", color=GREY, fontsize=6)
    for at in (upper, lower):
        at.axhline(0, color=COLOR.threshold, lw=0.5, ls=":")
        at.set_ylabel("activation", fontsize=6)
        at.legend(fontsize=5, loc="lower right", bbox_to_anchor=(1, 0.98), ncols=4, frameon=False)
        at.set_xlim(times[0], times[-1])
        for start, pair in zip(result.starts, result.asked, strict=True):
            at.axvline(start, color=COLOR.moment, lw=0.6)
            if at is upper:
                at.text(start, at.get_ylim()[0], " " + " ".join(pair), fontsize=6, va="bottom")
    upper.tick_params(labelbottom=False)
    lower.set_xlabel("time (s)", fontsize=6)
