"""Options that several commands share: cores, workers, device."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import deodar as dd
from deodar.cli import main
from deodar.cli._options import pair
from deodar.recording import files
from deodar.recording.record import about


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    model, x = dd.Model("small"), dd.Axis("x", 0, 20, samples=11, unit="deg")
    model.add(dd.Field("u", [x], tau=10, kernel=[dd.Gaussian(1, 3)], noise=0.5))
    model.add(dd.GaussianStimulus("s", [x], center=10, sigma=3, amplitude=7)) >> model["u"]
    dd.save(model, "small.json")
    return tmp_path


def run(*arguments: str) -> tuple[int, str]:
    """Return status and errors of a command in a process of its own."""
    environment = {k: v for k, v in os.environ.items() if k != "NPROC"}
    done = subprocess.run(
        [sys.executable, "-m", "deodar", *arguments],
        capture_output=True,
        text=True,
        timeout=600,
        env=environment,
    )
    return done.returncode, done.stderr


def test_a_run_uses_one_core_by_default_and_a_repetition_those_of_the_record(folder: Path) -> None:
    assert run("run", "small.json", "--duration", "5", "--out", "one") == (0, "")
    assert run("run", "small.json", "--duration", "5", "--out", "two", "--cores", "2") == (0, "")
    assert run("run", "two", "--out", "again") == (0, "")
    assert [
        about(files.load_record(folder / name))["made_by"]["cores"] for name in ("one", "two", "again")
    ] == ["1", "2", "2"]
    status, says = run("run", "two", "--out", "less", "--cores", "1")
    assert status == 0 and "cores: 2 then, 1 now" in says
    assert main(["run", "small.json", "--duration", "5", "--cores", "0"]) == 1


@pytest.mark.parametrize("text", ["u.tau", "=3", "u.tau="])
def test_a_setting_without_path_or_number_is_refused(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="is not of the form PATH=VALUE"):
        pair(text)


def test_workers_share_trials(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        main(
            [
                "run",
                "small.json",
                "--duration",
                "5",
                "--trials",
                "4",
                "--workers",
                "2",
                "--out",
                "shared",
                "--json",
            ]
        )
        == 0
    )
    assert json.loads(capsys.readouterr().out)["variables"]["u.activation"]["trial"] == 4
    assert about(files.load_record(folder / "shared"))["workers"] == 2
    with pytest.raises(SystemExit):
        main(["run", "shared", "--workers", "3"])
    assert "--workers cannot be given" in capsys.readouterr().err


def test_a_device_is_named_and_an_unknown_one_is_refused(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "small.json", "--duration", "5", "--device", "cpu:0", "--out", "named"]) == 0
    assert about(files.load_record(folder / "named"))["device"] == "cpu:0"
    assert main(["run", "small.json", "--duration", "5", "--device", "quantum"]) == 1
    assert "this computer has no device 'quantum'; valid names: cpu:0" in capsys.readouterr().err
    assert main(["doctor", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["devices"]["cpu:0"] == "cpu"
