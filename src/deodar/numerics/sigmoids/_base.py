"""The contract of a sigmoid: output of a field as a function of its activation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from deodar.numerics.intervals import ANY, Interval
from deodar.parameters import Part

if TYPE_CHECKING:
    from jax import Array

POINTS = 5


@dataclass(frozen=True)
class SigmoidFunction(Part):
    """The base class of output functions g(u), applied to each sample.

    Class attributes:
        jumps: whether g jumps, so that it has no derivative that a gradient could follow.
    """

    jumps: ClassVar[bool] = False

    def __call__(self, u: Array) -> Array:
        """Return the output for activation u; same shape."""
        raise NotImplementedError

    def ends(self, u: Array) -> tuple[Array, ...] | None:
        """Return expensive terms of `mean` at an end of a range of activation, which neighbouring ranges
        share.

        None without such terms.
        """
        return None

    def mean(
        self, a: Array, b: Array, at_a: tuple[Array, ...] | None = None, at_b: tuple[Array, ...] | None = None
    ) -> Array:
        """Return the mean of g over the activations between a and b, g(a) where they are equal; same shape.

        A sigmoid with a closed antiderivative overrides this with the exact mean; the default is
        Gauss-Legendre quadrature with five points.

        Args:
            a: one end.
            b: the other end; it may be below a, or equal.
            at_a: `ends(a)`, if known.
            at_b: `ends(b)`, if known.
        """
        places, weights = np.polynomial.legendre.leggauss(POINTS)
        middle, half = 0.5 * (a + b), 0.5 * (b - a)
        return sum(  # type: ignore[return-value] # a sum of arrays
            float(w) / 2 * self(middle + float(p) * half) for p, w in zip(places, weights, strict=True)
        )

    def bounds(self, u: Interval) -> Interval:
        """Return the smallest and largest output for activation in an interval."""
        return ANY
