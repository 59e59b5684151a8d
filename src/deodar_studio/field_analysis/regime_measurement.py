"""The measurement of the regime of a field, in a worker process, so that the run is not disturbed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from deodar.batch.packed_model import PackedModel
from deodar.element import Element
from deodar.errors import Problem
from deodar.model.model import Model
from deodar_studio.field_analysis.background import BackgroundTask, FieldTask


class MeasuredRegime(NamedTuple):
    """The regime of a field as plain data.

    Attributes:
        words: the regime, the most important first.
        rows: names of the measurements, and their values in words.
        strengths: the strengths of the localised input of the curves.
        up, down: the settled activation at its maximum, for growing and for falling input; None where it is
            not finite.
        threshold: the activation above which a peak exists.
    """

    words: tuple[str, ...]
    rows: list[tuple[str, str]]
    strengths: list[float]
    up: list[float | None]
    down: list[float | None]
    threshold: float


@dataclass(frozen=True)
class RegimeReport:
    """How far the measurement is.

    Attributes:
        session: number of the document.
        element: id of the field; empty: nothing was measured.
        measured: the field that was measured.
        measuring: whether it is being measured.
        found: what was found; None: nothing yet.
        problems: why nothing was found.
    """

    session: int = 0
    element: str = ""
    measured: Element | None = None
    measuring: bool = False
    found: MeasuredRegime | None = None
    problems: Sequence[Problem] = ()


class RegimeMeasurement(FieldTask[RegimeReport]):
    """Measures one field at a time; `changed` is called from any thread when the report has changed."""

    def __init__(self, changed: Callable[[], None]) -> None:
        super().__init__(RegimeReport(), BackgroundTask("deodar-regime", keep=True), changed)

    def start(self, session: int, model: Model, element: str) -> None:
        """Measure a field of a model, in a thread.

        Raises:
            WorkerError: a part of the model cannot be sent to another process.
        """
        entry, packed = model.document.by_id()[element], PackedModel.of(model, None)

        def ended(found: MeasuredRegime | None, problems: Sequence[Problem]) -> None:
            self.report = RegimeReport(session, element, entry.element, False, found, problems)
            self._changed()

        self.report = RegimeReport(session, element, entry.element, measuring=True)
        self._task.start(measured, [packed, entry.path], ended)
        self._changed()


def measured(send: Callable[[object], None], packed: PackedModel, path: str) -> MeasuredRegime:
    """Measure a field; called in the worker process."""
    # start-up time of the studio: this brings SciPy
    from deodar.analysis import regime_words
    from deodar.analysis.regimes import regimes

    found = regimes(packed.model, path)
    ramp = found.ramp
    return MeasuredRegime(
        found.words,
        regime_words.rows(found)[1:],
        ramp.values.tolist(),
        _finite(ramp.up.activation),
        _finite(ramp.down.activation),
        found.isolated.threshold,
    )


def _finite(values: np.ndarray) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]
