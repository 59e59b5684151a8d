"""The style of all figures: widths of a journal's columns, sizes of type and lines, meanings of colours.

docs/drawing.md has the same convention as a table.
"""

from __future__ import annotations

import warnings
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, cast

import matplotlib
from matplotlib import font_manager
from matplotlib.colors import Colormap, LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.rcsetup import cycler

from deodar.diagrams.shown_figure import ShownFigure
from deodar.errors import did_you_mean

SINGLE = 3.5
DOUBLE = 7.2
"""Widths of figures over one and two columns, in inches."""

PANEL = 2.1
"""Height of a panel across one column, in inches."""

DOTS = 300
"""Dots per inch of a PNG."""

COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""Colours of lines: Okabe and Ito's set, which colour-blind readers can distinguish."""

ORDERED = "viridis"
"""The colours of lines in an order, such as those of a sweep."""

BLUE, VERMILION, GREEN, _PURPLE, ORANGE, _SKY, BLACK = COLORS
GREY = "#999999"


@dataclass(frozen=True)
class Palette:
    """The meaning of colours, in all figures.

    Attributes:
        activation, output, input, interaction: lines of a field or node, on the page of the studio too;
            `input` also shades the times of an input.
        excitation, inhibition, mixed: signs of couplings, as in pictures of models, and of their inputs.
        falling: a branch or state that is reached from above; `activation` is reached from below.
        threshold: the lines at the threshold and at the resting level, and reference lines.
        wall, obstacle, obstacle_edge, start, goal: parts of an arena.
        window: shading of a time window.
        moment: a line at one time.
        claim, baseline, interval: the tested method, the baselines, 95 % intervals.
    """

    activation: str = "#0b6cb3"
    output: str = "#00795a"
    input: str = "#96620a"
    interaction: str = "#a3487f"
    excitation: str = "#333333"
    inhibition: str = VERMILION
    mixed: str = "#6a3d9a"
    falling: str = VERMILION
    threshold: str = "#555555"
    wall: str = "#bbbbbb"
    obstacle: str = "#e0c8a0"
    obstacle_edge: str = "#8a6d3b"
    start: str = "#222222"
    goal: str = GREEN
    window: str = "#dddddd"
    moment: str = GREY
    claim: str = BLUE
    baseline: str = ORANGE
    interval: str = BLACK


COLOR = Palette()

PORTS = ("activation", "output", "input", "interaction")
"""The ports of a field that have a colour of their own."""


def port_color(variable: str) -> str:
    """Return the colour of the line of a variable, by the name of its port."""
    port = variable.rsplit(".", 1)[-1]
    return getattr(COLOR, port) if port in PORTS else COLORS[0]


ROUTES = (GREEN, BLUE, VERMILION, GREY)
"""Colours of alternatives of which a run takes one; the last colour: none of them."""

THIN, MEDIUM, THICK = 0.5, 0.8, 1.1
"""Widths of lines in points: one of many trials, one of several lines, a mean or single line."""

DOT, CROSS = 2.5, 6.0
"""Sizes of the marks of a start and a goal, in points."""

SMALL = 6.5
"""Size of type inside a panel, in points."""

THRESHOLD = COLOR.threshold
THRESHOLD_LINE: dict[str, Any] = {
    "color": COLOR.threshold,
    "linewidth": 0.7,
    "linestyle": (0, (4, 3)),
    "zorder": 0.5,
}
"""The line at a threshold: thin, dashed, below the data."""

OUTLINE: dict[str, Any] = {
    "facecolor": "none",
    "edgecolor": BLACK,
    "linewidth": 0.7,
    "linestyle": "--",
    "zorder": 2,
}
"""The outline of an obstacle that appears and disappears."""

BELOW = ("#ffffff", "#d3e6f5", "#93c1e6", "#4e93cb", "#21659f", "#0e4070", "#08294b")
ABOVE = ("#ffffff", "#ffe3bd", "#ffb968", "#f98328", "#dd4d0d", "#a02f06", "#641a02")
"""Colours of activation at equal distances from the threshold, which is white. Lightness falls on both sides
(L* from 100 to 16 and to 22), so that the map reads without hues too.
"""

SUNK = "#ededef"
"""The colour of nothing, in maps of amounts."""


