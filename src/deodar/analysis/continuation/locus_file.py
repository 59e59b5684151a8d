"""A locus as a record: its line, and everything that made it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray

from deodar import codec
from deodar.analysis.continuation import line_file
from deodar.analysis.continuation.line import ParameterLine
from deodar.analysis.continuation.locus_plane import LocusPoint
from deodar.analysis.saved import opened
from deodar.codec import JsonObject
from deodar.recording.provenance import KEY

KIND = "locus"
"""Name of a locus in the provenance of its record."""


def dataset(line: ParameterLine | None, data: JsonObject) -> xarray.Dataset:
    """Return a locus as a Dataset: `first` and `second` over its points, and `frequency` of Hopf points.

    Args:
        line: the model along a parameter; None: unknown.
        data: the locus as plain data.
    """
    description = {key: value for key, value in data.items() if key not in ("values", "frequencies")}
    values = np.array(data["values"], float).reshape(-1, 2)
    names: Any = data["parameters"]
    variables: dict[str, Any] = {
        name: ("point", values[:, k], {"long_name": names[k]}) for k, name in enumerate(("first", "second"))
    }
    if frequencies := np.array(data["frequencies"], float).tolist():
        variables["frequency"] = ("point", frequencies, {"long_name": "angular frequency"})
    return xarray.Dataset(variables, attrs={KEY: codec.line({**line_file.made(line), KIND: description})})


def fields(path: str | Path) -> dict[str, Any]:
    """Return the fields of the locus in a file.

    Raises:
        RecordError: the file does not exist, is damaged, or is another record.
    """
    record, provenance = opened(path, KIND, "a locus")
    description = provenance[KIND]
    values = np.column_stack([record["first"].values, record["second"].values])
    points = tuple(LocusPoint(p["kind"], (p["values"][0], p["values"][1])) for p in description["points"])
    first, second = description["parameters"]
    return {
        "of": description["of"],
        "parameters": (first, second),
        "values": values,
        "points": points,
        "line": line_file.line_of(provenance),
        "frequencies": record["frequency"].values if "frequency" in record else np.zeros(0),
    }
