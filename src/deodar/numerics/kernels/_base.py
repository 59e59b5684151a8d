"""The contract of an interaction kernel: weights as a function of the distance between two positions."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from deodar.leaves import per_axis
from deodar.numerics.axes import Axes
from deodar.numerics.convolution import BOUNDARIES
from deodar.numerics.intervals import ANY, Interval
from deodar.numerics.scalar import Scalar
from deodar.numerics.signs import Sign, sign_of
from deodar.parameters import Part, PerAxis, Recompile, parameters

if TYPE_CHECKING:
    from jax import Array
    from jax.typing import DTypeLike

WIDEST = 1e12
"""Largest width or shift relative to an axis: single precision cannot square much larger ones (a guess, far
above any use).
"""


@dataclass(frozen=True)
class Term:
    """A separable part of a kernel: amplitude times the product over axes of `along(d, lag, period, step)`.

    `along` is computed when the kernel changes, not in each step. It uses `jax.numpy`, and parameters that
    rebuild (`dd.Rebuild`), not live ones. Its arguments:

    * `d`: number of the axis. A parameter of the type `dd.PerAxis` is one number for all axes or one for
      each: `dd.on_axis(self.width, d)` returns the one of axis d.
    * `lag`: distances to the centre of the kernel along axis d, in axis units, negative on one side; an array
      of any shape.
    * `period`: length after which the lag wraps, in axis units; None: it does not. The weight then has this
      period in the lag.
    * `step`: grid step of axis d, in axis units; a kernel that is narrower integrates over it.

    Attributes:
        amplitude: factor; a number, a live parameter, or a multiple of one.
        along: function that returns the weight at each lag; an array of the shape of `lag`, per axis unit.
    """

    amplitude: Scalar
    along: Callable[[int, Array, float | None, float], Array]


@dataclass(frozen=True)
class Kernel(Part):
    """The base class of interaction kernels k(x - x'), for fields of any dimension.

    A kernel is a sum of separable terms, or the array that `samples` returns.
    """

    boundary: Annotated[Sequence[str] | None, Recompile(choices=BOUNDARIES)] = dc.field(
        default=None, kw_only=True
    )

    def terms(self) -> Sequence[Term]:
        """Return the separable terms; amplitudes are live, `along` may only use parameters that rebuild."""
        raise NotImplementedError

    def widths(self) -> Sequence[PerAxis]:
        """Return the widths of a sum of Gaussians (each one number, or one for each axis), in the order of
        the terms; empty for other kernels.

        Such a kernel is smooth: it needs few spectral modes, whose number follows from its widths.
        """
        return ()

    def samples(self, axes: Axes, dtype: DTypeLike) -> Array | None:
        """Return the kernel as an array around lag zero on the grid of `axes`, or None if it is its
        `terms`.
        """
        return None

    def bounds(self, axes: Axes) -> Interval:
        """Return bounds on the integral of the negative weights and of the positive weights."""
        return ANY

    def polarity(self) -> Sign:
        """Return whether the kernel excites, inhibits, or does both at different distances."""
        return sign_of(*(term.amplitude for term in self.terms()))

    def validate_axes(self, axes: Axes) -> Iterator[str]:
        """Yield the mismatches between this kernel and the axes of its field."""
        if self.boundary is not None and len(self.boundary) not in (1, len(axes)):
            yield f"boundary has {len(self.boundary)} entries for {len(axes)} axes"
        for p in parameters(type(self)):
            setting = getattr(self, p.name)
            if (
                p.form != "per_axis"
                or setting is None
                or (isinstance(setting, tuple) and len(setting) != len(axes))
            ):
                continue
            for axis, v in zip(axes, per_axis(setting, axes), strict=True):
                if abs(v) > WIDEST * axis.range:
                    yield (
                        f"{p.name} is {v:g}, more than {WIDEST:g} times the axis {axis.name!r}"
                        f" ({axis.range:g}): a kernel this wide is constant. Give at most"
                        f" {WIDEST * axis.range:g}; for an input that is the same everywhere take a"
                        " Project([]) and a Gain"
                    )
                    break


def validate_kernels(kernels: Sequence[Kernel], axes: Axes) -> Iterator[str]:
    """Yield the mismatches between the kernels of a parameter `kernel` and the axes."""
    for i, kernel in enumerate(kernels):
        yield from (f"kernel.{i}: {problem}" for problem in kernel.validate_axes(axes))