def amounts(color: str) -> Colormap:
    """Return the map of amounts without a threshold: one hue, from the colour of nothing to a line's."""
    return LinearSegmentedColormap.from_list("amounts", [SUNK, color])


ACTIVATION: Colormap = LinearSegmentedColormap.from_list("activation", [*BELOW[::-1], *ABOVE[1:]], 257)
"""Activation, the threshold in the middle; 257 colours, so that one of them is white."""

AMOUNTS = amounts(COLOR.interaction)
"""Weights, traces and other amounts that no port has."""

RC: dict[str, Any] = {
    "axes.prop_cycle": cycler(color=COLORS),
    "lines.markersize": 3.5,
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Arial", "Helvetica", "sans-serif"],
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.titlesize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "legend.handlelength": 1.4,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.unicode_minus": True,
    "axes.formatter.useoffset": False,
    "lines.linewidth": THICK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "image.interpolation": "nearest",
    "image.origin": "lower",
    "svg.fonttype": "none",  # text as text, so that it can be edited and searched
    "svg.hashsalt": "deodar",  # equal figures give equal files
    "pdf.fonttype": 42,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}
"""Type, lines and frames, also for figures of users."""

TYPE = (
    "font.size",
    "axes.labelsize",
    "axes.titlesize",
    "xtick.labelsize",
    "ytick.labelsize",
    "legend.fontsize",
)
"""The settings that are sizes of type."""

TIGHT: dict[str, Any] = {**RC, "axes.xmargin": 0.0, "text.parse_math": False}
"""`RC` without margins, and with names as plain text instead of mathematical notation."""


def type_of(size: float | None = None, font: str | None = None) -> dict[str, Any]:
    """Return the settings for a size of type in points, which numbers at ticks have less one point in eight,
    and for a font.
    """
    found: dict[str, Any] = {}
    if size is not None:
        found = {key: size / RC["font.size"] * RC[key] for key in TYPE}
    if font is not None:
        found["font.family"] = [font, *RC["font.sans-serif"]]
    return found


def installed(font: str) -> bool:
    """Return whether matplotlib finds a font."""
    try:
        font_manager.findfont(font_manager.FontProperties(family=font), fallback_to_default=False)
    except ValueError:
        return False
    return True


@contextmanager
def style(size: float | None = None, font: str | None = None) -> Generator[None]:
    """Apply the style inside a block; the user's settings are restored after it."""
    with matplotlib.rc_context(cast(Any, TIGHT | type_of(size, font))), warnings.catch_warnings():
        # characters that the font lacks are drawn as boxes, without a warning
        warnings.filterwarnings("ignore", message="Glyph .* missing")
        yield


def figure(width: float, height: float) -> Figure:
    """Return an empty figure, with width and height in inches and a layout without overlaps."""
    empty = ShownFigure(figsize=(width, height), dpi=150, layout="constrained")
    empty.settings = TIGHT
    return empty


# ------------------------------------------------------------------------------------------ widths of columns


COLUMNS = {
    "nature": {"single": 89.0, "double": 183.0},
    "elsevier": {"single": 90.0, "double": 190.0},
    "ieee": {"single": 88.9, "double": 182.0},
}
"""Widths by journal or publisher, and column.

Sources, read in November 2026: Nature Research, figure guide, "Building and exporting figure panels" (89 and
183 mm); Elsevier, guide for authors, "Electronic artwork" (1063 and 2244 pixels at 300 dots per inch);
IEEE Author Center, "Resolution and size" (3.5 and 7.16 inches, there rounded to 182 mm).
"""

DEFAULT_JOURNAL = "nature"
SMALLEST_PAGE, LARGEST_PAGE = 10.0, 1000.0
"""Range of a width or height, in millimetres."""

INCH = 25.4
"""Millimetres of an inch."""


def column_width(column: str, journal: str | None = None) -> float:
    """Return the width of a column in millimetres.

    Raises:
        ValueError: no such journal or column; the message names the known ones.
    """
    name = journal or DEFAULT_JOURNAL
    if name not in COLUMNS:
        raise ValueError(f"there is no journal {name!r}. {did_you_mean(name, COLUMNS)}")
    if column not in COLUMNS[name]:
        raise ValueError(f"there is no column {column!r}. {did_you_mean(column, COLUMNS[name])}")
    return COLUMNS[name][column]
