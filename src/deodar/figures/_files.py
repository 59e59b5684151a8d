"""Figures as files: SVG, PDF or PNG, written to a temporary file and renamed."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from deodar.errors import FigureError, RecordError
from deodar.figures import _style
from deodar.model import output

FORMATS = ("png", "svg", "pdf")
COLLAPSED = "constrained_layout not applied"
"""Begin of matplotlib's warning that no space is left for axes."""


def claim(path: Path, force: bool = False) -> str:
    """Return the format of a file name; raise an error if it cannot be drawn or written."""
    format = path.suffix.lower().removeprefix(".")
    if format not in FORMATS:
        what = f"the name ends in {path.suffix!r}" if path.suffix else "the name has no ending"
        raise RecordError(
            f"{what}, which names no format of figures", where=str(path), fix="End it in .png, .svg or .pdf"
        )
    output.claim(path, force)
    return format


def save_figure(figure: Figure, path: str | Path, force: bool = False, dots: float = _style.DOTS) -> None:
    """Write a figure, with `dots` per inch; equal figures give equal bytes."""
    path = output.location(path)
    format = claim(path, force)
    about: dict[str, Any] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {}}[format]

    def content(beside: Path) -> None:
        with _style.style():
            warnings.filterwarnings("error", message=COLLAPSED)
            try:
                figure.savefig(beside, format=format, dpi=dots, metadata=about)
            except UserWarning as warning:
                if COLLAPSED not in str(warning):
                    raise
                width, height = figure.get_size_inches() * 25.4
                raise FigureError(
                    f"the panels and their labels do not fit into {width:.0f} x {height:.0f} mm",
                    fix="Make the figure larger, or font_size smaller",
                ) from None

    output.write(path, content)
