"""Couplings that compute each sample from the samples at the same position."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.element import Arrays, Coupling, PortAxes, PortBounds, PortUnits, Setting
from deodar.numerics.intervals import ZERO, hull, times
from deodar.numerics.sigmoids import Logistic, SigmoidFunction
from deodar.parameters import Live, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class Sum(Coupling):
    r"""The sum of several connections as one signal, for several targets or for another coupling.

    Equation:
        y(x) = \sum \mathrm{inputs}(x)

    Parameters:
        none.

    Ports:
        input: any axes: those of the connection with the most axes (then the most samples); others expand.
        output: the same axes.

    Reference:
        no reference
    """

    linear: ClassVar[bool] = True

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        return {"output": inputs["input"]}

    def position_units(self, ins: PortAxes, inputs: PortUnits) -> PortUnits:
        return {"output": inputs["input"]}

    def output(self, at: Setting) -> Arrays:
        return {"output": at.inputs["input"]}


@register
@dataclass(frozen=True)
class Product(Coupling):
    r"""The pointwise product of two signals, for gating.

    Each port sums all connections into it.

    Equation:
        y(x) = \mathrm{input}(x) \cdot \mathrm{factor}(x)

    Parameters:
        none.

    Ports:
        input: any axes.
        factor: the axes of `input`; one number multiplies all samples.
        output: the axes of `input`.

    Reference:
        no reference
    """

    inputs: ClassVar[tuple[str, ...]] = ("input", "factor")
    follows: ClassVar[Mapping[str, str]] = {"factor": "input"}

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        return {"output": times(inputs["input"], inputs["factor"])}

    def output(self, at: Setting) -> Arrays:
        return {"output": at.inputs["input"] * at.inputs["factor"]}


@register
@dataclass(frozen=True)
class Quotient(Coupling):
    r"""The pointwise quotient of two signals, for normalisation.

    Each port sums all connections into it.

    Equation:
        y(x) = \begin{cases} \frac{\mathrm{input}(x)}{\mathrm{divisor}(x)} & |\mathrm{divisor}(x)| \ge
            \mathrm{least} \\ \frac{\mathrm{input}(x)}{\mathrm{least}} & \text{else} \end{cases}

    Parameters:
        least: the divisor where the port's magnitude is smaller; > 0.

    Ports:
        input: any axes.
        divisor: the axes of `input`; one number divides all samples.
        output: the axes of `input`.

    Reference:
        no reference
    """

    least: Annotated[float, Live(lower=1e-30)] = 1e-6

    inputs: ClassVar[tuple[str, ...]] = ("input", "divisor")
    bounded_inputs: ClassVar[tuple[str, ...]] = ("divisor",)
    follows: ClassVar[Mapping[str, str]] = {"divisor": "input"}

    def jumps_at(self) -> Sequence[str]:
        return ("least",)

    def output(self, at: Setting) -> Arrays:
        d = at.inputs["divisor"]
        return {"output": at.inputs["input"] / jnp.where(jnp.abs(d) >= self.least, d, self.least)}


@register
@dataclass(frozen=True)
class Gain(Coupling):
    r"""A coupling strength: a positive factor excites, a negative factor inhibits.

    Equation:
        y(x) = \mathrm{factor} \cdot \mathrm{input}(x)

    Parameters:
        factor: strength.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 4, with a factor.
    """

    factor: Annotated[float, Live()] = 1.0

    linear: ClassVar[bool] = True
    scaled_by: ClassVar[str] = "factor"
    signed_by: ClassVar[tuple[str, ...]] = ("factor",)

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        return {} if self.factor == 0 else {"output": times((self.factor, self.factor), inputs["input"])}

    def position_units(self, ins: PortAxes, inputs: PortUnits) -> PortUnits:
        return {"output": tuple(p and p.scaled(self.factor) for p in inputs["input"])}

    def output(self, at: Setting) -> Arrays:
        return {"output": self.factor * at.inputs["input"]}


@register
@dataclass(frozen=True)
class Envelope(Coupling):
    r"""The larger, or the smaller, of two signals at each sample; with a Boost a limit.

    Each port sums all connections into it.

    Equation:
        \text{upper:}\quad y(x) = \max(\mathrm{input}(x), \mathrm{other}(x))
        \text{lower:}\quad y(x) = \min(\mathrm{input}(x), \mathrm{other}(x))

    Parameters:
        side: `upper` or `lower`.

    Ports:
        input: any axes.
        other: the axes of `input`; one number is compared with all samples.
        output: the axes of `input`.

    Reference:
        no reference
    """

    side: Annotated[str, Recompile(choices=("upper", "lower"))] = "upper"

    inputs: ClassVar[tuple[str, ...]] = ("input", "other")
    follows: ClassVar[Mapping[str, str]] = {"other": "input"}

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        (a, b), (c, d) = inputs["input"], inputs["other"]
        return {"output": (max(a, c), max(b, d)) if self.side == "upper" else (min(a, c), min(b, d))}

    def output(self, at: Setting) -> Arrays:
        choose = jnp.maximum if self.side == "upper" else jnp.minimum
        return {"output": choose(at.inputs["input"], at.inputs["other"])}


@register
@dataclass(frozen=True)
class Threshold(Coupling):
    r"""A threshold: the input where it exceeds the level, 0 elsewhere.

    Equation:
        y(x) = \begin{cases} \mathrm{input}(x) & \mathrm{input}(x) > \mathrm{level} \\ 0 &
            \text{else} \end{cases}

    Parameters:
        level: the threshold; in units of the input. For an output of 0 or 1 use the coupling `Sigmoid` with
            `Step`.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 12 (the thresholded sum).
    """

    level: Annotated[float, Live()] = 0.5

    def jumps_at(self) -> Sequence[str]:
        return "input", "level"

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        low, high = inputs["input"]
        return {"output": ZERO if high <= self.level else hull(ZERO, (max(low, self.level), high))}

    def output(self, at: Setting) -> Arrays:
        x = at.inputs["input"]
        return {"output": jnp.where(x > self.level, x, jnp.zeros_like(x))}


@register
@dataclass(frozen=True)
class Sigmoid(Coupling):
    r"""The sigmoid of a signal, such as a sum or a sensor's reading.

    Equation:
        y(x) = g(\mathrm{input}(x))

    Parameters:
        sigmoid: g, the sigmoid function.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 2 and the text before it.
    """

    sigmoid: SigmoidFunction = Logistic()

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        return {"output": self.sigmoid.bounds(inputs["input"])}

    def output(self, at: Setting) -> Arrays:
        return {"output": self.sigmoid(at.inputs["input"])}


@register
@dataclass(frozen=True)
class Logarithm(Coupling):
    r"""The logarithmic compression of a signal that ranges over orders of magnitude.

    Equation:
        y(x) = \mathrm{factor} \cdot \ln\!\left( 1 + \frac{\max(\mathrm{input}(x),
            0)}{\mathrm{scale}} \right)

    Parameters:
        factor: strength.
        scale: input above which the compression is noticeable; > 0.

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        Billing, Lowe & Sandamirskaya (2015), Adapt. Behav. 23(5), appendix A and its published simulator
        (proximity sensors).
    """

    factor: Annotated[float, Live()] = 1.0
    scale: Annotated[float, Live(lower=1e-6)] = 1.0

    signed_by: ClassVar[tuple[str, ...]] = ("factor",)

    def output(self, at: Setting) -> Arrays:
        return {"output": self.factor * jnp.log1p(jnp.maximum(at.inputs["input"], 0.0) / self.scale)}


LEAST = 1e-30
"""Smallest argument of the logarithm; smaller ones, and negative ones, give its logarithm, -69.1."""

FUNCTIONS: Mapping[str, Callable[[Array], Array]] = {
    "abs": jnp.abs,
    "square": jnp.square,
    "root": lambda x: jnp.sqrt(jnp.maximum(x, 0.0)),
    "exp": jnp.exp,
    "log": lambda x: jnp.log(jnp.maximum(x, LEAST)),
    "sin": jnp.sin,
    "cos": jnp.cos,
}


@register
@dataclass(frozen=True)
class Pointwise(Coupling):
    r"""A mathematical function of each sample, for conversions between what sensors, fields and motors use.

    The root of a negative number is 0, and the logarithm of a number below 1e-30 that of 1e-30, so that the
    output is finite for every input but large arguments of `exp`. Saturating functions are sigmoids: the
    coupling `Sigmoid`.

    Equation:
        y(x) = \mathrm{function}(\mathrm{input}(x))

    Parameters:
        function: the function; `abs`, `square`, `root`, `exp`, `log` (natural), `sin` or `cos` (of radians).

    Ports:
        input: any axes.
        output: the same axes.

    Reference:
        no reference
    """

    function: Annotated[str, Recompile(choices=tuple(FUNCTIONS))] = "abs"

    bounded_inputs: ClassVar[tuple[str, ...]] = ("input",)

    def output(self, at: Setting) -> Arrays:
        return {"output": FUNCTIONS[self.function](at.inputs["input"])}
