"""Published files and own ones give the same noise-free values as in dnf-composer, for every element and
step.

`syn-*.dnf` were written for these references; the other files are of the project dnf-composer.
"""

from __future__ import annotations

import json
import shutil

import numpy as np
import pytest

import deodar as dd
from deodar.importers.opening import read
from deodar.importers.tools import IMPORTERS
from deodar.model.check import problems
from deodar.model.paths import display
from tests.deodar_interop.importers.dnf_composer.files import HERE, SAMPLES, without_noise

LEARNING = {"learningRule", "learningRate", "decayRate"}
LOST = {
    "color-space-mapping": {"fc cg 1 - 2 0 0_weights.txt"},
    "syn-legacy": {"deltaT", "activationFunction"},
    "test": {"deltaT"},
}
"""What the files lack."""


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_every_part_of_a_sample_is_carried_but_learning_and_what_the_file_lacks(path):
    done = read(path)
    assert {line.what for line in done.report.losses} - LEARNING == LOST.get(path.stem, set())
    assert all(line.verdict == "dropped" for line in done.report.losses if line.what in LEARNING)
    assert problems(done.model.document) == []


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_every_listed_step_agrees(path, tmp_path):
    for weights in HERE.glob("*_weights.txt"):
        shutil.copyfile(weights, tmp_path / weights.name)
    quiet = tmp_path / path.name
    quiet.write_text(json.dumps(without_noise(json.loads(path.read_text()))))
    model = dd.load(quiet)
    with np.load(path.with_suffix(".npz")) as z:
        reference = {tuple(key.split("|")): z[key] for key in z}
    ports = {(name, port): f"{dd.quote(name)}.{port}" for name, port, _ in reference}
    dt, last = model.document.dt, max(int(step) for *_, step in reference)
    unstable = "color" in path.stem  # a two-cycle that multiplies rounding by 2,500 in 25 steps
    for precision, early, late in (("float64", 1e-9, 1e-7), ("float32", 1e-3, 1e-2))[: 1 if unstable else 2]:
        end = last if precision == "float64" else 50
        record = dd.simulate(model, end * dt, every=dt, record=list(ports.values()), precision=precision)
        for (name, port, step), expected in reference.items():
            if int(step) > end:
                continue
            near = early if int(step) <= 50 and not unstable else late
            values = record[display((name, port))].values[int(step)].reshape(-1)
            assert abs(values - expected).max() < near, (precision, name, port, step)


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_a_sample_is_recognised_and_by_one_importer(path):
    head = path.read_bytes()
    assert [name for name, tool in IMPORTERS.items() if tool.sniff(head)] == ["dnf-composer"]


def test_names_step_axes_and_notes_are_taken_from_the_file():
    model = dd.load(next(p for p in SAMPLES if p.stem == "and"))
    assert (model.name, model.document.dt, model.document.t0) == ("and", 25, 0)
    axis = model["nf 1"].element.axes[0]
    assert (axis.name, axis.samples, axis.step, axis.periodic) == ("x", 100, 1, True)
    assert "Imported from and.dnf (dnf-composer)" in model.document.notes
    assert dd.load(next(p for p in SAMPLES if p.stem == "test")).name == "test"


def test_the_written_document_gives_the_same_bits(tmp_path):
    model = dd.load(next(p for p in SAMPLES if p.stem == "syn-couplings"))
    dd.save(model, tmp_path / "a.json")
    loaded = dd.load(tmp_path / "a.json")
    assert loaded.document == model.document
    one, two = (dd.simulate(m, 20, every=20, seed=3) for m in (model, loaded))
    assert all(np.array_equal(one[name], two[name]) for name in one.data_vars)


def test_noise_has_the_strength_of_the_file(tmp_path):
    """White noise has the standard deviation amplitude / sqrt(dt); a kernel makes it smaller."""
    settings = {"label": [8, "normal noise"], "x_max": 400, "d_x": 1.0, "inputs": None, "amplitude": 0.6}
    smooth = {"label": [9, "correlated normal noise"], "width": 2.0, "circular": True}
    parts = [{"uniqueName": "n", **settings}, {"uniqueName": "c", **settings, **smooth}]
    (tmp_path / "n.dnf").write_text(json.dumps({"deltaT": 4.0, "elements": parts}))
    record = dd.simulate(dd.load(tmp_path / "n.dnf"), 400, every=4, record=["n.output", "c.output"], seed=1)
    taps = np.exp(-0.5 * (np.arange(-10, 11) / 2.0) ** 2)
    share = np.sqrt(np.sum((taps / taps.sum()) ** 2))
    for name, expected in (("n", 0.6 / 2), ("c", 0.6 / 2 * share)):
        assert abs(record[f"{name}.output"].values[1:].std() / expected - 1) < 0.05
