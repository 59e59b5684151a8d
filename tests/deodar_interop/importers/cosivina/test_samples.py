"""Published files give the same noise-free activations as in cosivina, for every field and step."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.importers.opening import read
from deodar.model.check import problems
from tests.deodar_interop.importers.cosivina.files import SAMPLES

REFERENCES = [p for p in SAMPLES if p.with_suffix(".npz").exists()]


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_every_part_of_a_sample_is_carried(path):
    done = read(path)
    assert done.report.faithful and done.report.lines, done.report.losses
    assert problems(done.model.document) == []


@pytest.mark.parametrize("path", [p for p in SAMPLES if p not in REFERENCES], ids=lambda p: p.stem)
def test_samples_without_stored_steps_run(path):
    record = dd.simulate(dd.load(path), 3, every=3)
    assert all(np.isfinite(values).all() for values in record.values())


@pytest.mark.parametrize("path", REFERENCES, ids=lambda p: p.stem)
def test_every_listed_step_agrees(path):
    with np.load(path.with_suffix(".npz")) as z:
        reference = {tuple(key.split("|")): z[key] for key in z}
    model, ports = dd.load(path), sorted({f"{dd.quote(label)}.activation" for label, _ in reference})
    for precision, near in (("float64", 1e-6), ("float32", 1e-3)):
        early, late = (
            dd.simulate(model, to, record=ports, every=every, precision=precision)
            for to, every in ((5, 1), (300, 20))
        )
        for (label, step), expected in reference.items():
            values = (early if int(step) <= 5 else late)[f"{label}.activation"].sel(time=float(step)).values
            assert abs(values.reshape(expected.shape) - expected).max() < near, (precision, label, step)


def test_axes_names_step_and_notes_are_taken_from_the_file():
    model = dd.load(next(p for p in SAMPLES if "Coupling" in p.stem))
    assert model.document.dt == 1 and model.document.t0 == 0
    assert [a.name for a in model['"field v"'].element.axes] == ["y", "x"]
    assert [a.name for a in model["field s"].element.axes] == ["x"]
    assert model["field s"].element.axes[0].points[0] == 1
    assert "Imported from presetCouplingFFT.json (cosivina)" in model.document.notes
    assert dd.Session(model).dt == 1


@pytest.mark.parametrize("path", REFERENCES[:2], ids=lambda p: p.stem)
def test_the_written_document_gives_the_same_bits(path, tmp_path):
    model = dd.load(path)
    dd.save(model, tmp_path / "a.json")
    loaded = dd.load(tmp_path / "a.json")
    assert loaded.document == model.document
    one, two = (dd.simulate(m, 20, every=20, seed=3) for m in (model, loaded))
    assert all(np.array_equal(one[name], two[name]) for name in one.data_vars)
