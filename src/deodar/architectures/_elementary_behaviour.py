"""The template of an elementary behaviour that can be planned: motivation, precondition, intention, condition
of satisfaction.

Each is a field over the positions at which the behaviour can begin. Activation at a position in `motivation`
means that the behaviour is useful there. It activates the `precondition` at the position one step back, which
inhibits the `intention` until the precondition is released. `satisfaction` detects that the behaviour is
complete. Numbers in the names of the parameters below are those of the paper's figures 2 to 4.

References:
    Billing, Lowe & Sandamirskaya (2015), Simultaneous planning and action, Adapt. Behav. 23(5), section 3.1,
    figures 2 and 3, appendix A and table 2, and its published simulator, which is followed where the paper
    differs. Sandamirskaya, Richter & Schöner (2011), A neural-dynamic architecture for behavioral
    organization of an embodied agent, ICDL.
"""

from __future__ import annotations

from collections.abc import Sequence

from deodar.couplings.arithmetic import Gain
from deodar.couplings.convolutions import Convolve, Shift
from deodar.elements.field import Field
from deodar.model.model import Handle, Model
from deodar.numerics.axes import Axis
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.sigmoids import Logistic

NARROW, WIDE = 2.0, 4.0
"""Widths of excitation and inhibition, cm (table 2)."""

TAU, RESTING, STEEP = 5.0, -5.0, 4.0
"""Time constant, resting level and slope of the sigmoid of all four fields; time is in steps of the published
simulation.
"""

QUADRATURE = "point"
"""Quadrature of all fields, as in the published simulator.

With `cell` the robot reaches the same goals.
"""

LATERAL = {
    "motivation": (7.0, -2.0),
    "precondition": (4.0, -2.0),
    "intention": (9.0, 0.0),
    "satisfaction": (2.0, -2.0),
}
"""Integrals of local excitation and of wider inhibition.

Table 2 prints the latter negative and eqs. 4 to 6 subtract it: it inhibits once.
"""

STRENGTHS = {
    "1 motivation to precondition": 12.0,
    "3 motivation to intention": 10.0,
    "4 precondition to intention": -10.0,
    "5 intention to satisfaction": 3.0,
    "6 satisfaction to intention": -5.0,
    "7 satisfaction to precondition": -15.0,
    "2a precondition to motivation": 5.0,
}
"""Document parameters, shared by all behaviours of a model."""

AHEAD = 0.2
"""Distance ahead of the vehicle at which satisfaction releases preconditions, as a share of a step."""


def elementary_behaviour(
    axes: Sequence[Axis], step: Sequence[float], noise: float = 1.0, boundary: str | None = None
) -> Model:
    """Create one behaviour, to be inserted into a model as a group.

    Args:
        axes: axes of the space, in cm.
        step: displacement by one execution, in cm along each axis. A plan grows backwards by this step.
        noise: strength of the noise of each field; 1 adds deviates of 1 / tau in a step of 1 with cells of 1.
        boundary: of all kernels; none: the axes decide.
    """
    model = Model("elementary behaviour")
    for name, value in STRENGTHS.items():
        model.parameter(name, value)
    fields = {name: model.add(_field(name, axes, noise, boundary)) for name in LATERAL}
    back, release = tuple(-s for s in step), tuple(AHEAD * s for s in step)

    def spread(a: str, b: str, parameter: str, by: Sequence[float] | None = None) -> None:
        """Add a connection through a kernel, after a shift by `by` if it is given.

        The shift drops values beyond an end, and the kernel wraps around the ends (as in the published code).
        So the margin of a field, whose preconditions lie outside, is inhibited.
        """
        kernel = [Gaussian(STRENGTHS[parameter], NARROW, normalized=True, boundary=ends)]
        through = model.add(Convolve(kernel, name=f"{a} to {b}"))
        model.link(f"{through.path}.kernel.0.amplitude", parameter)
        (fields[a] if by is None else moved(fields[a], f"{a} beside {b}", by)) >> through >> fields[b]

    def plain(a: str, b: str, parameter: str, by: Sequence[float]) -> None:
        """Add a shifted connection without a kernel.

        Connection 7 must not have a kernel: its release would be too weak, and the vehicle would stall.
        """
        strength = model.add(Gain(STRENGTHS[parameter], name=f"{a} to {b}"))
        model.link(f"{strength.path}.factor", parameter)
        fields[a] >> strength
        moved(strength, f"{a} beside {b}", by) >> fields[b]

    def moved(source: Handle, name: str, by: Sequence[float]) -> Handle:
        return source >> model.add(Shift(tuple(by), name=name))

    ends = None if boundary is None else [boundary]
    spread("motivation", "precondition", "1 motivation to precondition", back)
    spread("motivation", "intention", "3 motivation to intention")
    spread("precondition", "intention", "4 precondition to intention", step)
    spread("intention", "satisfaction", "5 intention to satisfaction")
    spread("satisfaction", "intention", "6 satisfaction to intention")
    plain("satisfaction", "precondition", "7 satisfaction to precondition", release)
    plain("precondition", "motivation", "2a precondition to motivation", back)
    return model


def _field(name: str, axes: Sequence[Axis], noise: float, boundary: str | None) -> Field:
    ends = None if boundary is None else [boundary]
    excitation, inhibition = LATERAL[name]
    kernel = [Gaussian(excitation, NARROW, normalized=True, boundary=ends)]
    if inhibition:
        kernel.append(Gaussian(inhibition, WIDE, normalized=True, boundary=ends))
    steep = Logistic(beta=STEEP)
    return Field(
        name,
        axes,
        tau=TAU,
        resting_level=RESTING,
        sigmoid=steep,
        kernel=kernel,
        noise=noise,
        quadrature=QUADRATURE,
    )
