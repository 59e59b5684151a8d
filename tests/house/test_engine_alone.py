"""The engine runs without the libraries of the studio, the figures and the command line."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

LIBRARIES = ("starlette", "uvicorn", "websockets", "matplotlib", "PIL", "rich")

HOOK = """
import importlib.abc, sys

class Refusal(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in LIBRARIES:
            raise ImportError(f"{name} is refused here")

sys.meta_path.insert(0, Refusal())
"""

RUN = """
import json
import deodar as dd

model = dd.Model("alone")
x = dd.Axis("x", 0, 20, samples=21)
stimulus = model.add(dd.GaussianStimulus("stimulus", [x], center=10, amplitude=6))
u = model.add(dd.Field("u", [x], tau=10, kernel=[dd.Gaussian(1.0, 2.0)], global_inhibition=0.1, noise=0.1))
stimulus >> dd.Gain(1.2) >> u
assert model.check() == []

data = dd.simulate(model, 50, trials=2, record=["u.activation"], every=5, on=dd.Resources(progress=True))
session = dd.Session(model)
session.run(50)
assert session.read("u").shape == (21,)

dd.save(model, "model.json")
assert dd.load("model.json").document == model.document
for name in ("record.zarr", "record.nc"):
    dd.save_record(data, name)
    assert dd.open_record(name)["u.activation"].equals(data["u.activation"])

found = dd.regimes(model, "u")
plan = dd.TrialPlan(100, events=[dd.Appears("seen", "u")])
rows = dd.Experiment("alone", model, plan, trials=2).run("rows")
peaks = dd.peaks(session.read("u"), [x])
print(model, data, found, rows, peaks)
print(json.dumps({"outcomes": rows["outcome"].values.tolist(), "peaks": len(peaks)}))
"""


def process(code: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run code in a new process in which the libraries cannot be imported."""
    text = f"LIBRARIES = {LIBRARIES!r}\n{HOOK}\n{code}"
    environment = os.environ | {"MPLBACKEND": ""}
    return subprocess.run(
        [sys.executable, "-c", text], cwd=folder, env=environment, capture_output=True, text=True
    )


@pytest.mark.parametrize("library", LIBRARIES)
def test_a_refused_library_cannot_be_imported(library: str, tmp_path: Path) -> None:
    assert f"{library} is refused here" in process(f"import {library}", tmp_path).stderr


def test_a_model_is_run_recorded_measured_and_experimented_with(tmp_path: Path) -> None:
    done = process(RUN, tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1]) == {"outcomes": ["seen", "seen"], "peaks": 1}
