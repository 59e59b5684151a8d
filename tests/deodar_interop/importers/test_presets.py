"""The values of a second file, applied to an open model."""

from __future__ import annotations

import json

import pytest

import deodar as dd
from deodar.errors import DocumentError
from deodar.importers.presets import applied, apply_preset
from tests.deodar_interop.importers.cosivina.files import SAMPLES, element, written

FIELD = {"size": [1, 10], "tau": 10, "h": -5, "beta": 4}
KERNEL = {"size": [1, 10], "sigma": 2, "amplitude": 1, "circular": 1, "normalized": 1, "cutoffFactor": 5}


def parts(**changes):
    field = {**FIELD, **changes}
    return [
        element("u", "NeuralField", field, [("k", "output")]),
        element("k", "GaussKernel1D", KERNEL, [("u", "output")]),
    ]


def test_values_of_a_preset_are_copied_and_connections_kept(tmp_path):
    model = dd.load(written(tmp_path, parts()))
    before = model.document
    other = parts(tau=20, beta=2)
    other[1]["param"] = {**KERNEL, "sigma": 3, "amplitude": 0.5}
    other[1]["input"] = None
    report = apply_preset(model, written(tmp_path, other, name="b.json"))
    assert {(line.where, line.what) for line in report.lines if line.verdict == "carried"} == {
        ("u", "tau"), ("u", "sigmoid.beta"), ("k", "kernel.0.sigma"), ("k", "kernel.0.amplitude"),
    }  # fmt: skip
    assert model.get("u.tau") == 20 and model.get("k.kernel.0.sigma") == 3
    assert model.document.connections == before.connections
    assert model.undo() and model.document == before


def test_values_without_a_match_are_listed(tmp_path):
    model = dd.load(
        written(
            tmp_path,
            [*parts(), element("s", "ScaleInput", {"size": [1, 10], "amplitude": 1}, [("u", "output")])],
        )
    )
    other = parts(tau=20)
    other[0]["param"]["size"] = [1, 12]
    other[1] = element("k", "ScaleInput", {"size": [1, 12], "amplitude": 3}, [("u", "output")])
    before = model.document
    report = apply_preset(
        model, written(tmp_path, [*other, element("new", "BoostStimulus", {"amplitude": 1})], name="b.json")
    )
    assert {line.where: line.why.split()[0] for line in report.lines} == {
        "u": "lies",
        "k": "is",
        "s": "the",
        "new": "the",
    }
    assert all(line.verdict == "dropped" for line in report.lines) and model.document == before


def test_linked_values_are_not_changed(tmp_path):
    model = dd.load(written(tmp_path, parts()))
    model.parameter("slow", 50.0)
    model.link("u.tau", "slow")
    report = apply_preset(model, written(tmp_path, parts(tau=20, h=-4), name="b.json"))
    assert [(line.what, line.verdict) for line in report.lines] == [
        ("tau", "dropped"),
        ("resting_level", "carried"),
    ]
    assert model.get("u.tau") == 50


def test_documents_of_deodar_are_presets_too(tmp_path):
    model = dd.load(written(tmp_path, parts()))
    loaded = dd.load(written(tmp_path, parts(h=-3), name="b.json"))
    dd.save(loaded, tmp_path / "own.json")
    assert apply_preset(model, tmp_path / "own.json").tool == "deodar" and model.get("u.resting_level") == -3


def test_a_broken_file_changes_nothing(tmp_path):
    model = dd.load(written(tmp_path, parts()))
    before = model.document
    (tmp_path / "broken.json").write_text('{"simulator": {')
    with pytest.raises(DocumentError):
        apply_preset(model, tmp_path / "broken.json")
    assert model.document is before


def test_the_same_file_changes_nothing():
    for path in SAMPLES[:3]:
        model = dd.load(path)
        assert apply_preset(model, path).lines == []
        assert json.loads(model.to_json())


X = dd.Axis("x", 0, 10, samples=11)


def one_field(**kernel):
    model = dd.Model("m")
    model.add(dd.Field("u", [X], kernel=[dd.Gaussian(sigma=2, **kernel)]))
    return model


@pytest.mark.parametrize(
    ("here", "there", "message"),
    [
        (None, "reflect", True),
        ("zero", "periodic", True),
        (None, "zero", False),  # equal effects are not listed
        ("zero", ["zero"], False),
    ],
)
def test_values_outside_the_range_are_unchanged_and_differences_are_listed(here, there, message):
    model = one_field(amplitude=1.0, boundary=here)
    doc, lines = applied(model.document, one_field(amplitude=2.0, boundary=there).document)
    (u,) = doc.entries
    (kernel,) = u.element.kernel
    assert kernel.amplitude == 2.0 and kernel.boundary == model["u"].element.kernel[0].boundary
    expected = [("kernel.0.boundary", "dropped")] if message else []
    assert sorted((line.what, line.verdict) for line in lines) == [
        ("kernel.0.amplitude", "carried"),
        *expected,
    ]
