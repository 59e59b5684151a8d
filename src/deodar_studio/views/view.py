"""Conversion of documents, parameters and problems to messages for the page."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import msgspec

from deodar.errors import Problem as Wrong
from deodar.errors import TrustFix
from deodar.experiments.design import KINDS, USUAL, Design, by_key
from deodar.experiments.trial import TrialPlan
from deodar.importers import stored_report
from deodar.kinds.description import describe, descriptions
from deodar.model import document_files
from deodar.model.check import judge
from deodar.model.document import Document
from deodar.model.fits import Fit, FittingKind
from deodar.parameters import Part
from deodar.recording.replay import RecordReader
from deodar.session.cost import StepCost
from deodar.session.port_reader import PortKey
from deodar_studio.live.published import CostReport
from deodar_studio.messages.message import made_of
from deodar_studio.messages.to_page import (
    CopyDimension,
    Costs,
    CostView,
    DocumentView,
    ExperimentForms,
    Fits,
    FittingKindView,
    FitView,
    ImportReportView,
    KeyedDifference,
    Kind,
    ListedProblem,
    OfferView,
    RecordView,
    ReportLineView,
)
from deodar_studio.views import converted, repairs
from deodar_studio.views.converted import Converted


def kinds() -> list[Kind]:
    """Return the description of every registered kind as a message."""
    return [msgspec.convert(kind, Kind, from_attributes=True) for kind in descriptions()]


def experiment_forms() -> ExperimentForms:
    """Return the descriptions of the parts of an experiment, those of packages included."""

    def forms(family: Mapping[str, type[Part]]) -> list[Kind]:
        return [msgspec.convert(describe(cls, {}), Kind, from_attributes=True) for cls in family.values()]

    own, plan = (
        {form.name: form for form in kind.parameters} for kind in forms({"": Design, "plan": TrialPlan})
    )
    settings = by_key(own, plan).items()
    return ExperimentForms(
        design=[msgspec.structs.replace(form, name=key) for key, form in settings],
        conditions=forms(KINDS["conditions"]),
        actions=forms(KINDS["actions"]),
        measures=forms(KINDS["measures"]),
        usual=USUAL["measures"],
    )


def document(
    doc: Document, file: str, unsaved: bool, undo: int, redo: int, known: Converted | None = None
) -> DocumentView:
    """Convert a whole document; `known`: what is converted already."""
    made = converted.convert(doc) if known is None else known
    listed = problems(made.problems or [*made.warnings, *judge(doc, made.nodes)], doc)
    return DocumentView(
        file=file, **converted.parts(made), problems=listed, unsaved=unsaved, undo=undo, redo=redo
    )


def record(reader: RecordReader, path: str) -> RecordView:
    """Convert a record: its state, its trials and sweep, and the recorded ports."""
    ports: dict[str, list[str]] = {}
    for ident, port in reader.ports:
        ports.setdefault(ident, []).append(port)
    copies = [
        CopyDimension(name=name, values=[f"{v:g}" for v in values.tolist()])
        for name, values in reader.copies.items()
    ]
    return made_of(RecordView, reader, path=path, copies=copies, ports=ports)


def fits(of: PortKey, ports: Iterable[Fit], kinds: Iterable[FittingKind]) -> Fits:
    """Convert what a port, an empty one by default, can be connected with."""
    shown = [made_of(FitView, f, offers=[made_of(OfferView, o) for o in f.offers]) for f in ports]
    found = [made_of(FittingKindView, k) for k in kinds]
    return Fits(request=0, element=of[0], port=of[1], ports=shown, kinds=found)


@functools.lru_cache(maxsize=1)
def costs(report: CostReport) -> Costs:
    """Convert a report, once for all pages."""
    cost = report.costs or StepCost((), 0.0)
    elements = [made_of(CostView, c, element=c.id) for c in cost.elements]
    measuring, listed = report.measuring, problems(report.problems)
    return Costs(measuring=measuring, step=cost.step, elements=elements, problems=listed)


def problems(
    reported: Iterable[Wrong], doc: Document | None = None, paths: Sequence[str] = (), buttons: bool = True
) -> list[ListedProblem]:
    """Convert problems, each once for every element concerned: the one that its `where` names, and those at
    `paths`.

    Without `buttons` for problems that the document does not have itself: those of a run, or of a request
    that was refused.
    """
    places = None if doc is None else repairs.NamedPlaces(doc)
    out: list[ListedProblem] = []
    for p in reported:
        button: dict[str, Any] = {"repair": "", "wire": None, "world": False}
        elements = [""]
        if doc is not None and places is not None:
            button = repairs.button(doc, p, places) if buttons else button
            elements = [i for path in (p.where, *paths) if (i := places.element(path))] or [""]
        trust = isinstance(p.fix, TrustFix)
        out += [
            made_of(ListedProblem, p, fix=p.fix_at("page"), element=ident, trust=trust, **button)
            for ident in dict.fromkeys(elements)
        ]
    return out


def one_parameter(doc: Document, element: str, parameter: str) -> KeyedDifference:
    """Return what changed of a document of which a parameter of an element has another value."""
    axes, arrays = {a: key for key, a in document_files.axes(doc).items()}, document_files.arrays(doc)
    values = converted.values(doc.by_id()[element].element, axes, arrays)
    name = parameter.split(".")[0]
    inside = KeyedDifference(changed={name: values[name]})
    place = next(k for k, entry in enumerate(doc.entries) if entry.id == element)
    for key in ("values", str(place), "elements"):
        inside = KeyedDifference(inside={key: inside})
    return inside


NO_REPORT = ImportReportView(tool="", file="", lines=[], bugs=[])


def import_report(doc: Document) -> ImportReportView:
    """Convert the import report that a document contains."""
    found = stored_report.report_of(doc)
    if found is None:
        return NO_REPORT
    lines = [msgspec.convert(line, ReportLineView, from_attributes=True) for line in found.lines]
    return ImportReportView(tool=found.tool, file=found.file, lines=lines, bugs=list(found.bugs))
