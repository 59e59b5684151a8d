"""The dynamic neural field, with up to four axes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.element import Arrays, Convolution, Element, PortAxes, PortBounds, Setting
from deodar.errors import assign
from deodar.leaves import is_neutral, per_axis, with_entry
from deodar.numerics import noise as noises
from deodar.numerics import quadrature, starting
from deodar.numerics.axes import Axes, Axis, cell
from deodar.numerics.integrators import euler
from deodar.numerics.intervals import Interval, hull, signed, times, total
from deodar.numerics.kernels._base import Kernel, validate_kernels
from deodar.numerics.kernels.separable import Gaussian
from deodar.numerics.quadrature_0_1 import cell_means_0_1
from deodar.numerics.sigmoids import Logistic, SigmoidFunction
from deodar.numerics.signs import Sign, sign_of, together
from deodar.parameters import Live, PerAxis, Rebuild, Recompile
from deodar.registry import register

MOST_AXES = 4
MARGIN = 6.0
"""Assumed bound on the effect of noise, in standard deviations (exceeded about once in 10^9 samples)."""


@register
@dataclass(frozen=True)
class Field(Element):
    r"""A dynamic neural field; without axes, a dynamic neural node.

    Equation:
        \tau \frac{du}{dt} = -u + h + s(x, t)
        \quad {} + \sum_k \int k(x - x')\, g(u(x'))\, dx'
        \quad {} - c \int g(u)\, dx + q\, \xi(x, t)

    Parameters:
        axes: the metric dimensions, none to four.
        tau: time constant; in the document's time unit, > 0, and at least one step.
        resting_level: h, the attractor without input.
        sigmoid: g, output as a function of activation.
        kernel: k, the sum of the interaction kernels. On a node their amplitudes are its self-excitation.
        global_inhibition: c, factor of the integral of the output.
        noise: q, strength of the noise; white in time; without `noise_length` white in space too (divided by
            the root of the cell's volume), else the standard deviation at a point. Euler step: q sqrt(dt) /
            tau.
        noise_length: correlation length of the noise; in axis units, one value or one for each axis; 0:
            white.
        quadrature: output as its mean over a cell, or at the sample; `cell`: the output at a sample is the
            mean of g over its cell without its blur, so that hills and edges narrower than a sample behave as
            on a fine grid; `point`: g at the sample; `cell-0.1`: the mean over a cell as version 0.1 computed
            it, which blurs hills. On a node all are g. The default in documents is `point`.

    Ports:
        input: s, the sum of all connections, over `axes`.
        output: g(u), over `axes`; its mean over each cell with `quadrature="cell"`, which leaves the range of
            g at edges by up to 0.1.
        bounded: the output in the range of g, over `axes`; with `quadrature="cell"` the mean with its blur,
            else `output`. Ports that use an output as a number between 0 and 1 read it in place of `output`.
        activation: u, over `axes`.
        interaction: the sum of both integral terms, over `axes`.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eqs. 1, 3 and 17; Amari (1977),
        Biol. Cybern. 27.
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    tau: Annotated[float, Live("time", role="time constant", lower=1e-6)] = 20.0
    resting_level: Annotated[float, Live("activation", section="time course")] = -5.0
    sigmoid: SigmoidFunction = Logistic()
    kernel: Sequence[Kernel] = ()
    global_inhibition: Annotated[float, Live("activation", section="interaction")] = 0.0
    noise: Annotated[float, Live("activation", lower=0, neutral=0.0, section="noise")] = 0.0
    noise_length: Annotated[PerAxis, Rebuild("axis", lower=0, neutral=0.0, off=True, section="noise")] = 0.0
    quadrature: Annotated[str, Recompile(choices=("cell", "cell-0.1", "point"), section="axes")] = "point"

    convolution: ClassVar[Convolution | None] = Convolution("output", into="input")
    levels: ClassVar[Mapping[str, Mapping[str, str]]] = {
        "activation": {"threshold": "sigmoid.threshold", "resting level": "resting_level"}
    }

    def recurrence(self) -> Mapping[str, Sign]:
        found: dict[str, Sign] = {}
        if self.kernel:
            found["kernel"] = together(k.polarity() for k in self.kernel)
        if self.global_inhibition:
            found["global inhibition"] = sign_of(-self.global_inhibition)
        return found

    def outputs(self, ins: PortAxes) -> PortAxes:
        axes = tuple(self.axes)
        return {"output": axes, "activation": axes, "interaction": axes, "bounded": axes}

    def bounded_port(self, port: str) -> str:
        return "bounded" if port == "output" else port

    def kernels(self) -> Sequence[Kernel]:
        return self.kernel

    def noise_axes(self) -> Axes | None:
        return None if is_neutral(self.noise) else tuple(self.axes)

    def validate_axes(self, ins: PortAxes) -> Iterator[str]:
        if len(self.axes) > MOST_AXES:
            yield f"has {len(self.axes)} axes; a field has at most {MOST_AXES}"
        yield from validate_kernels(self.kernel, tuple(self.axes))
        lengths = [float(v) for v in per_axis(self.noise_length, self.axes)]
        if any(lengths) and not all(lengths):
            yield "noise_length is 0 on one axis and not on another; give all of them or none"

    def warnings(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        lengths = per_axis(self.noise_length, self.axes)
        for d, (axis, length) in enumerate(zip(self.axes, lengths, strict=True)):
            if 0 < float(length) < 0.5 * axis.step:
                yield (
                    (
                        f"its noise_length {float(length):g} is below the step {axis.step:g} of the axis"
                        f" {axis.name!r}: the noise is white"
                    ),
                    assign(
                        f"Use {axis.step:g} or more",
                        {"noise_length": with_entry(self.noise_length, self.axes, d, 2 * axis.step)},
                        "Or write 0 for white noise",
                    ),
                )
            elif float(length) > axis.range:
                yield (
                    (
                        f"its noise_length {float(length):g} is longer than the axis {axis.name!r}"
                        f" ({axis.range:g}): the noise is the same everywhere"
                    ),
                    assign(
                        f"Use a length far below {axis.range:g}",
                        {"noise_length": with_entry(self.noise_length, self.axes, d, axis.range / 10)},
                    ),
                )

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        h, u = self.resting_level, before.get("activation", (self.resting_level, self.resting_level))
        spread = (
            MARGIN
            * self.noise
            / math.sqrt(
                2
                * self.tau
                * (1.0 if any(map(float, per_axis(self.noise_length, self.axes))) else cell(self.axes))
            )
        )
        own = self._output_bounds(u)
        parts = [kernel.bounds(tuple(self.axes)) for kernel in self.kernel]
        all_over = self.global_inhibition * math.prod(a.step * a.samples for a in self.axes)
        interaction = total(
            *(times((0.0, k[1]), own) for k in parts),
            *(times((k[0], 0.0), own) for k in parts),
            times(signed(-all_over), own),
        )
        drawn = total((h - spread, h + spread), inputs["input"], interaction)
        u = hull(u, drawn)
        return {
            "activation": u,
            "output": self._output_bounds(u),
            "interaction": interaction,
            "bounded": self.sigmoid.bounds(u),
        }

    def init(self, at: Setting) -> Arrays:
        return {"activation": at.full(tuple(self.axes), self.resting_level)}

    def prepare(self, at: Setting) -> dict[str, list[Array]]:
        return noises.prepare(tuple(self.axes), self.noise_length, at.dtype)

    def output(self, at: Setting) -> Arrays:
        u = at.state["activation"]
        g = self._output(at, u)
        bounded = g
        if self._overshoots:
            bounded = quadrature.bounded_cell_means(self.sigmoid, u, tuple(self.axes))
        return {"output": g, "activation": u, "interaction": self._interaction(at, g), "bounded": bounded}

    def advance(self, at: Setting) -> Arrays:
        u, h, s = at.state["activation"], self.resting_level, at.inputs["input"]
        change = -u + h + s + self._interaction(at, self._output(at, u))
        return {"activation": euler(u, change, self.tau, at.time.dt, self._noise(at))}

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        """Return a kernel and a global inhibition with which localised inputs of 6 compete for one peak.

        The peak decays without its input, at the other default values.
        """
        if not axes:
            return {}
        sigmas = starting.widths(axes)
        kernel = Gaussian(amplitude=15.0, sigma=starting.one_or_each(sigmas), normalized=True)
        inhibition = 4.0 / math.prod(2 * sigma for sigma in sigmas)
        return {"kernel": (kernel,), "global_inhibition": float(f"{inhibition:.3g}")}

    def inject(
        self, state: Mapping[str, np.ndarray], amount: np.ndarray | float, dt: float
    ) -> Mapping[str, np.ndarray] | None:
        return {"activation": state["activation"] + dt / self.tau * amount}

    def _output(self, at: Setting, u: Array) -> Array:
        if self.quadrature == "point":
            return self.sigmoid(u)
        if self.quadrature == "cell":
            return quadrature.cell_means(self.sigmoid, u, tuple(self.axes), at.native)
        return cell_means_0_1(self.sigmoid, u, tuple(self.axes))

    def _output_bounds(self, u: Interval) -> Interval:
        of_g = self.sigmoid.bounds(u)
        return quadrature.bounds(of_g) if self._overshoots else of_g

    @property
    def _overshoots(self) -> bool:
        """Whether the output may leave the range of the sigmoid."""
        return self.quadrature == "cell" and bool(self.axes)

    def _interaction(self, at: Setting, g: Array) -> Array:
        inhibition = self.global_inhibition * cell(tuple(self.axes)) * jnp.sum(g)
        return at.convolve(g) - inhibition

    def _noise(self, at: Setting) -> Array | None:
        if at.noise is None:
            return None
        return self.noise * noises.over(tuple(self.axes), at.noise, at.constants.get("noise"))
