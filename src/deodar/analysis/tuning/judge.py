"""The margins of candidates for all requirements, and a record of the best of them."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from deodar.analysis.tuning.protocol import TuningProtocol
from deodar.analysis.tuning.request import TuningRequest
from deodar.analysis.tuning.requirement import Requirement
from deodar.analysis.tuning.response import LOST, FieldResponse
from deodar.errors import AnalysisError
from deodar.progress import Tell


class CandidateJudge:
    """Measures candidates, and remembers the best one and the best trade-off of each pair of requirements.

    Args:
        request: what is tuned.
        tell: called after each batch, with the number of candidates so far.

    Attributes:
        request: what is tuned.
        measured: number of candidates so far.
        best: values of the candidate with the least loss; empty before the first.
        best_margins: its margins.
        alone: best margin of each requirement.
        pairs: best lower margin of each pair.
    """

    def __init__(self, request: TuningRequest, tell: Tell) -> None:
        self.request = request
        self._protocol = TuningProtocol(request)
        self._tell = tell
        self.measured, self._loss = 0, np.inf
        self.best, self.best_margins = np.zeros(0), np.zeros(0)
        n = len(request.requirements)
        self.alone = np.full(n, -np.inf)
        self.pairs = {pair: -np.inf for pair in combinations(range(n), 2)}

    @property
    def lanes(self) -> int:
        """How many candidates cost as much as one."""
        return self._protocol.lanes

    def margins(self, values: np.ndarray, what: str) -> np.ndarray:
        """Return the margins of candidates, (candidates, requirements).

        Args:
            values: values of the parameters, (candidates, parameters).
            what: what is done, for progress.

        Raises:
            AnalysisError: the margin of a requirement is not one number for each candidate.
        """
        parts: list[np.ndarray] = []
        for response, batch in self._protocol.responses(values):
            rows = [self._margin(of, response, len(batch)) for of in self.request.requirements]
            parts.append(np.stack(rows, axis=1))
            self._note(batch, parts[-1], what)
        return np.concatenate(parts)

    def _margin(self, requirement: Requirement, response: FieldResponse, n: int) -> np.ndarray:
        margin = np.asarray(requirement.margin(response), float)
        if margin.shape != (n,):
            raise AnalysisError(
                f"the margin of {requirement} has the shape {list(margin.shape)}",
                fix=f"Return one number for each of the {n} candidates",
            )
        return np.nan_to_num(margin, nan=LOST, neginf=LOST)

    def _note(self, values: np.ndarray, margins: np.ndarray, what: str) -> None:
        self.measured += len(values)
        lost = losses(margins)
        k = int(lost.argmin())
        if lost[k] < self._loss:
            self._loss, self.best, self.best_margins = float(lost[k]), values[k].copy(), margins[k].copy()
        self.alone = np.maximum(self.alone, margins.max(0))
        for a, b in self.pairs:
            self.pairs[a, b] = max(self.pairs[a, b], float(np.minimum(margins[:, a], margins[:, b]).max()))
        margin = float(self.best_margins.min())
        self._tell(self.measured, stage=f"{what}, margin {margin:.2g}", margin=margin)

    def values(self, candidate: np.ndarray) -> list[float | None]:
        """Return the measured value of each requirement of one candidate."""
        response, _ = next(self._protocol.responses(candidate[None]))
        measured = [requirement.value(response) for requirement in self.request.requirements]
        return [None if value is None else float(value[0]) for value in measured]


def losses(margins: np.ndarray) -> np.ndarray:
    """Return the loss of candidates, (candidates, requirements): 0 if all requirements are met.

    Each margin below 0 adds the logarithm of 1 + its square, so that no requirement that is missed by far
    hides the others.
    """
    return np.log1p(4 * np.minimum(margins, 0.0) ** 2).sum(-1)
