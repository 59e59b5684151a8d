"""A branch of steady states as a record: its states and modes by path, and everything that made them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from deodar import codec
from deodar.analysis.continuation import line_file
from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.line import ParameterLine
from deodar.analysis.continuation.right_hand_side import RightHandSide
from deodar.analysis.saved import opened
from deodar.codec import JsonObject
from deodar.numerics.axes import Axis
from deodar.recording.provenance import KEY

KIND = "steady_branch"
"""Name of a branch in the provenance of its record."""

STATE, BIFURCATION = "state", "bifurcation"
"""Dimensions: steady states, and bifurcations."""

NUMBERS = ("value", "rate", "frequency", "index", "step_value", "fine_value", "by_grid")


def dataset(
    line: ParameterLine,
    numbers: Mapping[str, np.ndarray],
    states: np.ndarray,
    bifurcations: Sequence[Bifurcation],
    description: Mapping[str, Any],
) -> xarray.Dataset:
    """Return a branch as a Dataset.

    The arrays of states are variables by path, such as `u.activation`; those at bifurcations and the modes
    there are `bifurcation:u.activation` and `mode:u.activation`.

    Args:
        line: the model along its parameter.
        numbers: `value`, `rate` and `growing` of each state.
        states: the states, one row each.
        bifurcations: the bifurcations.
        description: what else the branch states, as plain data: `parameter`, `ended`, `not_refined`.
    """
    equations = line.right_hand_side
    taken: dict[str, Axis | None] = {STATE: None, BIFURCATION: None}
    variables: dict[str, Any] = {
        "rate": (STATE, numbers["rate"], {"long_name": "largest growth rate"}),
        "growing": (STATE, numbers["growing"].astype(np.int64), {"long_name": "growing modes"}),
    }
    dims = {f"{p.path}.{p.name}": _dims(p.path, p.name, p.shape, p.axes, taken) for p in equations.parts}
    for prefix, lead, rows in (
        ("", STATE, states),
        ("bifurcation:", BIFURCATION, [b.state for b in bifurcations]),
        ("mode:", BIFURCATION, [b.vector for b in bifurcations]),
    ):
        for path, arrays in _by_path(equations, rows).items():
            variables[prefix + path] = ((lead, *dims[path]), arrays)
    coordinates: dict[str, Any] = {
        dim: (dim, axis.points, {"units": axis.unit} if axis.unit else {})
        for dim, axis in taken.items()
        if axis is not None
    }
    coordinates["value"] = (STATE, numbers["value"], {"long_name": description["parameter"]})
    coordinates[BIFURCATION] = (
        BIFURCATION,
        [b.value for b in bifurcations],
        {"long_name": description["parameter"]},
    )
    description_of_branch: JsonObject = {**description, "bifurcations": [_scalars(b) for b in bifurcations]}
    attributes = {
        KEY: codec.line({**line_file.made(line), KIND: description_of_branch}),
        "title": equations.doc.name,
    }
    return xarray.Dataset(variables, coordinates, attributes)


def fields(path: str | Path) -> dict[str, Any]:
    """Return the fields of the branch in a file.

    Raises:
        RecordError: the file does not exist, is damaged, or is another record.
    """
    record, provenance = opened(path, KIND, "a branch of steady states")
    line, description = line_file.line_of(provenance), provenance[KIND]
    assert line is not None
    equations = line.right_hand_side
    states, places, modes = (_rows(equations, record, prefix) for prefix in ("", "bifurcation:", "mode:"))
    bifurcations = [
        Bifurcation(state=x, vector=v, line=line, **b)
        for b, x, v in zip(description["bifurcations"], places, modes, strict=True)
    ]
    return {
        "parameter": description["parameter"],
        "values": record["value"].values,
        "states": states,
        "rates": record["rate"].values,
        "growing": record["growing"].values,
        "bifurcations": tuple(bifurcations),
        "ended": (description["ended"][0], description["ended"][1]),
        "line": line,
        "not_refined": description["not_refined"],
    }


def _dims(
    path: str, name: str, shape: Sequence[int], axes: Sequence[Axis], taken: dict[str, Axis | None]
) -> tuple[str, ...]:
    """Return the dimensions of an array, named by axes; others that have a name already are named by path."""
    out: list[str] = []
    for d, axis in enumerate(axes or [None] * len(shape)):
        dim = f"{path}.{name}.{d}" if axis is None else axis.name
        if dim in out or (dim in taken and taken[dim] != axis):
            dim = f"{path}.{name}.{dim}"
        taken[dim] = axis
        out.append(dim)
    return tuple(out)


def _by_path(equations: RightHandSide, rows: Sequence[np.ndarray] | np.ndarray) -> Mapping[str, np.ndarray]:
    """Return states by path, states first."""
    states = [equations.state(x) for x in rows]
    return {
        f"{p.path}.{p.name}": np.array([s[f"{p.path}.{p.name}"] for s in states]).reshape(-1, *p.shape)
        for p in equations.parts
    }


def _rows(equations: RightHandSide, record: xarray.Dataset, prefix: str) -> np.ndarray:
    """Return states by path as rows."""
    arrays = {(path := f"{p.path}.{p.name}"): record[prefix + path].values for p in equations.parts}
    number = len(record["value"] if not prefix else record[BIFURCATION])
    return np.array([equations.vector({k: a[n] for k, a in arrays.items()}) for n in range(number)]).reshape(
        number, equations.size
    )


def _scalars(b: Bifurcation) -> JsonObject:
    return {
        "kind": b.kind,
        "instability": b.instability,
        "where": b.where,
        **{name: getattr(b, name) for name in NUMBERS},
    }
