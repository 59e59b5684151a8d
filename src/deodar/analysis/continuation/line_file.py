"""A model along a parameter, as records contain it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from deodar.analysis.continuation.line import ParameterLine
from deodar.analysis.continuation.right_hand_side import PRECISION, right_hand_side
from deodar.codec import JsonObject
from deodar.compiler import device as devices
from deodar.model.model import Model
from deodar.recording import provenance


def made(line: ParameterLine | None) -> JsonObject:
    """Return the provenance of a result: the document without noise, the line, and the versions."""
    made_by: JsonObject = {"made_by": provenance.made_by(devices.find(), PRECISION)}
    if line is None:
        return made_by
    equations = line.right_hand_side
    by = equations.doc.by_id()
    description: JsonObject = {
        "parameters": list(equations.parameters),
        "values": line.parameters.tolist(),
        "index": line.index,
        "length": line.length,
        "at": equations.at,
        "hold": sorted(by[ident].path for ident in equations.held),
        "even": list(equations.even),
    }
    return {**provenance.stored(equations.doc), "line": description, **made_by}


def line_of(about: Mapping[str, Any]) -> ParameterLine | None:
    """Return the line of a provenance; None if it has none."""
    description = about.get("line")
    if description is None:
        return None
    model = Model(document=provenance.document(about))
    equations = right_hand_side(
        model, description["parameters"], description["at"], description["hold"], description["even"]
    )
    return ParameterLine(
        equations, description["index"], np.array(description["values"], float), description["length"]
    )
