"""Elements between two arrays of other dimensions: sums over dimensions, expansions, transposition, grids."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import jax
import numpy as np

from deodar.numerics import resampling
from deodar.numerics.axes import Axis
from deodar_interop.exporters.cosivina.layout import is_row, size
from deodar_interop.importers._piece import Dims

ConversionStep = tuple[str, dict[str, Any], Dims]
"""Class, parameters and output dimensions of an element."""


class NoConversion(ValueError):
    """Raised if cosivina has no elements for a conversion; the message is the reason."""


def conversion(
    source: Dims,
    target: Dims,
    rename: Mapping[str, str] | None = None,
    reduce: str = "integral",
    whole: bool = False,
    interpolation: str = "linear",
) -> list[ConversionStep]:
    """Return the elements through which an array gets other dimensions; none if it is expanded by itself.

    Args:
        source: dimensions of the array, with their axes.
        target: dimensions that it must have or into which it must fit.
        rename: names of axes of the source and their names in the target.
        reduce: how axes that the target does not have are contracted.
        whole: whether all dimensions of the target must be present in the result.
        interpolation: where the sampling differs.
    """
    names = {a.name: (rename or {}).get(a.name, a.name) for a in source if a is not None}
    here = [a.name for a in target if a is not None]
    steps: list[ConversionStep] = []
    lost = [d for d, a in enumerate(source) if a is not None and names[a.name] not in here]
    if lost:
        step = _contracted(source, target, lost, names, reduce)
        steps.append(step)
        source = step[2]
        names = {a.name: names.get(a.name, a.name) for a in source if a is not None}
    if any(_other_grid(a, names, target) for a in source):
        step = _resampled(source, target, names, interpolation)
        steps.append(step)
        source, names = step[2], {a.name: a.name for a in step[2] if a is not None}
    if _fits(source, target, names) and not (whole and size(source) != size(target)):
        return steps
    return [*steps, _expanded(source, target, names)]


def _fits(source: Dims, target: Dims, names: Mapping[str, str]) -> bool:
    """Return whether each dimension is the target's, or has one sample."""
    padded = (*target, *[None] * len(source))
    return all(
        a is None or (b is not None and names[a.name] == b.name) for a, b in zip(source, padded, strict=False)
    )


def _contracted(
    source: Dims, target: Dims, lost: Sequence[int], names: Mapping[str, str], reduce: str
) -> ConversionStep:
    gone = [a for d in lost if (a := source[d]) is not None]
    factors = {
        "integral": math.prod(a.step for a in gone),
        "sum": 1.0,
        "mean": 1 / math.prod(a.samples for a in gone),
    }
    if reduce not in factors:
        raise NoConversion(f"cosivina has no {reduce} over a dimension")
    dims = _summed([a for d, a in enumerate(source) if a is not None and d not in lost], target, names)
    return (
        "SumDimension",
        {"sumDimensions": [d + 1 for d in lost], "size": size(dims), "amplitude": factors[reduce]},
        dims,
    )


def _summed(kept: Sequence[Axis], target: Dims, names: Mapping[str, str]) -> Dims:
    """Return the dimensions of a sum: a sum is reshaped to any size, so they are those of the target where
    their order is the same.
    """
    own = {names[a.name]: a for a in kept}
    wanted = [names[a.name] for a in kept]
    if wanted != [b.name for b in target if b is not None and b.name in wanted]:
        return tuple(kept) if len(kept) > 1 else (None, *kept)
    dims: Dims = tuple(None if b is None else own.get(b.name) for b in target)
    while len(dims) > 2 and dims[-1] is None:
        dims = dims[:-1]
    return dims


def _other_grid(a: Axis | None, names: Mapping[str, str], target: Dims) -> bool:
    return a is not None and any(
        b is not None and b.name == names[a.name] and b.samples != a.samples for b in target
    )


def _resampled(source: Dims, target: Dims, names: Mapping[str, str], interpolation: str) -> ConversionStep:
    (axis, *more) = [a for a in source if a is not None]
    wanted = next(b for b in target if b is not None and b.name == names[axis.name])
    if more or not is_row(source):
        raise NoConversion("cosivina cannot resample a plane")
    with jax.enable_x64(True):
        weights = np.asarray(resampling.weights(axis, wanted.points, interpolation, "float64"))
    return (
        "WeightMatrix",
        {"size": [axis.samples, wanted.samples], "weights": weights.T.tolist()},
        (None, wanted),
    )


def _expanded(source: Dims, target: Dims, names: Mapping[str, str]) -> ConversionStep:
    """Return the element that moves dimensions to their places, and fills the others with copies."""
    at = {b.name: d for d, b in enumerate(target) if b is not None}
    mapping = [None if a is None else at[names[a.name]] for a in source]
    moved = [d for d in mapping if d is not None]
    rank = sum(b is not None for b in target)
    if len(target) == 2 and len(moved) == rank and len(source) == 2:
        if moved == sorted(moved) and rank == 2:
            return "ExpandDimension", _general(source, target, mapping), target
        return "Transpose", {"size": size(target)}, target
    if len(target) == 2 and len(moved) == 1:
        return "ExpandDimension2D", {"expandDimension": 2 - moved[0], "size": size(target)}, target
    return "ExpandDimension", _general(source, target, mapping), target


def _general(source: Dims, target: Dims, mapping: Sequence[int | None]) -> dict[str, Any]:
    """Return the parameters of the expansion between any numbers of dimensions."""
    unused = [d for d in range(max(len(target), len(source))) if d not in mapping]
    places = [unused.pop(0) if d is None else d for d in mapping]
    return {
        "inputSize": size(source),
        "outputSize": size(target),
        "dimensionMapping": [d + 1 for d in places],
    }
