"""Imports have no cycles: at the top, in functions and for types."""

from __future__ import annotations

import functools
import sys

from tests.house.source import ROOT

sys.path.insert(0, str(ROOT / "tools"))
from measure import cycle, graph, packages, trees


@functools.cache
def imports() -> dict[str, set[str]]:
    """Return what each module imports, read once."""
    return graph(trees(*packages()))


def test_no_module_is_part_of_a_cycle_of_imports() -> None:
    assert cycle(imports()) == []


def test_a_cycle_of_imports_is_found() -> None:
    assert set(cycle({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}})) == {"a", "b", "c"}


def test_imports_inside_functions_and_for_types_are_in_the_graph() -> None:
    assert "deodar.batch.workers" in imports()["deodar.batch.simulate"]
    assert "deodar.recording.record" in imports()["deodar.batch.compute"]
