"""`deodar plan FILE`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import deodar as dd
from deodar import cli


@pytest.fixture
def volume(tmp_path: Path) -> Path:
    """Return the file of a field over three axes of 32 samples."""
    model, path = dd.Model("volume"), tmp_path / "volume.json"
    axes = [dd.Axis(name, 0, 32, samples=32, periodic=True) for name in "xyz"]
    model.add(dd.Field("u", axes, kernel=[dd.Gaussian(12, 3, normalized=True)]))
    dd.save(model, path)
    return path


def test_the_plan_names_groups_methods_and_calls(volume: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["plan", str(volume)]) == 0
    text = capsys.readouterr().out
    assert "group 0: 1 x Field every 1: u" in text and "periodic periodic periodic: waves" in text
    assert cli.main(["plan", str(volume), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["plan"] == text.splitlines()


def test_the_plan_of_several_devices_states_axis_traffic_and_memory(
    volume: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The devices need not be there."""
    assert cli.main(["plan", str(volume), "--devices", "8"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("8 devices divide the axis x: 32 samples, 4 on each\n  u: waves, ")
    assert "\ntraffic: " in text and "\nmemory: at most about " in text
    assert cli.main(["plan", str(volume), "--devices", "8", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert (answer["axis"], answer["samples"], answer["devices"]) == ("x", 32, 8)
    assert answer["bytes"] == sum(e["bytes"] for e in answer["elements"]) and f"{answer['bytes']:,}" in text
    assert cli.main(["plan", str(volume), "--devices", "2", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["memory"] > answer["memory"]


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["--devices", "7"], "u: no axis can be divided into 7 equal parts"),
        (["--devices", "0"], "devices is 0; expected a number of devices"),
        (["--devices", "4", "--precision", "float64"], "by matrices along the axis 'x'"),
        (["--devices", "4", "--accuracy", "exact"], "by matrices along the axis 'x'"),
    ],
)
def test_what_cannot_be_divided_is_an_error(
    arguments: list[str], text: str, volume: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["plan", str(volume), *arguments]) == 1
    assert text in capsys.readouterr().err
