"""The package in examples/package: check, run, experiment and the studio find its kinds without an option."""

from __future__ import annotations

import dataclasses
import json
import sys
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar import registry
from deodar_studio.views.view import kinds
from tests.command_line import typed
from tests.deodar.experiments.calls import run_alone

pytestmark = pytest.mark.usefixtures("example")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Write a document that names the kind of the package, as another tool may write it."""
    elements = {
        "step": {"kind": "Boost", "amplitude": 1.0},
        "change": {"kind": "Change", "tau": 50.0},
        "eye": {"kind": "Sensor", "sensor": "light"},
    }
    connections = [{"source": "step", "target": "change"}]
    path = tmp_path / "step.json"
    path.write_text(json.dumps({"deodar": 3, "elements": elements, "connections": connections}))
    return path


def test_nothing_is_imported_before_a_kind_is_looked_up() -> None:
    assert registry.kind("Field") is dd.Field
    assert typed("examples").status == 0
    assert not [name for name in sys.modules if name.startswith("deodar_change")]
    assert registry.kind("Change").__module__ == "deodar_change.change"
    assert "deodar_change.lamp" not in sys.modules and "deodar_change.command" not in sys.modules


def test_check_and_run_find_the_kind_and_the_world(file: Path, tmp_path: Path) -> None:
    assert typed("check", file).status == 0
    options = "--duration 200 --record change.output eye.output --world lamp:100 --no-progress --out"
    command = typed("run", file, options, out := tmp_path / "run.zarr")
    assert command.status == 0, command.err
    record = dd.load_record(out)
    # Euler's z after 50 steps of 1 ms
    np.testing.assert_allclose(record["change.output"].values[50], (1 - 1 / 50) ** 50, rtol=1e-4)
    assert record["eye.output"].values[[50, 150]].tolist() == [0.0, 10.0]


@pytest.mark.parametrize(
    ("world", "message"),
    [
        ("lamp", "--world lamp: needs an argument. Write lamp:ARGUMENT; deodar elements Lamp describes it"),
        ("lamp:x", "lamp: needs the time at which it is switched on, in ms, not 'x'. Write lamp:100"),
    ],
    ids=["no argument", "a wrong argument"],
)
def test_a_world_that_cannot_be_opened_states_what_to_type(world: str, message: str, file: Path) -> None:
    command = typed("run", file, f"--duration 1 --world {world}")
    assert command.status == 1 and command.err.strip() == f"deodar run: {message}"


@pytest.fixture
def experiment(tmp_path: Path) -> Path:
    """Write an experiment whose model and measures use the package: a field that the detector drives."""
    x = {"x": {"name": "x", "lower": 0.0, "upper": 20.0, "samples": 41}}
    elements = {
        "step": {"kind": "GaussianStimulus", "axes": ["x"], "center": 10.0, "sigma": 2.0, "amplitude": 20.0},
        "change": {"kind": "Change", "axes": ["x"], "tau": 50.0},
        "field": {"kind": "Field", "axes": ["x"], "tau": 5.0},
        "eye": {"kind": "Sensor", "sensor": "light"},
    }
    connections = [{"source": "step", "target": "change"}, {"source": "change", "target": "field"}]
    model = {"deodar": 3, "dt": 1.0, "axes": x, "elements": elements, "connections": connections}
    (tmp_path / "model.json").write_text(json.dumps(model))
    data = {
        "experiment": 3,
        "name": "step",
        "model": "model.json",
        "limit": 30.0,
        "world": "lamp:10",
        "conditions": {"lit": {"kind": "Crosses", "of": "eye.output", "level": 5.0, "ends": False}},
        "measures": {
            "first": {"kind": "Width", "of": "field", "when": "lit", "threshold": 5.0},
            "width": {"kind": "Width", "of": "field", "threshold": 5.0},
            "none": {"kind": "Width", "of": "field", "threshold": 1000.0},
            "highest": {"of": "field"},
        },
    }
    path = tmp_path / "step.experiment.json"
    path.write_text(json.dumps(data))
    return path


def test_an_experiment_with_the_kind_the_world_and_the_measure_runs(experiment: Path, tmp_path: Path) -> None:
    command = typed("experiment", experiment, "--no-progress --out", tmp_path / "out")
    assert command.status == 0, command.err
    table = dd.load_results(tmp_path / "out")
    trial = run_alone(
        dd.load(tmp_path / "model.json"), 30, watch=["field"], world=registry.kind("Lamp")(10), dt=1
    )
    u = trial.values["field"]
    for name, look in (("first", int(table["lit"][0])), ("width", 30)):
        assert table[name].values.tolist() == [0.5 * (u[look] > 5).sum()]
    assert table["first"] != table["width"] and table["width"] > 0
    assert np.isnan(table["none"].values).all()
    np.testing.assert_allclose(table["highest"].values, [u[30].max()])


def test_an_experiment_with_a_measure_of_a_package_is_written_and_batched(
    experiment: Path, tmp_path: Path
) -> None:
    loaded = dd.Experiment.load(experiment)
    loaded.save(tmp_path / "again.json")
    assert (
        json.loads((tmp_path / "again.json").read_text())["measures"]
        == (json.loads(experiment.read_text())["measures"])
    )
    assert "Width" in json.dumps(dd.Experiment.schema()["properties"]["measures"])
    plan = dataclasses.replace(loaded.plan, events=(), measures=loaded.plan.measures[1:])
    together = dataclasses.replace(loaded, world="", plan=plan, trials=2, model=_without_eye(tmp_path))
    assert together.setup().batched
    alone = run_alone(together.model, 30, measures=plan.measures)
    assert together.run()["width"].values.tolist() == [alone.measures["width"]] * 2


def _without_eye(folder: Path) -> dd.Model:
    model = dd.load(folder / "model.json")
    model.remove("eye")
    return model


def test_a_misspelt_measure_suggests_that_of_the_package(experiment: Path) -> None:
    experiment.write_text(experiment.read_text().replace("Width", "Widht"))
    with pytest.raises(dd.errors.DocumentError, match=r"Did you mean 'Width'\?"):
        dd.Experiment.load(experiment)


def test_the_figure_of_the_package_is_a_kind_of_plot(file: Path, tmp_path: Path) -> None:
    record = tmp_path / "run.zarr"
    run = dd.simulate(
        dd.load(file), 20, record=["change.output", "step.output"], world=registry.kind("Lamp")()
    )
    dd.save_record(run, record)
    drawn = typed("plot", record, "change.output --kind histogram --json --out", tmp_path / "plot.svg")
    assert drawn.status == 0 and drawn.json["kinds"] == {"change.output": "histogram"}
    assert "number of values" in (tmp_path / "plot.svg").read_text()
    assert typed("plot", record, "--kind histogram --out", tmp_path / "both.svg").status == 0
    misspelt = typed("plot", record, "--kind histogran --out", tmp_path / "no.svg")
    assert misspelt.status == 1 and "Did you mean 'histogram'?" in misspelt.err


def test_a_figure_of_a_package_is_drawn_only_by_its_name() -> None:
    from deodar.figures import _panels

    assert "histogram" not in _panels.kinds()
    assert not [name for name in sys.modules if name.startswith("deodar_change")]


def test_the_studio_lists_the_kind_and_the_world() -> None:
    rooms = {kind.name: kind.room for kind in kinds()}
    assert rooms["Change"] == "own" and rooms["Lamp"] == "worlds"


def test_the_list_of_elements_shows_the_kind_and_the_world() -> None:
    command = typed("elements --json")
    assert command.status == 0
    assert list(command.json["own"]) == ["Change"] and "Lamp" in command.json["worlds"]


def test_the_command_of_the_package_runs() -> None:
    command = typed("change --tau 200")
    assert command.status == 0 and command.out.splitlines()[:2] == ["0 ms: 1.000", "100 ms: 0.606"]
    assert "print how the detector of change answers" in typed("--help").out


def test_doctor_lists_what_the_package_adds() -> None:
    command = typed("doctor")
    assert command.status == 0
    added = ("kinds Change", "worlds Lamp", "measures Width", "figures histogram")
    assert [line for line in command.out.splitlines() if line.startswith("plug-in")] == [
        f"plug-in    deodar-change 0.1.0: {part}" for part in (*added, "plots polar", "commands change")
    ]
