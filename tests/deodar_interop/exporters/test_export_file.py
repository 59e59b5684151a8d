"""`deodar export` of a model as a file of another tool, and of a record for MATLAB."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import scipy.io

import deodar as dd
from deodar.recording import files
from tests.command_line import typed
from tests.deodar.recording.models import record
from tests.deodar_interop.importers.cosivina.files import SAMPLES

SAMPLE = next(p for p in SAMPLES if "OneLayer" in p.stem)


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    "arguments",
    ["example:selection --to cosivina --out a.json", "cosivina example:selection -o a.json"],
)
def test_both_forms_write_the_file_and_show_the_report(workspace: Path, arguments: str) -> None:
    command = typed("export", arguments)
    assert command.status == 0
    assert all(text in command.out for text in ("NeuralField", "0 dropped", "Written: a.json"))
    assert dd.load("a.json")["u"].element.tau == dd.load("example:selection")["u"].element.tau
    again = typed("export", arguments)
    assert again.status == 1 and "exists already" in again.err
    assert typed("export --force", arguments).status == 0


def test_a_file_of_cosivina_is_the_same_after_import_and_export(workspace: Path) -> None:
    assert typed("import", SAMPLE, "-o model.json").status == 0
    assert typed("export model.json --to cosivina -o back.json").status == 0
    one, two = (json.loads(Path(p).read_text())["simulator"] for p in (SAMPLE, "back.json"))
    assert [e["label"] for e in one["elements"]] == [e["label"] for e in two["elements"]]
    before, after = (dd.simulate(dd.load(p), 20, every=20) for p in (SAMPLE, "back.json"))
    assert all(np.array_equal(before[name], after[name]) for name in before.data_vars)


def test_without_out_the_name_is_that_of_the_model(workspace: Path) -> None:
    assert typed("export example:selection --to cosivina").status == 0
    assert [p.name for p in workspace.iterdir()] == ["selection-export-001.json"]


def test_strict_writes_nothing_where_something_is_lost(workspace: Path) -> None:
    command = typed("export cosivina example:working_memory -o a.json --strict")
    assert command.status == 1 and "Nothing was written" in command.out and not Path("a.json").exists()
    assert typed("export cosivina example:selection -o a.json --strict").status == 0


def test_json_holds_every_line_of_the_report(workspace: Path) -> None:
    command = typed("export cosivina example:working_memory -o a.json --json")
    assert command.status == 0
    answer = command.json
    assert answer["out"] == "a.json" and answer["tool"] == "cosivina" and answer["counts"]["dropped"] == 1
    assert {line["part"] for line in answer["lines"]} == {"element", "parameter", "connection", "file"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("example:selection u --to cosivina", "writes a whole model, not u"),
        ("example:selection --to cosivina --trial 1", "--trial is about a record"),
        ("example:selection --to cosivina --speed 2", "--speed is about a record"),
        ("run.zarr --to csv --strict", "--strict is about a model"),
    ],
)
def test_options_that_do_not_fit_are_refused(workspace: Path, arguments: str, message: str) -> None:
    files.save_record(record(), "run.zarr")
    command = typed("export", arguments)
    assert command.status == 2 and message in command.err


def test_a_record_named_like_a_tool_is_a_record(workspace: Path) -> None:
    files.save_record(record(), "run.nc")
    Path("run.nc").rename("cosivina")
    assert typed("export cosivina u --to cosivina").status == 2


def test_a_record_is_written_for_matlab(workspace: Path) -> None:
    files.save_record(record(trials=2), "run.zarr")
    command = typed("export run.zarr u --out a.mat")
    assert command.status == 0 and "Wrote u.activation to a.mat" in command.out
    assert typed("export run.zarr u --to mat --trial 1").status == 0
    expected = record(trials=2)["u.activation"]
    for name, part in (("a.mat", expected), ("run-export-001.mat", expected.sel(trial=1))):
        assert np.array_equal(scipy.io.loadmat(name)["u_activation"].squeeze(), part.values)


@pytest.mark.parametrize(("out", "written"), [("", "run-export-001"), ("--out recording", "recording")])
def test_a_record_is_written_as_cedar_writes_it(workspace: Path, out: str, written: str) -> None:
    files.save_record(record(trials=2), "run.zarr")
    selected = "u n.activation --trial 1 --time-range 5 15"
    assert typed("export run.zarr", selected, "--to cedar", out).status == 0
    rows = Path(written, "n.activation.csv").read_text().splitlines()
    assert rows[0] == "Mat,CV_32F,1,1"
    assert [row.split(",")[0] for row in rows[1:]] == ["0.005 s", "0.01 s", "0.015 s"]
