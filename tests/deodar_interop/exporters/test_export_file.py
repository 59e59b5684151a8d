"""`deodar export` of a model as a file of another tool, and of a record for MATLAB."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import scipy.io

import deodar as dd
from deodar.cli import main
from deodar.recording import files
from tests.deodar.recording.models import record
from tests.deodar_interop.importers.cosivina.files import SAMPLES

SAMPLE = next(p for p in SAMPLES if "OneLayer" in p.stem)


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    "arguments",
    [
        ["example:selection", "--to", "cosivina", "--out", "a.json"],
        ["cosivina", "example:selection", "-o", "a.json"],
    ],
)
def test_both_forms_write_the_file_and_show_the_report(
    workspace: Path, arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", *arguments]) == 0
    printed = capsys.readouterr().out
    assert "NeuralField" in printed and "0 dropped" in printed and "Written: a.json" in printed
    assert dd.load("a.json")["u"].element.tau == dd.load("example:selection")["u"].element.tau
    assert main(["export", *arguments]) == 1 and "exists already" in capsys.readouterr().err
    assert main(["export", *arguments, "--force"]) == 0


def test_a_file_of_cosivina_is_the_same_after_import_and_export(workspace: Path) -> None:
    assert main(["import", str(SAMPLE), "-o", "model.json"]) == 0
    assert main(["export", "model.json", "--to", "cosivina", "-o", "back.json"]) == 0
    one, two = (json.loads(Path(p).read_text())["simulator"] for p in (SAMPLE, "back.json"))
    assert [e["label"] for e in one["elements"]] == [e["label"] for e in two["elements"]]
    before, after = (dd.simulate(dd.load(p), 20, every=20) for p in (SAMPLE, "back.json"))
    assert all(np.array_equal(before[name], after[name]) for name in before.data_vars)


def test_without_out_the_name_is_that_of_the_model(workspace: Path) -> None:
    assert main(["export", "example:selection", "--to", "cosivina"]) == 0
    assert [p.name for p in workspace.iterdir()] == ["selection-export-001.json"]


def test_strict_writes_nothing_where_something_is_lost(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", "cosivina", "example:working_memory", "-o", "a.json", "--strict"]) == 1
    assert "Nothing was written" in capsys.readouterr().out and not Path("a.json").exists()
    assert main(["export", "cosivina", "example:selection", "-o", "a.json", "--strict"]) == 0


def test_json_holds_every_line_of_the_report(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "cosivina", "example:working_memory", "-o", "a.json", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["out"] == "a.json" and answer["tool"] == "cosivina" and answer["counts"]["dropped"] == 1
    assert {line["part"] for line in answer["lines"]} == {"element", "parameter", "connection", "file"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["example:selection", "u", "--to", "cosivina"], "writes a whole model, not u"),
        (["example:selection", "--to", "cosivina", "--trial", "1"], "--trial is about a record"),
        (["example:selection", "--to", "cosivina", "--speed", "2"], "--speed is about a record"),
        (["run.zarr", "--to", "csv", "--strict"], "--strict is about a model"),
    ],
)
def test_options_that_do_not_fit_are_refused(
    workspace: Path, arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    files.save_record(record(), "run.zarr")
    with pytest.raises(SystemExit) as stop:
        main(["export", *arguments])
    assert stop.value.code == 2 and message in capsys.readouterr().err


def test_a_record_named_like_a_tool_is_a_record(workspace: Path) -> None:
    files.save_record(record(), "run.nc")
    Path("run.nc").rename("cosivina")
    with pytest.raises(SystemExit):
        main(["export", "cosivina", "u", "--to", "cosivina"])


def test_a_record_is_written_for_matlab(workspace: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files.save_record(record(trials=2), "run.zarr")
    assert main(["export", "run.zarr", "u", "--out", "a.mat"]) == 0
    assert "Wrote u.activation to a.mat" in capsys.readouterr().out
    assert main(["export", "run.zarr", "u", "--to", "mat", "--trial", "1"]) == 0
    expected = record(trials=2)["u.activation"]
    for name, part in (("a.mat", expected), ("run-export-001.mat", expected.sel(trial=1))):
        assert np.array_equal(scipy.io.loadmat(name)["u_activation"].squeeze(), part.values)


@pytest.mark.parametrize(
    ("arguments", "written"), [([], "run-export-001"), (["--out", "recording"], "recording")]
)
def test_a_record_is_written_as_cedar_writes_it(workspace: Path, arguments: list[str], written: str) -> None:
    files.save_record(record(trials=2), "run.zarr")
    selected = ["u", "n.activation", "--trial", "1", "--time-range", "5", "15"]
    assert main(["export", "run.zarr", *selected, "--to", "cedar", *arguments]) == 0
    rows = Path(written, "n.activation.csv").read_text().splitlines()
    assert rows[0] == "Mat,CV_32F,1,1"
    assert [row.split(",")[0] for row in rows[1:]] == ["0.005 s", "0.01 s", "0.015 s"]
