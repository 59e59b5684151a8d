"""A picture of the camera, the hues of its columns, and the colour-space field that they drive."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Colormap
from matplotlib.figure import Figure

from deodar.figures._style import ACTIVATION, AMOUNTS, BLACK, SINGLE, THICK, style
from deodar.figures._style import figure as sheet

RANGE = 3.0
"""Activation at both ends of the colour scale: the ridge then differs from the peak and from the rest."""

DEGREES = 360.0
"""Whole circle of hue."""


@dataclass(frozen=True)
class ColourPerception:
    """What the camera sees at a moment, and what the colour-space field makes of it.

    Attributes:
        picture: red, green and blue from 0 to 1, (columns, rows, 3), the first column at the left and the
            first row at the top.
        shares: amount of each hue in each column, (columns, hues), of a coarser grid.
        activation: activation of the colour-space field on that grid.
        columns, hues: ends of both axes, in pixels from the middle and in samples of hue.
        wanted: hue of the peak of the action field, in samples.
    """

    picture: np.ndarray
    shares: np.ndarray
    activation: np.ndarray
    columns: tuple[float, float]
    hues: tuple[float, float]
    wanted: float


def perception_figure(result: ColourPerception) -> Figure:
    """Draw the colour-space field above the amounts of hues above the picture, with one axis of columns.

    A line surrounds what is above threshold; triangles mark the hue that the action field activates.
    """
    r = result
    with style():
        out = sheet(SINGLE * 1.35, 6.4)
        a, b, c = out.subplots(3, 1, sharex=True)
        image = _over_hue(a, r, r.activation, ACTIVATION, (-RANGE, RANGE))
        out.colorbar(image, ax=a, label="activation", pad=0.02, aspect=14, extend="min")
        if (r.activation > 0).any():
            x = np.linspace(*r.columns, r.activation.shape[0])
            y = _degrees(r, np.linspace(*r.hues, r.activation.shape[1]))
            a.contour(x, y, r.activation.T, [0.0], colors=BLACK, linewidths=THICK)
        a.set_title("A  colour-space field", loc="left")
        image = _over_hue(b, r, r.shares, AMOUNTS, (0.0, 1.0))
        out.colorbar(image, ax=b, label="amount", pad=0.02, aspect=14)
        b.set_title("B  hues of each column of the picture", loc="left")
        c.imshow(
            np.clip(np.swapaxes(r.picture, 0, 1), 0.0, 1.0),
            extent=(*r.columns, r.picture.shape[1], 0),
            aspect="auto",
            origin="upper",
        )
        c.set_ylim(r.picture.shape[1], 0)
        c.set_ylabel("row (px)")
        c.set_xlabel("column (px)")
        c.set_title("C  picture of the camera", loc="left")
    return out


def _over_hue(
    axes: Axes, r: ColourPerception, values: np.ndarray, colours: Colormap, limits: tuple[float, float]
):
    image = axes.imshow(
        values.T,
        extent=(*r.columns, 0.0, DEGREES),
        origin="lower",
        cmap=colours,
        vmin=limits[0],
        vmax=limits[1],
        aspect="auto",
    )
    for side, mark in ((0.0, ">"), (1.0, "<")):
        axes.plot(
            side,
            float(_degrees(r, np.asarray(r.wanted))),
            mark,
            color=BLACK,
            transform=axes.get_yaxis_transform(),
            clip_on=False,
            markersize=4,
        )
    axes.set_yticks(np.arange(0.0, DEGREES + 1.0, 60.0))
    axes.set_ylabel("hue (degrees)")
    return image


def _degrees(r: ColourPerception, hue: np.ndarray) -> np.ndarray:
    """Return degrees of hue for samples of hue."""
    low, high = r.hues
    return (hue - low) / (high - low) * DEGREES
