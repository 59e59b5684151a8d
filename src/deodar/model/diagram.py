"""The picture of an architecture: shown in a notebook, and saved as SVG, PDF or PNG."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from deodar.diagrams import paint, paper, svg
from deodar.diagrams.graph import fold
from deodar.errors import RecordError
from deodar.model import output
from deodar.model.document import Document
from deodar.model.sketch import sketch
from deodar.parameters import show

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = ("svg", "pdf", "png")


class Diagram:
    """The picture of an architecture, as `dd.draw` returns it."""

    def __init__(self, document: Document, legend: bool = True, depth: int | None = None) -> None:
        graph = sketch(document)
        self._scene = paint.paint(graph if depth is None else fold(graph, depth), legend)

    @property
    def svg(self) -> str:
        """The picture as SVG; text is stored as text, which an editor can change."""
        return svg.write(self._scene)

    @property
    def size(self) -> tuple[float, float]:
        """Width and height in inches; names are 7.5 points high at this size."""
        return self._scene.width / paper.INCH, self._scene.height / paper.INCH

    def figure(self, width: float | None = None) -> Figure:
        """Return the picture as a matplotlib figure; `width` is in inches, by default the picture's own
        width.
        """
        return paper.figure(self._scene, width)

    def save(self, path: str | Path, width: float | None = None, force: bool = False) -> None:
        """Write the picture.

        Args:
            path: a file name that ends in .svg, .pdf or .png.
            width: in inches, for example that of a column of a journal; by default the picture's own width.
            force: whether to replace an existing file.

        Raises:
            RecordError: the ending is another one, or the width is not above 0.
            OutputExists: the file exists.
        """
        where = output.location(path)
        format = where.suffix.lower().removeprefix(".")
        if format not in FORMATS:
            raise RecordError(
                f"the name ends in {where.suffix!r}, which names no format of pictures",
                where=str(where),
                fix="End it in .svg, .pdf or .png",
            )
        if width is not None and not 0 < width < 1000:
            raise RecordError(
                f"width is {show(width)} inches; it is above 0 and below 1000", where=str(where)
            )
        output.claim(where, force)
        if format == "svg":
            output.write(
                where, svg.write(self._scene, None if width is None else width * paper.INCH).encode()
            )
        else:
            output.write(where, paper.content(self._scene, format, width))

    def inside(self, most: int) -> str:
        """Return the picture as HTML for a notebook, in the colours of its theme; "" for more than `most`
        characters.
        """
        drawn = svg.write_inside(self._scene)
        return f'<div style="overflow-x:auto">{drawn}</div>' if len(drawn) <= most else ""

    def __repr__(self) -> str:
        return f"<Diagram of {self._scene.title!r}, {self.size[0]:.1f} x {self.size[1]:.1f} inches>"

    def _repr_svg_(self) -> str:
        return self.svg
