"""Translate a file of cedar to a model: elements in groups, connections in cedar's order, and a report."""

from __future__ import annotations

import dataclasses as dc
from pathlib import PurePath

from deodar.element import Element
from deodar.elements.placeholder import Placeholder
from deodar.importers._beside import Beside, nothing
from deodar.importers.imported import Imported
from deodar.importers.report import ImportReport, Line
from deodar.model import edit
from deodar.model.document import Document, Entry
from deodar.model.model import Model
from deodar_interop.importers._foreign import FreeNames
from deodar_interop.importers._missing import or_placeholder, placeholder_lines
from deodar_interop.importers.cedar import file
from deodar_interop.importers.cedar.box_layout import layout
from deodar_interop.importers.cedar.classes import CLASSES, LOOPED, SIZED
from deodar_interop.importers.cedar.classes.missing import placeholder
from deodar_interop.importers.cedar.composition import SourceStep
from deodar_interop.importers.cedar.file import CedarFile, CedarStep, StepPath
from deodar_interop.importers.cedar.grid import Counts, SampleGrid
from deodar_interop.importers.cedar.parameter_links import linked
from deodar_interop.importers.cedar.piece import Refused, StepPiece
from deodar_interop.importers.cedar.sequence import clock, sequence
from deodar_interop.importers.cedar.side_file import SideFile
from deodar_interop.importers.cedar.wiring import CedarWiring, StepWire, buffers, halts, loaded, step_wires

STILL = {"tau": 1e12, "tau_build": 1e12, "tau_decay": 1e12, "rate": 0.0}
"""Values at which a state does not change: an element that cedar does not run."""


def read(content: bytes, name: str, bugs: bool = False, beside: Beside = nothing) -> Imported:
    """Return the model that the content of a file describes, and the report.

    Args:
        content: the content of the file.
        name: name of the file, for the model's name and the report.
        bugs: whether to reproduce known errors of cedar; none of them can be, and the report lists them.
        beside: reads other files of the folder: stored traces and weights, and linked groups.
    """
    return translated(content, name, beside)[1]


def translated(content: bytes, name: str, beside: Beside = nothing) -> tuple[StepTranslation, Imported]:
    """Return the translations of the steps of a file, and the model with its report."""
    translation = StepTranslation(file.parse(content, beside), SideFile(name, beside))
    title = PurePath(name).stem
    doc = Document(title or "cedar")
    doc, by = translation.added(doc)
    for (group, source), port, (target_group, target), entrance, reads in translation.wiring.connections:
        doc = edit.connect(doc, by[*group, source], port, by[*target_group, target], entrance, reads)
    doc, links = linked(doc, translation.architecture.root, by)
    report = ImportReport("cedar", name, [*translation.lines(), *links], translation.met)
    doc = edit.describe(
        doc,
        time_unit="ms",
        dt=translation.dt,
        notes=report.text(),
        layout=layout(translation.architecture.root, by, doc.connections),
    )
    return translation, Imported(Model(document=doc), report)


