"""Pictures with colour cues: one row for each cue, read from left to right."""

from __future__ import annotations

import colorsys
from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon, Rectangle

from deodar.architectures.saliency import CUE_AT
from deodar.figures import _color
from deodar.figures._style import COLOR, COLORS, MEDIUM, SMALL, style
from deodar.figures._style import figure as sheet
from deodar.worlds.picture import Picture

CuePlace = tuple[float, float]

ROW = 1.75
WIDTH, COLUMNS = 9.6, 4
EXPLAINED = (
    "black line: threshold\narrow: cued hue\ncircle: peak\ndotted outlines: right\n  places, marked by a"
    " person\ndotted lines: spatial peak"
)
LOWEST, HIGHEST = -6.0, 4.0
"""Activation at the ends of the colour scale, equal in all pictures, for comparison."""


class DrawnCue(Protocol):
    """A cued hue in degrees, and the outlines of the regions that a person marked, in pixels."""

    @property
    def hue(self) -> float: ...
    @property
    def name(self) -> str: ...
    @property
    def expect(self) -> str: ...
    @property
    def outlines(self) -> Sequence[Sequence[CuePlace]]: ...


class DrawnOutcome(Protocol):
    """The peaks after a cue, and the end of the motor variable; `spatial` in scene units, else in pixels."""

    @property
    def cue(self) -> DrawnCue: ...
    @property
    def places(self) -> Sequence[CuePlace]: ...
    @property
    def spatial(self) -> Sequence[CuePlace]: ...
    @property
    def motor(self) -> CuePlace: ...


class DrawnScene(Protocol):
    """A picture and its name."""

    @property
    def name(self) -> str: ...
    @property
    def picture(self) -> Picture: ...


class DrawnScenes(Protocol):
    """A scene with the outcomes of its cues."""

    @property
    def scene(self) -> DrawnScene: ...
    @property
    def outcomes(self) -> Sequence[DrawnOutcome]: ...


class DrawnResult(DrawnScenes, Protocol):
    """A scene that was run: its record, and the corners of the spatial field in pixels."""

    @property
    def record(self) -> xarray.Dataset: ...
    @property
    def corners(self) -> tuple[float, float, float, float]: ...


def cues_figure(result: DrawnResult) -> Figure:
    """Photograph with the selected place, colour-space field, spatial field, motor variable over time."""
    rows = len(result.outcomes) + 1
    with style():
        out = sheet(WIDTH, ROW * rows + 0.5)
        grid = out.subplots(rows, 4, squeeze=False, width_ratios=(1.15, 1.0, 1.1, 1.35))
        titles = (
            "picture, selected place",
            "colour-space field (seen along y)",
            "spatial field",
            "motor variable",
        )
        for axes, title in zip(grid[0], titles, strict=True):
            axes.set_title(title, fontweight="bold")
        before = int(np.searchsorted(result.record["time"].values, CUE_AT)) - 1
        image: Any = None
        _photograph(grid[0, 0], result, None)
        _label(grid[0, 0], "no cue", None)
        image = _colour_space(grid[0, 1], result, 0, before)
        _spatial(grid[0, 2], result, 0, before)
        grid[0, 3].axis("off")
        for row, outcome in enumerate(result.outcomes, 1):
            k = row - 1
            _photograph(grid[row, 0], result, outcome)
            _label(grid[row, 0], f"cue: {outcome.cue.name or 'hue'} ({outcome.cue.hue:g}°)", outcome.cue.hue)
            _colour_space(grid[row, 1], result, k, -1, outcome.cue.hue)
            _spatial(grid[row, 2], result, k, -1)
            _motor(grid[row, 3], result, k, outcome, last=row == rows - 1)
        bar = out.colorbar(image, cax=grid[0, 3].inset_axes((0.02, 0.12, 0.045, 0.8)))
        bar.set_label("activation (0: threshold)")
        bar.ax.axhline(0, color="black", linewidth=MEDIUM)
        legend = grid[0, 3].text(
            0.34, 0.92, EXPLAINED, va="top", fontsize=SMALL, linespacing=1.6, transform=grid[0, 3].transAxes
        )
        legend.set_in_layout(False)
    return out


