"""The regime of a field: hysteresis over its input, its patterns, and phase plots of nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from deodar.figures import _style
from deodar.figures._style import COLOR
from deodar.numerics.axes import Axis

if TYPE_CHECKING:
    from deodar.analysis.phase import Phase
    from deodar.analysis.regimes import Regimes


def regimes_figure(found: Regimes) -> Figure:
    """Draw the hysteresis of a field over its input, and its patterns (for a node: its phase plots)."""
    with _style.style():
        figure = _style.figure(_style.DOUBLE, 2.9)
        left, right = figure.subplots(1, 2)
        _hysteresis(left, found)
        if found.isolated.axes:
            _profiles(right, found)
        else:
            _phases(right, found)
        return figure


def phase_figure(shown: Phase, time_unit: str = "ms") -> Figure:
    """Draw the phase plot of a node."""
    with _style.style():
        figure = _style.figure(_style.SINGLE, 2.8)
        _phase_axes(figure.subplots(), [(shown, COLOR.activation, f"input {shown.input:.3g}")], time_unit)
        return figure


# ----------------------------------------------------------------------------------------------------- panels


def _hysteresis(axes: Axes, found: Regimes) -> None:
    swept, threshold = found.ramp, found.isolated.threshold
    axes.axhline(threshold, **_style.THRESHOLD_LINE)
    for branch, color, label, style in (
        (swept.down, COLOR.falling, "input falls", "-"),
        (swept.up, COLOR.activation, "input grows", "--"),
    ):
        axes.plot(swept.values, branch.activation, style, color=color, label=label)
    axes.margins(x=0.02, y=0.12)
    bottom, top = axes.get_ylim()
    axes.set_ylim(bottom, top + 0.12 * (top - bottom))
    up, down = found.detection, found.reverse
    marks = [
        (up, "detection", COLOR.activation, "center"),
        (down, "reverse detection", COLOR.falling, "center"),
    ]
    if found.graded:  # no instability: one mark, where activation crosses the threshold
        down, marks = None, [(up, "crosses the threshold", COLOR.activation, "center")]
    near = up is not None and down is not None and abs(up - down) < 0.35 * np.ptp(swept.values)
    for value, label, color, align in marks:
        if value is None:
            continue
        if near and up is not None and down is not None and up != down:
            align = "left" if label == "detection" else "right"
        elif value < swept.values[0] + 0.2 * np.ptp(swept.values):
            align = "left"  # a centred label would cover the labels of the axis
        axes.axvline(value, color=color, linewidth=0.7, linestyle=":")
        axes.annotate(
            f"{label}\n{value:.3g}",
            (value, 1.0),
            xycoords=("data", "axes fraction"),
            ha=align,
            va="top",
            color=color,
            fontsize=_style.SMALL,
            xytext=({"left": 3, "right": -3}.get(align, 0), 0),
            textcoords="offset points",
            backgroundcolor=(1, 1, 1, 0.8),
        )
    axes.set_xlabel("strength of the localised input" if found.isolated.axes else "input")
    axes.set_ylabel("highest activation" if found.isolated.axes else "activation")
    axes.set_title("a", loc="left", fontweight="bold")
    axes.legend(loc="lower right")


def _profiles(axes: Axes, found: Regimes) -> None:
    isolated = found.isolated
    axis = isolated.axes[0]
    axes.axhline(isolated.threshold, **_style.THRESHOLD_LINE)
    _profile(axes, found, found.rest, COLOR.interval, ":", "at rest")
    if found.above is not None:
        _profile(axes, found, found.above, COLOR.activation, "-", "just above detection")
    if found.memory is not None:
        _profile(axes, found, found.memory.activation, COLOR.falling, "--", "after the input is gone")
    axes.set_xlabel(_label(axis))
    others = [
        f"{a.name} = {c:g}{' ' + a.unit if a.unit else ''}"
        for a, c in zip(isolated.axes[1:], isolated.center[1:], strict=True)
    ]
    axes.set_ylabel("activation" + (f" at {', '.join(others)}" if others else ""))
    axes.margins(x=0.0, y=0.08)
    bottom, top = axes.get_ylim()
    axes.set_ylim(bottom, top + 0.35 * (top - bottom))
    axes.set_title("b", loc="left", fontweight="bold")
    axes.legend(loc="upper right")


def _profile(axes: Axes, found: Regimes, pattern: np.ndarray, color: str, style: str, label: str) -> None:
    """Draw the pattern along the first axis, through the centre of the input on the others."""
    cut = pattern[(slice(None), *(a.samples // 2 for a in found.isolated.axes[1:]))]
    axes.plot(found.isolated.axes[0].points, cut, style, color=color, label=label)


def _phases(axes: Axes, found: Regimes) -> None:
    # start-up time: it brings the engine, other figures do not need it
    from deodar.analysis.phase import phase

    field = found.isolated.field
    inputs = [(0.0, COLOR.interval, "no input")]
    marks = [
        ("detection", found.detection, COLOR.activation),
        ("reverse detection", found.reverse, COLOR.falling),
    ]
    marks = [("the threshold", found.detection, COLOR.activation)] if found.graded else marks
    inputs += [
        (value, color, f"at {label}, input {value:.3g}") for label, value, color in marks if value is not None
    ]
    each = [phase(field, value) for value, _, _ in inputs]
    span = (min(p.u[0] for p in each), max(p.u[-1] for p in each))
    plots = [(phase(field, value, span), color, label) for value, color, label in inputs]
    _phase_axes(axes, plots, found.isolated.time_unit)
    axes.set_title("b", loc="left", fontweight="bold")


def _phase_axes(axes: Axes, plots: list[tuple[Phase, str, str]], time_unit: str) -> None:
    axes.axhline(0.0, color=COLOR.moment, linewidth=0.6)
    for shown, color, label in plots:
        axes.plot(shown.u, shown.rate, color=color, label=label)
        for p in shown.fixed_points:
            axes.plot(
                p.u,
                0.0,
                "o",
                markersize=4.5,
                color=color,
                markerfacecolor=color if p.stable else "white",
                zorder=3,
            )
    axes.plot([], [], "o", markersize=4.5, color=COLOR.moment, label="stable")
    axes.plot([], [], "o", markersize=4.5, color=COLOR.moment, markerfacecolor="white", label="unstable")
    axes.set_xlabel("activation u")
    axes.set_ylabel(
        f"du/dt (1/{time_unit})"
        if time_unit.isalpha() and time_unit != "abstract"
        else "du/dt (per time unit)"
    )
    axes.margins(x=0.0, y=0.08)
    bottom, top = axes.get_ylim()
    axes.set_ylim(bottom, top + 0.45 * (top - bottom))
    axes.legend(loc="upper right")


def _label(axis: Axis) -> str:
    return f"{axis.name} ({axis.unit})" if axis.unit else axis.name
