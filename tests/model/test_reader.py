"""Reading of a document: all its problems are collected, each with its place."""

from __future__ import annotations

import pytest

from deodar.errors import DocumentError
from deodar.model import files
from deodar.model.reader import MOST_PROBLEMS


@pytest.mark.parametrize("wrong", [MOST_PROBLEMS - 1, MOST_PROBLEMS, MOST_PROBLEMS + 1, 5000])
def test_after_a_hundred_problems_no_further_connection_is_read(wrong: int) -> None:
    rows = [{"source": f"absent{k}", "target": "u"} for k in range(wrong)]
    with pytest.raises(DocumentError) as caught:
        files.from_data({"deodar": 1, "elements": {"u": {"kind": "Field"}}, "connections": rows}, {})
    *listed, last = caught.value.problems
    assert len(listed) == min(wrong, MOST_PROBLEMS + 1) - 1
    assert ("were not read" in last.what) == (wrong > MOST_PROBLEMS)
    assert last.where == f"connections.{len(listed)}"
