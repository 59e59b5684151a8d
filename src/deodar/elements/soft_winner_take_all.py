"""Soft winner-take-all: a pool of excitatory units that share one inhibitory unit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Element, Setting, Time
from deodar.leaves import is_neutral
from deodar.numerics import interaction
from deodar.numerics import noise as noises
from deodar.numerics.axes import Axes, Axis, cell
from deodar.numerics.integrators import euler
from deodar.numerics.interaction import KernelWeights, Mixture
from deodar.numerics.kernels._base import Kernel, validate_kernels
from deodar.numerics.sigmoids._base import SigmoidFunction
from deodar.numerics.sigmoids.semilinear import SemiLinear
from deodar.numerics.signs import Sign, sign_of, together
from deodar.parameters import Live, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class SoftWinnerTakeAll(Element):
    r"""Excitatory units that compete through one inhibitory unit: selection in a network of neurons.

    With fast inhibition (tau_inhibition much shorter than tau), slow input, and f_v linear at the sums that
    occur, u follows the equation of a Field with the same tau and kernels, sigmoid f, resting level -T,
    global inhibition beta_1 beta_2, and a Gain of alpha from its output to its input.

    Equation:
        u(x) = s(x, t) + \alpha\, r(x)
        \quad {} + \sum_k \int k(x - x')\, r(x')\, dx' - \beta_1 v - T
        \tau \frac{dr}{dt} = -r + f(u) + q\, \xi(x, t)
        \tau_{\mathrm{inhibition}} \frac{dv}{dt} = -v + f_v\!\left( \beta_2 \int r\, dx - T_v
            \right)

    Parameters:
        axes: positions of the units; units without a position take any axis (its grid step is a factor of
            the integrals).
        tau: time constant of the excitatory units, in the document's time unit; > 0, and at least one
            step.
        tau_inhibition: time constant of the inhibitory unit, in the document's time unit; > 0, and at least
            one step.
        self_excitation: alpha, strength of the coupling of each unit to itself.
        kernel: k, excitation among neighbours, summed; none in the published form.
        inhibition: beta_1, strength of the coupling from the inhibitory unit to all excitatory units.
        drive: beta_2, strength of the coupling from all excitatory units to the inhibitory unit.
        threshold: T, of the excitatory units.
        threshold_inhibition: T_v, of the inhibitory unit.
        sigmoid: f, rate of the excitatory units as a function of their input.
        sigmoid_inhibition: f_v, rate of the inhibitory unit.
        noise: q, strength of the noise of the excitatory units: white in time and space (divided by the root
            of the cell's volume). Euler step: q sqrt(dt) / tau.

    Ports:
        input: s, the sum of all connections, over `axes`.
        output: r, over `axes`.
        inhibitory: v, one number.
        interaction: u without the terms s and -T, over `axes`.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eqs. 4 and 5 (with both time constants equal to 1);
        Rutishauser & Douglas (2009), State-dependent computation using coupled recurrent networks, Neural
        Comput. 21, 478-509, eqs. 2.1.
    """

    name: Annotated[str, Recompile(meaning="name inside its group")] = ""
    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the units")] = ()
    tau: Annotated[
        float, Live("time", role="time constant", lower=1e-6, meaning="time constant of the excitatory units")
    ] = 20.0
    tau_inhibition: Annotated[
        float, Live("time", role="time constant", lower=1e-6, meaning="time constant of the inhibitory unit")
    ] = 5.0
    self_excitation: Annotated[
        float, Live("activation", section="interaction", meaning="of each unit by itself")
    ] = 1.2
    kernel: Annotated[Sequence[Kernel], Recompile(meaning="excitation among neighbours, summed")] = ()
    inhibition: Annotated[
        float, Live("activation", section="interaction", meaning="of all units by the inhibitory one")
    ] = 3.0
    drive: Annotated[
        float, Live(section="interaction", meaning="of the inhibitory unit by the integral over all units")
    ] = 0.25
    threshold: Annotated[
        float, Live("activation", section="interaction", meaning="of the excitatory units")
    ] = 0.0
    threshold_inhibition: Annotated[
        float, Live("activation", section="interaction", meaning="of the inhibitory unit")
    ] = 0.0
    sigmoid: Annotated[SigmoidFunction, Recompile(meaning="rate of the excitatory units")] = SemiLinear()
    sigmoid_inhibition: Annotated[SigmoidFunction, Recompile(meaning="rate of the inhibitory unit")] = (
        SemiLinear()
    )

    noise: Annotated[
        float,
        Live(
            "activation",
            lower=0,
            neutral=0.0,
            section="noise",
            meaning="strength of the noise of the excitatory units",
        ),
    ] = 0.0

    stateful: ClassVar[bool] = True

    def recurrence(self) -> Mapping[str, Sign]:
        return {
            "excitation": together([sign_of(self.self_excitation), *(k.polarity() for k in self.kernel)]),
            "inhibition": sign_of(-self.inhibition),
        }

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        axes = tuple(self.axes)
        return {"output": axes, "inhibitory": (), "interaction": axes}

    def noise_axes(self) -> Axes | None:
        return None if is_neutral(self.noise) else tuple(self.axes)

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str]:
        yield from validate_kernels(self.kernel, tuple(self.axes))

    def init(self, at: Setting) -> Arrays:
        return {"rate": at.full(tuple(self.axes), 0.0), "inhibition": at.full((), 0.0)}

    def prepare(self, at: Setting) -> dict[str, list[KernelWeights]]:
        return {"kernel": interaction.prepare(self.kernel, tuple(self.axes), at.dtype)}

    def hoist(self, at: Setting, constants: dict[str, list[KernelWeights]]) -> dict[str, Mixture]:
        return {"kernel": interaction.mix(self.kernel, tuple(self.axes), constants["kernel"])}

    def output(
        self,
        at: Setting,
        state: Arrays,
        inputs: Arrays,
        constants: dict[str, Mixture],
        time: Time,
        noise: Array | None,
    ) -> Arrays:
        return {
            "output": state["rate"],
            "inhibitory": state["inhibition"],
            "interaction": self._interaction(state, constants),
        }

    def advance(
        self,
        at: Setting,
        state: Arrays,
        inputs: Arrays,
        constants: dict[str, Mixture],
        time: Time,
        noise: Array | None,
    ) -> Arrays:
        r, v, axes = state["rate"], state["inhibition"], tuple(self.axes)
        u = inputs["input"] + self._interaction(state, constants) - self.threshold
        driven = self.drive * cell(axes) * jnp.sum(r) - self.threshold_inhibition
        deviates = None if noise is None else self.noise * noises.over(axes, noise, None)
        return {
            "rate": euler(r, -r + self.sigmoid(u), self.tau, time.dt, deviates),
            "inhibition": euler(v, -v + self.sigmoid_inhibition(driven), self.tau_inhibition, time.dt),
        }

    def _interaction(self, state: Arrays, constants: dict[str, Mixture]) -> Array:
        r = state["rate"]
        neighbours = interaction.apply(constants["kernel"], tuple(self.axes), r) if self.kernel else 0.0
        return self.self_excitation * r + neighbours - self.inhibition * state["inhibition"]

    @classmethod
    def example(cls) -> SoftWinnerTakeAll:
        return cls("example", [Axis("x", 0, 20, samples=21)])
