"""Changes of size and dimension. The size of the input is that of the source, not of the parameters."""

from __future__ import annotations

import dataclasses as dc
import math

import numpy as np

from deodar.couplings.arithmetic import Product
from deodar.couplings.projections import Project
from deodar.couplings.weights import Weights
from deodar.elements.stimuli import Pattern
from deodar.numerics.axes import shape
from deodar_interop.importers._element import ElementSignal, translates
from deodar_interop.importers._piece import Dims, Unfit, axes
from deodar_interop.importers.dnf_composer.element import StoredElement
from deodar_interop.importers.dnf_composer.sample_values import METHODS, matrix
from deodar_interop.importers.dnf_composer.values import is_plane, size

DENSE = 1_000_000
"""Largest number of weights that resample a plane at once; beyond, each axis is resampled in turn."""

COMPRESSIONS = {"sum": "sum", "average": "mean", "maximum": "max", "minimum": "min"}
"""Reductions of `collapse`, and those of `Project`."""


@translates("resize")
def resize(b: StoredElement) -> ElementSignal:
    """Translate `resize`: weights that interpolate."""
    dims, method = b.dims(), b.values.choice("method", METHODS)
    rows, came = _came(b, b.counts)
    if rows != 1:
        came *= rows  # a plane is taken as one line
    b.budget.take(came * b.counts[1])
    return _weights(b, b.of((1, came)), dims, matrix(method, came, b.counts[1]))


@translates("resize 2d")
def resize_2d(b: StoredElement) -> ElementSignal:
    """Translate `resize 2d`: interpolation along x, then along y."""
    dims, method = b.dims(), b.values.choice("method", METHODS)
    counts = _came(b, b.counts)
    came = b.of(counts)
    factors = [matrix(method, n, m) for n, m in zip(counts, b.counts, strict=True)]
    if math.prod(f.size for f in factors) <= DENSE:
        b.budget.take(math.prod(f.size for f in factors))
        return _weights(b, came, dims, np.kron(factors[0], factors[1]))
    pairs = [(d, a, z) for d in (1, 0) if (a := came[d]) != (z := dims[d])]
    if None in came or None in dims or not pairs:
        raise Unfit(f"it resamples {list(counts)} to {list(b.counts)} samples, which has no counterpart")
    seen, shrinking = b.input(came), list(axes(came))
    for d, old, new in pairs:
        assert old is not None and new is not None
        b.budget.take(factors[d].size)
        wide = (*shrinking, new)
        shrinking[d] = new
        reach = b.add(Project(wide, name=b.named(f"spread along {new.name}")), wide, input=seen)
        weights = b.add(Pattern(b.named(f"weights along {old.name}"), (new, old), factors[d]), (new, old))
        spread = Product(name=b.named(f"products along {old.name}"))
        name = b.named(f"along {old.name}" if (d, old, new) != pairs[-1] else "")
        products = b.add(spread, input=reach, factor=weights)
        seen = b.add(Project(shrinking, "sum", name=name), tuple(shrinking), input=products)
    b.explain("Project, Product and Pattern")
    return dc.replace(seen, dims=dims)


@translates("collapse")
def collapse(b: StoredElement) -> ElementSignal:
    """Translate `collapse`: a reduction over one axis of a plane."""
    dims = b.dims()
    reduction = COMPRESSIONS[b.values.choice("compression", tuple(COMPRESSIONS))]
    kept_dimension = 1 if b.values.choice("keepAxis", ("x", "y")) == "x" else 0
    fallback = (1, b.counts[1]) if kept_dimension else (b.counts[1], 1)
    counts = _came(b, fallback)
    source = b.source()
    if source is not None and not is_plane(source):
        raise Unfit("its source has one dimension")
    if counts[kept_dimension] != b.counts[1]:
        raise Unfit(f"its output has {b.counts[1]} samples, where its source has {counts[kept_dimension]}")
    came = b.of(counts)
    places = [dims[1] if d == kept_dimension else None for d, axis in enumerate(came) if axis is not None]
    return b.projected("", b.input(came), dims, places, reduction)


@translates("expand")
def expand(b: StoredElement) -> ElementSignal:
    """Translate `expand`: copies of a line along the other axis of a plane."""
    dims = b.dims()
    along = 1 if b.values.choice("broadcastProfileAxis", ("x", "y")) == "x" else 0
    counts = _came(b, (1, b.counts[along]))
    source = b.source()
    if source is not None and is_plane(source):
        raise Unfit("its source has two dimensions")
    if counts[1] != b.counts[along]:
        raise Unfit(f"its input has {counts[1]} samples, its output {b.counts[along]}")
    came = b.of(counts)
    return b.projected("", b.input(came), dims, [dims[along]] if came[1] is not None else [])


# ----------------------------------------------------------------------------------------------------- inside


def _came(b: StoredElement, fallback: tuple[int, int]) -> tuple[int, int]:
    """Return the size of the source, and report the parameters that repeat it."""
    for name in ("input_x_max", "input_d_x", "input_y_max", "input_d_y"):
        if name in b.element.values:
            b.values.say(name, "carried", "it follows from the source, as in dnf-composer")
    source = b.source()
    return fallback if source is None else size(source)


def _weights(b: StoredElement, came: Dims, dims: Dims, weights: np.ndarray) -> ElementSignal:
    ours = weights.reshape(shape(axes(dims)) + shape(axes(came)))
    return b.add(Weights(ours, axes(dims), name=b.label), dims, input=b.input(came))
