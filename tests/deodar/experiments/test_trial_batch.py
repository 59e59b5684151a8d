"""Batches: trials equal single ones, and programs become smaller as trials end."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.compiler.copy_batch import Batch
from deodar.elements.world_ports import Sensor
from deodar.errors import ParameterError, WorldError
from deodar.experiments import trial_copies
from deodar.experiments.events import Crosses, Within
from deodar.experiments.experiment import Experiment
from deodar.experiments.measures import Measure
from deodar.numerics.choice import MANY
from deodar.worlds.picture import Picture
from tests.deodar.experiments.calls import run_alone, run_together
from tests.deodar.experiments.robots import decider, room, straight

DECIDED = Crosses("decided", "u.activation")


def sizes(model):
    """Return the sizes of the batches for which a model has programs."""
    return sorted(p.batch.size for p in model.programs.values() if p.batch != Batch())


def test_a_batch_gives_the_values_of_single_trials():
    many = run_together(decider(), 400, [7, 0, 3, 1], ["u.activation"], [DECIDED], precision="float64")
    assert len({c.duration for c in many}) > 2
    for trial, course in zip([7, 0, 3, 1], many, strict=True):
        alone = run_alone(
            decider(), 400, trial=trial, watch=["u.activation"], events=[DECIDED], precision="float64"
        )
        np.testing.assert_array_equal(course.times, alone.times)
        np.testing.assert_allclose(course.values["u.activation"], alone.values["u.activation"], atol=1e-10)
        assert (course.outcome, course.events) == (alone.outcome, alone.events)


def test_finished_trials_are_dropped_from_the_batch(monkeypatch):
    monkeypatch.setattr(trial_copies, "WORTH", 0)
    model, remaining = decider(), []
    courses = run_together(model, 600, range(16), events=[DECIDED], between=remaining.append)
    assert remaining[0] == 16 and remaining[-1] == 0 and sorted(remaining, reverse=True) == remaining
    assert sizes(model)[-1] == 16 and len(sizes(model)) >= 3
    assert sum(course.outcome == "decided" for course in courses) > 8


def test_a_smaller_batch_has_the_state_of_the_larger_one_where_kernels_differ(monkeypatch):
    """With many copies a kernel whose strength differs between trials has a group of its own."""
    monkeypatch.setattr(trial_copies, "WORTH", 0)
    model, count = decider(), 2 * MANY
    model.add(dd.Field("v", [], tau=20, resting_level=-1, noise=3.0, kernel=[dd.Gaussian(0.5)]))
    model.set("u.kernel", [dd.Gaussian(0.5)])
    strengths = np.linspace(0.5, 0.6, count).tolist()
    values = {"u.kernel.0.amplitude": strengths}
    many = run_together(
        model, 600, range(count), ["u.activation"], [DECIDED], values=values, precision="float32"
    )
    assert {c.outcome for c in many} >= {"decided"} and len(sizes(model)) >= 3
    for k in (0, count - 1):
        model.set("u.kernel.0.amplitude", strengths[k])
        alone = run_alone(model, 600, trial=k, watch=["u.activation"], events=[DECIDED])
        assert alone.duration == many[k].duration


def test_a_smaller_batch_is_compiled_only_if_it_saves_time():
    model = decider()
    run_together(model, 600, range(16), events=[DECIDED])
    assert sizes(model) == [16]


def test_the_same_call_gives_the_same_bits():
    first, second = (
        run_together(decider(), 300, range(6), ["u.activation"], [DECIDED], every=5) for _ in range(2)
    )
    for a, b in zip(first, second, strict=True):
        np.testing.assert_array_equal(a.values["u.activation"], b.values["u.activation"])


def test_the_mean_time_of_a_decision_falls_with_noise():
    times = [
        np.median(
            [c.duration for c in run_together(decider(noise), 3000, range(40), events=[DECIDED], every=5)]
        )
        for noise in (2.0, 4.0)
    ]
    assert times[0] > 3 * times[1]


def test_fields_are_sampled_in_a_batch():
    model = dd.Model("line")
    model.add(dd.Field("u", [dd.Axis("x", 0, 10, 11)], tau=10, resting_level=-1, noise=0.5))
    courses = run_together(model, 50, [4, 5], ["u.activation"], every=10)
    assert [c.values["u.activation"].shape for c in courses] == [(6, 11)] * 2 and {
        c.outcome for c in courses
    } == {"time"}


def test_each_trial_has_its_own_world_and_drops_it_when_it_ends():
    model, starts = straight(), [(10, 20, 0), (60, 20, 0), (35, 20, 0), (75, 20, 0)]
    model.add(Sensor("pose", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
    arena, arrival = (
        room(start=starts, goal=[(80, 20)] * 4, slip=0.05),
        [Within("there", 5, "pose.output", "goal.output")],
    )
    model.add(Sensor("goal", [dd.Axis("of", 0, 1, 2)], sensor="goal"))
    many = run_together(model, 300, range(4), ["pose.output"], arrival, world=arena, precision="float64")
    assert len({c.duration for c in many}) == 4 and {c.outcome for c in many} == {"there"}
    assert sizes(model) == [1, 2, 4]
    for trial, course in enumerate(many):
        alone = run_alone(
            model, 300, arena, trial=trial, watch=["pose.output"], events=arrival, precision="float64"
        )
        np.testing.assert_array_equal(course.times, alone.times)
        np.testing.assert_allclose(course.values["pose.output"], alone.values["pose.output"], atol=1e-10)
        assert course.values["pose.output"][0, 0] == starts[trial][0]


def test_rows_keep_their_bits_with_workers_and_after_a_stop_although_the_widths_change(tmp_path, monkeypatch):
    """In single precision, half of the trials of each batch end early, so that it becomes narrower."""
    monkeypatch.setattr("deodar.experiments.setup.MOST_COPIES", 4)
    model = decider()
    model.add(dd.Field("v", [dd.Axis("x", 0, 500, 501)], tau=10, global_inhibition=0.1, noise=1.0))
    measures = [Measure("strongest", "v.activation", "max"), Measure("mean", "v.activation", "mean")]
    # with many steps left, so that a narrower batch saves time
    experiment = Experiment(
        "decide", model, dd.TrialPlan(1e6, events=[DECIDED], measures=measures, every=5), 8
    )
    whole = experiment.run(tmp_path / "whole")
    assert sizes(model) == [1, 2, 4] and len(set(whole["duration"].values.tolist())) > 4

    def stop(standing):
        if standing == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        experiment.run(tmp_path / "part", on=dd.Resources(progress=stop))
    assert experiment.run(tmp_path / "part").identical(whole)
    shared = experiment.run(tmp_path / "shared", on=dd.Resources(workers=2))
    assert shared.drop_attrs().identical(whole.drop_attrs())


def test_invalid_batches_are_refused():
    with pytest.raises(ParameterError, match="each of them once"):
        run_together(decider(), 10, [1, 1])
    with pytest.raises(ParameterError, match="each of them once"):
        run_together(decider(), 10, [])
    with pytest.raises(ParameterError, match="the model is empty"):
        run_together(dd.Model("nothing"), 10, [1])
    model = straight()
    model.add(Sensor("heading", sensor="heading"))
    with pytest.raises(WorldError, match="no world was given"):
        run_together(model, 10, [1], ["heading.output"])
    eye = dd.Model("eye")
    eye.add(
        Sensor(
            "camera",
            [dd.Axis("x", 0, 3, 4), dd.Axis("y", 0, 3, 4), dd.Axis("channel", 0, 2, 3)],
            sensor="camera",
        )
    )
    with pytest.raises(WorldError, match="Picture cannot be computed for a batch of copies"):
        run_together(eye, 10, [1], ["camera.output"], world=Picture.example())
