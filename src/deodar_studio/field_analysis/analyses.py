"""Messages on what was computed about a field: its regime, and its tuning."""

from __future__ import annotations

import math

from deodar.errors import DeodarError
from deodar.model import find
from deodar.model.document import Document
from deodar_studio.field_analysis.field_tuning import TuningReport
from deodar_studio.field_analysis.regime_measurement import RegimeReport
from deodar_studio.messages.to_page import Regime, RegimeCurve, RegimeRow, RequirementView, TunedValue, Tuning
from deodar_studio.views import view


def regime(report: RegimeReport, doc: Document | None) -> Regime:
    """Convert a measured regime; it is stale if the element of the document is another one by now."""
    found = report.found
    entry = None if doc is None else doc.by_id().get(report.element)
    return Regime(
        element=report.element,
        measuring=report.measuring,
        stale=bool(report.element) and (entry is None or entry.element is not report.measured),
        words=[] if found is None else list(found.words),
        rows=[] if found is None else [RegimeRow(name=name, text=text) for name, text in found.rows],
        curve=None
        if found is None
        else RegimeCurve(input=found.strengths, up=found.up, down=found.down, threshold=found.threshold),
        problems=view.problems(report.problems, None),
    )


def tuning(report: TuningReport, doc: Document | None) -> Tuning:
    """Convert what was tuned; it is applied if the document has its values."""
    found = report.found
    values = {} if found is None else found.values
    return Tuning(
        element=report.element,
        tuning=report.tuning,
        candidates=report.candidates,
        requirements=[]
        if found is None
        else [
            RequirementView(text=r.text, margin=_finite(r.margin), value=r.value, exact=r.exact)
            for r in found.requirements
        ],
        values=[]
        if found is None
        else [TunedValue(path=p, before=found.before[p], value=value) for p, value in values.items()],
        tolerated=0.0 if found is None else found.tolerated,
        reasons=[] if found is None else found.reasons,
        applied=bool(values) and doc is not None and all(_has(doc, p, v) for p, v in values.items()),
        problems=view.problems(report.problems, None),
    )


def _has(doc: Document, path: str, value: float) -> bool:
    """Return whether a parameter of the document has this value."""
    try:
        return bool(find.value(doc, path) == value)
    except DeodarError:  # it was removed
        return False


def _finite(number: float) -> float | None:
    return number if math.isfinite(number) else None
