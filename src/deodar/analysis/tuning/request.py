"""What is tuned: one field alone, its parameters, its requirements, and the inputs of the protocol."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any, Unpack

from deodar.analysis.isolated import Isolated, Isolation, isolate
from deodar.analysis.settling_copies import (
    STRONG,
    SettlingRequest,
    driven_alone,
    only_field,
    positive,
    require_one_axis,
    with_inputs,
)
from deodar.analysis.tuning.candidates import CandidateSpace, candidate_space
from deodar.analysis.tuning.requirement import Requirement, detects
from deodar.elements.stimuli import Boost
from deodar.errors import AnalysisError, ParameterError
from deodar.model.model import Model
from deodar.parameters import show

LIMIT = 300.0
"""Longest stage, in time constants."""

BUDGET = 8000
"""Candidates of the search."""

STEPS = 10
"""Euler steps in a time constant, the fewest that `isolate` takes."""

INPUTS = ("middle", "first", "second", "boost")
"""The inputs of the protocol."""


class TuneOptions(Isolation, total=False):
    """Keyword arguments of `tune`: those of `isolate`, and of the search."""

    strength: float | None
    seed: int
    budget: int
    limit: float


@dataclass(frozen=True, kw_only=True)
class TuningRequest(SettlingRequest):
    """One field alone, and what is wanted of it; its model has the input `boost` too.

    Attributes:
        original: the whole model.
        space: the parameters and their bounds.
        names: names of the document parameters of `model` that drive what is tuned.
        requirements: what the field is to do.
        seed: seed of the search.
        budget: most candidates of the search.
    """

    original: Model
    space: CandidateSpace
    names: tuple[str, ...]
    requirements: tuple[Requirement, ...]
    seed: int
    budget: int


def requested(
    model: Model,
    parameters: Sequence[str],
    requirements: Sequence[Requirement],
    field: str,
    bounds: Mapping[str, Any] | None,
    options: TuneOptions,
) -> TuningRequest:
    """Return what is tuned.

    Raises:
        AnalysisError: the element is no field with one axis or none, a parameter changes nothing there, or
            requirements contradict each other.
        ParameterError: a path or value is not one.
    """
    strength, seed, budget, longest, isolation = _divided(**options)
    for name, number in (("seed", seed), ("budget", budget)):
        if not isinstance(number, int) or isinstance(number, bool) or number < 0:
            raise ParameterError(f"{name} is {show(number)}; expected an integer of 0 or above")
    doc = model.document
    path = field or only_field(doc)
    space = candidate_space(doc, parameters, bounds)
    isolated = isolate(model, path, **isolation)
    if isolation.get("dt") is None:
        # what a field settles to does not depend on the step
        isolation["dt"] = isolated.field.tau / STEPS
        isolated = isolate(model, path, **isolation)
    require_one_axis(isolated, "dd.tune", "Tune the same field over one axis")
    required = _possible(requirements, bool(isolated.axes))
    small = with_inputs(isolated, model.trusted)
    small.add(Boost("boost", isolated.axes, amplitude=0.0)) >> small["field"]
    leaves = tuple(driven_alone(doc, small.document, isolated, name) for name in space.paths)
    for a, b in combinations(range(len(leaves)), 2):
        if set(leaves[a]) & set(leaves[b]):
            raise ParameterError(
                f"drives the same number as {space.paths[a]}", where=space.paths[b], fix="Name one of both"
            )
    names = tuple(f"tuned {k}" for k in range(len(leaves)))
    for name, leafs, value in zip(names, leaves, space.present, strict=True):
        small.parameter(name, float(value))
        for ident, leaf in leafs:
            small.link(f"{small.document.by_id()[ident].path}.{leaf}", name)
    return TuningRequest(
        original=model,
        isolated=isolated,
        model=small,
        space=space,
        names=names,
        leaves=leaves,
        requirements=required,
        strength=_amplitude(required, isolated) if strength is None else positive("strength", strength),
        limit=positive("limit", longest),
        seed=seed,
        budget=budget,
    )


def _divided(
    *,
    strength: float | None = None,
    seed: int = 0,
    budget: int = BUDGET,
    limit: float = LIMIT,
    **isolation: Unpack[Isolation],
) -> tuple[float | None, int, int, float, Isolation]:
    """Return the arguments of the search, and those of `isolate`."""
    return strength, seed, budget, limit, isolation


def _amplitude(required: Sequence[Requirement], isolated: Isolated) -> float:
    """Return the amplitude of the inputs: 1.2 times the detection threshold, if one is required above 0."""
    for requirement in required:
        if isinstance(requirement, detects) and requirement.at > 0:
            return STRONG * requirement.at
    return STRONG * isolated.scale


def _possible(requirements: Sequence[Requirement], axis: bool) -> tuple[Requirement, ...]:
    """Return requirements that may be met together."""
    required = () if isinstance(requirements, Requirement) else tuple(requirements)
    if not required:
        raise ParameterError(
            "no requirement is given", fix="Give one or more: [dd.detects(at=3, within=0.2), dd.remembers()]"
        )
    for requirement in required:
        if not isinstance(requirement, Requirement):
            raise ParameterError(
                f"expected a requirement, not {show(requirement)}",
                fix="Give such as dd.detects(at=3, within=0.2)",
            )
        if requirement.needs_axis and not axis:
            raise AnalysisError(f"{requirement} has no meaning on a node, which has no axis")
    for a, b in combinations(required, 2):
        if str(a) == str(b):
            raise ParameterError(f"{a} is required twice", fix="Give it once")
        if why := a.contradicts(b) or b.contradicts(a):
            raise AnalysisError(f"{a} contradicts {b}: {why}", fix="Leave one of both out, or change values")
    return required
