"""A small model around the example of a kind.

Sources that fit are found by trying a few kinds of axes, so that a new element or coupling needs no entry
here if one of them fits its example.
"""

from __future__ import annotations

import dataclasses as dc

import numpy as np

from deodar.element import Element
from deodar.elements.changing_stimuli import Noise
from deodar.elements.field import Field
from deodar.elements.stimuli import Boost, GaussianStimulus
from deodar.errors import KindError, Problem
from deodar.leaves import leaves
from deodar.model.check import problems as structural
from deodar.model.document_graph import graph
from deodar.model.model import Model
from deodar.model.resolve import Node
from deodar.numerics.axes import Axes, Axis, shape
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import SigmoidFunction
from deodar.parameters import Part
from deodar.worlds._base import World

NAME = "example"
"""The name of the element in its model."""


class AnyWorld(World):
    """A world that has every sensor and motor, and reads a fixed pattern."""

    def require(self, sensor: str) -> None:
        """Accept every sensor."""

    def require_motor(self, motor: str) -> None:
        """Accept every motor."""

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        return np.random.default_rng(len(sensor)).random(shape(axes))


def candidates(element: Element) -> list[Axes]:
    """Return axes of sources to try, for elements that accept any axes."""
    declared: Axes = tuple(getattr(element, "axes", ()))
    channel = Axis("channel", 0, 2, 3)
    x, y = Axis("x", 0, 20, samples=21), Axis("y", 0, 8, samples=9)
    mixed = [(*declared[:1], channel), (*declared[:2], channel), (*declared, y)]
    return [(x,), declared, (), (x, y), (x, y, channel), *mixed]


def source(name: str, axes: Axes, amplitude: float = 0.8, at: float = 0.4) -> Element:
    """Return a source with a peak near the middle; without axes a number."""
    if not axes:
        return Boost(name, [], amplitude)
    center = [a.lower + at * a.range for a in axes]
    sigma = [max(a.range / 6, a.step / 2) for a in axes]
    return GaussianStimulus(name, axes, center=center, sigma=sigma, amplitude=amplitude)


def around(element: Element, every: int = 1, noisy: bool = False) -> Model:
    """Return a model with the element under its own name, and a source (called `to PORT`) for each of its
    inputs.

    Raises:
        KindError: no source fits.
    """
    problems: list[Problem] = []
    for axes in candidates(element):
        model = Model("contract")
        handle = model.add(element, ticks=every)
        for port in element.ports():
            model.connect(model.add(source(f"to {port}", axes)), handle[port])
            if noisy:
                model.connect(model.add(Noise(f"noise to {port}", axes, 0.02)), handle[port])
        problems = structural(model.document)
        if not problems:
            return model
        if not element.ports():
            break
    raise KindError(problems, kind=type(element).__name__)


def holding(part: Part) -> Element:
    """Return an element with a part: a field with a kernel or a sigmoid; an element itself, renamed."""
    x = Axis("x", 0, 20, samples=21)
    if isinstance(part, SigmoidFunction):
        return Field(NAME, [x], sigmoid=part, kernel=[Gaussian(0.1, 2.0)])
    if isinstance(part, Kernel):
        return Field(NAME, [x], kernel=[part])
    assert isinstance(part, Element)
    return dc.replace(part, name=NAME)


def node(model: Model, path: str = NAME) -> Node:
    """Return an element as the engine resolves it, with the axes at its ports."""
    return next(n for n in graph(model.document).nodes if n.path == path)


def another(number: float, lower: float | None, upper: float | None) -> float:
    """Return another value inside the bounds, far from the first."""
    for new in (1.25 * number + 0.125, 0.75 * number, 0.5 * number - 0.125):
        if new != number and (lower is None or new >= lower) and (upper is None or new <= upper):
            return new
    raise KindError(f"no other value lies between {lower} and {upper} than {number}")


def another_values(element: Element) -> list[tuple[str, float | np.ndarray]]:
    """Return for each traced leaf of an element another value: (path, value)."""
    return [
        (path, 0.5 * number + 0.125)
        if isinstance(number, np.ndarray)
        else (path, another(float(number), p.lower, p.upper))
        for path, number, p in leaves(element)
    ]
