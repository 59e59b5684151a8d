"""The levels of a port that an element names are existing numbers that can be changed during a run."""

from __future__ import annotations

import pytest

from deodar.leaves import leaves
from tests.contracts.build import KINDS, around, example, session


@pytest.mark.parametrize("kind", [name for name, cls in KINDS.items() if cls.levels])
def test_levels_name_ports_and_numbers(kind: str) -> None:
    element = example(kind)
    numbers = {path for path, number, p in leaves(element) if isinstance(number, float) and p.cost == "live"}
    running = session(around(element))
    for port, levels in element.levels.items():
        assert running.read(f"example.{port}").size
        assert levels and all(levels)
        assert set(levels.values()) <= numbers


def test_levels_of_a_field_are_its_threshold_and_its_resting_level() -> None:
    assert set(KINDS["Field"].levels["activation"]) == {"threshold", "resting level"}
