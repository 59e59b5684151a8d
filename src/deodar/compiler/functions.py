"""The functions of one group that the program calls: those of its elements, with the convolution by
kernels.
"""

from __future__ import annotations

import dataclasses as dc
import functools
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from jax import Array

from deodar.element import Arrays, Element, Setting
from deodar.model.resolve import Node
from deodar.numerics import interaction
from deodar.numerics.axes import Axes
from deodar.numerics.choice import Choice
from deodar.numerics.native import Kernels

TappedOver = Callable[[Axes, Array, Array, str, int], Array]
"""A convolution by lags along one of some axes: the axes, and the arguments of `convolution.tapped`."""


class Replacements(NamedTuple):
    """Functions that replace those of `numerics`, on some devices or for gradients.

    Attributes:
        kernels: compiled kernels for parts of the step.
        tapped: the convolution by lags, where devices divide an axis.
        refuses: whether a gradient through a jump is an error.
    """

    kernels: Kernels | None = None
    tapped: TappedOver | None = None
    refuses: bool = False


class Constants(NamedTuple):
    """The constants of a group between steps; a JAX PyTree.

    Attributes:
        kernels: weights of the kernels, or their mixture after `hoist`; empty without a convolution.
        own: constants from the `prepare` of the elements.
    """

    kernels: Any
    own: Any


class Functions:
    """The functions of the elements of a group, each convolving on its own.

    The constants of a setting that they read are `Constants`.

    Attributes:
        axes: axes of what is convolved.
        choices: for each kind of boundaries how kernels are applied, where not by matrices.
        apart: whether matrices are not multiplied by the amplitudes.
        kernels: compiled kernels for the convolution and the outputs, if there are any.
        tapped: the convolution by lags, where devices divide an axis.
    """

    def __init__(
        self,
        node: Node,
        choices: Mapping[str, Choice],
        apart: bool = False,
        kernels: Kernels | None = None,
        tapped: TappedOver | None = None,
    ) -> None:
        self.axes, self.choices, self.apart = convolved_axes(node), dict(choices), apart
        self.kernels = kernels
        self.tapped = None if tapped is None else functools.partial(tapped, self.axes)
        self.convolves = node.element.convolution is not None

    def prepare(self, element: Element, at: Setting) -> Constants:
        """Constants that depend on axes and on parameters that rebuild."""
        if not self.convolves:
            return Constants((), element.prepare(at))
        weights = interaction.prepare(element.kernels(), self.axes, at.dtype, self.choices)
        return Constants(weights, element.prepare(at))

    def hoist(self, element: Element, at: Setting) -> Constants:
        """Return values that are constant during a chunk although they depend on live parameters."""
        hoisted = element.hoist(own(at))
        if not self.convolves:
            return Constants((), hoisted)
        return Constants(
            interaction.mix(element.kernels(), self.axes, at.constants.kernels, self.apart), hoisted
        )

    def output(self, element: Element, at: Setting) -> Arrays:
        """Every output port at time t."""
        return element.output(self.convolving(at))

    def advance(self, element: Element, at: Setting) -> Arrays:
        """The state at t + dt."""
        return element.advance(self.convolving(at))

    def convolving(self, at: Setting) -> Setting:
        """The setting of an element in which `convolve` applies the mixed kernels."""
        if not self.convolves:
            return own(at, native=self.kernels)
        mixture = at.constants.kernels
        return own(
            at,
            native=self.kernels,
            convolve=lambda y: interaction.apply(
                mixture, self.axes, y, self.choices, kernels=self.kernels, tapped=self.tapped
            ),
        )


def convolved_axes(node: Node) -> Axes:
    """Return the axes of the port that an element convolves; empty without a convolution."""
    convolution = node.element.convolution
    return node.axes(convolution.of) if convolution is not None else ()


def own(at: Setting, **changes: Any) -> Setting:
    """Return the setting that an element reads, with its own constants alone."""
    return dc.replace(at, constants=at.constants.own, **changes)
