"""Exported files, read by the plain simulator."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

import deodar as dd
from deodar_interop.exporters.cosivina import write
from tests.deodar_interop.importers.cosivina.oracle import Sim


def elements(content: bytes) -> list[tuple[str, str, dict[str, Any], list[tuple[str, str]]]]:
    """Return the elements of a file as the plain simulator takes them."""
    out = []
    for e in json.loads(content)["simulator"]["elements"]:
        inputs = e["input"] if isinstance(e["input"], list) else [e["input"]] if e["input"] else []
        assert e["nInputs"] == len(inputs)
        param = dict(e["param"])
        if "onTimes" in param:
            param["onTimes"] = [
                [float(str(v).replace("_Inf_", "inf")) for v in row] for row in param["onTimes"]
            ]
        out.append((e["label"], e["class"], param, [(i["label"], i["component"]) for i in inputs]))
    return out


def largest_difference(
    model: dd.Model, fields: list[str], steps: int, component: str = "activation"
) -> float:
    """Return the largest difference between deodar's trajectory and that of the exported file."""
    content = write(model, "file.json").content
    body = json.loads(content)["simulator"]
    plain = Sim(elements(content), body["deltaT"], body["tZero"])
    record = dd.simulate(
        model,
        steps * body["deltaT"],
        record=[f"{dd.quote(f)}.{component}" for f in fields],
        precision="float64",
    )
    far, moved = 0.0, 0.0
    for step in range(1, steps + 1):
        plain.step()
        for f in fields:
            expected = plain.out[f][component]
            values = record[f"{f}.{component}"].isel(time=step).values
            far = max(far, float(abs(values.reshape(expected.shape) - expected).max()))
            moved = max(moved, float(np.ptp(expected)))
    assert moved > 0.1  # something happens
    return far
