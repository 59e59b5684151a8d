"""`deodar plot`: each kind of figure, from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import deodar as dd
from deodar.batch.run_file import CHECKPOINT
from deodar.cli import main, plot
from deodar.elements.world_ports import Sensor
from deodar.recording import files, writer_lock
from deodar.recording.growing import GrowingRecord
from tests.deodar.experiments.robots import room, straight
from tests.deodar.recording.models import record, x, y


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    files.save_record(record(trials=3), "small.zarr")
    deep = dd.Model("deep")
    deep.add(dd.Field("w", [x, y, dd.Axis("z", 0, 4, samples=5)], noise=0.3))
    files.save_record(dd.simulate(deep, 20, record=["w.activation"], every=10), "deep.zarr")
    return tmp_path


@pytest.mark.parametrize(
    ("arguments", "kind"),
    [
        (["small.zarr", "n.activation"], "time_course"),
        (["small.zarr", "u.activation", "--trial", "0"], "space_time"),
        (["small.zarr", "u.activation", "--kind", "snapshot", "--at", "10"], "snapshot"),
        (["small.zarr", "u.activation", "--kind", "snapshots", "--at", "0", "10", "20"], "snapshots"),
        (["small.zarr", "u.activation", "--kind", "time_course", "--place", "10"], "time_course"),
        (["deep.zarr", "--kind", "projection", "--axes", "x", "y"], "projection"),
        (["deep.zarr"], "projection"),
    ],
)
def test_each_kind_of_figure_is_drawn(
    folder: Path, arguments: list[str], kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plot", *arguments, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert set(answer["kinds"].values()) == {kind}
    with Image.open(answer["out"]) as picture:
        assert min(picture.size) > 300 and len(np.unique(np.asarray(picture.convert("L")))) > 5


def test_each_where_selects_along_its_own_sweep(folder: Path) -> None:
    swept = record(sweep={"s.amplitude": [4.0, 8.0], "n.resting_level": [-1.0, -3.0]})
    files.save_record(swept[["n.activation"]], "swept.zarr")
    command = ["plot", "swept.zarr", "n.activation", "--where", "s.amplitude=8", "--where"]
    for name, level in (("a.png", -1), ("b.png", -3)):
        assert main([*command, f"n.resting_level={level}", "-o", name]) == 0
    assert (folder / "a.png").read_bytes() != (folder / "b.png").read_bytes()


def test_vector_graphics_hold_real_text_and_units(folder: Path) -> None:
    assert main(["plot", "small.zarr", "-o", "all.svg"]) == 0
    text = (folder / "all.svg").read_text()
    assert "time (ms)" in text and "x (deg)" in text and "activation" in text
    assert (
        main(["plot", "small.zarr", "-o", "all.svg"]) == 1
        and main(["plot", "small.zarr", "-o", "all.svg", "--force"]) == 0
    )


@pytest.mark.parametrize("reduce", ["maximum", "integral"])
def test_a_projection_is_labelled_with_its_reduction(folder: Path, reduce: str) -> None:
    assert main(["plot", "deep.zarr", "--axes", "x", "z", "--reduce", reduce, "-o", "deep.svg"]) == 0
    assert f"{reduce} over y of " in (folder / "deep.svg").read_text()


def test_the_same_record_gives_the_same_file(folder: Path) -> None:
    for name in ("a.svg", "b.svg"):
        assert main(["plot", "small.zarr", "u.activation", "--trial", "1", "-o", name]) == 0
    assert (folder / "a.svg").read_bytes() == (folder / "b.svg").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["nothing.zarr"], "nothing.zarr"),
        (["small.zarr", "u.actvation"], "Did you mean"),
        (["small.zarr", "--kind", "spacetime"], "Did you mean"),
        (["small.zarr", "u.activation", "--at", "999"], "999"),
        (["small.zarr", "-o", "picture.gif"], ".png"),
        (["small.zarr", "u.activation", "--trial", "7"], "trial"),
    ],
)
def test_invalid_calls_of_plot_are_errors_and_write_nothing(
    folder: Path, arguments: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    before = sorted(folder.iterdir())
    assert main(["plot", *arguments]) == 1
    error = capsys.readouterr().err
    assert says in error and "Traceback" not in error, error
    assert sorted(folder.iterdir()) == before


def test_a_path_is_drawn_in_its_arena_and_as_an_animation(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = straight()
    model.add(Sensor("pose", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
    files.save_record(dd.simulate(model, 40, record="pose.output", world=room()), "drive.zarr")
    assert main(["plot", "drive.zarr", "pose.output", "--gif", "drive.gif", "--out", "drive.png"]) == 0
    assert "drive.gif" in capsys.readouterr().out
    with Image.open("drive.gif") as film, Image.open("drive.png") as figure:
        assert getattr(film, "n_frames", 1) == 41 and figure.width > figure.height
    assert (
        main(
            [
                "plot",
                "drive.zarr",
                "pose.output",
                "--gif",
                "drive.gif",
                "--force",
                "--json",
                "--out",
                "again.png",
            ]
        )
        == 0
    )
    assert json.loads(capsys.readouterr().out)["gif"] == "drive.gif"
    assert main(["plot", "small.zarr", "--gif", "no.gif"]) == 1
    assert "a video shows one variable" in capsys.readouterr().err
    assert main(["plot", "small.zarr", "n.activation", "--gif", "no.gif"]) == 1
    assert "made without a world" in capsys.readouterr().err


def test_a_growing_record_is_drawn_until_it_is_complete(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    whole = record(record=["n.activation"])
    provenance = json.loads(whole.attrs["deodar"])
    growing = whole.assign_attrs(deodar=json.dumps(provenance | {"complete": False}))
    stages = [growing.isel(time=slice(0, n)) for n in (0, 3, 3, 4)] + [whole]
    figures: list[bytes | None] = []

    def grow(seconds: float) -> None:
        assert seconds == 0.5
        figures.append(Path("n.svg").read_bytes() if Path("n.svg").exists() else None)
        files.save_record(stages.pop(0), "run.zarr", force=True)

    monkeypatch.setattr(plot.time, "sleep", grow)
    assert (
        main(["plot", "run.zarr", "--kind", "time_course", "--follow", "--interval", "0.5", "-o", "n.svg"])
        == 0
    )
    assert not stages and "Drew n.activation into n.svg" in capsys.readouterr().out
    assert figures[:2] == [None, None] and figures[2] == figures[3] is not None
    figures.append(Path("n.svg").read_bytes())
    assert len(set(figures[2:])) == 3
    assert main(["plot", "run.zarr", "--kind", "time_course", "-o", "once.svg"]) == 0
    assert Path("once.svg").read_bytes() == figures[-1]


def test_following_ends_when_the_run_was_killed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(writer_lock, "CERTAIN_SECONDS", 0.02)
    whole = record(record=["n.activation"])
    writer = GrowingRecord(Path("run.zarr"), whole.isel(time=slice(0)))
    part = whole.isel(time=slice(0, 3))
    writer.put("time", part["time"].values, {"n.activation": part["n.activation"].values})
    writer.commit()
    rounds: list[float] = []
    sleep = plot.time.sleep

    def passing(seconds: float) -> None:
        sleep(seconds)
        rounds.append(seconds)
        if len(rounds) == 5:
            writer.abandon()

    with monkeypatch.context() as patched:
        patched.setattr(plot.time, "sleep", passing)
        words = ["plot", "run.zarr", "--kind", "time_course", "--follow", "--interval", "0.03"]
        assert main([*words, "-o", "n.svg"]) == 0
    assert len(rounds) > 5, "a writer that lives is waited for"
    printed = capsys.readouterr()
    assert "Drew n.activation into n.svg" in printed.out
    assert (
        "run.zarr is incomplete, and no process writes it any more" in printed.err
        and "--resume" not in printed.err
    )
    (tmp_path / "run.zarr" / CHECKPOINT).touch()
    assert main([*words, "-o", "again.svg"]) == 0
    assert "deodar run run.zarr --resume continues it" in capsys.readouterr().err
    GrowingRecord(Path("empty.zarr"), whole.isel(time=slice(0))).abandon()
    assert main(["plot", "empty.zarr", "--follow", "--interval", "0.03"]) == 1
    assert "stopped before the record held a sample" in capsys.readouterr().err


def test_following_ends_with_ctrl_c(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def stop(seconds: float) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(plot.time, "sleep", stop)
    assert main(["plot", "later.zarr", "--follow"]) == 0
    assert "before the record held a sample" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main(["plot", "small.zarr", "--follow", "--gif", "a.gif"])
    with pytest.raises(SystemExit):
        main(["plot", "small.zarr", "--follow", "--interval", "0"])
