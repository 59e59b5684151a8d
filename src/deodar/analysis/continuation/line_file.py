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
    own = line.right_hand_side
    by = own.doc.by_id()
    about: JsonObject = {
        "parameters": list(own.parameters),
        "values": line.parameters.tolist(),
        "index": line.index,
        "length": line.length,
        "at": own.at,
        "hold": sorted(by[ident].path for ident in own.held),
        "even": list(own.even),
    }
    return {**provenance.stored(own.doc), "line": about, **made_by}


def line_of(about: Mapping[str, Any]) -> ParameterLine | None:
    """Return the line of a provenance; None if it has none."""
    own = about.get("line")
    if own is None:
        return None
    model = Model(document=provenance.document(about))
    found = right_hand_side(model, own["parameters"], own["at"], own["hold"], own["even"])
    return ParameterLine(found, own["index"], np.array(own["values"], float), own["length"])
