"""The recent past of an input."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Element, Setting, Time
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.exact import exact, wide
from deodar.numerics.intervals import ZERO, Interval, hull
from deodar.parameters import Live, Recompile
from deodar.registry import register

EMPTY = ("zero", "nan")


@register
@dataclass(frozen=True)
class History(Element):
    r"""A running history of the input: the newest sample first, the oldest dropped.

    Equation:
        t = n \cdot \mathrm{interval}\text{:}\quad y_0 \leftarrow \mathrm{input}(t),\quad y_k
            \leftarrow y_{k-1}

    Parameters:
        axes: axes of the input.
        slots: the axis of the stored samples, the newest at its lower end; first axis of the output.
        interval: time between two stored samples, in the document's time unit; > 0. Shorter than a
            step: every step.
        empty: value of slots that hold no sample yet: `zero`, or `nan` (not a number). Elements that read
            `nan` become undefined too.

    Ports:
        input: over `axes`.
        output: over `slots`, then `axes`.

    Reference:
        no reference
    """

    name: Annotated[str, Recompile(meaning="name inside its group")] = ""
    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the input")] = ()
    slots: Annotated[Axis, Recompile(meaning="axis of the stored moments")] = needed("slot")
    interval: Annotated[
        float,
        Live("time", role="duration", exact=True, lower=1e-6, meaning="time between two stored moments"),
    ] = 1.0
    empty: Annotated[
        str, Recompile(choices=EMPTY, meaning="output of slots that no moment has reached yet")
    ] = "zero"

    stateful: ClassVar[bool] = True

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": (self.slots, *self.axes)}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        if self.slots.name in [a.name for a in self.axes]:
            yield (
                f"the slots are called {self.slots.name!r} like an axis of the input",
                "Give the axis of the slots another name",
            )

    def undefined(self) -> Sequence[str]:
        return ("output",) if self.empty == "nan" else ()

    def bounds(
        self, ins: Mapping[str, Axes], inputs: Mapping[str, Interval], before: Mapping[str, Interval]
    ) -> Mapping[str, Interval]:
        return {"output": hull(ZERO, inputs["input"])}

    def init(self, at: Setting) -> Arrays:
        state = {"kept": at.full((self.slots, *self.axes), 0.0), "newest": at.full((), 0.0)}
        return state | ({"count": at.full((), 0.0)} if self.empty == "nan" else {})

    def output(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        kept = jnp.roll(state["kept"], -state["newest"].astype(int), axis=0)
        if self.empty == "nan":  # only the output has NaN; the state is finite
            there = jnp.arange(self.slots.samples) < state["count"]
            kept = jnp.where(there.reshape(-1, *(1 for _ in self.axes)), kept, jnp.nan)
        return {"output": kept}

    def advance(
        self, at: Setting, state: Arrays, inputs: Arrays, constants: Arrays, time: Time, noise: Array | None
    ) -> Arrays:
        # a ring buffer: a step writes one row, whatever the number of slots
        kept, newest = state["kept"], state["newest"]
        with exact():
            coming, interval = time.wide + time.wide_dt, wide(self.interval)
            due = jnp.abs(coming - interval * jnp.round(coming / interval)) < 0.5 * time.wide_dt
        newest = jnp.where(due, jnp.mod(newest - 1, self.slots.samples), newest)
        place = newest.astype(int)
        new = {"kept": kept.at[place].set(jnp.where(due, inputs["input"], kept[place])), "newest": newest}
        if self.empty == "nan":
            new["count"] = jnp.minimum(state["count"] + due, self.slots.samples)
        return new

    @classmethod
    def example(cls) -> History:
        return cls("example", [Axis("x", 0, 20, samples=21)], Axis("slot", 0, 9, samples=10))
