"""The shifted kernel."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from deodar.leaves import on_axis
from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval
from deodar.numerics.kernels._base import Kernel, Term
from deodar.numerics.kernels.gaussian import Gaussian
from deodar.parameters import PerAxis, Rebuild, Recompile
from deodar.registry import register

if TYPE_CHECKING:
    from jax import Array


@register
@dataclass(frozen=True)
class Shifted(Kernel):
    r"""A kernel shifted by a fixed amount: a peak at x acts around x + shift.

    Equation:
        k(d) = \mathrm{inner}(d - \mathrm{shift})

    Parameters:
        kernel: the inner kernel, a sum of separable terms (not a custom array).
        shift: the shift, in axis units, one value or one for each axis.
        boundary: `periodic`, `zero`, `reflect` or `replicate`, one value or one for each axis; none:
            `periodic` on periodic axes, `zero` on others.

    Shapes:
        One number for each distance; any number of axes.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Simultaneous planning and action, Adapt. Behav. 23(5), appendix
        A (the shifts between its fields).
    """

    kernel: Annotated[Kernel, Recompile(meaning="the inner kernel")] = Gaussian()
    shift: Annotated[PerAxis, Rebuild("axis", meaning="how far the kernel is moved")] = 0.0

    def bounds(self, axes: Axes) -> Interval:
        return self.kernel.bounds(axes)

    def terms(self) -> Sequence[Term]:
        return [Term(t.amplitude, self._moved(t)) for t in self.kernel.terms()]

    def _moved(self, term: Term) -> Callable[[int, Array, float | None, float], Array]:
        def along(d: int, lag: Array, period: float | None, step: float) -> Array:
            return term.along(d, lag - on_axis(self.shift, d), period, step)

        return along

    def validate(self) -> Iterator[tuple[str, str]]:
        if type(self.kernel).__name__ == "Custom":
            yield "kernel", "a custom array cannot be shifted; shift the array itself"
        if self.kernel.boundary is not None:
            yield (
                "kernel.boundary",
                "belongs to the shifted kernel: write Shifted(kernel, shift, boundary=...)",
            )

    def validate_axes(self, axes: Axes) -> Iterator[str]:
        yield from super().validate_axes(axes)
        yield from self.kernel.validate_axes(axes)
