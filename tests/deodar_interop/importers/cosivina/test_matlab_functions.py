"""Functions of MATLAB: what a few words would make too large is refused before memory is taken for it."""

from __future__ import annotations

import tracemalloc
from typing import Any

import numpy as np
import pytest

from deodar_interop.importers.cosivina.launchers.expressions import NotRead
from deodar_interop.importers.cosivina.launchers.matlab_functions import FUNCTIONS
from deodar_interop.importers.cosivina.launchers.matlab_values import cells, text

LONG = text("x" * 100_000)
MANY = cells([text("x")] * 1000)


def test_texts_are_joined_and_split() -> None:
    parts = FUNCTIONS["strsplit"]([text("a b c")])
    assert [str("".join(part.ravel())) for part in parts.ravel()] == ["a", "b", "c"]
    assert "".join(FUNCTIONS["strjoin"]([parts, text("-")]).ravel()) == "a-b-c"
    assert FUNCTIONS["num2cell"]([np.ones((2, 3))]).shape == (2, 3)


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("strjoin", [MANY, LONG]),
        ("strcat", [MANY, LONG]),
        ("char", [cells([LONG, *([text("x")] * 1000)])]),
        ("strsplit", [text("x" * 2_000_000), text("x")]),
        ("num2cell", [np.zeros((1500, 1500))]),
        ("cell", [np.full((1, 1), 1100.0)]),
    ],
)
def test_a_value_that_would_be_too_large_is_refused_before_it_exists(name: str, arguments: list[Any]) -> None:
    tracemalloc.start()
    try:
        with pytest.raises(NotRead, match=r"at most|not read"):
            FUNCTIONS[name](arguments)
        assert tracemalloc.get_traced_memory()[1] < 64 * 2**20
    finally:
        tracemalloc.stop()
