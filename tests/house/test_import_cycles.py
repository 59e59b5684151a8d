"""No module imports, however far round, a module that imports it: at the top, in functions and for types."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter

from tests.house.source import MODULES, imported, module


def graph() -> dict[str, set[str]]:
    """For each module the modules that it imports."""
    names = {module(path) for path in MODULES}
    return {module(path): set(_known(imported(path), names)) - {module(path)} for path in MODULES}


def _known(found: list[tuple[int, str]], names: set[str]) -> Iterator[str]:
    for _, name in found:
        while name and name not in names:  # what is imported from a module is no module
            name = name.rpartition(".")[0]
        if name:
            yield name


def cycle(imports: Mapping[str, set[str]]) -> list[str]:
    """The first cycle, or nothing."""
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        return error.args[1]
    return []


def test_no_module_is_part_of_a_cycle_of_imports() -> None:
    assert cycle(graph()) == []


def test_the_rule_sees_a_cycle() -> None:
    assert set(cycle({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}})) == {"a", "b", "c"}


def test_the_graph_sees_an_import_inside_a_function_or_for_types() -> None:
    assert "batch.workers" in graph()["batch.simulate"]
    assert "recording.record" in graph()["batch.compute"]
