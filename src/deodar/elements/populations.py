"""Dynamics of nodes and of populations without the form of a field."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Element, PortAxes, PortBounds, Setting
from deodar.leaves import is_neutral
from deodar.numerics import interaction
from deodar.numerics import noise as noises
from deodar.numerics.axes import Axes, Axis, cell
from deodar.numerics.integrators import euler
from deodar.numerics.interaction import KernelWeights, Mixture
from deodar.numerics.intervals import hull, times, total
from deodar.numerics.kernels._base import Kernel, validate_kernels
from deodar.numerics.sigmoids import Logistic, SemiLinear, SigmoidFunction
from deodar.numerics.signs import Sign, sign_of, together
from deodar.parameters import Live
from deodar.registry import register


@register
@dataclass(frozen=True)
class RateNode(Element):
    r"""A neural node that stores its rate of change as a state, for phase plots.

    r is the rate of change at the time of u; the next Euler step uses the stored r.

    Equation:
        r = \frac{-u + h + c\, g(u) + s(t)}{\tau}
        \frac{du}{dt} = r + q\, \xi(t)

    Parameters:
        tau: time constant; in the document's time unit, > 0.
        resting_level: h, the attractor without input.
        sigmoid: g, output as a function of activation.
        self_excitation: c, strength of the node's coupling to itself; a negative value inhibits.
        noise: q, strength of the noise on u itself; it is not divided by tau. Euler step: q sqrt(dt).

    Ports:
        input: s, the sum of all connections, one number.
        output: g(u), one number.
        activation: u, one number.
        rate: r, one number.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 3 with self-excitation.
    """

    name: str = ""
    tau: Annotated[float, Live("time", role="time constant", lower=1e-6)] = 10.0
    resting_level: Annotated[float, Live("activation", section="time course")] = -5.0
    sigmoid: SigmoidFunction = Logistic()
    self_excitation: Annotated[float, Live("activation", section="interaction")] = 0.0
    noise: Annotated[float, Live("activation", lower=0, neutral=0.0, section="noise")] = 0.0

    levels: ClassVar[Mapping[str, Mapping[str, str]]] = {
        "activation": {"threshold": "sigmoid.threshold", "resting level": "resting_level"}
    }

    def recurrence(self) -> Mapping[str, Sign]:
        return {"self-excitation": sign_of(self.self_excitation)} if self.self_excitation else {}

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return ()

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": (), "activation": (), "rate": ()}

    def noise_axes(self) -> Axes | None:
        return None if is_neutral(self.noise) else ()

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        h, u = self.resting_level, before.get("activation", (self.resting_level, self.resting_level))
        spread = 6.0 * self.noise * math.sqrt(self.tau / 2)
        own = times((self.self_excitation, self.self_excitation), self.sigmoid.bounds(u))
        u = hull(u, total((h - spread, h + spread), inputs["input"], own))
        return {"activation": u, "output": self.sigmoid.bounds(u)}

    def init(self, at: Setting) -> Arrays:
        u = at.full((), self.resting_level)
        return {"activation": u, "rate": self._rate(u, jnp.zeros_like(u))}

    def output(self, at: Setting) -> Arrays:
        u = at.state["activation"]
        return {"output": self.sigmoid(u), "activation": u, "rate": at.state["rate"]}

    def advance(self, at: Setting) -> Arrays:
        u = at.state["activation"] + at.time.dt * at.state["rate"]
        if at.noise is not None:
            u = u + jnp.sqrt(at.time.dt) * self.noise * at.noise
        return {"activation": u, "rate": self._rate(u, at.inputs["input"])}

    def _rate(self, u: Array, s: Array) -> Array:
        return (-u + self.resting_level + self.self_excitation * self.sigmoid(u) + s) / self.tau


@register
@dataclass(frozen=True)
class TransientDetector(Element):
    r"""A detector of changes: the difference between the input and a slow copy of it.

    A step of height A gives a pulse A exp(-t / tau); an input of constant slope gives slope times tau.

    Equation:
        \tau \frac{dz}{dt} = -z + s(x, t)
        \mathrm{output} = \max(0, s - z)
        \mathrm{off} = \max(0, z - s)

    Parameters:
        axes: axes of the input; none: one number.
        tau: time constant of the slow copy; in the document's time unit, > 0. A pulse has decayed to 5 %
            after 3 tau.
        initial: z at the start; the difference of the input from it counts as a change.

    Ports:
        input: s, over `axes`.
        output: increases of the input, over `axes`; in the same step as the input.
        off: decreases of the input, over `axes`.

    Reference:
        Berger, Faubel, Norman, Hock & Schöner (2012), The counter-change model of motion perception: an
        account based on dynamic field theory, ICANN 2012, LNCS 7552 (motion perception from detectors of
        increments and of decrements).
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    tau: Annotated[float, Live("time", role="time constant", lower=1e-6)] = 100.0
    initial: Annotated[float, Live()] = 0.0

    direct: ClassVar[Mapping[str, tuple[str, ...]]] = {"output": ("input",), "off": ("input",)}

    def polarity(self) -> Sign:
        return "±"

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": tuple(self.axes), "off": tuple(self.axes)}

    def init(self, at: Setting) -> Arrays:
        return {"slow": at.full(tuple(self.axes), self.initial)}

    def output(self, at: Setting) -> Arrays:
        change = at.inputs["input"] - at.state["slow"]
        return {"output": jnp.maximum(0.0, change), "off": jnp.maximum(0.0, -change)}

    def advance(self, at: Setting) -> Arrays:
        z = at.state["slow"]
        return {"slow": euler(z, -z + at.inputs["input"], self.tau, at.time.dt)}


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
        tau: time constant of the excitatory units; in the document's time unit, > 0, and at least one step.
        tau_inhibition: time constant of the inhibitory unit; in the document's time unit, > 0, and at least
            one step.
        self_excitation: alpha, strength of the coupling of each unit to itself.
        kernel: k, excitation among neighbours, summed; none in the published form.
        inhibition: beta_1, strength of the coupling from the inhibitory unit to all excitatory units.
        drive: beta_2, strength of the coupling from all excitatory units to the inhibitory unit.
        threshold: T, of the excitatory units.
        threshold_inhibition: T_v, of the inhibitory unit.
        sigmoid: f, rate of the excitatory units as a function of their input.
        sigmoid_inhibition: f_v, rate of the inhibitory unit.
        noise: q, strength of the noise of the excitatory units; white in time and space (divided by the root
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

    name: str = ""
    axes: Sequence[Axis] = ()
    tau: Annotated[float, Live("time", role="time constant", lower=1e-6)] = 20.0
    tau_inhibition: Annotated[float, Live("time", role="time constant", lower=1e-6)] = 5.0
    self_excitation: Annotated[float, Live("activation", section="interaction")] = 1.2
    kernel: Sequence[Kernel] = ()
    inhibition: Annotated[float, Live("activation", section="interaction")] = 3.0
    drive: Annotated[float, Live(section="interaction")] = 0.25
    threshold: Annotated[float, Live("activation", section="interaction")] = 0.0
    threshold_inhibition: Annotated[float, Live("activation", section="interaction")] = 0.0
    sigmoid: SigmoidFunction = SemiLinear()
    sigmoid_inhibition: SigmoidFunction = SemiLinear()

    noise: Annotated[
        float,
        Live(
            "activation",
            lower=0,
            neutral=0.0,
            section="noise",
        ),
    ] = 0.0

    def recurrence(self) -> Mapping[str, Sign]:
        return {
            "excitation": together([sign_of(self.self_excitation), *(k.polarity() for k in self.kernel)]),
            "inhibition": sign_of(-self.inhibition),
        }

    def outputs(self, ins: PortAxes) -> PortAxes:
        axes = tuple(self.axes)
        return {"output": axes, "inhibitory": (), "interaction": axes}

    def noise_axes(self) -> Axes | None:
        return None if is_neutral(self.noise) else tuple(self.axes)

    def validate_axes(self, ins: PortAxes) -> Iterator[str]:
        yield from validate_kernels(self.kernel, tuple(self.axes))

    def init(self, at: Setting) -> Arrays:
        return {"rate": at.full(tuple(self.axes), 0.0), "inhibition": at.full((), 0.0)}

    def prepare(self, at: Setting) -> dict[str, list[KernelWeights]]:
        return {"kernel": interaction.prepare(self.kernel, tuple(self.axes), at.dtype)}

    def hoist(self, at: Setting) -> dict[str, Mixture]:
        return {"kernel": interaction.mix(self.kernel, tuple(self.axes), at.constants["kernel"])}

    def output(self, at: Setting) -> Arrays:
        return {
            "output": at.state["rate"],
            "inhibitory": at.state["inhibition"],
            "interaction": self._interaction(at),
        }

    def advance(self, at: Setting) -> Arrays:
        r, v, axes = at.state["rate"], at.state["inhibition"], tuple(self.axes)
        u = at.inputs["input"] + self._interaction(at) - self.threshold
        driven = self.drive * cell(axes) * jnp.sum(r) - self.threshold_inhibition
        deviates = None if at.noise is None else self.noise * noises.over(axes, at.noise, None)
        return {
            "rate": euler(r, -r + self.sigmoid(u), self.tau, at.time.dt, deviates),
            "inhibition": euler(v, -v + self.sigmoid_inhibition(driven), self.tau_inhibition, at.time.dt),
        }

    def _interaction(self, at: Setting) -> Array:
        r = at.state["rate"]
        neighbours = interaction.apply(at.constants["kernel"], tuple(self.axes), r) if self.kernel else 0.0
        return self.self_excitation * r + neighbours - self.inhibition * at.state["inhibition"]
