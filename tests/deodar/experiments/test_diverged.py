"""A trial that diverges is a row with its reason, and the others equal a run without it."""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar import cli
from deodar.errors import NotFinite, RunWarning
from deodar.experiments import trial_copies
from deodar.experiments.actions import Set
from deodar.experiments.events import Crosses, Reached
from deodar.experiments.experiment import Experiment
from deodar.experiments.factor import Factor
from deodar.experiments.measures import Measure
from deodar.experiments.results import ROWS, load_results
from deodar.recording import files
from deodar.session.run import Run
from tests.deodar.experiments.calls import changed, run_alone, run_together

LATE = Crosses("late", "v.activation", 1.0)
RISEN = Crosses("risen", "u.activation", 1.02, ends=False)
MEASURES = [Measure("last", "v.activation", "max"), Measure("risen to", "u.activation", "max", when="risen")]
APART = [Set(79, "v.quadrature", "point")]
"""Actions that change nothing, but prevent a batch."""

PROGRAMS: dict[Any, Any] = {}
"""Compiled programs, which all models of this file share."""


def model(factor: float = 0.1) -> dd.Model:
    """Return a node that grows without bound through a loop if the factor is large, and an independent
    node with noise.
    """
    model = dd.Model("runaway")
    model.programs = PROGRAMS
    u = model.add(dd.Field("u", [], tau=10, sigmoid=dd.Logistic(beta=1), resting_level=1.0))
    u["activation"] >> model.add(dd.Gain(factor, name="g")) >> u
    model.add(dd.Field("v", [], tau=10, noise=1.0))
    return model


def experiment(factors: Sequence[float], trials: int = 3, **others: object) -> Experiment:
    options = {
        "events": [LATE, RISEN],
        "factors": [Factor("factor", list(factors), "g.factor")],
        "measures": MEASURES,
    }
    return changed(Experiment("runaway", model(), dd.TrialPlan(80), trials), **options | others)


def finished(experiment: Experiment, *args: object, says: str = "3 of 9 trials diverged", **others: object):
    with pytest.warns(RunWarning, match=says) as warned:
        table = experiment.run(*args, **others)  # type: ignore[arg-type]
    assert len(warned) == 1
    return table


def test_a_diverged_trial_is_a_row_with_its_reason_and_others_keep_their_bits() -> None:
    table = finished(
        experiment([0.1, 1e6, 0.3]),
        says="3 of 9 trials diverged; the variable 'diverged' gives the reasons, the first is: g became",
    )
    bad = table["factor"].values == 1e6
    assert (
        set(table["outcome"].values[bad]) == {"diverged"} and "diverged" not in table["outcome"].values[~bad]
    )
    assert all(
        text.startswith("g became infinite or undefined in step ") for text in table["diverged"].values[bad]
    )
    assert set(table["diverged"].values[~bad]) == {""} and set(table["awaited"].values[bad]) == {""}
    good = experiment([0.1, 0.2, 0.3]).run()
    for name in ("duration", "late", "risen", "last", "risen to"):
        assert np.isnan(table[name].values[bad]).all()
        np.testing.assert_array_equal(table[name].values[~bad], good[name].values[~bad])
    assert table["outcome"].values[~bad].tolist() == good["outcome"].values[~bad].tolist()
    assert (
        "diverged" not in good
        and "diverged" not in good.attrs
        and np.isfinite(good["risen"].values[bad]).any()
    )


def test_the_warning_points_to_the_call() -> None:
    with pytest.warns(RunWarning) as warned:
        experiment([1e6, 0.1]).run()
    assert warned[0].filename == __file__


def test_trials_run_one_by_one_give_the_same_rows() -> None:
    alone, together = experiment([0.1, 1e6, 0.3], actions=APART), experiment([0.1, 1e6, 0.3])
    assert together.setup().batched and not alone.setup().batched
    table, table_together = finished(alone), finished(together)
    for name in ("outcome", "diverged", "awaited"):
        assert table[name].values.tolist() == table_together[name].values.tolist()
    for name in ("duration", "late", "risen", "last", "risen to"):
        np.testing.assert_allclose(table[name].values, table_together[name].values, atol=1e-4)


def test_a_sampled_coupling_that_diverges_gives_equal_rows_in_trials_and_batches() -> None:
    study = experiment([0.1, 1e6], 1, measures=[Measure("gain", "g.output", "max")])
    one, many = (
        finished(changed(study, actions=actions), says="1 of 2 trials diverged") for actions in (APART, [])
    )
    assert (
        one["diverged"].values.tolist()
        == many["diverged"].values.tolist()
        == ["", "g.output became infinite or undefined in step 7 (time 7 ms, dt 1)"]
    )
    np.testing.assert_allclose(one["gain"].values, many["gain"].values, atol=1e-4)


def test_a_trial_that_ends_before_it_diverges_has_its_own_outcome() -> None:
    step = _step(1e6)
    for at, outcome in ((step - 1, "early"), (step, "diverged")):
        [course, _] = run_together(
            model(), 80, [0, 1], events=[Reached("early", at)], values={"g.factor": [1e6, 0.1]}, tolerant=True
        )
        assert course.outcome == outcome and (course.error is None) == (outcome == "early")
        assert run_alone(model(1e6), 80, events=[Reached("early", at)], tolerant=True).outcome == outcome


