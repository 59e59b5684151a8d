"""A changed live parameter causes no tracing or compiling, and acts as the same value does from the start."""

from __future__ import annotations

import numpy as np
import pytest

from deodar.kind_rules.check_kind import courses, live_without_compiling
from deodar.leaves import resting
from tests.contracts.build import KINDS, PARTS, any_example, around, changes, node, parameters, session


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_live_parameters_change_without_recompiling(kind):
    assert [*live_without_compiling(any_example(kind))] == []
    declared = parameters({**KINDS, **PARTS}[kind])
    if any(p.cost == "live" or p.form == "array" for p in declared):
        assert changes(any_example(kind)), "no number to change"


def alone(kind: str) -> list[tuple[str, object]]:
    """Return the changes of a kind that need no other program."""
    element = any_example(kind)
    return [(path, number) for path, number in changes(element) if path not in resting(element)]


@pytest.mark.parametrize("kind", [kind for kind in KINDS if alone(kind)])
def test_each_change_alone_equals_the_same_value_from_the_start(kind):
    """One parameter at a time, so that none hides the effect of another; both sessions share one program."""
    model = around(any_example(kind))
    ports = [f"example.{port}" for port in node(model).outs]
    s = session(model)
    for path, number in alone(kind):
        s.set(f"example.{path}", number)
        changed = courses(s, ports)
        model.set(f"example.{path}", number)
        reading = courses(session(model), ports)
        for a, b in zip(changed, reading, strict=True):
            np.testing.assert_array_equal(a, b, err_msg=path)
