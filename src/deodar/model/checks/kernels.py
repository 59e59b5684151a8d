"""Kernels that do not fit the grid, or whose signs are exchanged."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from deodar.elements.field import Field
from deodar.errors import EditFix, Problem, assign
from deodar.leaves import one_axis, per_axis, with_entry
from deodar.model.checks.resolution import fix_with_cells
from deodar.model.resolve import Node
from deodar.model.wiring import Wiring, warning
from deodar.numerics.axes import Axes
from deodar.numerics.kernels._base import Kernel
from deodar.numerics.kernels.separable import Gaussian, MexicanHat, Shifted
from deodar.parameters import parameters
from deodar.proposed_edit import rounded

Fault = tuple[str, str]
"""What is wrong with a kernel, and what to write."""

NARROW = 0.4
"""Width in grid steps below which a Gaussian acts on its centre alone: neighbours get less than 5 % of its
height (a guess).
"""

WIDE = 2.0
"""Width, in lengths of the axis, from which a Gaussian is nearly flat: at least 88 % of its height everywhere
(a guess).
"""

LOCAL = 0.1
"""Width, in lengths of the axis, that replaces one that is too large (a guess)."""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Check every kernel of every element."""
    for n in wiring.declared:
        parameter: Any = getattr(n.element, "kernel", ())
        kernels: Sequence[Any] = parameter if isinstance(parameter, tuple) else ()
        for i, kernel in enumerate(kernels):
            if isinstance(kernel, Kernel):
                yield from _kernel(wiring, n, f"kernel.{i}", kernel)
        for name in ("global_inhibition", "inhibition") if n.element.stateful else ():
            inhibition: Any = getattr(n.element, name, 0.0)
            if inhibition < 0:
                sentence = (
                    f"{name} is {inhibition:g}: it is counted positive and subtracted, so a negative one"
                    " excites everything that is on"
                )
                yield warning(n, sentence, assign("Change the sign", {name: -inhibition}))


def _kernel(wiring: Wiring, n: Node, where: str, kernel: Kernel) -> Iterator[Problem]:
    element_axes: Any = getattr(n.element, "axes", None)
    axes = tuple(element_axes) if element_axes is not None else n.ins.get("input", ())
    for fault, fix in _faults(where, kernel, axes):
        if isinstance(n.element, Field):
            fix = fix_with_cells(wiring, n.element, fix)
        yield warning(n, f"{where}: {fault}", fix)


def _faults(where: str, kernel: Kernel, axes: Axes) -> Iterator[Fault]:
    match kernel:
        case Shifted():
            yield from _beyond(kernel, axes)
        case MexicanHat():
            yield from _signs(where, kernel)
            yield from _order(where, kernel, axes)
            yield from _width(where, kernel, axes, True)
        case Gaussian():
            yield from _width(where, kernel, axes, kernel.amplitude > 0)
        case _:
            pass


def _beyond(kernel: Shifted, axes: Axes) -> Iterator[Fault]:
    for axis, by in zip(axes, per_axis(kernel.shift, axes), strict=True):
        if not axis.periodic and abs(by) > axis.range:
            yield (
                f"the shift {by:g} is longer than the axis {axis.name!r} ({axis.range:g}), so it has no"
                " effect",
                f"Use a shift below {axis.range:g}",
            )


def _signs(where: str, kernel: MexicanHat) -> Iterator[Fault]:
    if kernel.inhibition < 0 or kernel.excitation < 0:
        name, does = ("inhibition", "excites") if kernel.inhibition < 0 else ("excitation", "inhibits")
        strength: float = getattr(kernel, name)
        yield (
            f"{name} is {strength:g}, and both are counted positive, so it {does}",
            assign("Change the sign", {f"{where}.{name}": -strength}),
        )
    elif kernel.inhibition > kernel.excitation and not kernel.normalized:
        yield (
            f"inhibits at its centre, since inhibition {kernel.inhibition:g} is larger than excitation"
            f" {kernel.excitation:g}",
            assign(
                "Exchange the two",
                {f"{where}.excitation": kernel.inhibition, f"{where}.inhibition": kernel.excitation},
                "Or make the excitation the larger one",
            ),
        )


def _order(where: str, kernel: MexicanHat, axes: Axes) -> Iterator[Fault]:
    near, far = per_axis(kernel.sigma_excitation, axes), per_axis(kernel.sigma_inhibition, axes)
    if kernel.inhibition > 0 and axes and all(float(b) <= float(a) for a, b in zip(near, far, strict=True)):
        yield (
            "sigma_inhibition is not larger than sigma_excitation, so near positions inhibit and distant ones"
            " excite",
            _wider(where, kernel),
        )


def _widened(where: str, kernel: Gaussian | MexicanHat, axes: Axes) -> EditFix:
    """Return the fix for a narrow kernel: all its widths in the same proportion, none below the step."""
    widths = dict(zip(_widths(kernel), kernel.widths(), strict=True))
    finer = [
        (a.step, float(s)) for w in widths.values() for a, s in zip(axes, per_axis(w, axes), strict=True)
    ]
    factor = max(step / s for step, s in finer)
    wider = {
        f"{where}.{name}": one_axis([rounded(factor * float(s), 3) for s in per_axis(w, axes)])
        for name, w in widths.items()
    }
    advice = "Make it wider; widths are in units of the axis"
    return assign(advice, wider, "Or take more samples")


def _widths(kernel: Gaussian | MexicanHat) -> list[str]:
    return [p.name for p in parameters(type(kernel)) if p.name.startswith("sigma")]


def _wider(where: str, kernel: MexicanHat) -> EditFix:
    """Return the fix for a surround that is not wider than the centre: exchange the two, or double it."""
    near, far = kernel.sigma_excitation, kernel.sigma_inhibition
    if near != far and not (isinstance(near, Sequence) or isinstance(far, Sequence)):
        values = {f"{where}.sigma_excitation": far, f"{where}.sigma_inhibition": near}
        return assign("Exchange the two widths", values)
    double = tuple(2 * s for s in near) if isinstance(near, Sequence) else 2 * near
    return assign("Make sigma_inhibition the larger one", {f"{where}.sigma_inhibition": double})


def _width(where: str, kernel: Gaussian | MexicanHat, axes: Axes, excites: bool) -> Iterator[Fault]:
    """Yield the first width that is too small, or too large for a kernel that excites."""
    for name, width in zip(_widths(kernel), kernel.widths(), strict=True):
        pairs = [(axis, float(s)) for axis, s in zip(axes, per_axis(width, axes), strict=True)]
        # a kernel that is narrow on one of several axes may be intended: no blur along hue
        if pairs and all(s < NARROW * axis.step for axis, s in pairs):
            axis, s = pairs[0]
            yield (
                f"a sigma of {s:g} is narrower than the step {axis.step:g} of the axis {axis.name!r}: no"
                " sample reaches its neighbours",
                _widened(where, kernel, axes),
            )
            return
        for d, (axis, s) in enumerate(pairs) if excites else ():
            if s >= WIDE * axis.range:
                yield (
                    f"a sigma of {s:g} is wider than the axis {axis.name!r} ({axis.range:g}), so the kernel"
                    " is the same everywhere",
                    assign(
                        f"Use a sigma far below {axis.range:g}",
                        {f"{where}.{name}": with_entry(width, axes, d, rounded(LOCAL * axis.range))},
                    ),
                )
                return
