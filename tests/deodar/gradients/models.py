"""Models of the tests of gradients."""

from __future__ import annotations

import numpy as np

import deodar as dd

X = dd.Axis("x", 0, 20, samples=21)


def field(noise: float = 0.0, samples: int = 21) -> dd.Model:
    """Return a field with a stimulus that comes after two steps."""
    x = dd.Axis("x", 0, 20, samples=samples)
    model = dd.Model("field")
    kernel = [dd.Gaussian(3.0, 2.0)]
    u = model.add(dd.Field("u", [x], tau=10, resting_level=-2, kernel=kernel, noise=noise))
    model.add(dd.GaussianStimulus("s", [x], center=8, sigma=2, amplitude=4, windows=[(2, 1e9)])) >> u
    return model


def mixed() -> dd.Model:
    """Return a field with noise, a trace that runs every third tick, a delay, free weights and a node."""
    model = field(0.5)
    u = model["u"]
    trace = model.add(
        dd.MemoryTrace("trace", [X], tau_build=30, tau_decay=200, graded=True, fades=True), ticks=3
    )
    node = model.add(dd.Field("node", [], tau=5, resting_level=-1))
    model.connect(u, trace)
    model.connect(trace, model.add(dd.Gain(0.5, name="gain")))
    model.connect("gain", u)
    model.connect(u, model.add(dd.Delay([X], name="delay")))
    model.connect("delay", model.add(dd.Weights(np.full(21, 0.1), [], name="sum")))
    model.connect("sum", node)
    model.connect(model.add(dd.Noise("n", [], amplitude=0.2)), node)
    return model