class StepTranslation:
    """The translations of a file's steps by path, their connections, and the report lines."""

    def __init__(self, architecture: CedarFile, stored: SideFile) -> None:
        self.stored = stored
        self.architecture = architecture
        self.grid = SampleGrid(architecture)
        self.met: list[str] = []
        self.report: list[Line] = []
        root = architecture.root
        self.dt, clock_lines = clock(root)
        self.steps = {step.path: step for step in root.all_steps()}
        self.names = {g.path: FreeNames([*g.steps, *g.groups]) for g in root.all_groups()}
        wires, wire_lines = step_wires(root)
        wires += buffers(root)
        self.wires = [w for w in wires if w.source in self.steps and w.target in self.steps]
        self.into: dict[StepPath, list[StepWire]] = {}
        self.out: dict[StepPath, list[StepWire]] = {}
        for wire in self.wires:
            self.into.setdefault(wire.target, []).append(wire)
            self.out.setdefault(wire.source, []).append(wire)
        self.unknown: set[StepPath] = set()
        self.pieces = self.translated()
        self.halted = halts(self.pieces, self.wires)
        looped = frozenset(path for path, step in self.steps.items() if step.kind in LOOPED)
        feeds = {path: [w.target for w in wires] for path, wires in self.out.items()}
        place, order_lines = sequence(root, looped, feeds)
        early = loaded(self.pieces, place, feeds, looped)
        self.wiring = CedarWiring(self.pieces, self.into, place, self.halted, self.names, self.grid, early)
        self.wiring.connect_all()
        self.report += [*clock_lines, *wire_lines, *order_lines]

    def translated(self) -> dict[StepPath, StepPiece]:
        """Return the translations: first of steps with a size of their own, then of what follows."""
        pieces: dict[StepPath, StepPiece] = {}
        lacks: dict[StepPath, int] = {}
        for path, step in self.steps.items():
            if step.kind in CLASSES and step.kind not in SIZED:
                lacks[path] = len(self.into.get(path, ()))
        ready = [path for path in self.steps if not lacks.get(path)]
        while len(pieces) < len(self.steps):
            if not ready:
                why = "its size follows from a loop of steps without a size of their own"
                ready = [next(path for path in self.steps if path not in pieces)]
                pieces[ready[0]] = self.piece(self.steps[ready[0]], pieces, why)
            for path in ready:
                if path not in pieces:
                    pieces[path] = self.piece(self.steps[path], pieces)
            after: list[StepPath] = []
            for wire in (w for path in ready for w in self.out.get(path, ())):
                if wire.target in lacks and wire.target not in pieces:
                    lacks[wire.target] -= 1
                    if not lacks[wire.target]:
                        after.append(wire.target)
            ready = after
        return {path: pieces[path] for path in self.steps}

    def piece(self, step: CedarStep, pieces: dict[StepPath, StepPiece], stops: str = "") -> StepPiece:
        """Return the translation of one step, or a placeholder with the reason."""
        ins: dict[str, list[Counts | None]] = {}
        unknown = ""
        for wire in self.into.get(step.path, ()):
            source = pieces.get(wire.source)
            outlet = None if source is None else source.outlets.get(wire.source_slot)
            if source is None and step.kind in SIZED:
                ins.setdefault(wire.target_slot, []).append(())
                continue
            if wire.source in self.unknown:
                unknown = wire.source[-1]
            if outlet is not None and source is not None:
                ins.setdefault(wire.target_slot, []).append(None if source.stops else outlet.dims)
        context = SourceStep(step, ins, self.grid, self.names[step.path[:-1]], self.dt, self.stored)
        translation = or_placeholder(
            lambda: self.attempted(context, stops, unknown), lambda why: self.unsized(step, why)
        )
        self.met += context.met
        self.report.append(Line(step.label, "element", step.kind, translation.verdict, translation.why))
        if isinstance(translation.elements[0], Placeholder):
            stated = [name for name in step.values if name not in ("name", "threaded", "comments")]
            self.report += placeholder_lines(step.label, stated)
        else:
            self.report += context.values.rest(step.short)
        return translation

    def attempted(self, s: SourceStep, stops: str, unknown: str) -> StepPiece:
        """Return the translation of a step, or a placeholder if cedar does not run it or it has none."""
        kind = s.step.kind
        try:
            if stops:
                raise Refused(stops)
            if unknown and kind not in SIZED:
                return self.unsized(s.step, f"its size is that of {unknown!r}, which is not known")
            return CLASSES[kind](s) if kind in CLASSES else self.unsized(s.step)
        except Refused as error:
            return self.missing(s.step, f"cedar does not run it: {error}", str(error))

    def unsized(self, step: CedarStep, why: str = "") -> StepPiece:
        """Return a placeholder for a step whose outputs have no size that is known."""
        self.unknown.add(step.path)
        return self.missing(step, why)

    def missing(self, step: CedarStep, why: str = "", stops: str = "") -> StepPiece:
        """Return a placeholder for a step, with the slots that connections name."""
        ins = list(dict.fromkeys(w.target_slot for w in self.into.get(step.path, ())))
        outs = list(dict.fromkeys(w.source_slot for w in self.out.get(step.path, ())))
        return placeholder(step, list(CLASSES), ins, outs, why, stops)

    def added(self, doc: Document) -> tuple[Document, dict[StepPath, Entry]]:
        """Return a document with all elements and groups, and the entries by path."""
        elements: list[tuple[Element, StepPath, int]] = []
        for path, piece in self.pieces.items():
            first, *others = piece.elements
            if path in self.halted:
                fields = {f.name for f in dc.fields(first)}  # pyright: ignore
                first = dc.replace(first, **{k: v for k, v in STILL.items() if k in fields})
            elements += [(element, path[:-1], 1) for element in (first, *others)]
        elements += [(element, group, 1) for group, element in self.wiring.extra]
        doc, entries = edit.add_all(doc, elements)
        for group in self.architecture.root.all_groups():
            if group.path and group.path not in doc.groups:
                doc = edit.group(doc, group.path)
        return doc, {entry.names: entry for entry in entries}

    def stilled(self, path: StepPath) -> str:
        """Return what keeps an element still, and the value that lets it run."""
        element = self.pieces[path].elements[0]
        values = [f"{name} is {getattr(element, name):g}" for name in STILL if hasattr(element, name)]
        return f"it does not change: of the file, {', '.join(values)}" if values else "it has no inputs"

    def lines(self) -> list[Line]:
        """Return all lines of the report."""
        halted = [
            Line(
                ".".join(path),
                "element",
                self.steps[path].kind,
                "approximated",
                f"cedar does not run it: {why}. Here {self.stilled(path)}",
            )
            for path, why in self.halted.items()
            if not isinstance(self.pieces[path].elements[0], Placeholder)
        ]
        labels = {line.where for line in halted}
        report = [
            x
            for x in self.report
            if not (x.part == "element" and x.where in labels and x.verdict == "carried")
        ]
        return [*self.architecture.lines, *self.stored.lines, *report, *halted, *self.wiring.lines]
