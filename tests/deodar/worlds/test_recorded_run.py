"""A recorded run as a world: open loop, exact."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import WorldError
from deodar.recording import files
from deodar.recording.opened import opened
from deodar.recording.repeat import repeat
from deodar.worlds.arena.arena import Arena
from deodar.worlds.picture import Picture
from deodar.worlds.recorded_run import Recording

EIGHT = dd.Axis("sensor", 0, 7, 8)


def driving() -> dd.Model:
    """Return a field of eight samples that reads the infrared sensors, and drives."""
    model = dd.Model("driving", dt=16)
    eyes = model.add(Sensor("eyes", [EIGHT], "infrared"))
    u = model.add(dd.Field("u", [EIGHT], tau=50, noise=0.3))
    eyes >> dd.Gain(0.01) >> u
    for name, speed in (("left", 300.0), ("right", 330.0)):
        wheel = model.add(Motor(name, [], name))
        model.add(Boost(f"go {name}", [], speed)) >> wheel
        u >> dd.Project([], "mean") >> dd.Gain(20.0) >> wheel
    return model


def recorded(**options: Any) -> Any:
    return dd.simulate(
        driving(),
        640,
        record=["eyes.output", "u.activation", "left.output"],
        seed=4,
        world=Arena("blocks"),
        **options,
    )


@pytest.fixture(scope="module")
def run() -> Any:
    return recorded()


def test_a_model_in_a_replayed_world_repeats_its_run(run: Any) -> None:
    record = dd.simulate(
        driving(), 640, record=["eyes.output", "u.activation", "left.output"], seed=4, world=Recording(run)
    )
    np.testing.assert_array_equal(run["eyes.output"].values, record["eyes.output"].values)
    for name in run.data_vars:  # another program: it may add in another order
        np.testing.assert_allclose(run[name].values, record[name].values, rtol=1e-5)


def test_a_replay_in_double_precision_agrees_to_1e_10() -> None:
    run = recorded(precision="float64")
    record = dd.simulate(
        driving(), 640, record=["u.activation"], seed=4, world=Recording(run), precision="float64"
    )
    np.testing.assert_allclose(run["u.activation"].values, record["u.activation"].values, atol=1e-10)


def test_a_record_at_the_period_of_the_world_is_sufficient_for_a_replay(run: Any) -> None:
    sparse = run[["eyes.output"]].isel(time=slice(None, None, 4))
    sparse.attrs = run.attrs
    record = dd.simulate(driving(), 640, record=["u.activation"], seed=4, world=Recording(sparse))
    np.testing.assert_allclose(run["u.activation"].values, record["u.activation"].values, rtol=1e-5)


def test_a_replay_with_another_seed_has_the_same_sensor_readings(run: Any) -> None:
    record = dd.simulate(driving(), 640, record=["eyes.output", "u.activation"], seed=5, world=Recording(run))
    np.testing.assert_array_equal(run["eyes.output"].values, record["eyes.output"].values)
    assert np.abs(run["u.activation"].values - record["u.activation"].values).max() > 0.01


def test_a_replay_from_a_file_can_be_repeated_from_its_record(run: Any, tmp_path: Path) -> None:
    files.save_record(run, tmp_path / "run.zarr")
    world = opened(Recording, str(tmp_path / "run.zarr"))
    record = dd.simulate(driving(), 320, record=["u.activation"], seed=4, world=world)
    np.testing.assert_allclose(run["u.activation"].values[:21], record["u.activation"].values, rtol=1e-5)
    repeated = repeat(record, dd.simulate)
    assert repeated.same_bits and not repeated.differences


def test_a_run_in_an_arena_is_repeated_from_its_record(run: Any) -> None:
    repeated = repeat(run, dd.simulate)
    assert repeated.same_bits and not repeated.differences


def test_each_trial_replays_its_own_record() -> None:
    example = Recording.example()
    x = Recording.example_axes("light")
    example.reset(0, [5, 0, 5])
    assert example.sense("light", x, 8.0)[:, 0].tolist() == [110, 10, 110]
    with pytest.raises(WorldError, match=r"holds no trial 3\. Valid trials: 0, 5"):
        example.reset(0, [3])


def test_records_that_cannot_be_replayed_are_refused(run: Any) -> None:
    with pytest.raises(WorldError, match="ends at 640 ms, and the run continues to 704 ms"):
        dd.simulate(
            driving(), 1280, record=["u.activation"], world=Recording(run.isel(time=slice(None, None, 4)))
        )
    with pytest.raises(WorldError, match="holds the output of no sensor"):
        Recording(run[["u.activation"]].assign_attrs(run.attrs))
    with pytest.raises(WorldError, match="does not state the model that made it"):
        Recording(run[["eyes.output"]].assign_attrs({}).drop_attrs())
    with pytest.raises(WorldError, match="is not a record"):
        Recording(run["eyes.output"])
    model = dd.Model("other")
    model.add(Sensor("eye", Picture.example_axes("picture"), "picture"))
    with pytest.raises(
        WorldError,
        match=r"no sensor 'picture'\. It has: infrared|no sensor 'picture'\. Valid names: infrared",
    ):
        dd.Session(model, world=Recording(run))
