"""Translate a file of cosivina to a model: elements, connections in the order of the file, and a report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import PurePath

from deodar.importers._beside import Beside, nothing
from deodar.importers.imported import Imported
from deodar.importers.report import Line
from deodar.model.document import Document
from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._piece import Piece
from deodar_interop.importers._translation import ListTranslation, component_lines
from deodar_interop.importers._wiring import SourceWiring
from deodar_interop.importers.cosivina import file
from deodar_interop.importers.cosivina.classes import CLASSES
from deodar_interop.importers.cosivina.constructors import components
from deodar_interop.importers.cosivina.element import SourceElement
from deodar_interop.importers.cosivina.file import Simulator
from deodar_interop.importers.cosivina.values import Dimensions, output_size

MISSING = {
    "AttractorDynamics": "turns a peak into the rate of change of a heading direction",
    "CameraGrabber": "reads a camera",
    "ColorExtraction": "counts colours in the columns of an image",
    "Convolution": "convolves its two inputs with each other",
    "DynamicRobotController": "drives an e-puck robot",
    "ImageLoader": "reads images from files",
    "Interpolation1D": "resamples its input at given points",
    "LFP": "records the mean input of a field",
    "MobileRobotArena": "simulates a vehicle among targets",
}
"""The function of each class that is not translated."""


def read(content: bytes, name: str, bugs: bool = False, beside: Beside = nothing) -> Imported:
    """Return the model that the content of a file describes, and the report.

    Args:
        content: the content of the file.
        name: name of the file, for the model's name and the report.
        bugs: whether to reproduce known errors of cosivina instead of correcting them.
        beside: not used: a file of cosivina needs no other files.
    """
    return translated(file.parse(content), name, bugs)


def translated(simulator: Simulator, name: str, bugs: bool, finish: Finish | None = None) -> Imported:
    """Return the model of a simulator, and the report.

    Args:
        simulator: the content of a file.
        name: name of the file.
        bugs: whether to reproduce known errors of cosivina.
        finish: adds to the document what else the file holds, and returns report lines about it.
    """
    translation = Translation(simulator, bugs)
    doc, lines = translation.document(PurePath(name).stem), list[Line]()
    if finish is not None:
        doc, lines = finish(translation, doc)
    return translation.imported(doc, name, simulator.step, simulator.start, lines)


Finish = Callable[["Translation", Document], tuple[Document, list[Line]]]
"""Adds to a document, and returns it with report lines."""


class Translation(ListTranslation[SourceElement]):
    """The translations of a file's elements by label, their connections, and the report lines."""

    tool, word, classes, missing = "cosivina", "class", CLASSES, MISSING

    def __init__(self, simulator: Simulator, bugs: bool) -> None:
        super().__init__(simulator.elements, Dimensions(simulator))
        self.simulator = simulator
        self.bugs = bugs
        self.pieces = {e.label: self.piece(e) for e in simulator.elements}
        self.wiring = SourceWiring("cosivina", simulator.elements, self.pieces, self.names)
        self.wiring.connect_all()

    def context(self, e: Foreign) -> SourceElement:
        read = self.components_read[e.label]
        return SourceElement(self.simulator, self.length_axes, e, read, self.names, self.bugs)

    def size(self, e: Foreign) -> Sequence[int]:
        return output_size(e)

    def finished(self, b: SourceElement, piece: Piece) -> tuple[Piece, list[Line]]:
        e = b.element
        return piece, [*b.values.rest(e.kind), *component_lines(e, piece, components(e.kind))]

    def lines(self) -> list[Line]:
        return [*self.simulator.lines, *super().lines()]
