"""How figures look: sizes of a journal's columns, readable type, colour maps that everyone can read."""

from __future__ import annotations

import warnings
from collections.abc import Generator
from contextlib import contextmanager
from typing import Any, cast

import matplotlib
from matplotlib.figure import Figure

SINGLE = 3.5
DOUBLE = 7.2
"""Widths of one and two columns, in inches."""

PANEL = 2.1
"""Height of a panel across one column, in inches."""

DOTS = 300
"""Dots per inch of a PNG."""

COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""Colours of lines: Okabe and Ito's set, which colour-blind readers tell apart."""

THRESHOLD = "#555555"

SEQUENTIAL = "viridis"
DIVERGING = "RdBu_r"

RC: dict[str, Any] = {
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
    "axes.xmargin": 0.0,
    "axes.unicode_minus": True,
    "axes.formatter.useoffset": False,
    "lines.linewidth": 1.1,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "image.interpolation": "nearest",
    "image.origin": "lower",
    "text.parse_math": False,  # names are names, whatever signs stand in them
    "svg.fonttype": "none",  # real text, which a journal or a reader can edit and search
    "svg.hashsalt": "deodar",  # the same figure gives the same file
    "pdf.fonttype": 42,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}


@contextmanager
def style() -> Generator[None]:
    """The look, for as long as it is needed; the user's own settings are left alone."""
    with matplotlib.rc_context(cast(Any, RC)), warnings.catch_warnings():
        warnings.filterwarnings(
            "ignore", message="Glyph .* missing"
        )  # a name in a script that the font lacks: boxes, not a failure
        yield


def figure(width: float, height: float) -> Figure:
    """An empty figure of that many inches, laid out so that nothing overlaps."""
    return Figure(figsize=(width, height), dpi=150, layout="constrained")
