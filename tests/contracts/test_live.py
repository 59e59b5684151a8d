"""A changed live parameter causes no tracing or compiling, and acts as the same value does from the start."""

from __future__ import annotations

from collections.abc import Iterator

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.leaves import leaves, resting
from tests.contracts.build import KINDS, PARTS, any_example, around, changes, node, parameters, session

EVENTS: list[str] = []


@pytest.fixture(scope="module", autouse=True)
def listening() -> Iterator[None]:
    """Collect the messages of JAX about tracing and compiling."""

    def hear(event: str, duration: float, **_: object) -> None:
        if "compile" in event or "trace" in event or "lower" in event:
            EVENTS.append(event)

    jax.monitoring.register_event_duration_secs_listener(hear)
    yield
    jax.monitoring.unregister_event_duration_listener(hear)


def read(s: dd.Session, ports: list[str]) -> list[np.ndarray]:
    """Return the values of ports at the start, after five steps, and after the sources are switched off."""
    s.reset()
    seen = [s.read(port) for port in ports]
    s.step(5)
    seen += [s.read(port) for port in ports]
    sources = [f"{dd.quote(e.path)}.amplitude" for e in s.document.entries if e.path.startswith("to ")]
    before = [s.get(path) for path in sources]
    for path in sources:
        assert s.set(path, 0.0) == "live"
    s.step(2)
    seen += [s.read(port) for port in ports]
    for path, value in zip(sources, before, strict=True):
        s.set(path, value)
    return seen


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_live_parameters_change_without_recompiling(kind):
    model = around(any_example(kind))
    element = model["example"].element
    neutral = resting(element)
    ports = [f"example.{port}" for port in node(model).outs]
    s = session(model)
    for path, number in changes(element):  # leaving a neutral value makes another program, once
        if path in neutral:
            assert s.set(f"example.{path}", number) == "recompile"
    first = read(s, ports)
    costs = {path: "rebuild" if p.form == "array" else p.cost for path, _, p in leaves(element)}
    traced = sum(program.traced for program in model.programs.values())
    EVENTS.clear()
    for path, number in changes(s.document.by_names()[("example",)].element):
        assert s.set(f"example.{path}", number) == costs[path], path
    second = read(s, ports)
    assert not EVENTS
    assert sum(program.traced for program in model.programs.values()) == traced
    assert all(np.isfinite(values).all() for values in second)
    declared = parameters({**KINDS, **PARTS}[kind])
    if any(p.cost == "live" or p.form == "array" for p in declared):
        assert changes(element), "no number to change"
    # the same values at the start
    for path, _ in changes(element):
        model.set(f"example.{path}", s.get(f"example.{path}"))
    fresh = read(session(model), ports)
    for changed, given in zip(second, fresh, strict=True):
        np.testing.assert_array_equal(changed, given)
    if changes(element):
        assert any(not np.array_equal(a, b) for a, b in zip(first, second, strict=True)), (
            "the changes do nothing"
        )


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
        changed = read(s, ports)
        model.set(f"example.{path}", number)
        reading = read(session(model), ports)
        for a, b in zip(changed, reading, strict=True):
            np.testing.assert_array_equal(a, b, err_msg=path)
