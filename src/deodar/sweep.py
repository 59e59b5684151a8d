"""A sweep, as a script gives it."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence
from typing import Any

from deodar.errors import ParameterError, show

POINT = "point"
"""The dimension of a list of points."""

EXAMPLE = "For example sweep=[{'u.tau': 10, 'u.resting_level': -5}, {'u.tau': 20, 'u.resting_level': -3}]"


@dc.dataclass(frozen=True)
class Points:
    """A list of points of a sweep, which have one dimension, `point`; a list alone is `Points(list)`.

    Attributes:
        values: for each point its values by parameter path; all points have the same paths.
        own_noise: whether each point has noise of its own; point 0 then has that of a run without a sweep.
            False: all points share the noise.
    """

    values: Sequence[Mapping[str, float]]
    own_noise: bool = False

    def __post_init__(self) -> None:
        """Check that the points are mappings with the same paths."""
        points: Any = self.values
        if isinstance(points, Mapping):
            raise ParameterError(
                "dd.Points is a list of points, and this is a grid, whose points share the noise", fix=EXAMPLE
            )
        if isinstance(points, (str, bytes)) or not isinstance(points, Sequence) or not points:
            raise ParameterError(
                f"a sweep gives values for each parameter path, or a list of points, not {show(points)}",
                fix=EXAMPLE,
            )
        found: list[Any] = list(points)
        for number, point in enumerate(found):
            where = f"point {number} of the sweep"
            if not isinstance(point, Mapping) or not point:
                raise ParameterError(
                    f"gives a value for each parameter path, not {show(point)}", where=where, fix=EXAMPLE
                )
            if set(point) != set(found[0]):
                own, first = (", ".join(map(str, paths)) for paths in (point, found[0]))
                raise ParameterError(
                    f"has the paths {own}; point 0 has {first}",
                    where=where,
                    fix="All points have the same paths",
                )
        if POINT in found[0]:
            raise ParameterError(
                f"is also the name of the dimension of the points, {POINT!r}",
                where=f"sweep of {POINT}",
                fix="Sweep a grid, or rename the document parameter",
            )

    def by_path(self) -> dict[str, list[float]]:
        """Return for each path its values at the points."""
        return {path: [point[path] for point in self.values] for path in self.values[0]}


Sweep = Mapping[str, Sequence[float]] | Sequence[Mapping[str, float]] | Points
"""For each parameter path its values, which form a grid; or a list of points, each with a value by path."""


def checked(sweep: Sweep | None) -> Mapping[str, Sequence[float]] | Points:
    """Return a sweep as a grid, which is empty without a sweep, or as points."""
    return {} if sweep is None else sweep if isinstance(sweep, (Mapping, Points)) else Points(sweep)
