"""SynapticConnection: a whole connection between fields as one step."""

from __future__ import annotations

import numpy as np

from deodar.couplings.convolve import Convolve
from deodar.elements.pattern import Pattern
from deodar.numerics.kernels._base import Kernel
from deodar_interop.importers.cedar.border import CedarBorder, border
from deodar_interop.importers.cedar.classes.algebra import largest, projected
from deodar_interop.importers.cedar.composition import Composition, StepSignal
from deodar_interop.importers.cedar.convolution_kernels import kernels, too_long
from deodar_interop.importers.cedar.grid import Counts
from deodar_interop.importers.cedar.piece import SourceStep, StepPiece

REDUCTIONS = ("SUM", "MAXIMUM")


def synaptic(b: SourceStep) -> StepPiece:
    """Translate SynapticConnection: the inputs are added up, convolved, multiplied by point-wise weights and
    by one weight, and projected.
    """
    inputs = b.all("matrix")
    dims, c = largest(inputs, "matrix"), Composition(b)
    signal = c.slot("matrix", dims)
    c.piece.sums = frozenset({"matrix"})
    if len(inputs) > 1:
        signal = c.total("inputs", signal)
    signal = _convolved(c, signal, dims)
    signal, weighted = _weighted(c, signal, dims)
    projection = b.values.inside("projection")
    enabled = projection.flag("enabled", False)
    if "static gain" in b.values.body:
        b.values.say("static gain")
    weight = b.values.inside("static gain").number("Synapse Weight", 1.0)
    signal = c.gain("weight" if enabled else "", weight, signal)
    if enabled:
        element, dims = projected(b, projection, dims, b.label, REDUCTIONS)
        signal = c.add(element, input=signal)
    else:
        for key in projection.body:
            if key != "enabled":
                projection.say(key, "carried", "without effect: the projection is not enabled")
    if "projection" in b.values.body:
        b.values.say("projection")
    c.outlet("result", signal, dims)
    why = ", ".join(dict.fromkeys(type(element).__name__ for element in c.piece.elements))
    if weighted:
        return c.done(f"{why}; that point-wise weights lie around the middle is a guess", "approximated")
    return c.done(why)


def _convolved(c: Composition, signal: StepSignal, dims: Counts) -> StepSignal:
    """Return a signal convolved with the kernels of the object `convolution`; without kernels itself."""
    values, axes = c.b.values, c.b.axes(dims)
    ends = border(values, "convolution", len(dims))
    listed = values.inside("convolution").objects("kernels")
    c.piece.fails = too_long(listed, axes, ends) if dims else ""
    return _applied(c, "convolved", signal, kernels(listed, axes, ends), dims)


def _weighted(c: Composition, signal: StepSignal, dims: Counts) -> tuple[StepSignal, bool]:
    """Return a signal multiplied by the kernels of the object `PointWiseWeight`, and whether it has any.

    The kernels lie around the middle sample: the weights are what they make of one active sample there.
    """
    values, axes = c.b.values, c.b.axes(dims)
    if "PointWiseWeight" in values.body:
        values.say("PointWiseWeight")
    point_kernels = kernels(values.inside("PointWiseWeight").objects("kernels"), axes, CedarBorder())
    if not point_kernels:
        return signal, False
    if not dims:
        return _applied(c, "point-wise weight", signal, point_kernels, dims), True
    impulse = np.zeros(dims)
    impulse[tuple(n // 2 for n in dims)] = 1.0
    middle = c.add(Pattern(c.named("middle"), axes, impulse))
    weights = _applied(c, "point-wise weights", middle, point_kernels, dims)
    return c.product("weighted", signal, weights), True


def _applied(
    c: Composition, role: str, signal: StepSignal, convolution: list[Kernel], dims: Counts
) -> StepSignal:
    """Return a signal convolved with kernels; of one number a multiple."""
    if not convolution:
        return signal
    if not dims:
        return c.gain(role, sum(float(getattr(k, "amplitude", 0.0)) for k in convolution), signal)
    return c.add(Convolve(convolution, name=c.named(role)), input=signal)


CLASSES = {"cedar.processing.SynapticConnection": synaptic}
