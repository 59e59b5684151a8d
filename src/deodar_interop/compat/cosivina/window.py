"""The window of a simulator: its controls become pins and presets of a document, which the studio shows."""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import Any

from deodar import regular_file
from deodar.errors import DeodarError, ModelError, RunWarning
from deodar.importers.imported import Imported
from deodar.importers.report import ImportReport, Line
from deodar.model.document import Document
from deodar.model.model import Model
from deodar_interop.compat.cosivina.simulator import Simulator
from deodar_interop.compat.cosivina.window_controls import WindowControl
from deodar_interop.importers.cosivina import file
from deodar_interop.importers.cosivina.panel import LauncherPanel
from deodar_interop.importers.cosivina.plots import PlotRequest, with_plots
from deodar_interop.importers.cosivina.translate import Translation, translated


class StandardGUI:
    """A window. deodar draws none: `model` has its controls, and the studio shows them.

    Args:
        simulatorHandle: the simulator, or None until `connect`.
        settings: positions, sizes and groups of elements; not used.
    """

    def __init__(self, simulatorHandle: Simulator | None = None, *settings: Any) -> None:
        self._simulator = simulatorHandle
        self._controls: list[WindowControl] = []
        self._plots: list[PlotRequest] = []
        self.pauseSimulation = self.quitSimulation = self.resetSimulation = False

    def connect(self, simulatorHandle: Simulator) -> None:
        """Connect the window with a simulator."""
        self._simulator = simulatorHandle

    def addControl(self, control: WindowControl, *position: Any) -> None:
        """Add a control; its position is not used."""
        self._controls.append(control)

    def addVisualization(self, visualization: Any, *position: Any) -> None:
        """Add a plot, which the studio shows."""
        self._plots.append(_request(visualization))

    def init(self) -> None:
        """Open the window: there is none."""

    def updateVisualizations(self) -> None:
        """Draw the plots: there are none."""

    def checkAndUpdateControls(self) -> None:
        """Read the controls, which never change here."""

    @property
    def model(self) -> Model:
        """The model of the simulator as it is now, with the controls as pinned sliders and presets."""
        return self._imported().model

    @property
    def report(self) -> ImportReport:
        """The report of the translation, with a line for each control."""
        return self._imported().report

    def run(self, tMax: float = math.inf, initialize: bool = False, simulator: Any = None) -> None:
        """Run the simulator up to a time. Without a time the studio is the place to run it.

        Warns:
            RunWarning: there is no time at which the run would end.
        """
        if simulator is not None:
            self.connect(simulator)
        if math.isinf(tMax):
            text = (
                "there is no window: save the model with dd.save(gui.model, FILE) and open it in the studio"
            )
            warnings.warn(text, RunWarning, stacklevel=2)
            return
        self._require().run(tMax, initialize)

    def _require(self) -> Simulator:
        if self._simulator is None:
            raise ModelError("the window has no simulator", fix="StandardGUI(sim), or gui.connect(sim)")
        return self._simulator

    def _imported(self) -> Imported:
        simulator = file.parse(self._require().content())

        def finish(translation: Translation, doc: Document) -> tuple[Document, list[Line]]:
            doc, lines = LauncherPanel(translation, [c.control for c in self._controls], _file).finish(doc)
            doc, shown = with_plots(doc, translation, self._plots)
            return doc, [*lines, *shown]

        return translated(simulator, "simulator", False, finish)


def _file(path: str) -> file.Simulator:
    try:
        return file.parse(regular_file.read_bytes(Path(path)))
    except OSError as error:
        raise ValueError(f"{path} cannot be read: {error.strerror}") from None
    except DeodarError as error:
        raise ValueError(f"{path} {error.problems[0].what}") from None


def _request(visualization: Any) -> PlotRequest:
    """Return what a plot shows, by its first two arguments: labels and components."""
    given = getattr(visualization, "arguments", ())[:2]
    names = [[v] if isinstance(v, str) else list(v) if isinstance(v, (list, tuple)) else [] for v in given]
    shown = tuple(zip(*names, strict=False)) if len(names) == 2 else ()
    return PlotRequest(type(visualization).__name__, shown)


class Visualization:
    """A plot, which is not drawn here; it takes any arguments, first labels and components."""

    def __init__(self, *arguments: Any, **named: Any) -> None:
        self.arguments = arguments


class MultiPlot(Visualization):
    """Curves of components."""


class XYPlot(Visualization):
    """Components against each other."""


class ScaledImage(Visualization):
    """A plane in colours."""


class SurfacePlot(Visualization):
    """A plane as a surface."""


class SlicePlot(Visualization):
    """Rows or columns of a plane."""


class TilePlot(Visualization):
    """Planes of a volume side by side."""


class KernelPlot(Visualization):
    """A kernel."""


class RGBImage(Visualization):
    """A picture."""


class StaticText(Visualization):
    """A text."""


class TimeDisplay(Visualization):
    """The present time."""
