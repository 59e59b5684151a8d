"""A plot of a page as the file of a figure, which `deodar plot` draws."""

from __future__ import annotations

from pathlib import Path

from deodar.model import find
from deodar.model.document import Document
from deodar.model.paths import quote
from deodar.recording import places
from deodar_studio.messages.to_server import SaveFigure

SUFFIX = ".toml"

FIGURES = {
    "course": "time_course",
    "curve": "snapshot",
    "heat": "snapshot",
    "picture": "snapshot",
    "space_time": "space_time",
}
"""The kind of figure for a kind of plot."""


def save(m: SaveFigure, document: Document, record: Path | None, time: float, folder: Path) -> Path:
    """Write the file and return its path: the next unused NAME-figure-001.toml in the folder.

    Args:
        m: the plot.
        document: the document of the run, or of the open record.
        record: the record that the plot shows, or that is being written; None: `deodar plot` names one.
        time: the moment that the page shows.
        folder: the folder of the studio.

    Raises:
        UnknownName: the document has no such element or port.
        OutputError: the file cannot be written.
    """
    # start-up time: this imports matplotlib
    from deodar.figures import FigureFile, FigurePanel

    entry, port = find.shown(document, f"{find.entry(document, m.element).path}.{quote(m.port)}")
    kind = FIGURES.get(m.kind)
    panel = FigurePanel(
        f"{entry.path}.{port}",
        kind=kind,
        at=[time] if kind == "snapshot" else None,
        value_range=m.range,
    )
    figure = FigureFile([panel], record=None if record is None else str(record), folder=folder)
    return figure.save(places.free(folder, f"{document.name}-figure", SUFFIX))
