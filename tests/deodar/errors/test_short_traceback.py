"""What a notebook shows of an error: the lines of the user, without those of the library."""

from __future__ import annotations

import linecache

import pytest

import deodar as dd
from deodar.errors import DeodarError
from deodar.short_traceback import FULL

CELL = """def look(model):
    return dd.simulate(model, 10, record=["u.activaton"])

look(model)
"""


@pytest.fixture
def error() -> DeodarError:
    """Return the error of a wrong port name in a cell."""
    model = dd.Model("m")
    model.add(dd.Field("u", [dd.Axis("x", 0, 20, samples=21)]))
    file = "/tmp/ipykernel_12/34.py"
    linecache.cache[file] = (len(CELL), None, CELL.splitlines(keepends=True), file)
    with pytest.raises(DeodarError) as caught:
        exec(compile(CELL, file, "exec"), {"dd": dd, "model": model})
    return caught.value


def test_frames_of_deodar_are_hidden_and_those_of_the_cell_are_not(error, monkeypatch) -> None:
    monkeypatch.delenv(FULL, raising=False)
    lines = error._render_traceback_()
    start = lines.index("Cell, line 4")
    assert lines[start : start + 4] == [
        "Cell, line 4",
        "    look(model)",
        "Cell, line 2, in look",
        '    return dd.simulate(model, 10, record=["u.activaton"])',
    ]
    assert lines[-3].startswith("UnknownName: u has no port 'activaton'. Did you mean 'activation'?")
    assert not any("run_plan" in line for line in lines) and len(lines) < 12
    assert f"%env {FULL}=full, then %tb" in lines[-1]


def test_all_frames_are_shown_on_request(error, monkeypatch) -> None:
    monkeypatch.setenv(FULL, "full")
    lines = error._render_traceback_()
    assert lines[0] == "Traceback (most recent call last):"
    assert any("run_plan.py" in line for line in lines) and "u has no port 'activaton'" in lines[-1]
