"""Every kind runs: its values stay finite, alone and in a batch, with the declared shapes."""

from __future__ import annotations

import dataclasses as dc

import numpy as np
import pytest

from deodar.couplings.learning import RewardGate
from deodar.kind_rules.check_kind import finite_alone_and_in_trials
from deodar.leaves import leaves
from deodar.model import find
from deodar.model.kind_contract import one_copy
from deodar.numerics.axes import shape
from tests.contracts.build import KINDS, PARTS, any_example, around, node, record, session


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_finite_for_a_thousand_steps_from_init_also_in_a_hundred_trials(kind):
    assert [*finite_alone_and_in_trials(any_example(kind))] == []


@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_every_port_can_be_read_and_has_the_axes_it_declares(kind):
    model = around(any_example(kind))
    resolved, s = node(model), session(model)
    s.step(1)
    entry = model["example"]
    for port in find.readable(model.entry(entry.id)):
        axes = resolved.outs[port] if port in resolved.outs else resolved.ins[port]
        assert s.read(f"example.{port}").shape == shape(axes), port


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize("kind", [*KINDS, *PARTS])
def test_one_copy_has_exactly_the_declared_outputs(kind, precision):
    """The element's own functions, outside a program: shapes and precision of outputs and of the state."""
    element = any_example(kind)
    resolved = node(around(element))
    assert one_copy(element, resolved.ins, resolved.outs, precision) == []


def depending(kind: str) -> set[tuple[str, str]]:
    """Return the pairs of an output and an input of a kind that changes it in the same step."""
    element = any_example(kind)
    if isinstance(element, RewardGate):
        element = dc.replace(element, duration=0.0)  # a window stays open, whatever arrives
    model = around(element)
    s = session(model)
    s.step(3)
    before = {port: s.read(f"example.{port}") for port in node(model).outs}
    pairs: set[tuple[str, str]] = set()
    for port in element.ports():
        source = f'"to {port}"'
        probes: list[tuple[str, object]] = [("amplitude", 0.2), ("amplitude", -2.0)]
        if node(model, f"to {port}").outs["output"]:  # a number has no position
            probes.append(("center", [c + 1 for c in s.get(f"{source}.center")]))
        for name, value in probes:
            path = f"{source}.{name}"
            kept = s.get(path)
            s.set(path, value)
            pairs |= {(p, port) for p, b in before.items() if not np.array_equal(s.read(f"example.{p}"), b)}
            s.set(path, kept)
    return pairs


@pytest.mark.parametrize("kind", [kind for kind in KINDS if any_example(kind).ports()])
def test_outputs_depend_in_the_same_step_on_the_inputs_that_they_declare_and_no_others(kind):
    outs = node(around(any_example(kind))).outs
    declared = {(port, name) for port, names in KINDS[kind].direct.items() if port in outs for name in names}
    assert depending(kind) == declared


@pytest.mark.parametrize("kind", KINDS)
def test_every_element_runs_at_a_step_of_its_own(kind):
    """Every kind may run at a multiple of the step; its state then changes at that multiple only."""
    element = any_example(kind)
    model = around(element, every=3)
    recording = record(model, 12, [f"example.{port}" for port in node(model).outs], every=1, dt=1.0)
    for variable in recording.data_vars.values():
        values = variable.values.reshape(13, -1)
        assert np.isfinite(values).all()
        if element.stateful:
            moved = np.flatnonzero((values[1:] != values[:-1]).any(axis=1)) + 1
            assert (moved % 3 == 0).all()


def test_examples_have_parameters_in_range():
    for kind in (*KINDS, *PARTS):
        for path, number, p in leaves(any_example(kind)):
            assert p.lower is None or np.min(number) >= p.lower, path
            assert p.upper is None or np.max(number) <= p.upper, path
