"""Presets that a document keeps in its layout."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar.errors import DocumentError, UnknownName
from deodar.importers.presets import apply_preset
from deodar.model.kept_presets import KeptPreset, kept_preset, kept_presets, take_preset, with_presets


@pytest.fixture
def model():
    model = dd.Model("presets")
    x = dd.Axis("x", 0, 10, samples=20)
    field = model.add(dd.Field("u", [x], tau=20, resting_level=-5))
    model.add(dd.GaussianStimulus("s", [x], center=[4], sigma=1)) >> field
    model.parameter("strength", 2)
    model.link("s.amplitude", "strength")
    values = {field.id: {"tau": 40.0, "resting_level": -5.0}, "": {"strength": 7.0}}
    return dd.Model(document=with_presets(model.document, [KeptPreset("slow", "pace", values)]))


def test_a_preset_sets_values_of_elements_and_document_parameters(model):
    report = apply_preset(model, "slow")
    assert (model["u"].tau, model["s"].amplitude) == (40, 7)
    assert [str(line) for line in report.lines] == [
        "u: parameter tau: carried",
        "parameter strength: carried",
    ]
    assert apply_preset(model, "slow").lines == []
    assert model.undo() and model["u"].tau == 20


def test_presets_are_stored_with_the_document(model, tmp_path):
    dd.save(model, tmp_path / "m.json")
    loaded = dd.load(tmp_path / "m.json")
    assert kept_presets(loaded.document) == kept_presets(model.document)
    apply_preset(loaded, "slow")
    assert loaded["u"].tau == 40


def test_lists_are_values_of_parameters_with_one_number_for_each_axis(model):
    preset = KeptPreset("there", "", {model["s"].id: {"center": [6.0]}})
    doc, lines = take_preset(model.document, preset)
    assert doc.by_names()["s",].element.center == (6.0,) and lines == [("s", "center", "")]
    assert take_preset(doc, preset)[1] == []


def test_values_that_cannot_be_applied_are_listed(model):
    ident = model["u"].id
    values = {"ffffffff": {"tau": 3.0}, "": {"q": 1.0}, ident: {"a": 1.0, "tau": -3.0, "resting_level": -1.0}}
    doc, lines = take_preset(
        model.document, KeptPreset("odd", "", {**values, model["s"].id: {"amplitude": 1.0}})
    )
    lost = {(where, path): why for where, path, why in lines if why}
    assert set(lost) == {("ffffffff", "tau"), ("", "q"), ("u", "a"), ("u", "tau"), ("s", "amplitude")}
    assert "driven by the document parameter 'strength'" in lost["s", "amplitude"]
    assert doc.by_names()["u",].element.resting_level == -1


def test_damaged_presets_of_a_file_are_skipped(model):
    listed = [*model.document.layout["presets"]]
    listed += [3, {"name": 4}, {"name": "x", "values": 3}, {"name": "slow", "values": {}}, {"name": "y"}]
    model.describe(layout={"presets": [*listed, {"name": "bare", "values": {"a": 3}}]})
    assert [(p.name, p.group, dict(p.values)) for p in kept_presets(model.document)][1:] == [("bare", "", {})]
    model.describe(layout={"presets": "nonsense"})
    assert kept_presets(model.document) == []


def test_the_name_of_an_unknown_preset_is_an_error_with_the_nearest(model, tmp_path, monkeypatch):
    with pytest.raises(UnknownName, match=r"no preset 'slo'.*slow"):
        kept_preset(model.document, "slo")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(DocumentError, match="slo: there is no such file"):
        apply_preset(model, "slo")


def test_presets_can_be_removed(model):
    assert "presets" not in with_presets(model.document, []).layout
