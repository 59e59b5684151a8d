"""The measurement of the regime of a field, in a worker process, so that the run is not disturbed."""

from __future__ import annotations

import dataclasses as dc
import threading
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from deodar.batch.packed import PackedModel
from deodar.batch.pool import Pool
from deodar.element import Element
from deodar.errors import DeodarError, Problem
from deodar.model.model import Model


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


@dc.dataclass(frozen=True)
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


class RegimeMeasurement:
    """Measures one field at a time; a new request ends the one before.

    Args:
        changed: called from any thread when the report has changed.
    """

    def __init__(self, changed: Callable[[], None]) -> None:
        self.report = RegimeReport()
        self._changed = changed
        self._attempt = 0
        self._lock = threading.Lock()
        self._pool: Pool | None = None

    def start(self, session: int, model: Model, element: str) -> None:
        """Measure a field of a model, in a thread.

        Raises:
            WorkerError: a part of the model cannot be sent to another process.
        """
        entry, packed = model.document.by_id()[element], PackedModel.of(model, None)
        self._attempt += 1
        self.report = RegimeReport(session, element, entry.element, measuring=True)
        arguments = self._attempt, packed, entry.path
        threading.Thread(target=self._work, args=arguments, name="deodar-regime", daemon=True).start()
        self._changed()

    def stop(self) -> None:
        """End the measurement; what was found before is gone."""
        self._attempt += 1
        self.report = RegimeReport()
        self._changed()

    def end(self) -> None:
        """End the measurement and its process, and wait until they have ended."""
        self._attempt += 1
        with self._lock:
            self._close()

    def _work(self, attempt: int, packed: PackedModel, path: str) -> None:
        with self._lock:  # the attempt before ends first
            try:
                found, problems = self._found(attempt, packed, path), ()
            except DeodarError as error:
                found, problems = None, error.problems
            except Exception as error:  # functions that the document names run in the worker
                found, problems = None, [Problem(path, f"{type(error).__name__}: {error}")]
        if attempt == self._attempt:
            self.report = dc.replace(self.report, measuring=False, found=found, problems=problems)
            self._changed()

    def _found(self, attempt: int, packed: PackedModel, path: str) -> MeasuredRegime | None:
        """Return what the worker finds; None if another attempt began meanwhile."""
        if attempt != self._attempt:
            return None
        try:
            if self._pool is None:
                self._pool = Pool(1).__enter__()
            self._pool.give(0, measured, packed, path)
            while attempt == self._attempt:
                for _, result in self._pool.wait(0.2):
                    return result
        except BaseException:
            self._close()
            raise
        self._close()
        return None

    def _close(self) -> None:
        pool, self._pool = self._pool, None
        if pool is not None:
            pool.__exit__(KeyboardInterrupt, None, None)


def measured(packed: PackedModel, path: str) -> MeasuredRegime:
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
