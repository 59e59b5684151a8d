"""Models of the contract tests: a small one around the example of each registered kind.

Sources that fit are found by trying a few kinds of axes, so that a new element or coupling needs no entry
here if one of them fits its example.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from typing import Any

import numpy as np

import deodar as dd
from deodar import registry
from deodar.element import Element
from deodar.elements.changing_stimuli import Noise
from deodar.elements.stimuli import Boost
from deodar.leaves import leaves
from deodar.model.check import problems as structural
from deodar.model.document_graph import graph
from deodar.model.resolve import Node
from deodar.numerics.axes import Axes, shape
from deodar.parameters import Part, parameters
from deodar.worlds._base import World

KINDS = {**registry.kinds("elements"), **registry.kinds("couplings")}
PARTS = {**registry.kinds("numerics.kernels"), **registry.kinds("numerics.sigmoids")}


class Anything(World):
    """A world that has every sensor and reads a fixed pattern."""

    def require(self, sensor: str) -> None:
        """Accept every sensor."""

    def require_motor(self, motor: str) -> None:
        """Accept every motor."""

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        return np.random.default_rng(len(sensor)).random(shape(axes))


def candidates(element: Element) -> list[tuple[dd.Axis, ...]]:
    """Return axes of sources to try, for elements that accept any axes."""
    own: tuple[dd.Axis, ...] = tuple(getattr(element, "axes", ()))
    channel = dd.Axis("channel", 0, 2, 3)
    x, y = dd.Axis("x", 0, 20, samples=21), dd.Axis("y", 0, 8, samples=9)
    return [(x,), own, (), (x, y), (x, y, channel), (*own[:1], channel), (*own[:2], channel), (*own, y)]


def source(name: str, axes: Axes, amplitude: float = 0.8, at: float = 0.4) -> Element:
    """Return a source with a peak in the middle; without axes a number."""
    if not axes:
        return Boost(name, [], amplitude)
    center = [a.lower + at * a.range for a in axes]
    return dd.GaussianStimulus(
        name, axes, center=center, sigma=[max(a.range / 6, a.step / 2) for a in axes], amplitude=amplitude
    )


def around(element: Element, every: int = 1, noisy: bool = False) -> dd.Model:
    """Return a model with the element under its own name, and a source (called `to PORT`) for each of its
    inputs.
    """
    problems: list[Any] = []
    for axes in candidates(element):
        model = dd.Model("contract")
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
    raise AssertionError(f"no source fits the example of {type(element).__name__}: {problems}")


def example(kind: str) -> Element:
    """Return the example of a kind, under the name `example`."""
    return dc.replace(KINDS[kind].example(), name="example")


def holding(part: Part) -> Element:
    """Return a field with the example of a kernel or a sigmoid."""
    x = dd.Axis("x", 0, 20, samples=21)
    if "sigmoids" in type(part).__module__:
        return dd.Field("example", [x], sigmoid=part, kernel=[dd.Gaussian(0.1, 2.0)])  # type: ignore[arg-type]
    return dd.Field("example", [x], kernel=[part])  # type: ignore[list-item]


def any_example(kind: str) -> Element:
    """Return the example of any registered kind, in an element that a model can contain."""
    return example(kind) if kind in KINDS else holding(PARTS[kind].example())


def node(model: dd.Model, path: str = "example") -> Node:
    """Return the element as the engine resolves it, with the axes at its ports."""
    return next(n for n in graph(model.document).nodes if n.path == path)


def session(model: dd.Model, **options: Any) -> dd.Session:
    """Return a session in a world that has every sensor and motor."""
    return dd.Session(model, world=Anything(), **options)


def record(model: dd.Model, duration: float, ports: Sequence[str], **options: Any) -> Any:
    """Return a record made in a world that has every sensor and motor."""
    return dd.simulate(model, duration, record=ports, world=Anything(), **options)


def another(number: float, lower: float | None, upper: float | None) -> float:
    """Return another value inside the bounds, far from the first."""
    for new in (1.25 * number + 0.125, 0.75 * number, 0.5 * number - 0.125):
        if new != number and (lower is None or new >= lower) and (upper is None or new <= upper):
            return new
    raise AssertionError(f"no other value between {lower} and {upper} than {number}")


def changes(element: Element) -> list[tuple[str, Any]]:
    """Return for each traced leaf of an element another value: (path, value)."""
    out: list[tuple[str, Any]] = []
    for path, number, p in leaves(element):
        if isinstance(number, np.ndarray):
            out.append((path, 0.5 * number + 0.125))
        else:
            out.append((path, another(float(number), p.lower, p.upper)))
    return out


__all__ = [
    "KINDS",
    "PARTS",
    "Anything",
    "any_example",
    "around",
    "changes",
    "example",
    "node",
    "parameters",
    "record",
    "session",
    "source",
]
