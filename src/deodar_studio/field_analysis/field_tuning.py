"""Tuning of a field to a stated regime, in a worker process, until its values are applied."""

from __future__ import annotations

import dataclasses as dc
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from deodar.batch.packed_model import PackedModel
from deodar.errors import DocumentError, Problem
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.model import Model
from deodar_studio.field_analysis.background import BackgroundTask, FieldTask

TELL_EVERY = 0.2
"""Wall time between two messages on the progress, in seconds."""


class MetRequirement(NamedTuple):
    """A requirement by its text, its margin (0 or above: met), its value if it has one, and whether that is
    exact.
    """

    text: str
    margin: float
    value: float | None
    exact: bool


class TunedField(NamedTuple):
    """What was found, as plain data.

    Attributes:
        requirements: the requirements.
        before, values: each parameter by path.
        tolerated: the relative change that all parameters may have at once.
        reasons: why not all requirements are met.
    """

    requirements: list[MetRequirement]
    before: dict[str, float]
    values: dict[str, float]
    tolerated: float
    reasons: list[str]


@dataclass(frozen=True)
class TuningReport:
    """How far the tuning is.

    Attributes:
        session: number of the document.
        element: id of the field; empty: nothing was tuned.
        tuning: whether it is being tuned.
        candidates: number of candidates so far.
        found: what was found; None: nothing yet.
        problems: why nothing was found.
    """

    session: int = 0
    element: str = ""
    tuning: bool = False
    candidates: int = 0
    found: TunedField | None = None
    problems: Sequence[Problem] = ()


class FieldTuning(FieldTask[TuningReport]):
    """Tunes one field at a time; `changed` is called from any thread when the report has changed."""

    def __init__(self, changed: Callable[[], None]) -> None:
        super().__init__(TuningReport(), BackgroundTask("deodar-tuning", keep=False), changed)

    def start(
        self, session: int, model: Model, element: str, parameters: Sequence[str], requirements: Sequence[Any]
    ) -> None:
        """Tune a field, in a thread.

        Args:
            session: number of the document.
            model: the model.
            element: id of the field.
            parameters: names of its parameters.
            requirements: each as in a file of requirements.

        Raises:
            WorkerError: a part of the model cannot be sent to another process.
        """
        path, packed = model.document.by_id()[element].path, PackedModel.of(model, None)
        wanted = {
            "parameters": {f"{path}.{name}": None for name in parameters},
            "requirements": list(requirements),
            "field": path,
        }

        def heard(candidates: int) -> None:
            self.report = TuningReport(session, element, True, candidates)
            self._changed()

        def ended(found: TunedField | None, problems: Sequence[Problem]) -> None:
            self.report = dc.replace(self.report, tuning=False, found=found, problems=problems)
            self._changed()

        self.report = TuningReport(session, element, tuning=True)
        self._task.start(tuned, [packed, wanted], ended, heard)
        self._changed()

    def applied(self, doc: Document) -> Document:
        """Return a document with the values that were found.

        Raises:
            DocumentError: nothing was found, or its parameters are no longer there.
        """
        found = self.report.found
        if found is None:
            raise DocumentError("nothing was tuned", fix="Tune a field first")
        for path, value in found.values.items():
            doc = edit.change(doc, path, value)
        return doc


def tuned(send: Callable[[object], None], packed: PackedModel, wanted: Mapping[str, Any]) -> TunedField:
    """Tune a field; called in the worker process.

    Raises:
        DocumentError: the requirements are not those of a file.
        DeodarError: as `tune` does.
    """
    # start-up time of the studio: these bring SciPy
    from deodar.analysis.tuning.tune import tune
    from deodar.analysis.tuning.tuning_file import tuning_file
    from deodar.resources import Resources

    asked = tuning_file(wanted, "the requirements")
    told = 0.0

    def tell(candidates: int) -> None:
        nonlocal told
        if time.monotonic() > told + TELL_EVERY:
            told = time.monotonic()
            send(int(candidates))

    found = tune(
        packed.model, asked.parameters, asked.requirements, on=Resources(progress=tell), **asked.options
    )
    requirements = [
        MetRequirement(text, margin, found.reached.get(text), text in found.exact)
        for text, margin in found.margins.items()
    ]
    return TunedField(
        requirements, dict(found.before), dict(found.values), found.tolerated, list(found.reasons)
    )
