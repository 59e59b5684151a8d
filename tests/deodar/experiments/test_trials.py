"""Trials that are prepared once: further calls, threads, pickles, and what they cost."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import deodar as dd
from deodar.errors import ParameterError
from deodar.experiments import trial_copies
from deodar.experiments.trial import Trial
from tests.deodar.experiments.robots import decider, room, straight

PLAN = dd.TrialPlan(400, ["u"], [dd.Crosses("decided", "u.activation")])


def equal(one: list[Trial], other: list[Trial]) -> bool:
    return all(
        a.outcome == b.outcome and a.events == b.events and np.array_equal(a.values["u"], b.values["u"])
        for a, b in zip(one, other, strict=True)
    )


def test_a_further_call_has_the_results_of_a_first_one_and_compiles_nothing():
    trials, model = dd.Trials(decider(), PLAN), decider()
    model.set("u.noise", 2.0)
    values = {"u.noise": [2.0, 2.0, 2.0]}
    trials.run([0, 1, 2], seed=1)
    trials.run([7, 8, 9], 1, {"u.noise": [1.0, 2.0, 3.0]})
    counts = {key: (p.traced, p.compiled) for key, p in trials.dynamics.model.programs.items()}
    outcomes = trials.run([3, 4, 5], 2), trials.run([3, 4, 5], 2, values)
    assert {key: (p.traced, p.compiled) for key, p in trials.dynamics.model.programs.items()} == counts
    assert equal(outcomes[0], dd.Trials(decider(), PLAN).run([3, 4, 5], 2))
    assert equal(outcomes[1], dd.Trials(decider(), PLAN).run([3, 4, 5], 2, values))
    for swept, alone in zip(outcomes[1], dd.Trials(model, PLAN).run([3, 4, 5], 2), strict=True):
        np.testing.assert_allclose(swept.values["u"], alone.values["u"], atol=1e-4)


def test_a_reset_of_one_trial_alone_copies_no_state_to_the_host_twice(monkeypatch):
    copied, copy = [], trial_copies.host
    monkeypatch.setattr(trial_copies, "host", lambda state: copied.append(1) or copy(state))
    for keep_learned in (False, True):
        copied.clear()
        plan = dd.TrialPlan(20, ["u"], actions=[dd.Reset(10, keep_learned=keep_learned)])
        [run] = dd.Trials(decider(), plan, together=False).run()
        assert len(run.times) == 21
        assert len(copied) == (2 if keep_learned else 1)  # the start, and what was learned


def test_later_changes_of_the_model_have_no_effect():
    model = decider()
    trials = dd.Trials(model, PLAN)
    before = trials.run([0])
    model.set("u.resting_level", 5.0)
    assert equal(trials.run([0]), before) and not equal(dd.Trials(model, PLAN).run([0]), before)


@pytest.mark.parametrize("world", [None, "arena"])
def test_threads_share_them(world: str | None):
    model, arena = (decider(), None) if world is None else (straight(), room(slip=0.3))
    plan = PLAN if world is None else dd.TrialPlan(60, ["go left"], every=4)
    trials = dd.Trials(model, plan, arena)
    watched = plan.watch[0]
    calls = [(range(k, k + 4), k) for k in range(6)]
    alone = [trials.run(*call) for call in calls]
    with ThreadPoolExecutor(3) as pool:
        together = list(pool.map(lambda call: trials.run(*call), calls))
    for rows, rows_together in zip(alone, together, strict=True):
        assert all(
            np.array_equal(a.values[watched], b.values[watched])
            for a, b in zip(rows, rows_together, strict=True)
        )


def test_a_pickle_is_what_they_were_made_from():
    trials = dd.Trials(decider(), PLAN, precision="float64")
    copy = pickle.loads(pickle.dumps(trials))
    assert copy.plan == trials.plan and copy.precision == "float64"
    assert equal(copy.run([3, 1], 4), trials.run([3, 1], 4))


def test_the_memory_grows_with_the_trials_that_run_at_once():
    trials = dd.Trials(decider(), PLAN)
    assert trials.memory(200) > 100 * trials.memory(1) > 0
    alone = dd.Trials(straight(), dd.TrialPlan(10), room(), together=False)
    assert alone.memory(200) == alone.memory(1)


def test_trials_one_by_one_have_no_values_of_their_own():
    trials = dd.Trials(decider(), PLAN, together=False)
    with pytest.raises(ParameterError, match=r"u\.noise: trials that run one by one have the parameters"):
        trials.run([0], values={"u.noise": [1.0]})
