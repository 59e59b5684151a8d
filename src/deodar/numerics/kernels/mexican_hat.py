"""The Mexican hat: local excitation, wider inhibition."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from deodar.numerics.axes import Axes
from deodar.numerics.intervals import Interval, hull, signed
from deodar.numerics.kernels._base import Kernel, Term
from deodar.numerics.kernels.gaussian import NARROWEST, gaussian_term, volume
from deodar.parameters import Live, PerAxis, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class MexicanHat(Kernel):
    r"""A difference of two Gaussians: local excitation and wider inhibition.

    If normalized, each Gaussian is divided by its integral.

    Equation:
        k(d) = \mathrm{excitation} \exp\!\left( -\frac{d^2}{2 \sigma_{\mathrm{excitation}}^2}
            \right)
        \quad {} - \mathrm{inhibition} \exp\!\left( -\frac{d^2}{2 \sigma_{\mathrm{inhibition}}^2}
            \right)

    Parameters:
        excitation: weight of the excitation at the centre (its integral if normalized).
        sigma_excitation: width of the excitation in axis units, one value or one for each axis; > 0.
        inhibition: weight of the inhibition at the centre, counted positive (its integral if normalized).
        sigma_inhibition: width of the inhibition in axis units, one value or one for each axis; > 0.
        normalized: whether the weights are integrals.
        boundary: `periodic`, `zero`, `reflect` or `replicate`, one value or one for each axis; none:
            `periodic` on periodic axes, `zero` on others.

    Shapes:
        One number for each distance; any number of axes.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 2.
    """

    excitation: Annotated[float, Live("activation", meaning="weight of the excitation")] = 15.0
    sigma_excitation: Annotated[
        PerAxis, Rebuild("axis", lower=NARROWEST, meaning="width of the excitation")
    ] = 5.0
    inhibition: Annotated[float, Live("activation", meaning="weight of the inhibition")] = 8.0
    sigma_inhibition: Annotated[
        PerAxis, Rebuild("axis", lower=NARROWEST, meaning="width of the inhibition")
    ] = 10.0
    normalized: Annotated[bool, Recompile(meaning="whether the weights are integrals")] = False

    def bounds(self, axes: Axes) -> Interval:
        up, down = (
            1.0 if self.normalized else volume(s, axes)
            for s in (self.sigma_excitation, self.sigma_inhibition)
        )
        return hull(signed(self.excitation * up), signed(-self.inhibition * down))

    def terms(self) -> Sequence[Term]:
        return (
            gaussian_term(self.excitation, self.sigma_excitation, self.normalized),
            gaussian_term(-self.inhibition, self.sigma_inhibition, self.normalized),
        )

    def widths(self) -> Sequence[PerAxis]:
        return (self.sigma_excitation, self.sigma_inhibition)
