"""The contract of a sigmoid: output of a field as a function of its activation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from deodar.numerics.intervals import ANY, Interval
from deodar.parameters import Part

if TYPE_CHECKING:
    from jax import Array

POINTS = 5


@dataclass(frozen=True)
class SigmoidFunction(Part):
    """g(u), applied cell by cell."""

    def __call__(self, u: Array) -> Array:
        """Output for activation u; same shape."""
        raise NotImplementedError

    def ends(self, u: Array) -> tuple[Array, ...] | None:
        """What `mean` needs at an end of a range of activation and what is costly: neighbouring ranges share
        it. None where nothing is.
        """
        return None

    def mean(
        self, a: Array, b: Array, at_a: tuple[Array, ...] | None = None, at_b: tuple[Array, ...] | None = None
    ) -> Array:
        """The mean of g over the activations between a and b, g(a) where they are equal; same shape.

        A sigmoid that knows its antiderivative gives the exact mean; this is Gauss-Legendre's rule with five
        points.

        Args:
            a: one end.
            b: the other; it may lie below a, or be equal.
            at_a: `ends(a)`, where it is known.
            at_b: `ends(b)`, where it is known.
        """
        places, weights = np.polynomial.legendre.leggauss(POINTS)
        middle, half = 0.5 * (a + b), 0.5 * (b - a)
        return sum(  # type: ignore[return-value] # a sum of arrays
            float(w) / 2 * self(middle + float(p) * half) for p, w in zip(places, weights, strict=True)
        )

    def bounds(self, u: Interval) -> Interval:
        """Between which values the output lies for activation in an interval."""
        return ANY
