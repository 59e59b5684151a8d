"""The stimulus defined by an array over time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, TypedDict

import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Setting, Time
from deodar.elements._stimulus import Stimulus, array_strength
from deodar.leaves import is_neutral
from deodar.numerics import starting
from deodar.numerics.axes import Axes, Axis, shape, wrong_shape
from deodar.numerics.exact import Exact, exact, wide
from deodar.numerics.intervals import Interval
from deodar.numerics.signs import Sign, product, sign_of
from deodar.numerics.windows import gate
from deodar.parameters import ArrayLike, FrozenArray, Live, Rebuild, Recompile
from deodar.registry import register

WAYS = ("linear", "hold")


class TimeSeriesConstants(TypedDict):
    """Moments and values as the program holds them."""

    times: Exact
    values: Array


@register
@dataclass(frozen=True)
class TimeSeries(Stimulus):
    r"""A time-varying input defined by an array: one pattern for each time.

    Between two times v is interpolated linearly (`linear`) or equals the earlier value (`hold`); before the
    first time it equals the first value, after the last time the last value.

    Equation:
        s(x, t) = \mathrm{amplitude} \cdot v(x, t)
        v(x, \mathrm{times}_k) = \mathrm{values}(k, x)
        \text{period } P\text{:}\quad v(x, t) = v(x, t \bmod P)

    Parameters:
        axes: axes of the stimulus; none: a number for a node.
        times: the times of the values, increasing, in the document's time unit.
        values: for each time one value for each sample of the axes (`TimeSeries.of(name, function, times,
            axes)` samples a function).
        amplitude: factor.
        interpolation: `linear` or `hold`.
        period: P, time after which the series repeats, in the document's time unit; values at times later
            than P are not used. 0: no repetition.
        windows: when it is on, pairs (start, stop) in the document's time unit; without windows always.

    Ports:
        output: over `axes`.

    Shapes:
        times: one entry for each time.
        values: the times, then the samples of `axes`, in their order.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 1 (the input s).
    """

    axes: Annotated[Sequence[Axis], Recompile(meaning="axes of the values")] = needed("[x]")
    times: Annotated[ArrayLike, Rebuild("time", role="moment", meaning="the moments")] = FrozenArray(
        [0.0, 100.0]
    )
    values: Annotated[
        ArrayLike, Rebuild("activation", meaning="for each moment one value for each sample")
    ] = FrozenArray([[float(k % 7 == 3) for k in range(21)], [float(k % 7 == 5) for k in range(21)]])
    amplitude: Annotated[float, Live(meaning="factor")] = 1.0
    interpolation: Annotated[str, Recompile(choices=WAYS, meaning="values between two moments")] = "linear"
    period: Annotated[
        float,
        Live(
            "time",
            role="duration",
            exact=True,
            lower=0,
            neutral=0.0,
            off=True,
            meaning="period of repetition; 0: none",
        ),
    ] = 0.0

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        two = np.stack([starting.hill(axes, 0.3), starting.hill(axes, 0.7)])
        return {"values": FrozenArray(two), "amplitude": starting.STRENGTH}

    def polarity(self) -> Sign:
        return product(sign_of(self.values), sign_of(self.amplitude))

    def validate(self) -> Iterator[tuple[str, str]]:
        times = self.times.data if isinstance(self.times, FrozenArray) else np.zeros(0)
        if times.ndim != 1 or not times.size:
            yield "times", f"has shape {list(times.shape)}; it is a list of moments, at least one"
        elif (np.diff(times) <= 0).any():
            yield "times", "does not rise; each moment is later than the one before"

    def validate_axes(self, ins: Mapping[str, Axes]) -> Iterator[str | tuple[str, str]]:
        yield from super().validate_axes(ins)
        times = self.times.shape if isinstance(self.times, FrozenArray) else ()
        yield from wrong_shape("values", self.values, times + shape(self.axes), "its times and axes have")

    def strength(self) -> Interval:
        return array_strength(self.values, self.amplitude)

    def steady(self) -> bool:
        return False

    def prepare(self, at: Setting) -> TimeSeriesConstants:
        return {"times": at.exact(self.times), "values": at.array(self.values)}

    def output(
        self,
        at: Setting,
        state: Arrays,
        inputs: Arrays,
        constants: TimeSeriesConstants,
        time: Time,
        noise: Array | None,
    ) -> Arrays:
        values, last = constants["values"], len(constants["values"]) - 1
        hold = self.interpolation == "hold"
        with exact():
            times, half, now = wide(constants["times"]), 0.5 * time.wide_dt, time.wide
            if not is_neutral(self.period):
                # shifted by half a step, so that rounding moves no time to the other end of the period
                now = jnp.mod(now + half, wide(self.period)) - half
            before = jnp.clip(
                jnp.sum(times <= now + (half if hold else 0.0)) - 1, 0, last if hold else max(last - 1, 0)
            )
            after = jnp.minimum(before + 1, last)
            span = jnp.where(after > before, times[after] - times[before], 1.0)
            share = jnp.clip((now - times[before]) / span, 0.0, 1.0).astype(at.dtype)
            before, after = before.astype(jnp.int32), after.astype(jnp.int32)
        y = values[before] if hold else (1 - share) * values[before] + share * values[after]
        return {"output": self.amplitude * gate(self.windows, time, at.dtype) * y}

    @classmethod
    def of(
        cls,
        name: str,
        function: Callable[..., npt.ArrayLike],
        times: Iterable[float],
        axes: Sequence[Axis],
        **others: Any,
    ) -> TimeSeries:
        """Sample a function of time and of the axes' values.

        Example: `TimeSeries.of("s", lambda t, x: np.sin(t / 50 + x), range(1000), [x])`.

        Args:
            name: name of the element.
            function: called once with arrays of equal number of dimensions, time first.
            times: the times of the values, increasing, in the document's time unit.
            axes: axes of the stimulus.
            others: other parameters of the element.
        """
        moments = np.asarray(times, float)
        grids = np.meshgrid(moments, *(a.points for a in axes), indexing="ij")
        return cls(
            name,
            tuple(axes),
            moments,
            np.broadcast_to(np.asarray(function(*grids), float), grids[0].shape),
            **others,
        )
