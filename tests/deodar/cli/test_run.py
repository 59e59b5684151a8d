"""`deodar run`: it makes a record from a document, and repeats a record."""

from __future__ import annotations

import io
import json
import os
import re
import signal
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.batch import simulate
from deodar.cli import _long, main
from deodar.recording import files
from deodar.recording.record import about
from deodar.session.pace import Pace
from deodar.session.run import Run
from tests.deodar.recording.models import model


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    dd.save(model(), "small.json")
    return tmp_path


def test_a_document_is_run_and_recorded(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        main(
            [
                "run",
                "small.json",
                "--duration",
                "20",
                "--every",
                "5",
                "--record",
                "u.activation",
                "n.activation",
                "--seed",
                "3",
            ]
        )
        == 0
    )
    assert "deodar plot small-001" in capsys.readouterr().out.splitlines()[-1]
    record = files.load_record(folder / "small-001")
    assert record["u.activation"].shape == (5, 11) and about(record)["seed"] == 3
    assert dd.load(folder / "small-001" / "model.json").document == model().document
    expected = dd.simulate(model(), 20, record=["u.activation"], every=5, seed=3)["u.activation"]
    assert np.array_equal(expected.values, record["u.activation"].values)
    assert main(["run", "small.json", "--duration", "5"]) == 0 and (folder / "small-002").is_dir()


