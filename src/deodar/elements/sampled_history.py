"""An input, sampled at stated times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import jax.numpy as jnp
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Element, Setting, Time
from deodar.numerics.axes import Axes, Axis
from deodar.numerics.exact import Exact, exact, wide
from deodar.parameters import ArrayLike, FrozenArray, Rebuild, Recompile
from deodar.registry import register

EMPTY = ("zero", "nan")


@register
@dataclass(frozen=True)
class SampledHistory(Element):
    r"""The input, sampled at stated times and stored; see `History` for the recent past.

    Equation:
        y_k(t) = \begin{cases} \mathrm{input}(\mathrm{times}_k) & t \ge \mathrm{times}_k \\
            \mathrm{empty} & \text{else} \end{cases}

    Parameters:
        axes: axes of the input.
        slots: the axis of the stored samples, one sample for each time; first axis of the output.
        times: the sampling times, in the document's time unit. A time between two steps is rounded to the
            nearer one; the input at the start of a run is not stored.
        empty: value of slots before their time: `zero`, or `nan` (not a number). Elements that read `nan`
            become undefined too.

    Ports:
        input: over `axes`.
        output: over `slots`, then `axes`.

    Shapes:
        times: one time for each sample of `slots`.

    Reference:
        no reference
    """

    name: Annotated[str, Recompile(meaning="name inside its group")] = ""
    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the input")] = ()
    slots: Annotated[Axis, Recompile(meaning="the moments")] = needed("slot")
    times: Annotated[ArrayLike, Rebuild("time", role="moment", meaning="the moments")] = FrozenArray(
        [1.0, 5.0, 10.0]
    )
    empty: Annotated[str, Recompile(choices=EMPTY, meaning="output of slots before their moment")] = "zero"

    stateful: ClassVar[bool] = True

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        return {"output": (self.slots, *self.axes)}

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[tuple[str, str]]:
        if self.slots.name in [a.name for a in self.axes]:
            yield (
                f"the slots are called {self.slots.name!r} like an axis of the input",
                "Give the axis of the slots another name",
            )
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

    def output(
        self,
        at: Setting,
        state: Arrays,
        inputs: Arrays,
        constants: dict[str, Exact],
        time: Time,
        noise: Array | None,
    ) -> Arrays:
        kept = state["kept"]
        return {
            "output": jnp.where(self._each(state["stored"]) > 0, kept, jnp.nan)
            if self.empty == "nan"
            else kept
        }

    def advance(
        self,
        at: Setting,
        state: Arrays,
        inputs: Arrays,
        constants: dict[str, Exact],
        time: Time,
        noise: Array | None,
    ) -> Arrays:
        with exact():
            late, half = time.wide + time.wide_dt - wide(constants["times"]), 0.5 * time.wide_dt
            due = (late >= -half) & (late < half)
        return {
            "kept": jnp.where(self._each(due), inputs["input"], state["kept"]),
            "stored": jnp.maximum(state["stored"], due.astype(at.dtype)),
        }

    def _each(self, values: Array) -> Array:
        """Reshape values of the slots so that they broadcast over the axes."""
        return values.reshape(-1, *(1 for _ in self.axes))

    @classmethod
    def example(cls) -> SampledHistory:
        return cls("example", [Axis("x", 0, 20, samples=21)], Axis("slot", 0, 2, samples=3))
