"""The result of tuning: the model with the found values, and how well they meet the requirements."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

import deodar
from deodar.analysis.tuning.exact_values import ExactValue
from deodar.analysis.tuning.judge import CandidateJudge
from deodar.analysis.tuning.request import TuningRequest
from deodar.analysis.tuning.requirement import Requirement
from deodar.analysis.tuning.search import RegionSize
from deodar.codec import JsonObject
from deodar.model import edit
from deodar.model.model import Model
from deodar.summary import Summarised, Summary

EXACT = 1e-6
"""Largest error of a value that counts as exact, in units of its tolerance."""


@dataclass(frozen=True, repr=False)
class Tuned(Summarised):
    """Parameters of one field at which it meets requirements, or the best that was found.

    Attributes:
        field: path of the field.
        model: a copy of the model with the found values.
        values: the found value of each parameter.
        before: its value in the model that was given.
        requirements: what was required.
        margins: margin of each requirement, by its text: 0 or above if it is met, 1 in the middle of its
            tolerance, or where an on/off requirement is met clearly.
        reached: value of each requirement that has one, from the equations where they have it.
        exact: the requirements whose values are reached exactly, computed from the equations.
        sensitivity: for each value that is computed from the equations its derivative in each parameter,
            times the magnitude of the parameter: the change of the value for a relative change.
        size: how far the parameters may move; None if a requirement is not met.
        conflicts: pairs of requirements that no candidate met together although each was met alone, with the
            best lower margin of both.
        unreachable: requirements that no candidate met.
        interrupted: whether the search was interrupted.
        candidates: number of candidates that were measured.
        about: how it was measured: `strength`, `sigma` and `center` of the input, `places` of two inputs,
            `limit`, `dt`, `precision`, `seed`, `bounds`, and why no equations were used (`not_exact`).
    """

    field: str
    model: Model
    values: Mapping[str, float]
    before: Mapping[str, float]
    requirements: tuple[Requirement, ...]
    margins: Mapping[str, float]
    reached: Mapping[str, float]
    exact: tuple[str, ...]
    sensitivity: Mapping[str, Mapping[str, float]]
    size: RegionSize | None
    conflicts: tuple[tuple[str, str, float], ...]
    unreachable: tuple[str, ...]
    interrupted: bool
    candidates: int
    about: JsonObject = dc.field(repr=False)

    @cached_property
    def met(self) -> bool:
        """Whether all requirements are met."""
        return all(margin >= 0 for margin in self.margins.values())

    @property
    def missed(self) -> tuple[str, ...]:
        """The requirements that are not met."""
        return tuple(name for name, margin in self.margins.items() if margin < 0)

    @property
    def tolerated(self) -> float:
        """The largest relative change that all parameters may have at once, in any direction, while all
        requirements stay met; 0 if one is not met. An estimate, from `size.points` random points.
        """
        return self.size.together if self.size else 0.0

    @property
    def tolerated_alone(self) -> dict[str, tuple[float, float]]:
        """For each parameter its largest relative change downwards and upwards, the others unchanged, up to a
        half.
        """
        return dict(zip(self.values, self.size.alone, strict=True)) if self.size else {}

    @property
    def note(self) -> str:
        """A sentence for the notes of a document: what it is tuned to, and how."""
        values = ", ".join(f"{path} from {self.before[path]:g}" for path in self.values)
        requirements = ", ".join(str(requirement) for requirement in self.requirements)
        met = "" if self.met else f" Not met: {', '.join(self.missed)}."
        seed, version = self.about["seed"], deodar.__version__
        return f"Tuned by deodar {version} (seed {seed}): {values}; for {requirements}.{met}"

    def data(self) -> JsonObject:
        """Return everything but the model as plain data."""
        return {
            "field": self.field,
            "met": self.met,
            "interrupted": self.interrupted,
            "values": dict(self.values),
            "before": dict(self.before),
            "requirements": [str(requirement) for requirement in self.requirements],
            "margins": dict(self.margins),
            "reached": dict(self.reached),
            "exact": list(self.exact),
            "sensitivity": {name: dict(slopes) for name, slopes in self.sensitivity.items()},
            "tolerated": self.tolerated,
            "tolerated_alone": {path: list(pair) for path, pair in self.tolerated_alone.items()},
            "tolerated_points": self.size.points if self.size else 0,
            "conflicts": [list(pair) for pair in self.conflicts],
            "unreachable": list(self.unreachable),
            "candidates": self.candidates,
            **dict(self.about),
        }

    def _summary(self) -> Summary:
        state = "meets all requirements" if self.met else "does not meet all requirements"
        if self.interrupted:
            state += ", interrupted"
        rows: list[tuple[str, ...]] = []
        for name, margin in self.margins.items():
            reached = f"at {self.reached[name]:.6g}" if name in self.reached else ""
            met = ("met" if margin >= 0 else "NOT MET") + (" exactly" if name in self.exact else "")
            rows.append((met, name, reached, f"margin {margin:.2g}"))
        rows += [("value", path, f"{number:.6g}") for path, number in self.values.items()]
        if self.met and self.size:
            rows.append((f"all may move by {self.tolerated:.1%} at once ({self.size.points} random points)",))
        rows += [(sentence,) for sentence in self.reasons]
        return Summary(f"Tuned {self.field}: {state}", rows)

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why not all requirements are met, in words: what no candidate met, alone or together."""
        if self.met:
            return ()
        alone = [f"no candidate met {name}" for name in self.unreachable]
        pairs = [
            f"no candidate met both {a} and {b}; best margin of the worse one: {margin:.2g}"
            for a, b, margin in self.conflicts
        ]
        return (*alone, *pairs)


