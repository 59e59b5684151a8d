"""The selected part of a variable: trial, point of a sweep, times, positions, axes, ranges and labels."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray

from deodar.errors import Fix, RecordError, did_you_mean, option
from deodar.recording.record import time_dimension

if TYPE_CHECKING:
    from deodar.worlds._base import World

TIME, TRIAL = "time", "trial"
REDUCTIONS = ("maximum", "integral")
NEAR = 1e-9


def other_kind(name: str) -> Fix:
    """Return the advice to draw another kind of figure."""
    return Fix(f"Draw it with dd.{name}", f"Type: --kind {name}")


@dc.dataclass(frozen=True)
class View:
    """A variable and the part of it that a figure shows.

    Args:
        variable: a variable of a record; its dimensions are sweep paths, trial, time and axes.
        at: times, in the record's unit; the nearest recorded times are used. None: the default of the kind.
        trial: number of the trial. None: all trials in figures with lines, else the first.
        where: for each sweep path the selected value. None: all values in figures with lines, else the
            first.
        axes: names of the axes to keep in a projection.
        places: for time courses of fields: positions, one number for each axis. None: the position of the
            largest value.
        reduce: contraction over the other axes in a projection: maximum or integral.
        time_range: first and last time to show, in the record's unit. None: all of them.
        every: time between two shown samples, in the record's unit; of a long record only these are read, so
            that events between them are not seen. None: all samples.
        value_range: smallest and largest value of the scale. None: those of the shown values.
        colors: name of a colour map of matplotlib, for maps. None: the map that suits the values.
        labels: labels in place of the default ones, with their units: by name of an axis, `time` for time,
            `value` for the values.
        world: the world of the record, whose walls are drawn under a path.

    A variable that is read from a file when its values are needed stays there; only the selected part is
    read.
    """

    variable: xarray.DataArray
    at: Sequence[float] | None = None
    trial: int | None = None
    where: Mapping[str, float] | None = None
    axes: Sequence[str] | None = None
    places: Sequence[Sequence[float] | float] | None = None
    reduce: str = "maximum"
    time_range: Sequence[float] | None = None
    every: float | None = None
    value_range: Sequence[float] | None = None
    colors: str | None = None
    labels: Mapping[str, str] | None = None
    world: World | None = None

    def __post_init__(self) -> None:
        v = self.variable
        if not isinstance(v, xarray.DataArray):
            raise RecordError(
                f"a variable of a record is drawn, not {type(v).__name__}",
                fix="For example dd.space_time(data['u.activation'])",
            )
        if v.dtype.kind not in "biuf":
            raise RecordError(f"holds {v.dtype}, which cannot be drawn", where=self.name)
        if not v.size:
            raise RecordError("holds nothing: the run was stopped before its first record", where=self.name)
        self._require_names()
        for what, limits in (("time_range", self.time_range), ("value_range", self.value_range)):
            if limits is not None and not (len(limits) == 2 and limits[0] < limits[1]):
                raise RecordError(
                    f"{what} is [{', '.join(f'{n:g}' for n in limits)}]; a smaller and a larger number",
                    where=self.name,
                )
        self._cut()
        for t in self.at or ():
            if not self.times[0] - self.margin <= t <= self.times[-1] + self.margin:
                raise RecordError(
                    f"was not recorded at {t:g}",
                    where=self.name,
                    fix=f"Recorded are times from {self.times[0]:g} to {self.times[-1]:g}",
                )

    def _require_names(self) -> None:
        """Raise RecordError if a sweep, trial, axis or reduction is none of the variable."""
        for path in self.where or {}:
            if path not in self.sweeps:
                raise RecordError(
                    f"was not swept over {path!r}", where=self.name, fix=did_you_mean(path, self.sweeps)
                )
        if self.trial is not None:
            v = self.variable
            numbers = v[TRIAL].values.tolist() if TRIAL in v.dims else [0]
            if self.trial not in numbers:
                shown = f"{numbers[0]} to {numbers[-1]}" if len(numbers) > 1 else f"{numbers[0]} only"
                raise RecordError(f"has no trial {self.trial}", where=self.name, fix=f"Valid trials: {shown}")
        for axis in self.axes or ():
            if axis not in self.space:
                raise RecordError(
                    f"has no axis {axis!r}", where=self.name, fix=did_you_mean(axis, self.space)
                )
        if self.reduce not in REDUCTIONS:
            raise RecordError(
                f"there is no reduction {self.reduce!r}", fix=did_you_mean(self.reduce, REDUCTIONS)
            )

    def _cut(self) -> None:
        """Leave out the times outside `time_range`, and those between the shown samples."""
        if self.every is not None and not self.every > 0:
            raise RecordError(
                f"the time between two samples is {self.every:g}; it is above 0", where=self.name
            )
        times = self.times
        step = 1
        if self.every is not None and len(times) > 1:
            step = max(1, round(self.every * (len(times) - 1) / float(times[-1] - times[0])))
        if self.time_range is None and step == 1:
            return
        low, high = self.time_range or (times[0], times[-1])
        first, last = np.searchsorted(times, low - NEAR), np.searchsorted(times, high + NEAR, side="right")
        if first == last:
            raise RecordError(
                f"was not recorded between {low:g} and {high:g}",
                where=self.name,
                fix=f"Recorded are times from {times[0]:g} to {times[-1]:g}",
            )
        if self.time in self.variable.dims:
            part = self.variable.isel({self.time: slice(int(first), int(last), step)})
            object.__setattr__(self, "variable", part)

    # ------------------------------------------------------------------------------------------- the variable

    @property
    def name(self) -> str:
        """The variable's path."""
        return str(self.variable.name or "variable")

    @property
    def time(self) -> str:
        """The dimension of time: `time`, or `PATH.PORT.time` for a port with its own sampling interval."""
        return time_dimension(self.variable) or TIME

    @property
    def space(self) -> list[str]:
        """Dimensions that are axes of the field: those with bounds, and those without a coordinate."""
        v, others = self.variable, (self.time, TRIAL)
        return [str(d) for d in v.dims if d not in others and (d not in v.coords or "lower" in v[d].attrs)]

    @property
    def sweeps(self) -> list[str]:
        """Dimensions that are paths of a sweep."""
        return [str(d) for d in self.variable.dims if d not in (self.time, TRIAL) and d not in self.space]

    @property
    def times(self) -> np.ndarray:
        """Recorded times."""
        v, time = self.variable, self.time
        if time in v.coords and not set(v[time].dims) <= {time}:
            raise RecordError(f"has times along {', '.join(map(str, v[time].dims))}", where=self.name)
        return np.atleast_1d(self.points(time)) if time in (*v.coords, *v.dims) else np.zeros(1)

    @property
    def margin(self) -> float:
        """Half the interval between records: the tolerance with which a time selects a record."""
        t = self.times
        return 0.5 * float(np.diff(t).min()) if len(t) > 1 else NEAR * max(1.0, abs(float(t[0])))

    @property
    def threshold(self) -> float | None:
        """The activation at which the output is half of its maximum, if the variable is an activation."""
        value = self.variable.attrs.get("threshold")
        return float(value) if value is not None else None

    @property
    def trials(self) -> int:
        """The number of selected trials."""
        return self.variable.sizes.get(TRIAL, 1) if self.trial is None else 1

    # ------------------------------------------------------------------------------------------ the selection

    def chosen(self) -> xarray.DataArray:
        """The variable at the selected trial and sweep values; other dimensions are kept."""
        v = self.variable
        if self.trial is not None and TRIAL in v.dims:
            v = v.sel({TRIAL: self.trial})
        for path, value in (self.where or {}).items():
            known = v[path].values
            if not np.isclose(known, value, rtol=1e-6).any():
                raise RecordError(
                    f"was not run at {path} = {value:g}",
                    where=self.name,
                    fix=f"Valid values: {', '.join(f'{k:g}' for k in known[:12])}",
                )
            v = v.sel({path: value}, method="nearest")
        return v

    def one(self) -> xarray.DataArray:
        """The variable of one trial and one sweep point: time and axes, in that order."""
        v = self.chosen()
        v = v.isel({d: 0 for d in [*self.sweeps, TRIAL] if d in v.dims})
        v = v if self.time in v.dims else v.expand_dims(self.time)
        return v.transpose(self.time, *self.space)

    def note(self) -> str:
        """The trial and sweep point of `one`, in words; empty if the record has only one."""
        v, parts = self.chosen(), []
        for path in self.sweeps:
            if self.variable.sizes[path] > 1:
                value = v[path].values.reshape(-1)[0]
                parts.append(f"{path} = {value:g}")
        if self.variable.sizes.get(TRIAL, 1) > 1:
            parts.append(f"trial {int(v[TRIAL].values.reshape(-1)[0])}")
        return ", ".join(parts)

    def steps(self, default: Sequence[int]) -> list[int]:
        """Return the indices of the selected times, or of the default times."""
        if self.at is None:
            return [int(k) % len(self.times) for k in default]
        return [int(np.abs(self.times - t).argmin()) for t in self.at]

    def nearest(self, time: float) -> int:
        """Return the number of the record nearest to a time."""
        times = self.times
        k = int(np.clip(np.searchsorted(times, time), 1, max(1, len(times) - 1)))
        return min(k, len(times) - 1) if len(times) < 2 or time - times[k - 1] > times[k] - time else k - 1

    def instant(self) -> int:
        """Return the index of the selected time, by default the last."""
        if self.at is not None and len(self.at) != 1:
            raise RecordError(
                f"{len(self.at)} times were given, and one is drawn",
                where=self.name,
                fix=other_kind("snapshots"),
            )
        return self.steps([len(self.times) - 1])[0]

    # -------------------------------------------------------------------------------------------------- words

    def label(self) -> str:
        """Return the label of the variable for an axis or a colour bar."""
        if "value" in (self.labels or {}):
            return (self.labels or {})["value"]
        return _with_unit(
            str(self.variable.attrs.get("long_name") or self.name), self.variable.attrs.get("units")
        )

    def axis_label(self, dim: str) -> str:
        """Name and unit of a dimension."""
        short = self.short(dim)
        return (self.labels or {}).get(short) or _with_unit(short, self.unit(dim))

    def unit(self, dim: str) -> str:
        """Unit of a dimension; empty without one."""
        coords = self.variable.coords
        return str(coords[dim].attrs.get("units", "")) if dim in coords else ""

    def short(self, dim: str) -> str:
        """Name of a dimension, without the path of its variable."""
        for path in (self.name, self.name.rpartition(".")[0]):
            dim = dim.removeprefix(f"{path}.")
        return dim

    def time_label(self, time: float) -> str:
        """A time with its unit."""
        unit = _time_unit(self.unit(self.time))
        return f"{time:g} {unit}" if unit else f"t = {time:g}"

    def points(self, dim: str) -> np.ndarray:
        """Positions of the samples along an axis, or of another coordinate; without one their numbers."""
        v = self.variable
        if dim not in v.coords:
            return np.arange(v.sizes[dim], dtype=float)
        stored = v[dim].values
        if stored.dtype.kind not in "biuf" or not np.isfinite(stored).all():
            raise RecordError(f"has values of {dim} that are no finite numbers", where=self.name)
        return np.asarray(stored, float)

    def extent(self, dim: str) -> tuple[float, float]:
        """Outer edges of the first and the last cell."""
        p = self.points(dim)
        half = 0.5 * (p[1] - p[0]) if len(p) > 1 else 0.5
        return float(p[0] - half), float(p[-1] + half)


def values(part: xarray.DataArray) -> np.ndarray:
    """Return the values of a part of a variable, which may be read from a file here.

    Raises:
        RecordError: the file is damaged.
    """
    try:
        return np.asarray(part.values)
    except MemoryError:
        raise
    except Exception as error:  # libraries that read untrusted bytes may raise any exception
        text = " ".join(str(error).split())[:200]
        raise RecordError(
            f"cannot be read, its file may be damaged ({type(error).__name__}: {text})",
            where=str(part.name or ""),
            fix=option("Draw another part of it:", "time_range", "0 500", "(0, 500)"),
        ) from None


def _with_unit(name: str, unit: str | None) -> str:
    text = _time_unit(unit)
    return f"{name} ({text})" if text else name


def _time_unit(unit: str | None) -> str:
    text = str(unit or "")
    if text == "abstract":
        return ""
    return f"steps, {text}" if text.startswith("1 = ") else text
