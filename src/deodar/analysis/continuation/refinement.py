"""The dependence of bifurcations on the grid: the same branch on a grid twice as fine."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable, Sequence

from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.errors import DeodarError
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.numerics.axes import Axis

MOST = 20_000
"""Largest number of samples of one element on the finer grid (a guess: about ten seconds on one core)."""

NEAR = 0.1
"""Largest shift of a bifurcation on the finer grid, as a share of the span; beyond it is another one."""


def refined(model: Model) -> Model | str:
    """Return a model with twice as many steps along each axis, or why there is none.

    A new axis has 2 n - 1 samples, or 2 n if it is periodic, so that it has all old samples.
    """
    doc = model.document
    axes = _axes(doc)
    if not axes:
        return "no element has an axis"
    try:
        for axis in axes:
            samples = 2 * axis.samples if axis.periodic else 2 * axis.samples - 1
            doc = edit.replace_axis(doc, axis, dc.replace(axis, samples=samples))
    except DeodarError as error:
        problem = error.problems[0]
        return f"{problem.where} {problem.what}" if problem.where else problem.what
    largest = max(math.prod(a.samples for a in axes_of_element) for axes_of_element in _all_axes(doc))
    if largest > MOST:
        return f"the grid twice as fine has {largest} samples in one element, more than {MOST}"
    return Model(document=doc, trusted=model.trusted)


def compared(
    coarse: Sequence[Bifurcation], fine: Sequence[Bifurcation], length: float, whole: bool
) -> tuple[Bifurcation, ...]:
    """Return bifurcations with their values on a finer grid: the nearest of the same kind there, each once.

    Args:
        coarse: the bifurcations.
        fine: those of the finer grid.
        length: length of the span.
        whole: whether the finer branch is complete, so that what it lacks is not there.
    """
    pairs = sorted(
        (abs(a.value - b.value) + (0 if a.instability == b.instability else length), k, n)
        for k, a in enumerate(coarse)
        for n, b in enumerate(fine)
        if a.kind == b.kind and abs(a.value - b.value) <= NEAR * length
    )
    matched: dict[int, int] = {}
    for _, k, n in pairs:
        if k not in matched and n not in matched.values():
            matched[k] = n
    return tuple(
        dc.replace(b, fine_value=fine[matched[k]].value, by_grid=False)
        if k in matched
        else dc.replace(b, by_grid=True if whole else None)
        for k, b in enumerate(coarse)
    )


def _axes(doc: Document) -> list[Axis]:
    """Return the axes of a document with more than one sample, each once."""
    unique = {axis: None for axes in _all_axes(doc) for axis in axes if axis.samples > 1}
    return list(unique)


def _all_axes(doc: Document) -> list[tuple[Axis, ...]]:
    return [tuple(axes) for e in doc.entries if (axes := getattr(e.element, "axes", ()))]


FollowBranch = Callable[[Model], tuple[Sequence[Bifurcation], bool]]
"""A function that follows a branch of a model, and says what it found and whether it reached its end."""


def checked(
    model: Model, coarse: Sequence[Bifurcation], length: float, follow: FollowBranch
) -> tuple[tuple[Bifurcation, ...], str]:
    """Return bifurcations with their values on a finer grid, and why there are none."""
    if not coarse:
        return (), ""
    fine = refined(model)
    if isinstance(fine, str):
        return tuple(coarse), fine
    try:
        fine_bifurcations, whole = follow(fine)
    except DeodarError as error:
        return tuple(coarse), f"on the grid twice as fine: {error.problems[0].what}"
    return compared(coarse, fine_bifurcations, length, whole), ""
