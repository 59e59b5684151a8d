"""Sources whose pattern changes over time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, TypedDict

import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from jax import Array

from deodar.declarations import needed
from deodar.element import Arrays, Element, PortAxes, Setting
from deodar.elements.stimuli import Stimulus, array_strength
from deodar.leaves import is_neutral, per_axis
from deodar.numerics import noise as noises
from deodar.numerics import starting
from deodar.numerics.axes import Axes, Axis, shape, wrong_shape
from deodar.numerics.exact import Exact, exact, wide
from deodar.numerics.intervals import Interval, signed
from deodar.numerics.signs import Sign
from deodar.numerics.windows import gate
from deodar.parameters import ArrayLike, FrozenArray, Live, PerAxis, Rebuild, Recompile
from deodar.registry import register


@register
@dataclass(frozen=True)
class MovingGaussian(Stimulus):
    r"""A Gaussian input that moves at a constant velocity, along waypoints, or both.

    On a periodic axis the distance is the shorter one. On an axis that is not periodic, the Gaussian may
    leave the axis; it is not reflected.

    Equation:
        s(x, t) = \mathrm{amplitude} \exp\!\left( -\sum_i \frac{(x_i - c_i(t))^2}{2 \sigma_i^2}
            \right)
        c_i(t) = \mathrm{center}_i + \mathrm{velocity}_i\, t + p_i(t)

    Parameters:
        axes: axes of the stimulus; none: a constant for a node.
        center: position at time 0 without waypoints; in axis units, one value or one for each axis.
        sigma: width; in axis units, one value or one for each axis, > 0.
        amplitude: value at the centre.
        velocity: speed of the motion; axis units per unit of the document's time, one value or one for each
            axis.
        waypoints: p, times and the positions at them; in the document's time unit and axis units;
            interpolated linearly, constant before the first and after the last. Positions may exceed a
            periodic axis: 350 to 370 is a move by 20 across its end. None: p = 0.
        windows: when it is on; pairs (start, stop) in the document's time unit; none: always; []: never.

    Ports:
        output: over `axes`.

    Shapes:
        waypoints: one row for each time: the time, then one position for each axis.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 1 (the input s).
    """

    center: Annotated[PerAxis, Live("axis")] = 0.0
    sigma: Annotated[PerAxis, Live("axis", lower=1e-6)] = 5.0
    amplitude: Annotated[float, Live("activation")] = 1.0
    velocity: Annotated[PerAxis, Live("axis/time", role="speed", exact=True)] = 0.0
    waypoints: Annotated[ArrayLike | None, Rebuild("axis", exact=True)] = None

    signed_by: ClassVar[tuple[str, ...]] = ("amplitude",)

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        return starting.bump(axes, "sigma")

    def validate(self) -> Iterator[tuple[str, str]]:
        if isinstance(self.waypoints, FrozenArray):
            rows, columns = self.waypoints.data, 1 + len(self.axes)
            if rows.ndim != 2 or rows.shape[1] != columns or not rows.size:
                yield (
                    "waypoints",
                    (
                        f"has shape {list(rows.shape)}; it has rows of {columns} numbers: the time, then one"
                        " place for each axis"
                    ),
                )
            elif (np.diff(rows[:, 0]) <= 0).any():
                yield "waypoints", "goes back in time; each row is later than the one before"

    def strength(self) -> Interval:
        return signed(self.amplitude)

    def steady(self) -> bool:
        return False

    def prepare(self, at: Setting) -> dict[str, Exact]:
        return {} if self.waypoints is None else {"waypoints": at.exact(self.waypoints)}

    def output(self, at: Setting) -> Arrays:
        y = self.amplitude * gate(self.windows, at.time, at.dtype) * jnp.ones((), at.dtype)
        places = self._places(at)
        for axis, place, sigma in zip(self.axes, places, per_axis(self.sigma, self.axes), strict=True):
            distance = at.points(axis) - place
            if axis.periodic:
                distance = distance - axis.range * jnp.round(distance / axis.range)
            y = y[..., None] * jnp.exp(-0.5 * (distance / sigma) ** 2)
        return {"output": y}

    def _places(self, at: Setting) -> list[Array]:
        """The centre along each axis.

        On a periodic axis whole periods are subtracted in float64, before the cast to the model's
        precision, so that large positions lose no digits.
        """
        out: list[Array] = []
        with exact():
            for d, axis in enumerate(self.axes):
                place = (
                    wide(per_axis(self.center, self.axes)[d])
                    + wide(per_axis(self.velocity, self.axes)[d]) * at.time.wide
                )
                if "waypoints" in at.constants:
                    points = wide(at.constants["waypoints"])
                    place = place + jnp.interp(at.time.wide, points[:, 0], points[:, 1 + d])
                if axis.periodic:
                    place = axis.lower + jnp.mod(place - axis.lower, axis.range)
                out.append(place.astype(at.dtype))
        return out


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
        times: the times of the values, increasing; in the document's time unit.
        values: for each time one value for each sample of the axes; `TimeSeries.of(name, function, times,
            axes)` samples a function.
        amplitude: factor.
        interpolation: `linear` or `hold`.
        period: P, time after which the series repeats; in the document's time unit; values at times later
            than P are not used. 0: no repetition.
        windows: when it is on; pairs (start, stop) in the document's time unit; none: always; []: never.

    Ports:
        output: over `axes`.

    Shapes:
        times: one entry for each time.
        values: the times, then the samples of `axes`, in their order.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 1 (the input s).
    """

    axes: Sequence[Axis] = needed("[x]")
    times: Annotated[ArrayLike, Rebuild("time", role="moment")] = FrozenArray([0.0, 100.0])
    values: Annotated[ArrayLike, Rebuild("activation")] = FrozenArray(
        [[float(k % 7 == 3) for k in range(21)], [float(k % 7 == 5) for k in range(21)]]
    )
    amplitude: Annotated[float, Live()] = 1.0
    interpolation: Annotated[str, Recompile(choices=WAYS)] = "linear"
    period: Annotated[
        float,
        Live(
            "time",
            role="duration",
            exact=True,
            lower=0,
            neutral=0.0,
            off=True,
        ),
    ] = 0.0

    signed_by: ClassVar[tuple[str, ...]] = ("values", "amplitude")

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        two = np.stack([starting.hill(axes, 0.3), starting.hill(axes, 0.7)])
        return {"values": FrozenArray(two), "amplitude": starting.STRENGTH}

    def validate(self) -> Iterator[tuple[str, str]]:
        times = self.times.data if isinstance(self.times, FrozenArray) else np.zeros(0)
        if times.ndim != 1 or not times.size:
            yield "times", f"has shape {list(times.shape)}; it is a list of moments, at least one"
        elif (np.diff(times) <= 0).any():
            yield "times", "does not rise; each moment is later than the one before"

    def validate_axes(self, ins: PortAxes) -> Iterator[str | tuple[str, str]]:
        yield from super().validate_axes(ins)
        times = self.times.shape if isinstance(self.times, FrozenArray) else ()
        yield from wrong_shape("values", self.values, times + shape(self.axes), "its times and axes have")

    def strength(self) -> Interval:
        return array_strength(self.values, self.amplitude)

    def steady(self) -> bool:
        return False

    def prepare(self, at: Setting) -> TimeSeriesConstants:
        return {"times": at.exact(self.times), "values": at.array(self.values)}

    def output(self, at: Setting) -> Arrays:
        values, last = at.constants["values"], len(at.constants["values"]) - 1
        hold = self.interpolation == "hold"
        with exact():
            times, half, now = wide(at.constants["times"]), 0.5 * at.time.wide_dt, at.time.wide
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
        return {"output": self.amplitude * gate(self.windows, at.time, at.dtype) * y}

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


