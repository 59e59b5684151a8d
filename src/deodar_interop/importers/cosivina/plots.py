"""The visualizations of a window in a document: the plots that the studio shows at first."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

from deodar.codec import Json
from deodar.importers.report import Line
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.paths import display
from deodar_interop.importers._piece import Outlet
from deodar_interop.importers.cosivina.translate import Translation

PLOTS = "plots"
"""Key of the layout: `[{"element": id, "port": name}]`."""

MOST_PLOTS = 12
"""Most plots of a document; those of a window with more would be too small to see."""

SHOWN = ("MultiPlot", "ScaledImage", "SurfacePlot", "SlicePlot", "TilePlot")
"""Classes that show components of elements over their axes or over time."""

ELSEWHERE = {"TimeDisplay": "the clock of the studio"}
"""What the studio has in place of other classes."""


@dc.dataclass(frozen=True)
class PlotRequest:
    """A visualization.

    Attributes:
        kind: its class.
        shown: label of an element and name of a component, for each curve or picture.
        where: its line in a script, for the report, or "".
    """

    kind: str
    shown: tuple[tuple[str, str], ...]
    where: str = ""


def with_plots(
    doc: Document, translation: Translation, requests: Sequence[PlotRequest]
) -> tuple[Document, list[Line]]:
    """Return a document that lists the plots of a window, and a report line for each visualization."""
    plots: list[Json] = []
    lines: list[Line] = []
    ids = {entry.element.name: entry.id for entry in doc.entries}
    for request in requests:
        before = f"{request.where}: " if request.where else ""
        outlets = _outlets(translation, request)
        if request.kind in ELSEWHERE:
            lines.append(Line("", "visualization", request.kind, "carried", ELSEWHERE[request.kind]))
        elif not outlets:
            why = f"{before}plots are chosen in the studio"
            lines.append(Line("", "visualization", request.kind, "dropped", why))
        else:
            first = outlets[0]
            plot: Json = {"element": ids[first.name], "port": first.port}
            if plot not in plots and len(plots) < MOST_PLOTS:
                plots.append(plot)
            why = f"{before}a plot of {display((first.name, first.port))}"
            why += " is shown at first" if plot in plots else f" is beyond the first {MOST_PLOTS}"
            verdict = "approximated" if plot in plots else "dropped"
            lines.append(Line("", "visualization", request.kind, verdict, why))
    return (edit.arrange(doc, {**doc.layout, PLOTS: plots}) if plots else doc), lines


def _outlets(translation: Translation, request: PlotRequest) -> list[Outlet]:
    """Return the ports of what a visualization shows; activations are the first."""
    if request.kind not in SHOWN:
        return []
    ranked = [
        (component != "activation", k, piece.outlets[component])
        for k, (label, component) in enumerate(request.shown)
        if (piece := translation.pieces.get(label)) is not None and component in piece.outlets
    ]
    return [outlet for *_, outlet in sorted(ranked, key=lambda entry: entry[:2])]
