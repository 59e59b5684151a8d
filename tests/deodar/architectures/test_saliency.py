"""The saliency architecture as a document."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import deodar as dd
from deodar.architectures.saliency import CUE_AT, saliency
from deodar.worlds.picture import Picture


def test_the_document_of_the_model_names_no_file(tmp_path: Path) -> None:
    model = saliency()
    dd.save(model, tmp_path / "saliency.json")
    loaded = dd.load(tmp_path / "saliency.json")
    assert loaded.document == model.document and not loaded.check()
    assert "jpg" not in (tmp_path / "saliency.json").read_text()


def test_the_ridge_has_the_strength_that_its_constant_states() -> None:
    record = dd.simulate(
        saliency(hue=100.0),
        CUE_AT + 1000,
        record=["ridge.output", "colour.activation"],
        every=500,
        world=Picture.example(),
    )
    ridge = record["ridge.output"].values
    assert ridge[1].max() < 0.05 and 3.6 < ridge[-1].max() < 4.0
    assert abs(record["hue"].values[ridge[-1].argmax()] - 100) <= 12
    assert np.all(record["colour.activation"].values[1] < 0)
