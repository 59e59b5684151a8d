"""`deodar export`: every format, and what does not fit together."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import deodar as dd
from deodar.cli import main
from deodar.elements.world_ports import Sensor
from deodar.recording import files
from tests.deodar.experiments.robots import room, straight
from tests.deodar.recording.models import record


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    files.save_record(record(trials=2), "run.zarr")
    return tmp_path


@pytest.mark.parametrize(
    ("arguments", "written"),
    [
        (["--out", "a.nc"], "a.nc"),
        (["--out", "a.csv"], "a.csv"),
        (["--out", "a.zarr"], "a.zarr"),
        (["--to", "netcdf"], "run-export-001.nc"),
    ],
)
def test_values_are_written_in_each_format(
    folder: Path, arguments: list[str], written: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        main(
            ["export", "run.zarr", "u", "n.activation", "--trial", "1", "--time-range", "5", "15", *arguments]
        )
        == 0
    )
    assert f"Wrote u.activation, n.activation to {written}" in capsys.readouterr().out
    part = record(trials=2)[["u.activation", "n.activation"]].sel(trial=1, time=[5, 10, 15])
    if written.endswith((".nc", ".zarr")):
        assert files.load_record(written).equals(part)
    else:
        rows = Path(written).read_text().splitlines()
        assert rows[0].startswith("time,") and len(rows) == 1 + 3 + 3 * 11


def test_values_are_thinned(folder: Path) -> None:
    assert main(["export", "run.zarr", "n.activation", "--every", "10", "--out", "a.nc"]) == 0
    assert files.load_record("a.nc").equals(record(trials=2)[["n.activation"]].sel(time=[0, 10, 20]))


def test_videos_are_written_in_each_format(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plot = ["export", "run.zarr", "u.activation", "--trial", "0", "--width", "200"]
    assert main([*plot, "--kind", "snapshot", "--out", "u.gif", "--every", "10", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {
        "out": "u.gif",
        "format": "gif",
        "variables": ["u.activation"],
    }
    with Image.open("u.gif") as video:
        assert getattr(video, "n_frames", 1) == 3 and video.width == 200
    assert main([*plot, "--out", "u.mp4"]) == 0 and Path("u.mp4").stat().st_size > 1000
    assert main([*plot, "--to", "png"]) == 0
    assert [p.name for p in sorted(Path("run-export-001").iterdir())] == [
        f"frame-{n:05}.png" for n in range(1, 6)
    ]
    Path("figure.toml").write_text('[[panel]]\nvariable = "n.activation"\n')
    assert main(["export", "figure.toml", "run.zarr", "--to", "gif", "--width", "200"]) == 0
    assert Path("figure-export-001.gif").exists()


def test_the_world_is_shown_with_the_path(folder: Path) -> None:
    model = straight()
    model.add(Sensor("pose", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
    files.save_record(dd.simulate(model, 40, record="pose.output", world=room()), "drive.zarr")
    drive = ["export", "drive.zarr", "pose.output", "--kind", "path", "--every", "10", "--width", "200"]
    assert main([*drive, "--out", "drive.gif"]) == 0
    with Image.open("drive.gif") as video:
        assert getattr(video, "n_frames", 1) >= 4
        first = np.asarray(video.convert("RGB"), float)
        video.seek(3)
        assert np.abs(np.asarray(video.convert("RGB")) - first).max() > 50


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        (["run.zarr"], 2, "the format is missing"),
        (["run.zarr", "-o", "a.avi"], 2, "the format is missing"),
        (["run.zarr", "--to", "gif", "-o", "a.mp4"], 2, "--to gif needs a name that ends in .gif"),
        (["run.zarr", "--to", "png", "-o", "a.gif"], 2, "--to png needs the name of a folder"),
        (["run.zarr", "-o", "a.nc", "--kind", "snapshot"], 2, "--kind selects what is drawn"),
        (["run.zarr", "-o", "a.nc", "--speed", "5"], 2, "--speed selects what is drawn"),
        (["figure.toml", "-o", "a.nc"], 2, "writes the values of a record"),
        (["run.zarr", "-o", "a.gif", "--speed", "0"], 2, "--speed"),
        (["run.zarr", "n.activation", "-o", "a.gif", "--width", "5"], 1, "the width is 5"),
        (["run.zarr", "m", "-o", "a.nc"], 1, "no variable 'm'"),
        (["none.zarr", "-o", "a.nc"], 1, "there is no such record"),
        (["run.zarr", "-o", "below/a.nc"], 1, "does not exist"),
    ],
)
def test_invalid_calls_of_export_are_errors_and_write_nothing(
    folder: Path, arguments: list[str], status: int, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    before = sorted(folder.iterdir())
    if status == 2:
        with pytest.raises(SystemExit) as ended:
            main(["export", *arguments])
        assert ended.value.code == 2
    else:
        assert main(["export", *arguments]) == 1
    error = capsys.readouterr().err
    assert says in error and "Traceback" not in error, error
    assert sorted(folder.iterdir()) == before
