"""Fields, nodes, integrators and traces."""

from __future__ import annotations

from typing import Any

import numpy as np

from deodar.elements.field import Field
from deodar.elements.memories import MemoryTrace
from deodar.elements.placeholder import Placeholder
from deodar.elements.populations import RateNode
from deodar.elements.variables import Integrator
from deodar.parameters import FrozenArray
from deodar_interop.exporters.cosivina.classes.algebra import logistic
from deodar_interop.exporters.cosivina.classes.kernels import field_kernels
from deodar_interop.exporters.cosivina.classes.stimuli import noise_part
from deodar_interop.exporters.cosivina.draft import Given, Unwritable
from deodar_interop.exporters.cosivina.inverse import inverse
from deodar_interop.exporters.cosivina.layout import size


def field(b: Given, element: Field) -> None:
    """Write NeuralField; kernels, global inhibition and noise of the field are elements of their own."""
    beta, threshold = logistic(b, element.sigmoid)
    values = {"tau": element.tau, "h": element.resting_level - threshold, "beta": beta}
    part = b.sized("NeuralField", values, sums=True)
    if threshold:
        b.say("resting_level", "carried", f"less the threshold, {values['h']:g}; cosivina's threshold is 0")
        if b.draft.readers(b.id, "activation"):
            b.approximate(f"its activation is lower by the threshold {threshold:g} of its sigmoid")
    if element.quadrature != "point" and element.axes:
        b.say("quadrature", "dropped", "cosivina takes the output at the sample")
        b.approximate("its output is that at the sample, not the mean over the cell")
    for level in b.draft.followers(b.id, "h"):
        if getattr(level.element, "amplitude", None) == element.resting_level:
            b.claim([level])
            b.show(part, "output", "h", of=level.id, dims=(None, None), free=True)
    b.take(part)
    for port, component in (("output", "output"), ("bounded", "output"), ("activation", "activation")):
        b.show(part, port, component)
    field_kernels(b, element, part)
    if element.noise:
        noise = noise_part(
            b, tuple(element.axes), element.noise, element.noise_length, label=f"noise {b.label}"
        )
        b.inner(part, noise, after=None)


def rate_node(b: Given, element: RateNode) -> None:
    """Write SingleNodeDynamics."""
    beta, threshold = logistic(b, element.sigmoid)
    if threshold:
        b.say("sigmoid", "approximated", "cosivina's threshold is 0; the resting level is lower by it")
        b.approximate(f"its activation is lower by the threshold {threshold:g} of its sigmoid")
    part = b.part(
        "SingleNodeDynamics",
        {
            "tau": element.tau,
            "h": element.resting_level - threshold,
            "beta": beta,
            "selfExcitation": element.self_excitation,
            "noiseLevel": element.noise,
        },
        sums=True,
    )
    b.take(part)
    for port, component in (("output", "output"), ("activation", "activation"), ("rate", "rateOfChange")):
        b.show(part, port, component)


def memory_trace(b: Given, element: MemoryTrace) -> None:
    """Write MemoryTrace, whose rates are per step."""
    if element.graded or element.gated or element.fades:
        what = [name for name in ("graded", "gated", "fades") if getattr(element, name)]
        for name in what:
            b.say(name, "dropped", "cosivina has no such memory trace")
        b.approximate(f"cosivina's trace is not {' and '.join(what)}")
    if element.start is not None:
        b.say("start", "dropped", "cosivina begins with 0")
        b.approximate("it begins with 0")
    step = b.draft.step
    build, decay = (
        inverse(lambda v: max(v * step, 1e-6), t, t / step) for t in (element.tau_build, element.tau_decay)
    )
    part = b.sized("MemoryTrace", {"tauBuild": build, "tauDecay": decay, "threshold": element.threshold})
    b.carry(part)
    b.show(part, "active", "activeRegions")


def integrator(b: Given, element: Integrator) -> None:
    """Write DynamicVariable, with the time constant 1 / rate."""
    if not element.rate:
        raise Unwritable("cosivina divides by the time constant, which a rate of 0 does not have")
    initial: Any = element.initial
    if isinstance(element.start, FrozenArray):
        initial = np.reshape(element.start.data, size(b.dims())).tolist()
    tau = inverse(lambda v: 1 / v, element.rate, 1 / element.rate)
    part = b.sized("DynamicVariable", {"tau": tau, "initialState": initial}, sums=True)
    b.take(part)
    b.show(part, "output", "state")


def placeholder(b: Given, element: Placeholder) -> None:
    """Leave out a placeholder, which gives 0."""
    raise Unwritable(f"it stands for {element.missing or 'a missing element'}, whose parameters are not here")


KINDS = {
    Field: field,
    RateNode: rate_node,
    MemoryTrace: memory_trace,
    Integrator: integrator,
    Placeholder: placeholder,
}
