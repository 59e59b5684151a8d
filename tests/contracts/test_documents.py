"""Every kind is equal after it is written to a document and read."""

from __future__ import annotations

import dataclasses as dc

import numpy as np
import pytest

import deodar as dd
from deodar.kind_rules.check_kind import read_as_written
from deodar.leaves import replace
from tests.contracts.build import KINDS, PARTS, any_example, around, changes, record


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_document_to_text_to_document_is_identity(kind):
    assert [*read_as_written(any_example(kind))] == []


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
