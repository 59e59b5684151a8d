"""Files of cosivina, written for tests."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).parent
SAMPLES = sorted(HERE.glob("*.json"))


def element(label: str, kind: str, param: dict[str, Any], inputs: Any = None) -> dict[str, Any]:
    """Return one entry of the list of elements; inputs are (label, component)."""
    given = inputs
    if isinstance(inputs, list):
        given = [{"label": a, "component": b} for a, b in inputs]
        given = given[0] if len(given) == 1 else given or None
    return {
        "label": label,
        "class": kind,
        "param": param,
        "nInputs": 0 if inputs is None else len(inputs),
        "input": given,
    }


def text(elements: list[dict[str, Any]], dt: float = 1, t0: float = 0) -> str:
    """Return the text of a file."""
    labels = [e["label"] for e in elements]
    body = {
        "deltaT": dt,
        "tZero": t0,
        "nElements": len(elements),
        "elementLabels": labels,
        "elements": elements,
    }
    return json.dumps({"simulator": body}, default=lambda v: np.asarray(v).tolist())


def written(
    folder: Path, elements: list[dict[str, Any]], dt: float = 1, t0: float = 0, name: str = "simulator.json"
) -> Path:
    """Write the file into a folder."""
    path = folder / name
    path.write_text(text(elements, dt, t0))
    return path
