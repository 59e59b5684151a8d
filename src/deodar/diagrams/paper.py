"""Drawing of a scene as a matplotlib figure, for PDF and PNG."""

from __future__ import annotations

import io
import warnings
from typing import TYPE_CHECKING, Any

from deodar.diagrams.scene import Drawing, PathCommand, TextLine
from deodar.diagrams.text import FAMILY, plain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure

INCH = 72.0
"""Points per inch."""


def figure(scene: Drawing, width: float | None = None) -> Figure:
    """Return a figure of the scene; `width` is in inches, None: the size of the scene."""
    # start-up time: matplotlib is needed for figures only
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path
    from matplotlib.text import Text
    from matplotlib.transforms import Affine2D

    from deodar.diagrams.shown_figure import ShownFigure

    codes = {"M": Path.MOVETO, "L": Path.LINETO, "C": Path.CURVE4, "Z": Path.CLOSEPOLY}
    scale = 1.0 if width is None else width * INCH / scene.width
    drawn = ShownFigure(figsize=(scene.width * scale / INCH, scene.height * scale / INCH), dpi=300)
    place = Affine2D().scale(1, -1).translate(0, scene.height).scale(scale / INCH) + drawn.dpi_scale_trans
    for one in scene:
        if isinstance(one, TextLine):
            text = Text(
                one.x,
                one.y,
                plain(one.text),
                fontsize=one.size * scale,
                color=one.color,
                fontfamily=[FAMILY, "sans-serif"],
                ha={"start": "left", "middle": "center", "end": "right"}[one.anchor],
                va="baseline",
                weight="bold" if one.bold else "normal",
                style="italic" if one.italic else "normal",
                transform=place,
                parse_math=False,
            )
            drawn.add_artist(text)
            continue
        points, marks = (
            _points(one.path),
            [c for move in one.path for c in [codes[move[0]]] * max(1, (len(move) - 1) // 2)],
        )
        patch = PathPatch(
            Path(points, marks),
            facecolor=one.fill or "none",
            edgecolor=one.stroke or "none",
            linewidth=one.width * scale if one.stroke else 0.0,
            linestyle=(0, [d / one.width for d in one.dash]) if one.dash else "solid",
            capstyle="butt",
            joinstyle="miter",
            transform=place,
        )
        drawn.add_artist(patch)
    return drawn


def content(scene: Drawing, format: str, width: float | None = None) -> bytes:
    """Return the picture as pdf or png; equal pictures have equal bytes."""
    # start-up time: matplotlib is needed for figures only
    import matplotlib

    about: Any = {"CreationDate": None} if format == "pdf" else {}
    out = io.BytesIO()
    with matplotlib.rc_context({"pdf.fonttype": 42}), warnings.catch_warnings():
        # the font lacks characters of a name
        warnings.filterwarnings("ignore", message="Glyph .* missing")
        figure(scene, width).savefig(out, format=format, metadata=about)
    return out.getvalue()


def _points(path: Sequence[PathCommand]) -> list[tuple[float, float]]:
    found: list[tuple[float, float]] = []
    start = (0.0, 0.0)
    for move in path:
        numbers = [float(v) for v in move[1:]]
        if move[0] == "Z":
            found.append(start)
            continue
        pairs = list(zip(numbers[::2], numbers[1::2], strict=True))
        start = pairs[-1] if move[0] == "M" else start
        found += pairs
    return found
