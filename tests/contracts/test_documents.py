"""Every kind is equal after it is written to a document and read."""

from __future__ import annotations

import dataclasses as dc
import json

import numpy as np
import pytest

import deodar as dd
from deodar.leaves import get, replace
from deodar.parameters import FrozenArray
from tests.contracts.build import KINDS, PARTS, any_example, around, changes, record


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_document_to_text_to_document_is_identity(kind, tmp_path):
    model = around(any_example(kind), every=2)
    dd.save(model, tmp_path / "a.json")
    back = dd.load(tmp_path / "a.json", trust=True)
    assert back.document == model.document
    dd.save(back, tmp_path / "b.json")
    first, second = (json.loads((tmp_path / name).read_text()) for name in ("a.json", "b.json"))
    for data in (first, second):
        data.get("arrays", {}).pop("file", None)
    assert first == second


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_values_other_than_defaults_are_saved_and_loaded(kind, tmp_path):
    """Every traced leaf has a value that is not the default."""
    model = around(any_example(kind))
    for path, number in changes(model["example"].element):
        model.set(f"example.{path}", number)
    dd.save(model, tmp_path / "a.json")
    back = dd.load(tmp_path / "a.json", trust=True)
    assert back.document == model.document
    for path, number in changes(any_example(kind)):
        stored = get(back["example"].element, path)
        assert np.array_equal(stored.data if isinstance(stored, FrozenArray) else stored, number), path


@pytest.mark.parametrize("kind", ["Field", "Weights", "Project"])
def test_a_loaded_document_gives_the_same_bits(kind, tmp_path):
    model = around(any_example(kind), noisy=True)
    dd.save(model, tmp_path / "a.json")
    back = dd.load(tmp_path / "a.json")
    before, after = (
        record(m, 20, ["example.output"], seed=3)["example.output"].values for m in (model, back)
    )
    assert np.array_equal(before, after)


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_parts_are_compared_by_their_values(kind):
    one, two = any_example(kind), any_example(kind)
    assert one == two and hash(one) == hash(two)
    for path, number in changes(one):
        assert replace(one, path, number) != one
    assert dc.replace(one, name="other") != one
