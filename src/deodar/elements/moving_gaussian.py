"""The moving Gaussian stimulus."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.element import Arrays, Setting, Time
from deodar.elements._stimulus import Stimulus
from deodar.leaves import per_axis
from deodar.numerics import starting
from deodar.numerics.axes import Axes
from deodar.numerics.exact import Exact, exact, wide
from deodar.numerics.intervals import Interval, signed
from deodar.numerics.signs import Sign, sign_of
from deodar.numerics.windows import gate
from deodar.parameters import ArrayLike, FrozenArray, Live, PerAxis, Rebuild
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
        center: position at time 0 without waypoints, in axis units, one value or one for each axis.
        sigma: width in axis units, one value or one for each axis; > 0.
        amplitude: value at the centre.
        velocity: axis units per unit of the document's time, one value or one for each axis.
        waypoints: p, times and the positions at them, in the document's time unit and axis units;
            interpolated linearly, constant before the first and after the last. Positions may exceed a
            periodic axis: 350 to 370 is a move by 20 across its end. None: p = 0.
        windows: when it is on, pairs (start, stop) in the document's time unit; without windows always.

    Ports:
        output: over `axes`.

    Shapes:
        waypoints: one row for each time: the time, then one position for each axis.

    Reference:
        Lomp, Richter, Zibner & Schöner (2016), Front. Neurorobot. 10:14, eq. 1 (the input s).
    """

    center: Annotated[PerAxis, Live("axis", meaning="place at time 0 without waypoints")] = 0.0
    sigma: Annotated[PerAxis, Live("axis", lower=1e-6, meaning="width")] = 5.0
    amplitude: Annotated[float, Live("activation", meaning="value at the centre")] = 1.0
    velocity: Annotated[
        PerAxis, Live("axis/time", role="speed", exact=True, meaning="speed of the motion")
    ] = 0.0
    waypoints: Annotated[
        ArrayLike | None,
        Rebuild(
            "axis", exact=True, meaning="times and the positions at them; none: it moves with its velocity"
        ),
    ] = None

    def polarity(self) -> Sign:
        return sign_of(self.amplitude)

    @classmethod
    def starting_values(cls, axes: Axes, arriving: Axes | None = None) -> Mapping[str, Any]:
        return (
            {
                "center": starting.middle(axes),
                "sigma": starting.one_or_each(starting.widths(axes)),
                "amplitude": starting.STRENGTH,
            }
            if axes
            else {"amplitude": starting.STRENGTH}
        )

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

    def output(
        self,
        at: Setting,
        state: Arrays,
        inputs: Arrays,
        constants: dict[str, Exact],
        time: Time,
        noise: Array | None,
    ) -> Arrays:
        y = self.amplitude * gate(self.windows, time, at.dtype) * jnp.ones((), at.dtype)
        places = self._places(at, constants, time)
        for axis, place, sigma in zip(self.axes, places, per_axis(self.sigma, self.axes), strict=True):
            distance = at.points(axis) - place
            if axis.periodic:
                distance = distance - axis.range * jnp.round(distance / axis.range)
            y = y[..., None] * jnp.exp(-0.5 * (distance / sigma) ** 2)
        return {"output": y}

    def _places(self, at: Setting, constants: dict[str, Exact], time: Time) -> list[Array]:
        """The centre along each axis.

        On a periodic axis whole periods are subtracted in float64, before the cast to the model's
        precision, so that large positions lose no digits.
        """
        out: list[Array] = []
        with exact():
            for d, axis in enumerate(self.axes):
                place = (
                    wide(per_axis(self.center, self.axes)[d])
                    + wide(per_axis(self.velocity, self.axes)[d]) * time.wide
                )
                if "waypoints" in constants:
                    points = wide(constants["waypoints"])
                    place = place + jnp.interp(time.wide, points[:, 0], points[:, 1 + d])
                if axis.periodic:
                    place = axis.lower + jnp.mod(place - axis.lower, axis.range)
                out.append(place.astype(at.dtype))
        return out
