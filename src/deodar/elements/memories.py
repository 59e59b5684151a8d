"""Elements that store the past of their input."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Element, PortAxes, PortBounds, Setting
from deodar.numerics.axes import Axes, Axis, shape, wrong_shape
from deodar.numerics.exact import Exact, exact, wide
from deodar.numerics.intervals import ZERO, hull
from deodar.numerics.sigmoids import SigmoidFunction
from deodar.parameters import ArrayLike, FrozenArray, Live, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class MemoryTrace(Element):
    r"""A slow trace of past activation, which pre-shapes the field that it reads.

    The trace changes only while the input is above the threshold somewhere, unless `fades`: it then grows
    where the input is above the threshold and decays elsewhere. In the graded form f is the input clipped to
    0..1. With an `activity` a sigmoid a takes the place of the threshold, and the trace fades.

    Equation:
        \frac{dp}{dt} = \begin{cases} \mathrm{gate}\, (\mathrm{input} - p) / \tau_{\mathrm{build}} &
            \mathrm{input} > \mathrm{threshold} \\ -\mathrm{gate}\, p / \tau_{\mathrm{decay}} &
            \text{else} \end{cases}
        \text{graded:}\quad \frac{dp}{dt} = \mathrm{gate} \left( \frac{f (f -
            p)}{\tau_{\mathrm{build}}} - \frac{(1 - f)\, p}{\tau_{\mathrm{decay}}} \right)
        \text{activity:}\quad \frac{dp}{dt} = \mathrm{gate} \left( \frac{a (\mathrm{input} -
            p)}{\tau_{\mathrm{build}}} - \frac{(1 - a)\, p}{\tau_{\mathrm{decay}}} \right),\quad
            a = \mathrm{activity}(\mathrm{input})

    Parameters:
        axes: the metric dimensions; none: one number.
        tau_build: time constant of the build-up; in the document's time unit, > 0. In eq. 11: tau_l /
            lambda_build.
        tau_decay: time constant of the decay; in the document's time unit, > 0. In eq. 11: tau_l /
            lambda_decay.
        threshold: input above which a sample is active.
        graded: whether build-up and decay are weighted by the input itself; as in eq. 11, instead of by
            whether it is above the threshold.
        fades: whether the trace also decays while no sample is active.
        gated: whether the element has a port `gate`; without it the gate is 1.
        start: p at the start; one value for each sample; none: 0.
        activity: a sigmoid of the input that weights build-up and decay; in place of the threshold; none: the
            threshold. Not together with `graded`.

    Ports:
        input: over `axes`; usually the output of a field.
        gate: one number, only if `gated`; factor of the rates of build-up and decay. Values below 0 count
            as 0.
        output: p, over `axes`.
        active: 1 where the input of the previous step was above the threshold, over `axes`.

    Shapes:
        start: the samples of `axes`, in their order.

    Reference:
        Sandamirskaya (2014), Front. Neurosci. 7:276, eq. 11 (graded; the equation does not state
        whether the trace decays while the field has no peak: by default it does not, so that memories outlast
        pauses). Lipinski, Simmering, Johnson & Spencer (2010), The role of experience in location estimation,
        Psychon. Bull. Rev. 17 (traces that grow below peaks and decay between them); Erlhagen & Schöner
        (2002), Psychol. Rev. 109 (preshape).
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    tau_build: Annotated[float, Live("time", role="time constant", lower=1e-6)] = 100.0
    tau_decay: Annotated[float, Live("time", role="time constant", lower=1e-6)] = 1000.0
    threshold: Annotated[float, Live()] = 0.5

    graded: bool = False
    fades: bool = False
    gated: bool = False
    start: Annotated[ArrayLike | None, Rebuild("activation")] = None
    activity: SigmoidFunction | None = None

    inputs: ClassVar[tuple[str, ...]] = ("input", "gate")
    optional: ClassVar[Mapping[str, str]] = {"gate": "gated"}
    bounded_inputs: ClassVar[tuple[str, ...]] = ("input",)

    def input_axes(self, port: str, arriving: Axes | None) -> Axes | None:
        return () if port == "gate" else tuple(self.axes)

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        yield from wrong_shape("start", self.start, shape(self.axes))

    def validate(self) -> Iterator[tuple[str, str]]:
        if self.graded and self.activity is not None:
            yield "activity", "is a sigmoid, and graded takes the input itself; give one of them"

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": tuple(self.axes), "active": tuple(self.axes)}

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        first = (
            ZERO
            if not isinstance(self.start, FrozenArray)
            else (float(self.start.data.min()), float(self.start.data.max()))
        )
        return {"output": hull(first, inputs["input"]), "active": (0.0, 1.0)}

    def jumps_at(self) -> Sequence[str]:
        gradual = (self.graded and self.fades) or self.activity is not None
        return ("threshold",) if gradual else ("input", "threshold")

    def init(self, at: Setting) -> Arrays:
        trace = at.full(tuple(self.axes), 0.0) if self.start is None else at.array(self.start)
        return {"trace": trace, "active": at.full(tuple(self.axes), 0.0)}

    def output(self, at: Setting) -> Arrays:
        return {"output": at.state["trace"], "active": at.state["active"]}

    def advance(self, at: Setting) -> Arrays:
        p, x = at.state["trace"], at.inputs["input"]
        active = x > self.threshold
        if self.activity is not None:
            a = self.activity(x)
            rate = a * (x - p) / self.tau_build - (1.0 - a) * p / self.tau_decay
        elif self.graded:
            f = jnp.clip(x, 0.0, 1.0)
            rate = f * (f - p) / self.tau_build - (1.0 - f) * p / self.tau_decay
        else:
            rate = jnp.where(active, (x - p) / self.tau_build, -p / self.tau_decay)
        if not self.fades and self.activity is None:
            rate = jnp.where(jnp.any(active), rate, 0.0)
        if self.gated:
            rate = jnp.maximum(at.inputs["gate"], 0.0) * rate
        return {"trace": p + at.time.dt * rate, "active": active.astype(p.dtype)}

    def learned_parameters(self, state: Mapping[str, np.ndarray]) -> Mapping[str, np.ndarray]:
        return {"start": state["trace"]}

    @classmethod
    def example(cls) -> MemoryTrace:
        return cls("example", [Axis("x", 0, 20, samples=21)], gated=True)


