"""The linear output function."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from deodar.numerics.intervals import Interval, times
from deodar.numerics.sigmoids._base import SigmoidFunction
from deodar.parameters import Live
from deodar.registry import register

if TYPE_CHECKING:
    from jax import Array


@register
@dataclass(frozen=True)
class Linear(SigmoidFunction):
    r"""A linear output function, for linear stages of an architecture.

    Equation:
        g(u) = \mathrm{slope}\, (u - \theta)

    Parameters:
        slope: output per unit of activation.
        threshold: theta, activation of zero output.

    Shapes:
        Any shape in, the same out.

    Reference:
        no reference
    """

    slope: Annotated[float, Live("1/activation", meaning="output per unit of activation")] = 1.0
    threshold: Annotated[float, Live("activation", meaning="activation of zero output")] = 0.0

    def __call__(self, u: Array) -> Array:
        return self.slope * (u - self.threshold)

    def mean(
        self, a: Array, b: Array, at_a: tuple[Array, ...] | None = None, at_b: tuple[Array, ...] | None = None
    ) -> Array:
        """Return the output in the middle of the range."""
        return self(0.5 * (a + b))

    def bounds(self, u: Interval) -> Interval:
        return times((self.slope, self.slope), (u[0] - self.threshold, u[1] - self.threshold))
