"""The contract of an interaction kernel: weights as a function of the distance between two positions."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from deodar.errors import KindError
from deodar.kind_errors import misshapen, position
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

    A kernel is the sum of the separable terms that `terms` returns, or the array that `samples` returns; a
    class defines one of the two.
    """

    boundary: Annotated[Sequence[str] | None, Recompile(choices=BOUNDARIES)] = dc.field(
        default=None, kw_only=True
    )

    def terms(self) -> Sequence[Term]:
        """Return the separable terms; amplitudes are live, `along` may only use parameters that rebuild.

        A kernel that `samples` alone defines has none.
        """
        if not is_sampled(self):
            raise NotImplementedError
        return ()

    def widths(self) -> Sequence[PerAxis]:
        """Return the widths of a sum of Gaussians (each one number, or one for each axis), in the order of
        the terms; empty for other kernels.

        Such a kernel is smooth: it needs few spectral modes, whose number follows from its widths.
        """
        return ()

    def samples(self, axes: Axes, dtype: DTypeLike) -> Array | None:
        """Return the weights around lag zero on the grid of `axes`, or None if the kernel is its `terms`.

        The array has an odd number of samples along each axis, of which the middle one is lag zero, and any
        number of them. It uses parameters that rebuild. A parameter `amplitude` multiplies it in each step,
        and may be live.
        """
        return None

    def bounds(self, axes: Axes) -> Interval:
        """Return bounds on the integral of the negative weights and of the positive weights."""
        return ANY

    def polarity(self) -> Sign:
        """Return whether the kernel excites, inhibits, or does both at different distances.

        That of an array is not known here, and counts as both.
        """
        if is_sampled(self):
            return "±"
        return sign_of(*(term.amplitude for term in self.terms()))

    def validate_axes(self, axes: Axes) -> Iterator[str]:
        """Yield the mismatches between this kernel and the axes of its field."""
        if not axes and is_sampled(self):
            yield (
                "is an array over the axes of a field, and a node has none. For the self-excitation of a node"
                " take a kernel of terms, such as Gaussian"
            )
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
                        " Project without axes and a Gain"
                    )
                    break


def is_sampled(kernel: Kernel) -> bool:
    """Return whether a kernel is defined by `samples` alone."""
    cls = type(kernel)
    return cls.samples is not Kernel.samples and cls.terms is Kernel.terms


def sampled(kernel: Kernel, axes: Axes, dtype: DTypeLike) -> Array | None:
    """Return what `samples` of a kernel returns; None: the kernel is its terms.

    Raises:
        KindError: it has no middle sample, or is None in a class that has no terms.
    """
    samples = kernel.samples(axes, dtype)
    if samples is None and not is_sampled(kernel):
        return None
    fault = misshapen(samples, None)
    if samples is not None and not fault:
        shape = list(np.shape(samples))
        if len(shape) != len(axes) or not all(count % 2 for count in shape):
            fault = f"an array of shape {shape} for {len(axes)} {'axis' if len(axes) == 1 else 'axes'}"
    if fault:
        cls = type(kernel)
        fix = "Return an array with an odd number of samples along each axis; the middle one is lag zero"
        raise KindError(f"{position(cls, 'samples')} returns {fault}", fix=fix, kind=cls.__name__)
    return samples


def samples_amplitude(kernel: Kernel) -> Scalar:
    """Return the factor of what `samples` returns: the parameter `amplitude`, or 1 if there is none."""
    return getattr(kernel, "amplitude", 1.0)


def validate_kernels(kernels: Sequence[Kernel], axes: Axes) -> Iterator[str]:
    """Yield the mismatches between the kernels of a parameter `kernel` and the axes."""
    for i, kernel in enumerate(kernels):
        yield from (f"kernel.{i}: {problem}" for problem in kernel.validate_axes(axes))
