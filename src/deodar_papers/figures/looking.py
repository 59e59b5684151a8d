"""A run of the looking architecture: learning curves, motor variables during gazes, and the learned map."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from deodar.architectures.looking import PIXELS, REACH
from deodar.figures._style import AMOUNTS, COLOR, COLORS, DOUBLE, MEDIUM, THIN, style
from deodar.figures._style import figure as sheet

HEIGHT = 5.6
CENTRE = (PIXELS - 1) / 2
LINE = 0.07
"""Least distance of two names beside the curves, as a share."""

ARROWS = 4
"""Every fourth sample of the retina has an arrow."""


@dataclass(frozen=True)
class LearningCurve:
    """Share of near gazes: its name, numbers of gazes, means over seeds, and the range over seeds."""

    name: str
    gazes: tuple[int, ...]
    mean: tuple[float, ...]
    span: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Course:
    """Time courses: a title, the time between samples (s), and as columns pan and tilt (servo units), column
    and row of the target (pixels), and the commanded shift along pan and tilt.
    """

    title: str
    step: float
    values: np.ndarray


@dataclass(frozen=True)
class LearnedMap:
    """The map: summed over row and tilt (pan, column), over column and pan (tilt, row), and the mean shift of
    each sample of the retina as a share of the largest (column, row, 2).
    """

    pan: np.ndarray
    tilt: np.ndarray
    shifts: np.ndarray


def looking_figure(
    curves: Sequence[LearningCurve], course: tuple[Course, Course], learned: LearnedMap
) -> Figure:
    """Draw learning curves and the mean shifts above, then the motor variables, then both projections."""
    with style():
        out: Any = sheet(DOUBLE, HEIGHT)
        above, middle, below = out.subfigures(3, 1, height_ratios=[1.1, 0.9, 1.0])
        left, right = above.subplots(1, 2, width_ratios=[1.5, 1.0])
        _draw_curves(left, curves)
        _draw_shifts(right, learned.shifts)
        places: Any = middle.subplots(1, 2, sharey=True)
        for place, one in zip(places, course, strict=True):
            _draw_course(place, one)
        names = (("pan", "column", learned.pan), ("tilt", "row", learned.tilt))
        places = below.subplots(1, 2)
        for place, (motor, retina, values) in zip(places, names, strict=True):
            _draw_projection(place, motor, retina, values)
        return out


def _draw_curves(place: Any, curves: Sequence[LearningCurve]) -> None:
    heights = _apart([curve.mean[-1] for curve in curves], LINE)
    for k, curve in enumerate(curves):
        low, high = zip(*curve.span, strict=True)
        place.fill_between(curve.gazes, low, high, color=COLORS[k], alpha=0.18, linewidth=0)
        place.plot(curve.gazes, curve.mean, color=COLORS[k], linewidth=MEDIUM, marker="o", markersize=2.5)
        place.annotate(
            curve.name,
            (curve.gazes[-1], heights[k]),
            xytext=(3, 0),
            textcoords="offset points",
            color=COLORS[k],
            va="center",
        )
    last = max(curve.gazes[-1] for curve in curves)
    place.set(xlim=(0, 1.55 * last), ylim=(0, 1.02), xlabel="gazes", ylabel="gazes within 12 pixels")
    place.set_xticks([t for t in place.get_xticks() if 0 <= t <= last])


def _apart(values: Sequence[float], least: float) -> list[float]:
    """Return heights of labels at least so far apart, in the order of the values; the lowest one stays."""
    out = [float(v) for v in values]
    order = sorted(range(len(out)), key=out.__getitem__)
    for below, above in itertools.pairwise(order):
        out[above] = max(out[above], out[below] + least)
    return out


def _draw_shifts(place: Any, shifts: np.ndarray) -> None:
    n = shifts.shape[0]
    at = (np.arange(n) + 0.5) * PIXELS / n - 0.5
    some = slice(ARROWS // 2, None, ARROWS)
    x, y = np.meshgrid(at[some], at[some], indexing="ij")
    u, v = shifts[some, some, 0], shifts[some, some, 1]
    place.quiver(x, y, u, v, color=COLOR.activation, angles="xy", scale=6.0, width=0.006)
    place.plot([CENTRE], [CENTRE], "+", color=COLOR.goal)
    place.set(
        xlim=(0, PIXELS),
        ylim=(0, PIXELS),
        aspect="equal",
        xlabel="column",
        ylabel="row",
        title="learned shift",
    )


def _draw_course(place: Any, course: Course) -> None:
    time = np.arange(len(course.values)) * course.step
    for column, name, color in ((0, "pan", COLORS[0]), (1, "tilt", COLORS[1])):
        place.plot(time, course.values[:, column], color=color, linewidth=MEDIUM, label=name)
    place.set(xlabel="time (s)", title=course.title)
    place.set_ylabel("servo position")
    twin = place.twinx()
    away = np.hypot(*(course.values[:, 2:4] - CENTRE).T)
    twin.plot(time, away, color=COLOR.threshold, linewidth=THIN, label="distance of the target (px)")
    twin.set(ylim=(0, 260), yticks=[0, 60], ylabel="target (px)")
    lines = [*place.get_lines(), *twin.get_lines()]
    if course.title.startswith("first"):
        place.legend(lines, [line.get_label() for line in lines], loc="upper left", ncols=3)


def _draw_projection(place: Any, motor: str, retina: str, values: np.ndarray) -> None:
    place.imshow(
        values,
        origin="lower",
        aspect="auto",
        cmap=AMOUNTS,
        extent=(-0.5, PIXELS - 0.5, -REACH, REACH),
        interpolation="nearest",
    )
    place.set(xlabel=retina, ylabel=f"shift along {motor}")
