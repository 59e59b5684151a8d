"""The package in examples/package: check, run, experiment and the studio know what it brings, without a
flag.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar import registry
from deodar.cli import main
from deodar.server.view import kinds

pytestmark = pytest.mark.usefixtures("example")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A document that names the kind of the package, as another tool might write it."""
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
    assert main(["examples"]) == 0
    assert not [name for name in sys.modules if name.startswith("deodar_change")]
    assert registry.kind("Change").__module__ == "deodar_change.change"
    assert "deodar_change.lamp" not in sys.modules and "deodar_change.command" not in sys.modules


def test_check_and_run_know_the_kind_and_the_world(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", str(file)]) == 0
    out = tmp_path / "run.zarr"
    given = [
        "--duration",
        "200",
        "--record",
        "change.output",
        "eye.output",
        "--world",
        "lamp:100",
        "--out",
        str(out),
        "--no-progress",
    ]
    assert main(["run", str(file), *given]) == 0, capsys.readouterr().err
    record = dd.load_record(out)
    np.testing.assert_allclose(
        record["change.output"].values[50], (1 - 1 / 50) ** 50, rtol=1e-4
    )  # Euler's z after 50 steps of 1 ms
    assert record["eye.output"].values[[50, 150]].tolist() == [0.0, 10.0]


def test_an_experiment_knows_the_kind(file: Path) -> None:
    experiment = dd.Experiment(
        "step", str(file), 20, conditions=[dd.Crosses("answered", "change.output", 0.5)], world="lamp:100"
    )
    assert experiment.check() == []


def test_the_studio_knows_the_kind_and_the_world() -> None:
    rooms = {kind.name: kind.room for kind in kinds()}
    assert rooms["Change"] == "own" and rooms["Lamp"] == "worlds"


def test_the_list_of_elements_shows_the_kind_and_the_world(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["elements", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert list(listed["own"]) == ["Change"] and "Lamp" in listed["worlds"]


def test_its_command_is_a_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["change", "--tau", "200"]) == 0
    assert capsys.readouterr().out.splitlines()[:2] == ["0 ms: 1.000", "100 ms: 0.606"]
    with pytest.raises(SystemExit):
        main(["--help"])
    assert "print how the detector of change answers" in capsys.readouterr().out


def test_doctor_lists_what_it_brings(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor"]) == 0
    page = capsys.readouterr().out.splitlines()
    found = [line for line in page if line.startswith("plug-in")]
    assert found == [
        f"plug-in    deodar-change 0.1.0: {what}"
        for what in ("kinds Change", "worlds Lamp", "commands change")
    ]