def _step(factor: float) -> int:
    with pytest.raises(NotFinite) as caught:
        dd.simulate(model(factor), 80)
    assert f"in step {caught.value.step} " in str(caught.value)
    return caught.value.step


@pytest.mark.parametrize("steps", [1, 7, 1000])
def test_the_reason_does_not_depend_on_chunks(monkeypatch: pytest.MonkeyPatch, steps: int) -> None:
    monkeypatch.setattr(Run, "_chunk_steps", lambda run: steps)
    values = {"g.factor": [1e6, 0.1, 1e4]}
    with pytest.warns(RunWarning, match="2 of 3 trials"):
        courses = run_together(model(), 80, range(3), ["u.activation", "g.output"], values=values)
    summaries = [(c.outcome, len(c.times), str(c.error and c.error.problems[0].what)) for c in courses]
    assert summaries == [
        ("diverged", 7, "g.output became infinite or undefined in step 7 (time 7 ms, dt 1)"),
        ("time", 81, "None"),
        ("diverged", 12, "g.output became infinite or undefined in step 12 (time 12 ms, dt 1)"),
    ]
    assert np.isnan(courses[0].values["u.activation"]).all() and courses[0].values["u.activation"].shape == (
        7,
    )


def test_a_batch_in_which_all_trials_diverge_raises_as_a_single_trial_does() -> None:
    for trials in ([3], [3, 1]):
        with pytest.raises(NotFinite, match="g became infinite"):
            run_together(model(1e6), 80, trials)
    with pytest.raises(NotFinite, match="g became infinite"):
        run_alone(model(1e6), 80)


def test_an_experiment_of_which_all_trials_diverge_has_their_rows() -> None:
    table = finished(experiment([1e6, 1e7], 2), says="4 of 4 trials diverged")
    assert set(table["outcome"].values) == {"diverged"} and np.isnan(table["duration"].values).all()


def test_diverged_trials_are_dropped_from_the_batch(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trial_copies, "WORTH", 0)
    values = {"g.factor": [1e6, 0.1, 1e6, 0.3, 1e6, 1e6]}
    with pytest.warns(RunWarning, match="4 of 6 trials"):
        runaway = model()
        runaway.programs = {}
        some = run_together(runaway, 80, range(6), ["v.activation"], values=values)
    # one of them has diverged and fills the batch
    assert sorted(p.batch.size for p in runaway.programs.values()) == [3, 6]
    good = run_together(
        model(), 80, range(6), ["v.activation"], values={"g.factor": [0.1, 0.1, 0.1, 0.3, 0.1, 0.1]}
    )
    for k in (1, 3):
        np.testing.assert_allclose(some[k].values["v.activation"], good[k].values["v.activation"], atol=1e-5)


def test_rows_are_equal_with_workers_after_an_interruption_and_from_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("deodar.experiments.setup.MOST_COPIES", 4)
    study = experiment([0.1, 1e6, 0.3], watch=["u.activation"])
    data = finished(study, tmp_path / "whole")

    def stop(standing: object) -> None:
        if standing >= 3:  # type: ignore[attr-defined]
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        study.run(tmp_path / "part", on=dd.Resources(progress=stop))
    assert finished(study, tmp_path / "part").identical(data) and load_results(tmp_path / "part").identical(
        data
    )
    assert (tmp_path / "part" / ROWS).read_bytes() == (tmp_path / "whole" / ROWS).read_bytes()
    table = (tmp_path / "whole" / "trials.csv").read_text()
    assert table.splitlines()[0] == "trial,factor,outcome,awaited,diverged,duration,late,risen,last,risen to"
    read = files.load_record(tmp_path / "whole" / "trials.nc")
    assert read.identical(data) and read.attrs["diverged"] == data.attrs["diverged"]
    bad = int(np.flatnonzero(data["factor"].values == 1e6)[0])
    record = files.load_record(tmp_path / "whole" / "records" / f"{bad:06}.nc")
    assert np.isnan(record["u.activation"].values).all() and data["diverged"].values[bad] in json.dumps(
        dict(record.attrs)
    )


def test_the_command_prints_the_number_of_diverged_trials(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    experiment([0.1, 1e6, 0.3]).save("e.json")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert cli.main(["experiment", "e.json", "--no-progress", "--out", "out"]) == 0
    printed = capsys.readouterr()
    assert (
        "factor 1e+06: 3 trials, diverged 100 %, no duration" in printed.out
        and "9 trials: diverged 3, " in printed.out
    )
    assert "deodar experiment: warning: 3 of 9 trials diverged; " in printed.err
    assert cli.main(["experiment", "e.json", "--json", "--out", "out"]) == 0
    assert json.loads(capsys.readouterr().out)["diverged"] == 3
    experiment([1e6, 1e7]).save("none.json")
    assert cli.main(["experiment", "none.json", "--no-progress", "--out", "none"]) == 1
    assert "warning: 6 of 6 trials diverged" in capsys.readouterr().err


def test_diverged_is_a_reserved_column() -> None:
    with pytest.raises(dd.errors.ParameterError, match="'diverged' is a column of every table"):
        experiment([0.1], events=[Crosses("diverged", "v.activation")])
    assert math.isnan(float(finished(experiment([1e6], 1), says="1 of 1")["duration"][0]))
