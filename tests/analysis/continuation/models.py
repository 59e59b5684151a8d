"""Models whose bifurcations are known."""

from __future__ import annotations

import numpy as np

import deodar as dd


def node(excitation: float = 6.0) -> dd.Model:
    """Return a node with self-excitation and the input `s`."""
    model = dd.Model("node")
    kernel = [dd.Gaussian(excitation)] if excitation else []
    u = model.add(dd.Field("u", tau=20, resting_level=-5, kernel=kernel))
    model.add(dd.Boost("s", amplitude=0.0)) >> u
    return model


def node_folds(excitation: float = 6.0, beta: float = 4.0) -> tuple[float, float]:
    """Return the inputs of its folds, detection first: where w g'(u) = 1, and s = u - h - w g(u)."""
    root = np.sqrt(1 - 4 / (beta * excitation))
    inputs = []
    for output in ((1 - root) / 2, (1 + root) / 2):
        u = np.log(output / (1 - output)) / beta
        inputs.append(float(u + 5 - excitation * output))
    return inputs[0], inputs[1]


def line(samples: int = 101, excitation: float = 8.0, inhibition: float = 0.1, beta: float = 4.0) -> dd.Model:
    """Return the field of docs/instabilities.md with the inputs `s` (localised) and `boost`."""
    x = dd.Axis("x", 0, 100, samples)
    model = dd.Model("line")
    kernel = [dd.Gaussian(excitation, 5, normalized=True)]
    field = dd.Field("u", [x], tau=20, resting_level=-5, kernel=kernel, global_inhibition=inhibition)
    u = model.add(field)
    model.set("u.sigmoid.beta", beta)
    model.add(dd.GaussianStimulus("s", [x], center=50, sigma=5, amplitude=0.0)) >> u
    model.add(dd.Boost("boost", [x], amplitude=0.0)) >> u
    return model


def rivals(samples: int = 201) -> dd.Model:
    """Return a field with two equal inputs, mirror images of each other."""
    x = dd.Axis("x", 0, 100, samples)
    model = dd.Model("rivals")
    field = dd.Field("u", [x], tau=20, resting_level=-5, kernel=[dd.Gaussian(12, 5, normalized=True)])
    u = model.add(field)
    model.set("u.global_inhibition", 0.1)
    for name, center in (("left", 30), ("right", 70)):
        model.add(dd.GaussianStimulus(name, [x], center=center, sigma=5, amplitude=6)) >> u
    return model


def oscillator(dt: float = 1.0) -> dd.Model:
    """Return an excitatory and an inhibitory node, which oscillate between two Hopf points."""
    model = dd.Model("oscillator", dt=dt)
    e = model.add(dd.Field("e", tau=20, resting_level=-4.0, kernel=[dd.Gaussian(2.5)]))
    i = model.add(dd.Field("i", tau=40, resting_level=-3.0, sigmoid=dd.Logistic(beta=1)))
    e >> dd.Gain(6.0, name="forth") >> i
    i >> dd.Gain(-6.0, name="back") >> e
    return model


def plane(samples: int = 30) -> dd.Model:
    """Return a field over two axes with a localised input `s`, with more states than have matrices."""
    x, y = (dd.Axis(name, 0, 30, samples) for name in "xy")
    model = dd.Model("plane")
    kernel = [dd.Gaussian(14, 3, normalized=True)]
    field = dd.Field("u", [x, y], tau=20, resting_level=-5, kernel=kernel, global_inhibition=0.05)
    u = model.add(field)
    model.add(dd.GaussianStimulus("s", [x, y], center=(15, 15), sigma=3, amplitude=0.0)) >> u
    return model