def overview(results: Sequence[DrawnScenes]) -> Figure:
    """All photographs with the selections by cues of present colours: marked region, peaks, end of the motor
    variable.
    """
    shown = [(r, o) for r in results for o in r.outcomes if o.cue.expect != "absent"]
    rows = -(-len(shown) // COLUMNS)
    with style():
        out = sheet(WIDTH, 2.1 * rows)
        grid = out.subplots(rows, COLUMNS, squeeze=False)
        for axes in grid.flat:
            axes.axis("off")
        for axes, (result, outcome) in zip(grid.flat, shown, strict=False):
            _photograph(axes, result, outcome)
            axes.plot(*outcome.motor, marker="+", markersize=11, markeredgewidth=2.6, color="black")
            axes.plot(*outcome.motor, marker="+", markersize=10, markeredgewidth=1.2, color="white")
            width, height = result.scene.picture.size
            axes.set_xlim(0, width)
            axes.set_ylim(height, 0)
            axes.set_title(f"{result.scene.name}, {outcome.cue.name or 'hue'} ({outcome.cue.hue:g}°)")
    return out


def _label(axes: Axes, text: str, hue: float | None) -> None:
    axes.set_ylabel(text, labelpad=16)
    if hue is not None:
        colour = colorsys.hsv_to_rgb(hue / 360, 0.9, 0.85)
        axes.add_patch(
            Rectangle((-0.115, 0.0), 0.06, 1.0, transform=axes.transAxes, color=colour, clip_on=False)
        )


def _photograph(axes: Axes, result: DrawnScenes, outcome: DrawnOutcome | None) -> None:
    axes.imshow(result.scene.picture.pixels, origin="upper", interpolation="antialiased")
    axes.set_anchor("N")
    axes.set_xticks([])
    axes.set_yticks([])
    if outcome is None:
        return
    for outline in outcome.cue.outlines:
        axes.add_patch(
            Polygon(outline, closed=True, fill=False, edgecolor="white", linewidth=0.8, linestyle=":")
        )
    size = max(result.scene.picture.size)
    for place in outcome.places:
        axes.add_patch(Circle(place, 0.06 * size, fill=False, edgecolor="black", linewidth=2.6))
        axes.add_patch(Circle(place, 0.06 * size, fill=False, edgecolor="white", linewidth=1.4))
    if not outcome.places:
        axes.text(
            0.5,
            0.04,
            "nothing selected",
            transform=axes.transAxes,
            ha="center",
            va="bottom",
            color="white",
            bbox={"color": "black", "alpha": 0.6, "pad": 1.5},
        )


def _colour_space(axes: Axes, result: DrawnResult, k: int, at: int, hue: float | None = None) -> Any:
    seen = result.record["seen.output"].isel({"cue.center": k, "time": at}).values
    x, hues = result.record["x"].values, result.record["hue"].values
    step = hues[1] - hues[0]
    extent = (x[0] - 1, x[-1] + 1, hues[0] - step / 2, hues[-1] + step / 2)
    image = axes.imshow(seen.T, origin="lower", aspect="auto", extent=extent, **_scale())
    axes.contour(x, hues, seen.T, levels=[0.0], colors="black", linewidths=MEDIUM)
    axes.set_yticks([0, 120, 240, 360])
    axes.set_ylim(extent[2], extent[3])
    axes.set_ylabel("hue (deg)")
    axes.set_xlabel("x")
    if hue is not None:
        axes.annotate(
            "",
            xy=(1.0, hue),
            xytext=(1.09, hue),
            xycoords=("axes fraction", "data"),
            arrowprops={"arrowstyle": "-|>", "lw": 0.8},
        )
    return image


def _scale() -> dict[str, Any]:
    """The colours of activation, white at the threshold."""
    colors = _color.scale([np.array([LOWEST, HIGHEST])], 0.0)
    return {"cmap": colors.cmap, "norm": colors.norm}


def _spatial(axes: Axes, result: DrawnResult, k: int, at: int) -> None:
    u = result.record["spatial.activation"].isel({"cue.center": k, "time": at}).values
    width, height = result.scene.picture.size
    axes.imshow(
        u.T,
        origin="upper",
        extent=result.corners,
        **_scale(),
        interpolation="nearest",
    )
    axes.set_anchor("N")
    axes.set_xlim(0, width)
    axes.set_ylim(height, 0)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.set_xlabel("columns and rows of the picture" if at == -1 and k == len(result.outcomes) - 1 else "")


def _motor(axes: Axes, result: DrawnResult, k: int, outcome: DrawnOutcome, last: bool) -> None:
    time = result.record["time"].values / 1000
    for name, words, color, place in (("pan", "x", COLORS[0], 0), ("tilt", "y", COLORS[1], 1)):
        values = result.record[f"{name}.output"].isel({"cue.center": k}).values
        axes.plot(time, values, color=color, label=f"{name} ({words})")
        for peak in outcome.spatial:
            axes.axhline(peak[place], color=color, linewidth=0.7, linestyle=":")
    axes.axvline(CUE_AT / 1000, color=COLOR.moment, linewidth=MEDIUM)
    axes.text(CUE_AT / 1000 + 0.05, 78, "cue", va="top", color=COLOR.threshold, fontsize=SMALL)
    axes.set_ylim(0, 80)
    axes.set_ylabel("scene units")
    if last:
        axes.set_xlabel("time (s)")
    axes.legend(loc="lower right", ncols=2)
