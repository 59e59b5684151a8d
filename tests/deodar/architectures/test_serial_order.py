"""The chain learns and produces sequences; its transitions have the order of the theory, and its state
persists between them.
"""

from __future__ import annotations

import dataclasses as dc

import numpy as np
import pytest

import deodar as dd
from deodar.architectures.cascade import ActionTransition, cascade, cascade_paths
from deodar.architectures.serial_order import lesson, lesson_end, production_start, serial_order
from deodar.errors import ParameterError
from deodar.numerics.windows import Window

PLACES = (6.0, 18.0, 30.0, 42.0, 54.0)
RELEASED = 250.0
"""Time after the start of production, in ms, at which cleared nodes are off."""


def assert_right(transitions: list[ActionTransition], sequence: list[float]) -> None:
    assert [t.item for t in transitions] == list(range(1, len(sequence) + 1))
    assert [t.place for t in transitions] == pytest.approx(sequence, abs=1.5)


@pytest.mark.parametrize(
    "sequence", [[54.0, 6.0], [30.0, 6.0, 6.0, 54.0, 30.0, 18.0, 42.0, 42.0, 42.0, 6.0]], ids=["two", "ten"]
)
def test_a_sequence_is_learned_and_produced_in_every_trial(sequence: list[float]) -> None:
    n = len(sequence)
    runs = dd.simulate(
        lesson(sequence, PLACES), lesson_end(n, len(PLACES)), record=cascade_paths(n), trials=8
    )
    for trial in range(8):
        record = runs.isel(trial=trial)
        learned, produced = (
            cascade(record, 0.0, production_start(n)),
            cascade(record, production_start(n) + RELEASED),
        )
        assert_right(learned, sequence)
        assert_right(produced, sequence)
        assert all(t.in_order for t in produced)
        assert np.isnan(produced[-1].next_on) and not any(np.isnan(t.next_action) for t in produced[:-1])
        # in learning the action continues after its node until it is no longer shown, and then the next one
        # is requested
        assert all(t.satisfied < t.off < t.action_off < t.released < t.next_on for t in learned[:-1])


def test_the_order_of_percepts_does_not_matter() -> None:
    sequence = [30.0, 6.0, 54.0]
    for seen in (PLACES, PLACES[::-1]):
        record = dd.simulate(lesson(sequence, seen), lesson_end(3, 5), record=cascade_paths(3))
        assert_right(cascade(record, production_start(3) + RELEASED), sequence)


def test_an_action_waits_for_its_own_condition_of_satisfaction() -> None:
    record = dd.simulate(lesson([30.0, 6.0], [18.0, 42.0]), lesson_end(2, 2), record=cascade_paths(2))
    assert cascade(record, production_start(2) + RELEASED) == []
    assert (
        float(record["item 1.node.activation"][-1]) > 0
        and float(record["satisfaction.activation"].sel(time=slice(4000, None)).max()) < 0
    )


def test_the_sequence_continues_after_pauses_of_1_to_1000_s() -> None:
    sequence, pauses = [30.0, 6.0, 30.0, 54.0], [1e3, 1e4, 1e5, 1e6]
    model = lesson(sequence)
    begin = production_start(4)
    moments = begin + 400.0 + np.cumsum(np.array(pauses) + 500.0)
    for k, place in enumerate(sorted(set(sequence)), 1):
        model.set(
            f"seen {k}.windows",
            [Window(t, t + 200.0) for t, p in zip(moments, sequence, strict=True) if p == place],
        )
    session = dd.Session(model, dt=5, seed=1)
    session.run(begin + 500.0)
    weights = [_weights(session, model, k) for k in range(1, 5)]
    for k, (place, moment) in enumerate(zip(sequence, moments, strict=True), 1):
        session.run(moment - session.time)
        assert [session.read(f"item {j}.node.activation") > 0 for j in range(1, 5)] == [
            j == k for j in range(1, 5)
        ], f"after {pauses[k - 1]} ms"
        u = session.read("action.activation")
        assert (
            abs(np.mean(np.flatnonzero(u > 0)) - place) < 2.5
            and session.read("satisfaction.activation").max() < 0
        )
        session.run(400.0)
    assert not any(session.read(f"item {j}.node.activation") > 0 for j in range(1, 5))
    for k, before in enumerate(weights, 1):
        assert np.array_equal(_weights(session, model, k), before), (
            "weights that do not learn stay the same bits"
        )


def test_each_node_learns_its_own_action_and_a_snapshot_holds_it() -> None:
    sequence = [54.0, 6.0, 54.0]
    model = lesson(sequence)
    session = dd.Session(model)
    session.run(production_start(3))
    for k, place in enumerate(sequence, 1):
        w = _weights(session, model, k)
        active = np.flatnonzero(w > 0.5)
        assert w.max() > 0.95 and 3 <= len(active) <= 9 and abs(active.mean() - place) < 2
    snapshot = session.snapshot()
    session.run(3000)
    later = session.read("action.activation").copy()
    session.restore(snapshot)
    session.run(3000)
    assert np.array_equal(session.read("action.activation"), later)


def test_a_chain_may_be_longer_than_the_sequence() -> None:
    """The node after the last one switches on, and represents no item."""
    model = lesson([30.0, 6.0], PLACES, items=3)
    record = dd.simulate(model, lesson_end(2, len(PLACES)), record=cascade_paths(3))
    assert_right(cascade(record, production_start(2) + RELEASED), [30.0, 6.0])
    assert float(record["item 3.node.activation"][-1]) > 0 > float(record["action.activation"][-1].max())


@pytest.mark.parametrize("items", [0, 51, 2.5, True])
def test_a_chain_of_fewer_than_1_or_more_than_50_items_is_refused(items: object) -> None:
    with pytest.raises(ParameterError, match="a chain has 1 to 50 items"):
        serial_order(items)  # type: ignore[arg-type]


def test_a_sequence_must_fit_into_its_chain() -> None:
    with pytest.raises(ParameterError, match="a chain of 2 items cannot hold a sequence of 3"):
        lesson([1.0, 2.0, 3.0], items=2)


def test_a_transition_in_another_order_is_reported() -> None:
    good = ActionTransition(1, 30.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0)
    assert (
        good.in_order
        and not dc.replace(good, action_off=11.0).in_order
        and not dc.replace(good, released=np.nan).in_order
    )
    assert (
        dc.replace(good, next_on=np.nan, next_action=np.nan).in_order
        and not dc.replace(good, next_action=np.nan).in_order
    )


def _weights(session: dd.Session, model: dd.Model, k: int) -> np.ndarray:
    memory, _ = session.snapshot().states[model[f"item {k}.meaning"].id]
    return np.array(memory["weights"])
