"""Tuning of a field to a stated regime, in a worker process, until its values are applied."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import msgspec

from deodar.analysis.tuning.requirement import QuantityKind, Requirement
from deodar.batch.packed_model import PackedModel
from deodar.errors import DeodarError, DocumentError
from deodar.model import edit, find
from deodar.model.document import Document
from deodar.model.model import Model
from deodar_studio.field_analysis.background import FieldTask
from deodar_studio.messages.to_page import RequirementView, TunedValue, Tuning

TELL_EVERY = 0.2
"""Wall time between two messages on the progress, in seconds."""

NOTHING = Tuning(
    element="",
    tuning=False,
    candidates=0,
    requirements=[],
    values=[],
    tolerated=0.0,
    reasons=[],
    applied=False,
    problems=[],
)


QUANTITIES: Mapping[QuantityKind, str] = {
    "detection": "detection threshold",
    "reverse detection": "reverse detection threshold",
    "forgetting": "forgetting threshold",
    "width": "width of the peak",
    "amplitude": "amplitude of the peak",
}
"""Quantities in words."""

BEHAVIOURS = {
    "remembers": "a peak stays after its input",
    "forgets": "a peak vanishes after its input",
    "selects": "two equal inputs end in one peak",
    "multi_peak": "two equal inputs each have a peak",
    "rests": "the field has no peak without input",
    "relaxes_within": "a peak vanishes within {time:g} {time_unit} after its input",
}
"""What a field does, in words, by the name of the requirement."""


class FieldTuning(FieldTask[Tuning]):
    """Tunes one field at a time; `changed` is called from any thread when the message has changed."""

    def __init__(self, changed: Callable[[], None]) -> None:
        super().__init__(NOTHING, "tuning", False, changed)

    def start(
        self, session: int, model: Model, element: str, parameters: Sequence[str], wanted: Mapping[str, Any]
    ) -> None:
        """Tune a field, in a thread.

        Args:
            session: number of the document.
            model: the model.
            element: id of the field.
            parameters: names of its parameters.
            wanted: requirements, each as in a file, and options of the file.

        Raises:
            WorkerError: a part of the model cannot be sent to another process.
        """
        path, packed = model.document.by_id()[element].path, PackedModel.of(model, None)
        asked = {**wanted, "parameters": {f"{path}.{name}": None for name in parameters}, "field": path}
        self.ask(session, element, tuned, packed, asked)

    def shown(self, doc: Document | None) -> Tuning:
        """Return the message; what was tuned is applied if the document has its values."""
        values = self.message.values
        applied = bool(values) and doc is not None and all(_has(doc, v) for v in values)
        return msgspec.structs.replace(self.message, applied=applied)

    def applied(self, doc: Document) -> Document:
        """Return a document with the values that were found.

        Raises:
            DocumentError: nothing was found, or its parameters are no longer there.
        """
        if not self.message.values:
            raise DocumentError("nothing was tuned", fix="Tune a field first")
        for tuned in self.message.values:
            doc = edit.change(doc, tuned.path, tuned.value)
        return doc


def _has(doc: Document, tuned: TunedValue) -> bool:
    """Return whether a parameter of the document has the value that was found."""
    try:
        return bool(find.value(doc, tuned.path) == tuned.value)
    except DeodarError:  # it was removed
        return False


def tuned(
    send: Callable[[object], None], packed: PackedModel, wanted: Mapping[str, Any]
) -> Mapping[str, Any]:
    """Tune a field; called in the worker process. Return fields of the message.

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
            send({"candidates": int(candidates)})

    found = tune(
        packed.model, asked.parameters, asked.requirements, on=Resources(progress=tell), **asked.options
    )
    time_unit = packed.model.document.time_unit
    return {
        "requirements": [
            RequirementView(
                text=text,
                sentence=sentence(requirement, found.reached.get(text), margin >= 0, time_unit),
                margin=margin if math.isfinite(margin) else None,
                value=found.reached.get(text),
                exact=text in found.exact,
            )
            for requirement in found.requirements
            for text, margin in [(str(requirement), found.margins[str(requirement)])]
        ],
        "values": [TunedValue(path=p, before=found.before[p], value=v) for p, v in found.values.items()],
        "tolerated": found.tolerated,
        "reasons": list(found.reasons),
    }


def sentence(requirement: Requirement, measured: float | None, met: bool, time_unit: str) -> str:
    """Return in words what a field does, and what was asked for."""
    quantity = requirement.exact(0.0)
    if quantity is not None:
        name = QUANTITIES[quantity.kind]
        stated = f"{quantity.target:g} \N{PLUS-MINUS SIGN} {quantity.within:g}"
        if measured is None:
            return (
                f"The {name} is {stated}, as you asked."
                if met
                else f"The {name} is not within {stated}, which you asked for."
            )
        # as many digits as a tolerance may need: 3.0004 is not 3 ± 0.0001
        value = f"is {measured:.6g}" if math.isfinite(measured) else "could not be measured"
        return f"The {name} {value}; you asked for {stated}."
    words = BEHAVIOURS.get(type(requirement).__name__, "{requirement}").format_map(
        {**vars(requirement), "requirement": requirement, "time_unit": time_unit}
    )
    return f"As you asked, {words}." if met else f"You asked that {words}; that is not so."
