"""Bifurcation diagrams: steady states over a parameter, stable and unstable, with their bifurcations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from deodar.elements.field import Field
from deodar.errors import FigureError
from deodar.figures import _style
from deodar.figures._style import COLOR

if TYPE_CHECKING:
    from deodar.analysis.continuation.bifurcation import Bifurcation
    from deodar.analysis.continuation.branch import SteadyBranch

MARKS = {"fold": "o", "branch point": "s", "Hopf": "D"}


def bifurcation_diagram(*branches: SteadyBranch, shown: str = "") -> Figure:
    """Draw branches of steady states: the highest value of a port over the parameter.

    Stable states are a solid line, unstable ones dashed. Folds are circles, branch points squares, Hopf
    points diamonds; those that only the grid makes are open and small.

    Args:
        branches: the branches, over one parameter.
        shown: the port; "": the activation of the first field.

    Raises:
        FigureError: there is no branch, or they have different parameters.
    """
    if not branches:
        raise FigureError("there is no branch to draw", fix="Give what dd.continuation returned")
    parameters = sorted({branch.parameter for branch in branches})
    if len(parameters) > 1:
        raise FigureError(f"the branches have different parameters: {', '.join(parameters)}")
    port = shown or _first_field(branches[0])
    with _style.style():
        figure = _style.figure(1.3 * _style.SINGLE, 2.8)
        axes = figure.subplots()
        for branch in branches:
            _branch(axes, branch, port)
        axes.plot([], [], color=COLOR.activation, label="stable")
        axes.plot([], [], "--", color=COLOR.falling, linewidth=0.9, label="unstable")
        axes.set_xlabel(parameters[0])
        axes.set_ylabel(f"highest {port}")
        axes.margins(x=0.2, y=0.12)
        for branch in branches:
            _marks(axes, branch, port)
        axes.legend(loc="best")
        return figure


def _first_field(branch: SteadyBranch) -> str:
    for entry in branch.line.right_hand_side.doc.entries:
        if isinstance(entry.element, Field):
            return f"{entry.path}.activation"
    raise FigureError("the model has no field", fix="Name what is drawn: shown='NAME.output'")


def _branch(axes: Axes, branch: SteadyBranch, port: str) -> None:
    """Draw the parts of a branch between changes of stability, each up to the bifurcation at its end."""
    heights = _heights(branch.read(port))
    x, y, stable = list(branch.values), list(heights), list(branch.stable)
    for b in sorted(branch.bifurcations, key=lambda b: b.index, reverse=True):
        height = _height(b, port)
        x[b.index + 1 : b.index + 1] = [b.value, b.value]
        y[b.index + 1 : b.index + 1] = [height, height]
        stable[b.index + 1 : b.index + 1] = [bool(branch.stable[b.index]), bool(branch.stable[b.index + 1])]
    begin = 0
    for k in range(1, len(x) + 1):
        if k == len(x) or stable[k] != stable[begin]:
            drawn = axes.plot(x[begin:k], y[begin:k], color=COLOR.activation)[0]
            if not stable[begin]:
                drawn.set(color=COLOR.falling, linestyle="--", linewidth=0.9)
            begin = k


def _marks(axes: Axes, branch: SteadyBranch, port: str) -> None:
    for b in branch.bifurcations:
        height, made = _height(b, port), bool(b.by_grid)
        mark = axes.plot(b.value, height, MARKS[b.kind], color=COLOR.threshold, zorder=4)[0]
        mark.set_markersize(2.2 if made else 4.0)
        mark.set_markerfacecolor("white" if made else COLOR.threshold)
        if made:
            continue
        # beside a fold on the side without states; below other points
        behind = branch.values[b.index : b.index + 2].mean() > b.value
        left = bool(behind) if b.kind == "fold" else b.kind == "branch point"
        axes.annotate(
            f"{b.instability or b.kind}\n{b.value:.4g}",
            (b.value, height),
            xytext=(-5 if left else 5, 0 if b.kind == "fold" else -3),
            textcoords="offset points",
            ha="right" if left else "left",
            va="center" if b.kind == "fold" else "top",
            fontsize=_style.SMALL,
        )


def _height(b: Bifurcation, port: str) -> float:
    line = b.line
    z = line.point(b.state, b.value)
    return float(np.max(line.right_hand_side.read(port, b.state, line.all_parameters(z))))


def _heights(values: np.ndarray) -> np.ndarray:
    return values.reshape(len(values), -1).max(axis=1)