def result(
    judge: CandidateJudge,
    values: np.ndarray,
    computed: Sequence[ExactValue | None],
    size: RegionSize | None,
    interrupted: bool,
    why: str,
) -> Tuned:
    """Return the result for values of the parameters.

    Args:
        judge: measures candidates.
        values: the values.
        computed: what the equations say of each requirement.
        size: the size of the region.
        interrupted: whether the search was interrupted.
        why: why no equations were used.
    """
    request = judge.request
    names = [str(requirement) for requirement in request.requirements]
    margins = dict(zip(names, judge.margins(values[None], "result")[0].tolist(), strict=True))
    reached = {n: v for n, v in zip(names, judge.values(values), strict=True) if v is not None}
    exact: list[str] = []
    sensitivity: dict[str, Mapping[str, float]] = {}
    for name, requirement, exact_value in zip(names, request.requirements, computed, strict=True):
        quantity = requirement.exact(request.strength)
        if exact_value is None or quantity is None:
            continue
        reached[name] = exact_value.value
        error = abs(exact_value.value - quantity.target) / quantity.within
        if margins[name] >= 0:
            margins[name] = 1 - error
        if error < EXACT:
            exact.append(name)
        slopes = exact_value.slopes * request.space.units(values)
        sensitivity[name] = dict(zip(request.space.paths, slopes.tolist(), strict=True))
    alone = judge.alone
    return Tuned(
        request.isolated.path,
        _with_values(request, values),
        dict(zip(request.space.paths, values.tolist(), strict=True)),
        dict(zip(request.space.paths, request.space.present.tolist(), strict=True)),
        request.requirements,
        margins,
        reached,
        tuple(exact),
        sensitivity,
        size,
        tuple(
            (names[a], names[b], best)
            for (a, b), best in judge.pairs.items()
            if best < 0 <= min(alone[a], alone[b])
        ),
        tuple(name for name, best in zip(names, alone, strict=True) if best < 0),
        interrupted,
        judge.measured,
        _about(request, why),
    )


def _with_values(request: TuningRequest, values: np.ndarray) -> Model:
    """Return a copy of the whole model with the values of the tuned parameters."""
    doc = request.original.document
    for path, value in zip(request.space.paths, values, strict=True):
        doc = edit.change(doc, path, float(value))
    return Model(document=doc, trusted=request.original.trusted)


def _about(request: TuningRequest, why: str) -> JsonObject:
    isolated, space = request.isolated, request.space
    bounds = zip(space.paths, space.low.tolist(), space.high.tolist(), strict=True)
    return {
        "strength": request.strength,
        "sigma": list(isolated.sigma),
        "center": list(isolated.center),
        "places": list(request.places),
        "limit": request.limit,
        "dt": isolated.session.dt,
        "precision": isolated.session.precision,
        "inputs": list(isolated.background),
        "seed": request.seed,
        "budget": request.budget,
        "bounds": {path: [low, high] for path, low, high in bounds},
        "not_exact": why or None,
    }
