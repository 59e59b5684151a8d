"""What streams draw of the parameters of an element, as they are now."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable
from typing import Any

import numpy as np

from deodar.element import Element
from deodar.errors import ModelError
from deodar.numerics.axes import Axes, describe, shape
from deodar.numerics.kernel_shape import kernel_shape
from deodar.parameters import FrozenArray
from deodar_studio.live.section import Section


@dc.dataclass(frozen=True)
class PlaneDrawing:
    """An array over at most two axes.

    Attributes:
        values: the array.
        axes: its axes.
        rest: the axes at which it is cut, or over which the maximum is taken.
        folded: names of the axes over which the maximum is taken.
    """

    values: np.ndarray
    axes: Axes
    rest: Axes = ()
    folded: tuple[str, ...] = ()


AxesOf = Callable[[str], Axes]
"""Returns the axes of a port of the element."""

Drawable = tuple[Any, Callable[[], PlaneDrawing]]
"""All that a drawing follows from, and a function that makes it."""

Plane = Callable[[Element, AxesOf], Drawable]
"""Returns what is drawn of an element; raises DeodarError: it has none."""


def kernel(element: Element, axes_of: AxesOf) -> Drawable:
    """Return the sum of the kernels of an element over the lag."""
    if element.convolution is None or not element.kernels():
        raise ModelError("has no interaction kernel")
    kernels, axes = tuple(element.kernels()), axes_of(element.convolution.of)

    def draw() -> PlaneDrawing:
        lags, weights = kernel_shape(kernels, axes)
        return PlaneDrawing(weights, lags, axes[2:])

    return (kernels, axes), draw


def weights(parameter: str, section: Section) -> Plane:
    """Return the plane of an array parameter, one of `Element.maps`, which maps a source to a target."""

    def plane(element: Element, axes_of: AxesOf) -> Drawable:
        ports = element.maps.get(parameter, ())
        array = getattr(element, parameter, None)
        if not ports or not isinstance(array, FrozenArray):
            raise ModelError(f"has no weights {parameter!r}")
        axes = tuple(a for port in ports for a in axes_of(port))
        if array.shape != shape(axes):
            raise ModelError(
                f"{parameter} has shape {list(array.shape)}, which does not fit {describe(axes)}"
            )
        drawn, rest = section.split(axes)
        folded = tuple(a.name for a in section.folded(axes))
        return (array, axes), lambda: PlaneDrawing(section.take(array.data, axes), drawn, rest, folded)

    return plane