@register
@dataclass(frozen=True)
class Noise(Element):
    r"""A source of Gaussian noise, for several targets at once or through a coupling.

    As input of a field it has the same effect as the field's parameter `noise` of strength q: an Euler step
    adds q sqrt(dt) / tau xi_n.

    Equation:
        y(x, t_n) = \frac{q\, \xi_n(x)}{\sqrt{dt}}

    Parameters:
        axes: axes of the noise; none: one number.
        amplitude: q, strength; without `length` divided by the root of the cell's volume, else the standard
            deviation at a point of the process that the stochastic Euler step adds.
        length: correlation length; in axis units, one value or one for each axis; 0: white.

    Ports:
        output: over `axes`; a new sample in every step of the element.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eqs. 16 and 17.
    """

    name: str = ""
    axes: Sequence[Axis] = ()
    amplitude: Annotated[float, Live("activation", lower=0, neutral=0.0)] = 1.0
    length: Annotated[PerAxis, Rebuild("axis", lower=0, neutral=0.0, off=True)] = 0.0

    inputs: ClassVar[tuple[str, ...]] = ()

    def polarity(self) -> Sign:
        return "±"

    def steady(self) -> bool:
        return False

    def noise_axes(self) -> Axes | None:
        return None if is_neutral(self.amplitude) else tuple(self.axes)

    def validate_axes(self, ins: PortAxes) -> Iterator[str]:
        lengths = [float(v) for v in per_axis(self.length, self.axes)]
        if any(lengths) and not all(lengths):
            yield "length is 0 on one axis and not on another; give all of them or none"

    def prepare(self, at: Setting) -> dict[str, list[Array]]:
        return noises.prepare(tuple(self.axes), self.length, at.dtype)

    def output(self, at: Setting) -> Arrays:
        if at.noise is None:
            return {"output": at.full(tuple(self.axes), 0.0)}
        deviates = noises.over(tuple(self.axes), at.noise, at.constants.get("noise"))
        return {"output": self.amplitude / jnp.sqrt(at.time.dt) * deviates}