EMPTY = ("zero", "nan")


@dataclass(frozen=True)
class StoredSamples(Element):
    """The base class of histories: samples of the input over an axis of slots; subclasses say which."""

    name: str = ""
    axes: Sequence[Axis] = ()
    slots: Axis = needed("slot")

    def outputs(self, ins: PortAxes) -> PortAxes:
        return {"output": (self.slots, *self.axes)}

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        if self.slots.name in [a.name for a in self.axes]:
            yield (
                f"the slots are called {self.slots.name!r} like an axis of the input",
                "Give the axis of the slots another name",
            )


@register
@dataclass(frozen=True)
class History(StoredSamples):
    r"""A running history of the input: the newest sample first, the oldest dropped.

    Equation:
        t = n \cdot \mathrm{interval}\text{:}\quad y_0 \leftarrow \mathrm{input}(t),\quad y_k
            \leftarrow y_{k-1}

    Parameters:
        axes: axes of the input.
        slots: the axis of the stored samples, the newest at its lower end; first axis of the output.
        interval: time between two stored samples, in the document's time unit; > 0. Shorter than a
            step: every step.
        empty: value of slots that hold no sample yet; `zero`, or `nan` (not a number). Elements that read
            `nan` become undefined too.

    Ports:
        input: over `axes`.
        output: over `slots`, then `axes`.

    Reference:
        no reference
    """

    interval: Annotated[float, Live("time", role="duration", exact=True, lower=1e-6)] = 1.0
    empty: Annotated[str, Recompile(choices=EMPTY)] = "zero"

    def undefined(self) -> Sequence[str]:
        return ("output",) if self.empty == "nan" else ()

    def bounds(self, ins: PortAxes, inputs: PortBounds, before: PortBounds) -> PortBounds:
        return {"output": hull(ZERO, inputs["input"])}

    def init(self, at: Setting) -> Arrays:
        state = {"kept": at.full((self.slots, *self.axes), 0.0), "newest": at.full((), 0.0)}
        return state | ({"count": at.full((), 0.0)} if self.empty == "nan" else {})

    def state_axes(self, ins: PortAxes) -> Mapping[str, Sequence[Axis | int]]:
        return {"kept": (self.slots.samples, *self.axes)}

    def output(self, at: Setting) -> Arrays:
        kept = jnp.roll(at.state["kept"], -at.state["newest"].astype(int), axis=0)
        if self.empty == "nan":  # only the output has NaN; the state is finite
            there = jnp.arange(self.slots.samples) < at.state["count"]
            kept = jnp.where(there.reshape(-1, *(1 for _ in self.axes)), kept, jnp.nan)
        return {"output": kept}

    def advance(self, at: Setting) -> Arrays:
        # a ring buffer: a step writes one row, whatever the number of slots
        kept, newest = at.state["kept"], at.state["newest"]
        with exact():
            coming, interval = at.time.wide + at.time.wide_dt, wide(self.interval)
            due = jnp.abs(coming - interval * jnp.round(coming / interval)) < 0.5 * at.time.wide_dt
        newest = jnp.where(due, jnp.mod(newest - 1, self.slots.samples), newest)
        place = newest.astype(int)
        new = {"kept": kept.at[place].set(jnp.where(due, at.inputs["input"], kept[place])), "newest": newest}
        if self.empty == "nan":
            new["count"] = jnp.minimum(at.state["count"] + due, self.slots.samples)
        return new

    @classmethod
    def example(cls) -> History:
        return cls("example", [Axis("x", 0, 20, samples=21)], Axis("slot", 0, 9, samples=10))


