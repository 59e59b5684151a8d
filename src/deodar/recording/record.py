"""Convert recorded arrays to an `xarray.Dataset` with axes, units and provenance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np
import xarray

from deodar import codec
from deodar.codec import JsonObject
from deodar.errors import DamagedFile, first_line, show
from deodar.model.document import Document, Entry
from deodar.numerics.axes import Axes, Axis
from deodar.recording.probe import TIME, Series, is_time
from deodar.recording.provenance import KEY
from deodar.recording.shown_dataset import ShownDataset

STATED: Mapping[str, type | tuple[type, ...]] = {
    "document": dict,
    "arrays": str,
    "world": (dict, type(None)),
    "made_by": (dict, type(None)),
    "sweep": (dict, list, type(None)),
    "record": (list, type(None)),
}
"""Types of what the provenance of a record states, by name."""

Variable = tuple[Entry, str, Axes, np.ndarray]
"""Element, port, axes of the port, and the array: sweep points, trials, time, axes."""


def dataset(
    doc: Document,
    variables: Sequence[Variable],
    times: np.ndarray,
    trials: Sequence[int] | None,
    sweep: Mapping[str, Sequence[float]],
    about: Mapping[str, Any],
    beside: Mapping[str, Sequence[float]] | None = None,
) -> xarray.Dataset:
    """Return the record of a run.

    Variables are named by path. Dimensions are those of the sweep, `trial` (if trials were requested),
    `time`, and axes by name; an axis whose name belongs to another sampling, or that occurs twice, becomes
    `PATH.axis`, PATH being the path of the port.

    Args:
        doc: the document.
        variables: the recorded arrays.
        times: time of each sample.
        trials: number of each trial; None without this dimension.
        sweep: values along each dimension of the sweep; a range for the numbers of points of a list.
        about: the provenance.
        beside: for each path its value at each point of a list.
    """
    lead = [*sweep, *(["trial"] if trials is not None else []), "time"]
    coords: dict[str, Any] = {path: (path, _numbers(values)) for path, values in sweep.items()}
    coords |= {path: (list(sweep), np.asarray(values, float)) for path, values in (beside or {}).items()}
    if trials is not None:
        coords["trial"] = ("trial", np.asarray(trials, np.int64))
    coords["time"] = ("time", times, {"units": doc.time_unit})
    grid = [len(v) for v in sweep.values()]
    taken: dict[str, Axis | None] = dict.fromkeys(lead)
    out: dict[str, Any] = {}
    for entry, port, axes, array in variables:
        dims: list[str] = []
        for axis in axes:
            dim = axis.name
            if dim in dims or (dim in taken and taken[dim] != axis):
                dim = f"{entry.path}.{port}.{axis.name}"
            taken[dim] = axis
            dims.append(dim)
            coords[dim] = (dim, axis.points, _axis_attributes(axis))
        shaped = array.reshape(*grid, *array.shape[1:]) if sweep else array
        attributes: dict[str, Any] = {
            "long_name": f"{port} of {entry.path}",
            "kind": type(entry.element).__name__,
            "port": port,
        }
        threshold = getattr(getattr(entry.element, "sigmoid", None), "threshold", None)
        if port == "activation" and isinstance(threshold, float):
            attributes["threshold"] = threshold
        out[f"{entry.path}.{port}"] = ([*lead, *dims], shaped, attributes)
    return ShownDataset(out, coords, {KEY: codec.line(about), "title": doc.name})


def with_times(record: xarray.Dataset, series: Sequence[Series]) -> xarray.Dataset:
    """Return a record without samples whose variables have dimensions of time of their own.

    Args:
        record: the record; its dimension `time` has length 0.
        series: the series of the variables.
    """
    dimensions = {name: s.dimension for s in series for name in s.names}
    times, coords = record[TIME], {n: c for n, c in record.coords.items() if n != TIME}
    variables: dict[Any, Any] = {}
    for name, variable in record.data_vars.items():
        dims = [dimensions[str(name)] if d == TIME else d for d in variable.dims]
        variables[name] = (dims, variable.values, variable.attrs)
    for dimension in dimensions.values():
        coords[dimension] = (dimension, times.values, times.attrs)
    return ShownDataset(variables, coords, record.attrs)


def about(record: xarray.Dataset) -> JsonObject:
    """Return the provenance of a record, as plain data; empty for a Dataset of other origin.

    Raises:
        DamagedFile: it is not what a record states.
    """
    text = record.attrs.get(KEY)
    if not isinstance(text, str):
        return {}
    try:
        origin = codec.parse(text)
    except ValueError as error:
        raise DamagedFile(f"is damaged: what made it is not JSON ({first_line(error)})") from None
    if not isinstance(origin, dict):
        raise DamagedFile(f"is damaged: what made it is {show(origin)}, not an object")
    stated = cast("JsonObject", origin)
    for name, kinds in STATED.items():
        if name in stated and not isinstance(stated[name], kinds):
            raise DamagedFile(f"is damaged: it states {show(stated[name])} as its {name}")
    return stated


def time_dimension(variable: xarray.DataArray) -> str | None:
    """Return the name of the time dimension of a recorded variable; None if it has none.

    It is `time`, or `PATH.PORT.time` for a port with a sampling interval or a condition of its own.
    """
    # the times of the samples stand before the axes, of which one may have this name, too
    return next((str(d) for d in variable.dims if is_time(str(d))), None)


def _numbers(values: Sequence[float]) -> np.ndarray:
    """Return the values of a sweep as real numbers, the numbers of its points as whole ones."""
    return np.asarray(values, np.int64 if isinstance(values, range) else float)


def _axis_attributes(axis: Axis) -> dict[str, Any]:
    out: dict[str, Any] = {"units": axis.unit} if axis.unit else {}
    return out | {"periodic": int(axis.periodic), "lower": axis.lower, "upper": axis.upper}
