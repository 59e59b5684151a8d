"""Elements that store their input: empty rows are NaN as in cosivina, unless elements read them."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.importers.opening import read
from tests.deodar_interop.importers.cosivina.files import element, written
from tests.deodar_interop.importers.cosivina.oracle import Sim

ROW, PLANE = [1, 4], [3, 4]
KINDS = {
    "running": ("RunningHistory", {"timeSlots": 4, "interval": 3}),
    "listed": ("History", {"storingTimes": [0, 3, 3, 4.5, 8, 40]}),
    "one": ("History", {"storingTimes": [2]}),
}


def parts_of(name, size, readers=()):
    kind, param = KINDS[name]
    return [
        (
            "drive",
            "GaussStimulus1D",
            {"size": ROW, "sigma": 1, "amplitude": 4, "position": 2, "circular": 1, "normalized": 0},
            [],
        ),
        ("u", "NeuralField", {"size": size, "tau": 5, "h": -1, "beta": 2}, [("drive", "output")]),
        ("past", kind, {"size": size, **param}, [("u", "output")]),
        *readers,
    ]


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize(("size", "first"), [(ROW, True), (ROW, False), (PLANE, True)])
def test_each_row_is_stored_when_cosivina_stores_it(name, size, first, tmp_path):
    parts = parts_of(name, size)
    if not first:
        parts[1], parts[2] = parts[2], parts[1]
    if name == "running" and size == PLANE:
        parts[2 if first else 1] = (
            "past",
            "RunningHistory",
            {"size": ROW, **KINDS[name][1]},
            [("drive", "output")],
        )
    done = read(written(tmp_path, [element(*part) for part in parts]))
    assert done.report.faithful
    record = dd.simulate(done.model, 14, record=["past.output"], precision="float64")["past.output"]
    plain = Sim(parts)
    for step in range(15):
        expected = plain.out["past"]["output"]
        values = record.isel(time=step).values
        values = np.moveaxis(values, 0, -1) if expected.ndim == 3 else values
        assert np.allclose(values.reshape(expected.shape), expected, rtol=0, atol=1e-12, equal_nan=True), step
        plain.step()
    assert np.isnan(record.isel(time=0)).all() and not np.isnan(record.isel(time=-1)).all()


def test_rows_that_elements_read_begin_with_zero_which_the_report_states(tmp_path):
    readers = [("v", "NeuralField", {"size": [4, 4], "tau": 5, "h": 0, "beta": 4}, [("past", "output")])]
    done = read(written(tmp_path, [element(*part) for part in parts_of("running", ROW, readers)]))
    assert [(line.where, line.verdict) for line in done.report.losses] == [("past", "approximated")]
    record = dd.simulate(done.model, 4, record=["v.activation", "past.output"])
    assert np.isfinite(record["v.activation"]).all() and (record["past.output"][0] == 0).all()


@pytest.mark.parametrize("bugs", [False, True])
def test_times_that_rounding_misses_are_a_known_error(bugs, tmp_path):
    """0.1 added three times is not 0.3."""
    parts = [
        element("u", "NeuralField", {"size": ROW}),
        element("past", "History", {"size": ROW, "storingTimes": [0.2, 0.3]}, [("u", "output")]),
    ]
    done = read(written(tmp_path, parts, dt=0.1), bugs)
    assert len(done.report.bugs) == 1 and "misses 1 of 2" in done.report.bugs[0]
    values = dd.simulate(done.model, 1, every=1, record=["past.output"])["past.output"].values[-1]
    assert np.isnan(values).all(axis=1).tolist() == [False, bugs]


@pytest.mark.parametrize("rewarded", [False, True])
def test_an_association_learns_as_cosivina_does_with_its_defaults(rewarded, tmp_path):
    parts = [
        (
            "left",
            "GaussStimulus1D",
            {"size": [1, 5], "sigma": 1, "amplitude": 4, "position": 2, "circular": 1, "normalized": 0},
            [],
        ),
        (
            "right",
            "GaussStimulus1D",
            {"size": [1, 3], "sigma": 1, "amplitude": 4, "position": 3, "circular": 1, "normalized": 0},
            [],
        ),
        ("pulse", "TimedBoost", {"amplitude": 9, "onTimes": [[4, 6]]}, []),
        ("r", "NeuralField", {"size": [1, 1], "tau": 1, "h": -5, "beta": 9}, [("pulse", "output")]),
        ("u", "NeuralField", {"size": [1, 5], "tau": 5, "h": -1, "beta": 2}, [("left", "output")]),
        (
            "it",
            "HebbianConnection",
            {"learningRate": 0.2},
            [("u", "output"), ("v", "output"), *([("r", "output")] if rewarded else [])],
        ),
        (
            "v",
            "NeuralField",
            {"size": [1, 3], "tau": 5, "h": -1, "beta": 2},
            [("right", "output"), ("it", "output")],
        ),
    ]
    done = read(written(tmp_path, [element(*p) for p in parts]))
    assert {line.what for line in done.report.losses if line.part == "parameter"} == {
        "tau",
        "tauDecay",
        "instar",
        "biDirectional",
        "manualWeights",
        "rewardDuration",
    }
    assert all("default" in line.why for line in done.report.losses if line.part == "parameter")
    assert [(line.verdict, line.where) for line in done.report.lines if line.what == "HebbianConnection"] == [
        ("approximated", "it")
    ]
    plain = Sim(
        [
            (a, k, p | ({"onTimes": np.array(p["onTimes"])} if "onTimes" in p else {}), i)
            for a, k, p, i in parts
        ]
    )
    record = dd.simulate(
        done.model, 12, record=["v.activation", "it.output", "it.weights"], precision="float64"
    )
    for step in range(1, 13):
        plain.step()
        assert np.allclose(
            record["v.activation"].isel(time=step).values,
            plain.out["v"]["activation"].ravel(),
            rtol=0,
            atol=1e-9,
        ), step
    assert np.allclose(record["it.weights"].values[-1].T.ravel(), plain.memory["it"].ravel(), atol=1e-9)
    assert abs(plain.memory["it"]).max() > 0.1