@register
@dataclass(frozen=True)
class SampledHistory(StoredSamples):
    r"""The input, sampled at stated times and stored; see `History` for the recent past.

    Equation:
        y_k(t) = \begin{cases} \mathrm{input}(\mathrm{times}_k) & t \ge \mathrm{times}_k \\
            \mathrm{empty} & \text{else} \end{cases}

    Parameters:
        axes: axes of the input.
        slots: the axis of the stored samples, one sample for each time; first axis of the output.
        times: the sampling times; in the document's time unit. A time between two steps is rounded to the
            nearer one; the input at the start of a run is not stored.
        empty: value of slots before their time; `zero`, or `nan` (not a number). Elements that read `nan`
            become undefined too.

    Ports:
        input: over `axes`.
        output: over `slots`, then `axes`.

    Shapes:
        times: one time for each sample of `slots`.

    Reference:
        no reference
    """

    times: Annotated[ArrayLike, Rebuild("time", role="moment")] = FrozenArray([1.0, 5.0, 10.0])
    empty: Annotated[str, Recompile(choices=EMPTY)] = "zero"

    def validate_axes(self, ins: PortAxes) -> Iterator[tuple[str, str]]:
        yield from super().validate_axes(ins)
        given = self.times.shape if isinstance(self.times, FrozenArray) else ()
        if given != (self.slots.samples,):
            yield (
                f"times has shape {list(given)}, the axis of the slots has {self.slots.samples} samples",
                "Give one moment for each sample",
            )

    def undefined(self) -> Sequence[str]:
        return ("output",) if self.empty == "nan" else ()

    def prepare(self, at: Setting) -> dict[str, Exact]:
        return {"times": at.exact(self.times)}

    def init(self, at: Setting) -> Arrays:
        return {"kept": at.full((self.slots, *self.axes), 0.0), "stored": at.full((self.slots,), 0.0)}

    def state_axes(self, ins: PortAxes) -> Mapping[str, Sequence[Axis | int]]:
        return {"kept": (self.slots.samples, *self.axes), "stored": (self.slots.samples,)}

    def output(self, at: Setting) -> Arrays:
        kept = at.state["kept"]
        return {
            "output": jnp.where(self._each(at.state["stored"]) > 0, kept, jnp.nan)
            if self.empty == "nan"
            else kept
        }

    def advance(self, at: Setting) -> Arrays:
        with exact():
            late, half = at.time.wide + at.time.wide_dt - wide(at.constants["times"]), 0.5 * at.time.wide_dt
            due = (late >= -half) & (late < half)
        return {
            "kept": jnp.where(self._each(due), at.inputs["input"], at.state["kept"]),
            "stored": jnp.maximum(at.state["stored"], due.astype(at.dtype)),
        }

    def _each(self, values: Array) -> Array:
        """Reshape values of the slots so that they broadcast over the axes."""
        return values.reshape(-1, *(1 for _ in self.axes))

    @classmethod
    def example(cls) -> SampledHistory:
        return cls("example", [Axis("x", 0, 20, samples=21)], Axis("slot", 0, 2, samples=3))
