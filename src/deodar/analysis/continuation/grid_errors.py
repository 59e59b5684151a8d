"""The dependence of a field's thresholds on its grid, in percent, for two quadratures."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from dataclasses import dataclass

from deodar.analysis.continuation.confirmation import central, folds
from deodar.analysis.discretisation import obstacle, refined
from deodar.analysis.isolated import Isolated, isolate
from deodar.analysis.regimes import Regimes
from deodar.codec import JsonObject
from deodar.elements.field import Field
from deodar.errors import AnalysisError


@dataclass(frozen=True)
class GridError:
    """The error of thresholds on a field's own grid.

    Attributes:
        quadrature: quadrature on this grid.
        between: whether the input lies between samples along each axis, else on a sample.
        percent: for each threshold that is a fold, its value on this grid minus that on a grid twice as fine
            with means over cells, in percent of the latter; None: one of both was not found.
    """

    quadrature: str
    between: bool
    percent: Mapping[str, float | None]

    def data(self) -> JsonObject:
        """Return it as plain data."""
        return {
            "quadrature": self.quadrature,
            "between_samples": self.between,
            "percent": dict(self.percent),
        }


def grid_errors(measured: Regimes) -> list[GridError]:
    """Compute by how much the grid changes detection, reverse detection and forgetting.

    Thresholds are folds, with the field's own quadrature and with `cell`, for an input on a sample and for
    one between two samples along each axis. Forgetting is computed where the input is in the middle of each
    axis of both grids.

    Args:
        measured: the measured regime of a field.

    Raises:
        AnalysisError: if the field cannot be measured on a finer grid.
    """
    isolated = measured.isolated
    if why := obstacle(isolated):
        raise AnalysisError(
            f"the thresholds cannot be compared with those of a finer grid: {why}",
            where=isolated.path,
            fix="Call it only where obstacle(measured.isolated) is empty",
        )
    over_cells = dc.replace(isolated.field, quadrature="cell")
    errors: list[GridError] = []
    for between in (False, True):
        exact = _thresholds(refined(over_cells), between, measured)
        for quadrature in dict.fromkeys((isolated.field.quadrature, "cell")):
            field = dc.replace(isolated.field, quadrature=quadrature)
            coarse = _thresholds(field, between, measured)
            percent = {n: _percent(coarse[n], fine) for n, fine in exact.items() if n in coarse}
            errors.append(GridError(quadrature, between, percent))
    return errors


def _thresholds(field: Field, between: bool, measured: Regimes) -> dict[str, float | None]:
    """Return the folds of a field, None where one was not found; forgetting only for a central input."""
    isolated = measured.isolated
    half = [0.5 * a.step * (a.samples > 1) * between for a in isolated.axes]
    moved: Isolated = isolate(
        field,
        sigma=isolated.sigma,
        center=[c + h for c, h in zip(isolated.center, half, strict=True)],
        precision=isolated.session.precision,
        dt=isolated.session.dt,
    )
    return {
        name: fold.value
        for name, fold in folds(moved, measured).items()
        if name != "forgetting" or central(moved)
    }


def _percent(coarse: float | None, fine: float | None) -> float | None:
    return None if coarse is None or not fine else 100 * (coarse / fine - 1)
