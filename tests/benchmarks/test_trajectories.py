"""Some trajectories that `benchmarks/trajectories.py` stored are computed again, and a change is reported."""

from __future__ import annotations

import dataclasses as dc
import sys
from pathlib import Path

import numpy as np
import pytest

import deodar as dd

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import trajectories
from trajectory_models import Scene, Table, scenes, tables

SCENES = scenes()
SOME = (
    "example selection",
    "example timed_stimuli",
    "contract Interaction",
    "contract SteeredShift",
    "imported presetOneLayerField_memory",
)
"""Models that compile fast."""


@pytest.fixture(scope="module")
def stored() -> trajectories.Stored:
    return trajectories.Stored.read()


@pytest.mark.parametrize("name", SOME)
def test_a_model_has_its_stored_trajectory(name: str, stored: trajectories.Stored) -> None:
    values = trajectories.compare(name, SCENES[name], stored.models[name], stored.values[name], ["float64"])
    assert not values.problems
    assert values.largest["float64"][0] <= trajectories.LIMITS["float64"]


def test_the_events_of_an_experiment_have_their_stored_times(stored: trajectories.Stored) -> None:
    name = "experiment decider"
    assert not trajectories.compare(name, tables()[name], stored.models[name], {}, ["float64"]).problems


def changed(path: str, value: float) -> Scene:
    """The example `selection` with another value of a parameter."""

    def build() -> dd.Model:
        model = dd.load("example:selection")
        model.set(path, value)
        return model

    return dc.replace(SCENES["example selection"], build=build)


def test_a_parameter_changed_by_a_millionth_is_reported(stored: trajectories.Stored) -> None:
    name = "example selection"
    scene = changed("u.tau", dd.load("example:selection").get("u.tau") * (1 + 1e-6))
    problems = trajectories.compare(
        name, scene, stored.models[name], stored.values[name], ["float64"]
    ).problems
    assert any("another document" in p for p in problems) and any("above 1e-10" in p for p in problems)


def test_documents_that_differ_only_in_notes_are_equal(stored: trajectories.Stored) -> None:
    model = dd.load("example:selection")
    model.describe(notes="Other words.")
    before = stored.models["example selection"]
    assert "Other words" not in before["document"]
    assert not list(trajectories._documents(model, before))


def test_a_changed_id_and_its_noise_are_reported(stored: trajectories.Stored) -> None:
    name, before = "example selection", stored.models["example selection"]
    before = before | {"ids": before["ids"] | {"u": "00000000"}, "noise": {"u": "0" * 12}}
    problems = trajectories.compare(name, SCENES[name], before, stored.values[name], ["float64"]).problems
    assert [p.split(":")[0] for p in problems] == ["id of u", "noise of u"]


def test_an_event_at_another_time_is_reported() -> None:
    table = Table(lambda precision: {"detected": [3.0, None], "end": [1.0, 2.0]}, ("detected",), ("float64",))
    before, _ = trajectories.computed("t", table)
    assert not trajectories.compare("t", table, before, {}).problems
    later = dc.replace(table, numbers=lambda precision: {"detected": [4.0, None], "end": [1.0, 2.0 + 1e-9]})
    assert len(trajectories.compare("t", later, before, {}).problems) == 2


def test_a_full_name_selects_one_model_and_a_part_all_that_contain_it(stored: trajectories.Stored) -> None:
    assert trajectories.chosen(["example projection"]).keys() == {"example projection"}
    assert trajectories.stored_names(stored, ["example projection"]) == ["example projection"]
    assert trajectories.stored_names(stored, ["projection to"]) == ["example projection to the end"]
    copied = dc.replace(stored, models={"example older": {}, "example projection": {}})
    assert (
        trajectories.stored_names(copied, ["example older"]) == ["example older"]
        and len(trajectories.stored_names(copied, [])) == 2
    )


def test_a_difference_is_relative_to_the_port_and_a_missing_value_is_infinite() -> None:
    one = np.array([1.0, -200.0, np.nan])
    assert trajectories.difference(one, one) == 0
    assert trajectories.difference(one, one + 1e-3) == pytest.approx(5e-6)
    assert trajectories.difference(one, np.nan_to_num(one)) == np.inf


def test_values_are_read_with_the_bits_that_were_written(tmp_path: Path) -> None:
    double = np.random.default_rng(0).normal(size=(3, 5))
    values = {
        "m": {
            "float64": {"u mean": double, "n": double[0]},
            "float32": {"u mean": (double * (1 + 1e-7)).astype("f4"), "n": -double[0].astype("f4")},
        }
    }
    written = trajectories.Stored(
        {"models": 1}, {"m": {"name": "m"}, "t": {"name": "t", "numbers": {}}}, values
    )
    written.write(tmp_path)
    reading = trajectories.Stored.read(tmp_path)
    assert reading.models == written.models and reading.about == written.about
    for precision, rows in values["m"].items():
        for row, array in rows.items():
            assert reading.values["m"][precision][row].dtype == precision
            np.testing.assert_array_equal(reading.values["m"][precision][row], array)


def test_every_stored_model_states_its_versions_and_can_be_run(stored: trajectories.Stored) -> None:
    for body in stored.models.values():
        maker = stored.about["made_by"][body["made_by"]]
        assert {
            "commit",
            "deodar",
            "jax",
            "jaxlib",
            "numpy",
            "python",
            "machine",
            "cores",
        } <= maker.keys() and "changes" not in maker["commit"]
    assert sum(p.stat().st_size for p in trajectories.FOLDER.iterdir()) < 3e6
    assert stored.models.keys() <= {*SCENES, *tables()}, "every stored model can be run"
