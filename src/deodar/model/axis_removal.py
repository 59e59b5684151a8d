"""Removal of an axis from the parts of an element, with the values that they state for it alone."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from typing import Any, cast

from deodar.errors import ParameterError
from deodar.numerics.axes import Axis
from deodar.parameters import Parameter, parameters

AXIS_NAMES = ("along", "rename")
"""Names of the parameters that hold names of axes of an input."""


@dc.dataclass(frozen=True)
class AxisRemoval:
    """The removal of an axis.

    Attributes:
        axis: the axis.
        name: the name that parameters lose with it; empty: another axis has it too.
    """

    axis: Axis
    name: str

    def without(self, part: Any, where: str, outer: Sequence[Axis] = ()) -> Any:
        """Return a part without the axis, and without its values for it alone; the same object if it has
        neither.

        Args:
            part: the part.
            where: its path.
            outer: axes of what the part belongs to, which it describes if it has no axes itself.

        Raises:
            ParameterError: the part needs the axis.
        """
        axes: Sequence[Axis] = getattr(part, "axes", outer)
        moved: dict[str, Any] = {}
        for p in parameters(type(part)):
            setting: Any = getattr(part, p.name)
            if setting is not None:
                after = self._setting(p, setting, axes, f"{where}.{p.name}")
                moved |= {} if after is setting or after == setting else {p.name: after}
        try:
            return dc.replace(part, **moved) if moved else part
        except ParameterError as error:
            problem = error.problems[0]
            parameter = problem.where.partition(".")[2]
            place = f"{where}.{parameter}" if parameter else where
            raise ParameterError(problem.what, where=place, fix=problem.fix) from None

    def _setting(self, p: Parameter, setting: Any, axes: Sequence[Axis], where: str) -> Any:
        match p.form:
            case "axes":
                return tuple(a for a in setting if a != self.axis)
            case "axis" if setting == self.axis:
                fix = "Choose another axis there, or remove the element"
                raise ParameterError(f"needs the axis {self.axis.name}", where=where, fix=fix)
            case "part":
                return self.without(setting, where, axes)
            case "parts":
                return tuple(self.without(v, f"{where}.{i}", axes) for i, v in enumerate(setting))
            case "texts" | "pairs" if p.name in AXIS_NAMES:
                return tuple(v for v in setting if self.name not in (v if p.form == "pairs" else (v,)))
            case _ if _is_per_axis(p, setting, axes):
                return tuple(v for v, a in zip(setting, axes, strict=True) if a != self.axis)
            case _:
                return setting

    def leaf(self, part: Any, path: Sequence[str], outer: Sequence[Axis] = ()) -> list[str] | None:
        """Return the path of a number of a part after the removal; None: it is one for the axis alone."""
        axes: Sequence[Axis] = getattr(part, "axes", outer)
        p = next((p for p in parameters(type(part)) if p.name == path[0]), None)
        if p is None or len(path) == 1:
            return list(path)
        setting: Any = getattr(part, p.name)
        if p.form in ("part", "parts"):
            depth = 1 if p.form == "part" else 2
            inner = setting if p.form == "part" else setting[int(path[1])]
            after = self.leaf(inner, path[depth:], axes)
            return None if after is None else [*path[:depth], *after]
        if not _is_per_axis(p, setting, axes):
            return list(path)
        place = int(path[1])
        before = sum(a == self.axis for a in axes[:place])
        return None if axes[place] == self.axis else [p.name, str(place - before)]


def _is_per_axis(p: Parameter, setting: Any, axes: Sequence[Axis]) -> bool:
    """Return whether a setting has one entry for each axis: a number, or a word such as `zero`."""
    words = p.form == "texts" and p.name not in AXIS_NAMES
    listed = isinstance(setting, tuple) and len(cast("tuple[Any, ...]", setting)) == len(axes)
    return listed and (p.form == "per_axis" or words)
