"""Elements and parameters by their paths."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar.errors import UnknownName
from deodar.model import find


def test_an_unknown_path_suggests_the_nearest() -> None:
    model = dd.Model("paths")
    model.add(dd.Field("memory", []), group="working")
    model.add(dd.Field("input", []))
    with pytest.raises(UnknownName, match=r"there is no element 'working\.memroy'") as error:
        find.element(model.document, "working.memroy")
    assert "Did you mean 'working.memory'?" in str(error.value)
    assert find.element(model.document, "working.memory").path == "working.memory"
