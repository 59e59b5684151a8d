"""A copy of a batch that diverges is NaN with its reason, and the others equal a run without it."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.errors import NotFinite, RunWarning
from deodar.model.model import Model
from deodar.recording import files
from deodar.recording.record import about
from deodar.recording.repeat import compare, repeat

X = dd.Axis("x", 0, 10, samples=11)
RECORD = ["u.activation", "v.activation"]


def model() -> Model:
    """Return a field that grows without bound through a loop if its gain is large, and an independent
    field.
    """
    model = dd.Model("runaway")
    u = model.add(dd.Field("u", [X], tau=10, sigmoid=dd.Logistic(beta=1), noise=0.1, resting_level=1.0))
    u["activation"] >> model.add(dd.Gain(1.0, name="g")) >> u
    model.add(dd.Field("v", [X], tau=10, noise=0.1))
    return model


def run(gains: list[float], steps: int = 60, **others: object) -> object:
    return dd.simulate(model(), steps, record=RECORD, every=20, sweep={"g.factor": gains}, **others)  # type: ignore[arg-type]


def test_a_diverged_point_is_nan_with_its_reason_and_the_others_are_kept() -> None:
    says = (
        "1 of 3 copies are NaN; the coordinate 'diverged' gives the reasons, the first is: g became infinite"
    )
    with pytest.warns(RunWarning, match=says) as warned:
        record = run([0.1, 1e6, 0.3])
    assert len(warned) == 1 and warned[0].filename == __file__
    assert [bool(text) for text in record["diverged"].values] == [False, True, False]
    reason = record["diverged"].sel({"g.factor": 1e6}).item()
    assert (
        reason.startswith("g became infinite or undefined in step ")
        and "dt 1)" in reason
        and "diverged" in repr(record)
    )
    good = run([0.1, 0.2, 0.3])
    for path in RECORD:
        assert np.isnan(record[path].values[1]).all(), "at all times, and in elements that it does not reach"
        np.testing.assert_array_equal(record[path].values[[0, 2]], good[path].values[[0, 2]])
    assert "diverged" not in good.coords and "diverged" not in good.attrs


def test_the_reason_names_the_first_step() -> None:
    alone = [_error(gain) for gain in (1e3, 1e9)]
    with pytest.warns(RunWarning):
        record = run([0.1, 1e3, 1e9])
    assert record["diverged"].values.tolist() == ["", *alone] and alone[0] != alone[1]


def _error(gain: float) -> str:
    runaway = model()
    runaway.set("g.factor", gain)
    with pytest.raises(NotFinite) as caught:
        dd.simulate(runaway, 60)
    return caught.value.problems[0].what


@pytest.mark.parametrize("batch", [{"batch": 2}, {"batch": 2, "workers": 2}])
def test_diverged_points_of_all_trials_are_nan_in_pieces_and_workers(batch: dict[str, int]) -> None:
    with pytest.warns(RunWarning, match="4 of 8 copies"):
        record = run([0.1, 1e6, 0.3, 1e7], trials=[3, 1], on=dd.Resources(**batch))
    assert record["diverged"].dims == ("g.factor", "trial")
    assert [[bool(text) for text in row] for row in record["diverged"].values] == [
        [False] * 2,
        [True] * 2,
        [False] * 2,
        [True] * 2,
    ]
    assert (
        np.isfinite(record["u.activation"].values[[0, 2]]).all()
        and np.isnan(record["u.activation"].values[[1, 3]]).all()
    )


def test_a_copy_diverges_if_a_recorded_coupling_is_not_finite() -> None:
    runaway = model()
    runaway.add(Boost("b", amplitude=1.0)) >> runaway.add(dd.Gain(1.0, name="h"))
    runaway["h"] >> runaway.add(dd.Gain(1e38, name="i"))
    with pytest.warns(RunWarning, match=r"1 of 2 copies.*i\.output became infinite"):
        record = dd.simulate(runaway, 5, record=["i.output"], sweep={"h.factor": [1.0, 1e6]})
    assert np.isfinite(record["i.output"].values[0]).all() and np.isnan(record["i.output"].values[1]).all()


def test_a_single_run_and_a_batch_of_which_nothing_is_left_raise() -> None:
    for others in (
        {},
        {"trials": 3},
        {"sweep": {"g.factor": [1e6, 1e7]}},
        {"trials": 4, "on": dd.Resources(batch=2)},
    ):
        runaway = model()
        runaway.set("g.factor", 1e6)
        with pytest.raises(NotFinite, match="g became infinite") as caught:
            dd.simulate(runaway, 10**9 - 1, **others)  # type: ignore[arg-type]
        assert caught.value.paths == ("g",)


@pytest.mark.parametrize("name", ["r.zarr", "r.nc"])
def test_reasons_of_divergence_are_saved_and_repeated(tmp_path: Path, name: str) -> None:
    with pytest.warns(RunWarning):
        record = run([0.1, 1e6])
    files.save_record(record, tmp_path / name)
    read = files.load_record(tmp_path / name)
    assert (
        read["diverged"].values.tolist() == record["diverged"].values.tolist()
        and read.attrs["diverged"] == record.attrs["diverged"]
    )
    with pytest.warns(RunWarning):
        done = repeat(read, dd.simulate)
    assert done.same_bits and all(gap == 0 for gap in done.largest.values())
    assert json.loads(record.attrs["deodar"])["complete"] and about(read)["sweep"] == {"g.factor": [0.1, 1e6]}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not compare(record, run([0.1, 0.2])).same_bits
