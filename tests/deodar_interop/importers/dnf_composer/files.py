"""Files of dnf-composer, written for tests."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from deodar.importers._beside import in_folder
from deodar.importers.imported import Imported
from deodar_interop.importers import dnf_composer

HERE = Path(__file__).parent
SAMPLES = sorted(HERE.glob("*.dnf"))

FIELD = {
    "tau": 10.0,
    "restingLevel": -2.0,
    "activationFunction": {"type": "sigmoid", "x_shift": 0.0, "steepness": 4.0},
}
BELL = {"amplitude": 6.0, "width": 2.0, "position": 5.0, "circular": True, "normalized": False}
KERNEL = {"amplitude": 3.0, "width": 1.5, "amplitudeGlobal": -0.05, "circular": True, "normalized": True}


def element(
    name: str,
    label: str,
    values: dict[str, Any],
    inputs: Any = None,
    x: Any = 20,
    d: float = 1.0,
    **options: Any,
) -> dict[str, Any]:
    """Return one entry of the list of elements; inputs are names, or pairs of name and component."""
    pairs = [[s, "output"] if isinstance(s, str) else list(s) for s in inputs] if inputs else inputs
    settings = {"uniqueName": name, "label": [1, label], "x_max": x, "d_x": d, "inputs": pairs}
    return {**settings, **values, **options}


def plane(
    name: str,
    label: str,
    values: dict[str, Any],
    inputs: Any = None,
    size: tuple[int, int] = (6, 8),
    d: float = 1.0,
) -> dict[str, Any]:
    """Return one entry over a plane of (rows, columns) samples."""
    return element(name, label, values, inputs, size[1] * d, d, y_max=size[0] * d, d_y=d)


def text(elements: list[dict[str, Any]], dt: float = 1.0, name: str = "made") -> str:
    """Return the text of a file."""
    return json.dumps({"identifier": name, "deltaT": dt, "elements": elements})


def written(folder: Path, elements: list[dict[str, Any]], dt: float = 1.0, name: str = "made.dnf") -> Path:
    """Write the file into a folder."""
    path = folder / name
    path.write_text(text(elements, dt))
    return path


def imported(path: Path) -> Imported:
    """Convert a file in this process, whose limits a test may change."""
    return dnf_composer.read(path.read_bytes(), path.name, beside=in_folder(path.parent))


def without_noise(data: Any) -> Any:
    """Return the content of a file with all noise at 0, as its reference was computed."""
    for e in data["elements"] if isinstance(data, dict) else data:
        if "noise" in e["label"][1]:
            e["amplitude"] = 0.0
    return data
