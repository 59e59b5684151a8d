"""The measurement of the regime of a field, in a worker process, so that the run is not disturbed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import msgspec
import numpy as np

from deodar.batch.packed_model import PackedModel
from deodar.element import Element
from deodar.model.document import Document
from deodar.model.model import Model
from deodar_studio.field_analysis.background import FieldTask
from deodar_studio.messages.to_page import Regime, RegimeCurve, RegimeRow

NOTHING = Regime(element="", measuring=False, stale=False, words=[], rows=[], curve=None, problems=[])


class RegimeMeasurement(FieldTask[Regime]):
    """Measures one field at a time; `changed` is called from any thread when the message has changed."""

    def __init__(self, changed: Callable[[], None]) -> None:
        super().__init__(NOTHING, "measuring", True, changed)
        self._measured: Element | None = None

    def start(self, session: int, model: Model, element: str) -> None:
        """Measure a field of a model, in a thread.

        Raises:
            WorkerError: a part of the model cannot be sent to another process.
        """
        entry, packed = model.document.by_id()[element], PackedModel.of(model, None)
        self._measured = entry.element
        self.ask(session, element, measured, packed, entry.path)

    def shown(self, doc: Document | None) -> Regime:
        """Return the message; it is stale if the element of the document is another one by now."""
        element = self.message.element
        entry = None if doc is None else doc.by_id().get(element)
        stale = bool(element) and (entry is None or entry.element is not self._measured)
        return msgspec.structs.replace(self.message, stale=stale)


def measured(send: Callable[[object], None], packed: PackedModel, path: str) -> Mapping[str, Any]:
    """Measure a field; called in the worker process. Return fields of the message."""
    # start-up time of the studio: this brings SciPy
    from deodar.analysis import regime_words
    from deodar.analysis.regimes import regimes

    found = regimes(packed.model, path)
    ramp = found.ramp
    curve = RegimeCurve(
        input=ramp.values.tolist(),
        up=_finite(ramp.up.activation),
        down=_finite(ramp.down.activation),
        threshold=found.isolated.threshold,
    )
    rows = [RegimeRow(name=name, text=text) for name, text in regime_words.rows(found)[1:]]
    return {"words": list(found.words), "rows": rows, "curve": curve}


def _finite(values: np.ndarray) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]
