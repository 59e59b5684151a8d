"""SynapticConnection: a whole connection between fields as one step."""

from __future__ import annotations

import numpy as np

from deodar.elements.pattern import Pattern
from deodar_interop.importers.cedar.border import CedarBorder, border
from deodar_interop.importers.cedar.classes.algebra import remapped
from deodar_interop.importers.cedar.composition import SourceStep, StepSignal, step
from deodar_interop.importers.cedar.convolution_kernels import kernels, too_long

REDUCTIONS = ("SUM", "MAXIMUM")


@step("cedar.processing.SynapticConnection", gives="result")
def synaptic(s: SourceStep) -> StepSignal:
    """Translate SynapticConnection: the inputs are added up, convolved, multiplied by point-wise weights and
    by one weight, and projected.
    """
    signal = s.added("matrix")
    if len(s.ins["matrix"]) > 1:
        signal = s.total("inputs", signal)
    convolved = _convolved(s, signal)
    signal = _weighted(s, convolved)
    is_weighted = signal is not convolved
    inside = s.values.inside("projection")
    enabled = inside.flag("enabled", False)
    if "static gain" in s.values.body:
        s.values.say("static gain")
    weight = s.values.inside("static gain").number("Synapse Weight", 1.0)
    signal = s.gain("weight" if enabled else "", weight, signal)
    if enabled:
        signal = remapped(s, inside, signal, REDUCTIONS)
    else:
        for key in inside.body:
            if key != "enabled":
                inside.say(key, "carried", "without effect: the projection is not enabled")
    if "projection" in s.values.body:
        s.values.say("projection")
    why = ", ".join(dict.fromkeys(type(element).__name__ for element in s.piece.elements))
    if is_weighted:
        s.explain(f"{why}; that point-wise weights lie around the middle is a guess", "approximated")
    else:
        s.explain(why)
    return signal


def _convolved(s: SourceStep, signal: StepSignal) -> StepSignal:
    """Return a signal convolved with the kernels of the object `convolution`; without kernels itself."""
    ends = border(s.values, "convolution", len(signal.dims))
    listed = s.values.inside("convolution").objects("kernels")
    s.piece.fails = too_long(listed, signal.axes, ends) if signal.dims else ""
    convolution = kernels(listed, signal.axes, ends)
    return s.convolved("convolved", convolution, signal) if convolution else signal


def _weighted(s: SourceStep, signal: StepSignal) -> StepSignal:
    """Return a signal multiplied by the kernels of the object `PointWiseWeight`; without kernels itself.

    The kernels lie around the middle sample: the weights are what they make of one active sample there.
    """
    if "PointWiseWeight" in s.values.body:
        s.values.say("PointWiseWeight")
    listed = s.values.inside("PointWiseWeight").objects("kernels")
    point_kernels = kernels(listed, signal.axes, CedarBorder())
    if not point_kernels:
        return signal
    if not signal.dims:
        return s.convolved("point-wise weight", point_kernels, signal)
    impulse = np.zeros(signal.dims)
    impulse[tuple(n // 2 for n in signal.dims)] = 1.0
    middle = s.add(Pattern(s.named("middle"), signal.axes, impulse))
    return s.product("weighted", signal, s.convolved("point-wise weights", point_kernels, middle))