def test_warnings_of_the_check_are_printed_and_do_not_prevent_the_run(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lonely, x = dd.Model("lonely"), dd.Axis("x", 0, 10, 11)
    fields = [lonely.add(dd.Field(name, [x])) for name in "abcd"]
    lonely.add(dd.GaussianStimulus("left", [x], center=5, sigma=2, amplitude=3)) >> fields[0]
    dd.save(lonely, "lonely.json")
    assert main(["run", "lonely.json", "--duration", "5"]) == 0
    lines = capsys.readouterr().err.splitlines()
    assert [line.split(":")[:2] for line in lines] == [["deodar run", " warning"]] * 4
    assert lines[-1] == "deodar run: warning: 1 more; type: deodar check lonely.json"


def test_options_set_step_parameters_sweep_and_format(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    call = [
        "run",
        "small.json",
        "--duration",
        "4",
        "--dt",
        "0.5",
        "--trials",
        "2",
        "--sweep",
        "s.amplitude=1,2,3",
        "--set",
        "u.tau=7",
    ]
    assert main([*call, "--precision", "float64", "--format", "netcdf", "--out", "out", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    record = files.load_record(folder / "out" / "record.nc")
    assert (
        record["u.activation"].dtype == np.float64
        and record.sizes["trial"] == 2
        and record.sizes["s.amplitude"] == 3
    )
    assert dd.load(folder / "out" / "model.json").get("u.tau") == 7 and answer["out"] == "out"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("points.csv", "s.amplitude,u.tau\n1,7\n2,9\n3,11\n"),
        ("points.json", '[{"s.amplitude": 1, "u.tau": 7}, {"s.amplitude": 2, "u.tau": 9},'
         ' {"s.amplitude": 3, "u.tau": 11}]'),
    ],
)  # fmt: skip
def test_a_list_of_points_is_read_from_a_file_and_run_again(
    folder: Path, capsys: pytest.CaptureFixture[str], name: str, text: str
) -> None:
    (folder / name).write_text(text)
    call = ["run", "small.json", "--duration", "4", "--points", name, "--own-noise", "--trials", "2"]
    assert main([*call, "--out", "out", "--json"]) == 0
    capsys.readouterr()
    record = files.load_record(folder / "out" / "record.zarr")
    assert dict(record["u.activation"].sizes)["point"] == 3 and record.sizes["trial"] == 2
    assert record["u.tau"].values.tolist() == [7, 9, 11]
    assert main(["run", "out/record.zarr", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["repetition"]["same_bits"] is True


def test_a_record_is_repeated_and_compared(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "small.json", "--duration", "20", "--every", "5", "--out", "first"]) == 0
    assert main(["run", "first", "--out", "second"]) == 0
    assert "same bits" in capsys.readouterr().out
    assert (
        files.load_record(folder / "first")
        .drop_attrs()
        .identical(files.load_record(folder / "second").drop_attrs())
    )
    assert main(["run", "first/record.zarr", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["repetition"]["same_bits"] is True


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        (["small.json"], 2, "--duration"),
        (["nothing.json", "--duration", "5"], 1, "no such file"),
        (["small.json", "--duration", "5", "--record", "u.actvation"], 1, "Did you mean"),
        (["small.json", "--duration", "5.5"], 1, "multiple"),
        (["small.json", "--duration", "5", "--dt", "50"], 1, "longer than the time constant"),
        (["small.json", "--duration", "5", "--set", "u.tua=3"], 1, "Did you mean"),
        (["small.json", "--duration", "5", "--sweep", "u.tau=a,b"], 2, "numbers"),
        (["small.json", "--duration", "5", "--points", "none.csv"], 1, "none.csv: cannot be read"),
        (["small.json", "--duration", "5", "--points", "small.json"], 1, "is no list of points"),
        (["small.json", "--duration", "5", "--points", "p.csv", "--sweep", "u.tau=7"], 2, "one of them"),
        (["small.json", "--duration", "5", "--sweep", "u.tau=7", "--own-noise"], 2, "list of points"),
        (["small.json", "--duration", "5", "--world", "picture:none.jpg"], 1, "no such picture"),
        (["small.json", "--duration", "5", "--out", "small.json"], 1, "not a folder"),
        (["small.json", "--duration", "5", "--out", "a/b"], 1, "does not exist"),
    ],
)
def test_invalid_calls_of_run_are_errors_and_write_nothing(
    folder: Path, arguments: list[str], status: int, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    before = sorted(folder.iterdir())
    try:
        code = main(["run", *arguments])
    except SystemExit as stopped:
        code = int(stopped.code or 0)
    error = capsys.readouterr().err
    assert code == status and says in error and "Traceback" not in error, error
    assert sorted(folder.iterdir()) == before


def test_force_replaces_only_what_a_run_wrote(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["run", "small.json", "--duration", "5", "--out", "out"]
    assert main(call) == 0 and main(call) == 1
    assert "--force" in capsys.readouterr().err
    (folder / "out" / "notes.txt").write_text("mine")
    assert main([*call, "--force"]) == 0 and (folder / "out" / "notes.txt").read_text() == "mine"


def test_ctrl_c_writes_the_record_so_far(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    chunk, calls = Run._chunk, []

    def pressed(self: Run, *args: object) -> object:
        calls.append(1)
        if len(calls) == 3:
            os.kill(os.getpid(), signal.SIGINT)
        return chunk(self, *args)  # type: ignore[arg-type]

    monkeypatch.setattr(Run, "_chunk", pressed)
    call = [
        "run",
        "small.json",
        "--duration",
        "100000000",
        "--record",
        "n.activation",
        "--every",
        "100000",
        "--out",
        "cut",
    ]
    assert main(call) == 130 and len(calls) == 3
    assert "incomplete. Continue it with: deodar run cut --resume." in capsys.readouterr().err.replace(
        "\n", " "
    )
    record = files.load_record(folder / "cut")
    assert (
        about(record)["complete"] is False
        and 1 <= record.sizes["time"] < 1001
        and np.isfinite(record["n.activation"].values).all()
    )


def test_a_live_run_follows_the_wall_clock_and_prints_its_meter(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    began = time.perf_counter()
    assert main(["run", "small.json", "--live", "--duration", "100", "--speed", "0.5", "--json"]) == 0
    meter = json.loads(capsys.readouterr().out)["meter"]
    assert (
        time.perf_counter() - began > 0.2
        and meter["wall"] >= 0.2
        and meter["time"] == 100
        and meter["factor"] <= 0.5
    )
    assert (
        main(["run", "small.json", "--live", "--duration", "100", "--speed", "max", "--longest-step", "2"])
        == 0
    )
    assert "as fast as possible" in capsys.readouterr().out
    assert sorted(p.name for p in folder.iterdir()) == ["small.json"], "nothing is recorded"


def test_ctrl_c_ends_a_live_run_with_its_meter(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    due, calls = Pace.due, iter(range(20))

    def pressed(self: Pace, session: dd.Session) -> int:
        if next(calls, None) is None:
            raise KeyboardInterrupt
        return due(self, session)

    monkeypatch.setattr(Pace, "due", pressed)
    assert main(["run", "small.json", "--live", "--duration", "1000000", "--json"]) == 130
    printed = capsys.readouterr()
    meter = json.loads(printed.out)["meter"]
    assert meter["complete"] is False and 0 < meter["steps"] < 1000000 and "stopped at" in printed.err


def test_cost_prints_the_time_of_each_element(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "small.json", "--cost", "--duration", "10", "--json"]) == 0
    cost = json.loads(capsys.readouterr().out)["cost"]
    assert {"u", "n", "s"} <= {row["path"] for row in cost["elements"]} and cost["step_us"] > 0
    assert main(["run", "small.json", "--cost"]) == 0
    assert "the whole step takes" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        (["--live"], 2, "needs --duration"),
        (["--speed", "2", "--duration", "10"], 2, "--speed needs --live"),
        (["--cost", "--longest-step", "2"], 2, "--longest-step needs --live"),
        (["--live", "--duration", "10", "--trials", "2", "--out", "o"], 2, "--trials, --out cannot be given"),
        (["--live", "--duration", "10", "--speed", "0"], 1, "above 0"),
        (["--live", "--duration", "10", "--longest-step", "0.1"], 1, "not below the planned step"),
    ],
)
def test_options_that_a_live_run_does_not_have_are_errors(
    folder: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], status: int, says: str
) -> None:
    try:
        got = main(["run", "small.json", *arguments])
    except SystemExit as end:
        got = int(str(end.code))
    assert got == status and says in capsys.readouterr().err


@pytest.mark.parametrize(("answer", "status"), [("y\n", 0), ("no\n", 1), ("", 1)])
def test_a_very_long_run_asks_for_confirmation(
    folder: Path,
    answer: str,
    status: int,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    class Keyboard(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setattr(simulate, "LONG_STEPS", 40)
    monkeypatch.setattr(_long, "TRIAL_SECONDS", 0.0)
    monkeypatch.setattr(sys, "stdin", Keyboard(answer))
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert main(["run", "small.json", "--duration", "40", "--no-progress", "--out", "out"]) == status
    error = capsys.readouterr().err
    assert (
        re.search(r"40 steps of dt = 1 take about \S+ \w+ on this machine", error)
        and "Begin? [y/N]" in error
        and "RunWarning" not in error
    )
    assert (folder / "out").is_dir() == (status == 0) and ("was not confirmed" in error) == (status == 1)
    assert main(["run", "small.json", "--duration", "39", "--out", "shorter"]) == 0
    assert "on this machine" not in capsys.readouterr().err


def test_without_a_terminal_a_very_long_run_needs_yes(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(simulate, "LONG_STEPS", 40)
    monkeypatch.setattr(_long, "TRIAL_SECONDS", 0.0)
    monkeypatch.setattr(sys, "stdin", io.StringIO("y\n"))
    call = ["run", "small.json", "--duration", "40", "--out", "out"]
    assert main(call) == 1 and not (folder / "out").exists()
    assert "cannot ask for confirmation" in (complaint := capsys.readouterr().err) and "--yes" in complaint
    assert main([*call, "--yes"]) == 0 and (folder / "out").is_dir()
    assert "steps of dt = 1 take about" in capsys.readouterr().err


def test_a_very_long_record_is_not_repeated_without_yes(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        main(
            [
                "run",
                "small.json",
                "--duration",
                "40",
                "--record",
                "u.activation",
                "--trials",
                "2",
                "--out",
                "first",
            ]
        )
        == 0
    )
    monkeypatch.setattr(simulate, "LONG_STEPS", 40)
    monkeypatch.setattr(_long, "TRIAL_SECONDS", 0.0)
    monkeypatch.setattr(sys, "stdin", io.StringIO("y\n"))
    capsys.readouterr()
    assert main(["run", "first", "--out", "second"]) == 1 and not (folder / "second").exists()
    assert re.search(
        "40 steps of dt = 1 take about .* cannot ask for confirmation.* --yes",
        capsys.readouterr().err.replace("\n", " "),
    )
    assert main(["run", "first", "--out", "second", "--yes"]) == 0
    printed = capsys.readouterr()
    assert "same bits" in printed.out and "deodar run: 40 steps of dt = 1 take about" in printed.err


def test_an_estimated_duration_is_printed_in_words() -> None:
    seconds = [3.2, 90, 7200, 86400 * 3.25, 86400 * 365 * 4000]
    assert [_long.duration(s) for s in seconds] == [
        "3 seconds",
        "1.5 minutes",
        "2 hours",
        "3.2 days",
        "4,000 years",
    ]


def test_a_diverged_point_of_a_sweep_is_reported_once(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    diverging = model()
    diverging["u"]["activation"] >> diverging.add(dd.Gain(0.0, name="g")) >> diverging["u"]
    dd.save(diverging, "loop.json")
    assert main(["run", "loop.json", "--duration", "60", "--sweep", "g.factor=0.1,1e9", "--out", "out"]) == 0
    error = capsys.readouterr().err
    assert error.count("deodar run: warning: 1 of 2 copies are NaN") == 1 and "RunWarning" not in error
    assert files.load_record(folder / "out")["diverged"].values.tolist()[0] == ""
