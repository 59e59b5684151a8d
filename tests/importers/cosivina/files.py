"""Files of cosivina, written for tests."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).parent
SAMPLES = sorted(HERE.glob("*.json"))


def element(label: str, kind: str, param: dict[str, Any], inputs: Any = None) -> dict[str, Any]:
    """One entry of the list; inputs as (label, component)."""
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
    """The file."""
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
    """The file, in a folder."""
    path = folder / name
    path.write_text(text(elements, dt, t0))
    return path
