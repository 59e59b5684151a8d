"""A launcher as a model: the simulator that it builds, with the controls of its window."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any, cast

import numpy as np

from deodar import codec
from deodar.errors import DocumentError
from deodar.importers._beside import Beside, nothing
from deodar.importers.imported import Imported
from deodar.importers.report import Line
from deodar.model.document import Document
from deodar_interop.importers.cosivina import file
from deodar_interop.importers.cosivina.launchers.matlab_values import is_cells, is_text
from deodar_interop.importers.cosivina.launchers.objects import BuiltSimulator, BuiltWindow
from deodar_interop.importers.cosivina.launchers.script_controls import control_of, plot_of
from deodar_interop.importers.cosivina.launchers.script_reader import ScriptReader, decoded
from deodar_interop.importers.cosivina.panel import LauncherPanel
from deodar_interop.importers.cosivina.plots import with_plots
from deodar_interop.importers.cosivina.translate import Translation, translated

WORDS = re.compile(
    rb"(?m)^[^%\n'\"]*\b(?:Simulator\s*[(;]|(?:addElement|addControl|addVisualization|StandardGUI)\s*\()"
    rb"|^[ \t]*gui[ \t]*\.[ \t]*run[ \t]*\("
)
"""What a launcher has somewhere, outside comments."""

PYTHON = re.compile(
    rb"(?m)^[ \t]*(?:from[ \t]+\w[\w.]*[ \t]+import\b|import[ \t]+\w+|def[ \t]+\w+[ \t]*\([^\n]*:[ \t\r]*$)"
)
"""What only a script of Python has."""


HEAD = 65536
"""Number of bytes by which a launcher is recognised."""


def is_launcher(content: bytes) -> bool:
    """Return whether a file begins like a script of MATLAB that builds a simulator."""
    head = content[:HEAD]
    return (
        head.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] not in (b"{", b"[", b"<", b"")
        and PYTHON.search(head) is None
        and WORDS.search(head) is not None
    )


def read_launcher(content: bytes, name: str, bugs: bool = False, beside: Beside = nothing) -> Imported:
    """Return the model that a launcher builds, and the report.

    Args:
        content: the content of the script.
        name: name of the file.
        bugs: whether to reproduce known errors of cosivina.
        beside: reads parameter files and other scripts of the same folder.

    Raises:
        DocumentError: the script builds no simulator, is too long, or is nested too deeply.
    """
    reader = ScriptReader(beside)
    reader.read(decoded(content))
    gui, sim = _chosen(reader)
    if sim is None or not sim.elements:
        lost = [f"{line.what}: {line.why}" for line in reader.lines][:3]
        raise DocumentError(
            "is a script that builds no simulator of cosivina" + (f" ({'; '.join(lost)})" if lost else ""),
            fix="A launcher has `sim = Simulator();` and `sim.addElement(...)`",
        )
    simulator = file.parse(simulator_file(sim))
    plots = [plot_of(call) for call in ([] if gui is None else gui.plots)]
    controls = [control_of(call) for call in ([] if gui is None else gui.controls)]

    def files(path: str) -> file.Simulator:
        return reader.file(path)

    def finish(translation: Translation, doc: Document) -> tuple[Document, list[Line]]:
        doc, lines = LauncherPanel(translation, controls, files).finish(doc)
        doc, plot_lines = with_plots(doc, translation, plots)
        return doc, [*reader.lines, *lines, *plot_lines]

    return translated(simulator, name, bugs, finish)


def _chosen(reader: ScriptReader) -> tuple[BuiltWindow | None, BuiltSimulator | None]:
    """Return the last window and the simulator that it shows, or the last simulator with elements."""
    built = [s for s in reader.simulators if s.elements]
    connected = [w for w in reader.windows if w.simulator is not None and w.simulator.elements]
    gui = connected[-1] if connected else reader.windows[-1] if reader.windows else None
    sim = connected[-1].simulator if connected else built[-1] if built else None
    for simulator in built:
        if simulator is not sim:
            why = (
                f"the script builds {len(built)} simulators; this one has {len(simulator.elements)} elements"
            )
            reader.lines.append(Line("", "file", "Simulator", "dropped", why))
    return gui, sim


def simulator_file(sim: BuiltSimulator) -> bytes:
    """Return a simulator as the content of a parameter file."""
    elements = [
        {
            "label": e.label,
            "class": e.kind,
            "param": {name: plain(value) for name, value in e.values.items()},
            "nInputs": len(e.inputs),
            "input": [{"label": label, "component": component} for label, component in e.inputs],
        }
        for e in sim.elements.values()
    ]
    body = {"deltaT": plain(sim.step), "tZero": plain(sim.start), "nElements": len(elements)}
    labels = list(sim.elements)
    return codec.text({"simulator": {**body, "elementLabels": labels, "elements": elements}}).encode()


def plain(value: Any) -> Any:
    """Return a value of a script as parameter files hold it: a row as a list, a matrix as a list of rows."""
    match value:
        case np.ndarray():
            return _plain_array(value)
        case list() | tuple():
            return [plain(inner) for inner in cast("Sequence[Any]", value)]
        case bool():
            return int(value)
        case float():
            return _plain_number(value)
        case int() | str() | dict():
            return cast("Any", value)
        case _:
            return None


def _plain_array(value: np.ndarray) -> Any:
    flat = value.reshape(-1)
    if is_cells(value):
        return [plain(cell) for cell in flat]
    if is_text(value):
        return "".join(flat.tolist())
    if value.size == 1:
        return plain(flat[0].item())
    return plain(flat.tolist() if value.shape[0] == 1 and value.ndim == 2 else value.tolist())


def _plain_number(value: float) -> float | str:
    if not math.isfinite(value):
        return "_NaN_" if math.isnan(value) else "_Inf_" if value > 0 else "-_Inf_"
    return int(value) if value.is_integer() and abs(value) < 1e15 else value
