"""Files of a made-up later deodar: each is refused, with the version that wrote it and what to install."""

from __future__ import annotations

import importlib.metadata
import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import deodar as dd
from deodar import file_version
from deodar.analysis.continuation.branch import SteadyBranch
from deodar.batch.run_file import CHECKPOINT
from deodar.cli import main
from deodar.errors import DeodarError, DocumentError
from deodar.model import clipboard
from deodar.model.document import VERSION
from deodar.packing import packing as packed
from deodar.recording import stored
from deodar_robots.robot.robot_file import load_robot
from deodar_studio.files.state_store import StateStore, StoredExperiment

X = dd.Axis("x", 0, 20, samples=21)
RECOVERY = "0123456789abcdef"
"""Name of unsaved edits."""

FORMS = (
    "deodar.model.document_files.VERSION",
    "deodar.model.reader.VERSION",
    "deodar.model.package_contents.VERSION",
    "deodar.recording.portable.VERSION",
    "deodar.recording.stored.VERSION",
    "deodar.experiments.design.VERSION",
    "deodar.experiments.experiment_migrations.VERSION",
    "deodar.experiments.record_target.VERSION",
    "deodar_studio.files.state_store.VERSION",
)
"""Versions of the forms of files, where their writers and readers have them."""


def field() -> dd.Model:
    """Return a small model."""
    model = dd.Model("field")
    model.add(dd.GaussianStimulus("s", [X], center=8, amplitude=6)) >> model.add(dd.Field("u", [X]))
    return model


def experiment() -> dd.Experiment:
    """Return an experiment of one trial with a record."""
    plan = dd.TrialPlan(20.0, watch=["u.activation"])
    return dd.Experiment("one", field(), plan, trials=1)


def write_files(folder: Path) -> None:
    """Write a file of each kind, in the way of the deodar that runs."""
    model = field()
    dd.save(model, folder / "model.json")
    dd.save(model, folder / "model.deodar")
    (folder / "copied.txt").write_text(clipboard.text(model.document))
    record = dd.simulate(model, duration=5, record=["u.activation"])
    dd.save_record(record, folder / "record.zarr")
    dd.save_record(record, folder / "record.nc")
    dd.pack(folder / "record.nc", folder / "packed.deodar")
    dd.simulate(model, duration=5, record=["u.activation"], out=dd.Output(folder / "run", snapshots=2))
    dd.save_snapshot(dd.Session(model).snapshot(), folder / "moment.npz")
    experiment().save(folder / "experiment.json")
    experiment().run(folder / "results", records=folder / "store")
    stored_experiment = StoredExperiment({"name": "one", "limit": 20.0}, "experiment.json")
    StateStore(folder / "state").store_edits(RECOVERY, model.document, "model.json", stored_experiment)
    (folder / "robot.json").write_text('{"robot": 2, "written_by": "deodar 0.9.0", "wheels": 3}')


@pytest.fixture(scope="module")
def later(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the files of deodar 0.9.0, all of whose forms have the version 9."""
    folder, version = tmp_path_factory.mktemp("later"), importlib.metadata.version
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(file_version, "HERE", "deodar 0.9.0")
        patch.setattr(
            importlib.metadata, "version", lambda name: "0.9.0" if name == "deodar" else version(name)
        )
        for form in FORMS:
            patch.setattr(form, 9)
        write_files(folder)
    return folder


def opened_recovery(folder: Path) -> object:
    """Open unsaved edits."""
    return StateStore(folder / "state").read(RECOVERY)


def with_later_state(folder: Path) -> object:
    """Continue a run of which the state alone is of a later version."""
    dd.simulate(
        field(), duration=5, record=["u.activation"], out=dd.Output(folder / "mine", force=True, snapshots=2)
    )
    state = folder / "run" / "record.zarr" / CHECKPOINT
    (folder / "mine" / "record.zarr" / CHECKPOINT).write_bytes(state.read_bytes())
    return dd.resume(folder / "mine", duration=10)


def with_later_objects(folder: Path) -> object:
    """Read a store of which the records alone are of a later version."""
    mark = folder / "store" / "experiment.json"
    text = mark.read_text()
    mark.write_text(text.replace('"records": 9', '"records": 1'))
    try:
        return dd.open_records(folder / "store")[0]
    finally:
        mark.write_text(text)


OPENED: dict[str, tuple[str, Callable[[Path], object]]] = {
    "document": ("a document", lambda folder: dd.load(folder / "model.json")),
    "package of a document": ("a document", lambda folder: dd.load(folder / "model.deodar")),
    "package": ("a package", lambda folder: packed.contents(folder / "packed.deodar")),
    "unpacked": ("a package", lambda folder: dd.unpack(folder / "packed.deodar", folder / "unpacked")),
    "preset": ("a document", lambda folder: dd.apply_preset(field(), folder / "model.json")),
    "clipboard": ("a document", lambda folder: clipboard.read((folder / "copied.txt").read_text())),
    "Zarr": ("a record", lambda folder: dd.load_record(folder / "record.zarr")),
    "Zarr, opened": ("a record", lambda folder: dd.open_record(folder / "record.zarr")),
    "NetCDF": ("a record", lambda folder: dd.load_record(folder / "record.nc")),
    "analysis": ("a record", lambda folder: SteadyBranch.load(folder / "record.nc")),
    "run": ("a record", lambda folder: dd.load_record(folder / "run")),
    "run, continued": ("a record", lambda folder: dd.resume(folder / "run", duration=10)),
    "state of a run": ("a state of a run", with_later_state),
    "snapshot": ("a snapshot of a session", lambda folder: dd.load_snapshot(folder / "moment.npz")),
    "listed snapshot": ("a snapshot of a session", lambda folder: stored.header(folder / "moment.npz")),
    "experiment": ("an experiment", lambda folder: dd.Experiment.load(folder / "experiment.json")),
    "results": ("an experiment", lambda folder: dd.load_results(folder / "results")),
    "results, continued": ("an experiment", lambda folder: experiment().run(folder / "results")),
    "store": ("a store", lambda folder: dd.open_records(folder / "store")),
    "store, written": (
        "a store",
        lambda folder: experiment().run(folder / "new results", records=folder / "store"),
    ),
    "object of a store": ("an object of a store", with_later_objects),
    "unsaved edits": ("a document", opened_recovery),
    "unsaved experiment": (
        "an experiment",
        lambda folder: StateStore(folder / "state").experiment(RECOVERY),
    ),
    "robot": ("a robot file", lambda folder: load_robot(folder / "robot.json")),
}
"""For each kind of file what the message calls it, and how it is opened."""


def contents(folder: Path) -> dict[str, bytes]:
    """Return the content of each file that a later deodar wrote."""
    later_ones = ("mine", "new results")
    files = [
        path
        for path in folder.rglob("*")
        if path.is_file() and path.relative_to(folder).parts[0] not in later_ones
    ]
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


@pytest.mark.parametrize("kind", OPENED)
def test_a_later_file_is_refused_whole_with_what_to_install(kind: str, later: Path) -> None:
    noun, opened = OPENED[kind]
    before = contents(later)
    with pytest.raises(DeodarError) as refused:
        opened(later)
    (problem,) = refused.value.problems
    version = 2 if kind == "robot" else 9
    assert f"is {noun} of version {version}, written by deodar 0.9.0; this deodar, " in problem.what
    assert problem.fix_at("shell") == "Type: pip install --upgrade 'deodar>=0.9.0'"
    assert problem.where or kind == "clipboard", "the file is named"
    assert contents(later) == before


@pytest.mark.parametrize(
    "command",
    [["check", "model.json"], ["run", "record.nc"], ["experiment", "experiment.json", "--check"]],
    ids=lambda command: command[0],
)
def test_a_command_refuses_a_later_file(
    command: list[str], later: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    name, file, *options = command
    assert main([name, str(later / file), *options]) == 1
    message = " ".join(capsys.readouterr().err.split())
    assert "written by deodar 0.9.0" in message and "pip install --upgrade 'deodar>=0.9.0'" in message


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"colours": {}}, "colours: is not a key of a document"),
        ({"elements": {"u": {"kind": "GlowingField", "id": "00000001"}}}, "GlowingField"),
    ],
    ids=["key", "kind"],
)
def test_an_unknown_part_of_a_later_document_is_refused_with_its_writer(
    change: dict[str, Any], says: str, tmp_path: Path
) -> None:
    # the form is one that is read, so that the problem itself is stated, too
    document = json.loads(field().to_json()) | {"written_by": "deodar 0.9.0"} | change
    (tmp_path / "model.json").write_text(json.dumps(document))
    with pytest.raises(DocumentError) as refused:
        dd.load(tmp_path / "model.json")
    text = refused.value.at("shell")
    assert says in text
    assert "It was written by deodar 0.9.0, and this is deodar" in text and "'deodar>=0.9.0'" in text


@pytest.mark.parametrize("stated", ["deodar 0.9.0; rm -rf /", "deodar $(reboot)", "0.9.0'", 9, None])
def test_a_version_that_is_none_is_not_something_to_type(stated: object, tmp_path: Path) -> None:
    (tmp_path / "model.json").write_text(json.dumps({"deodar": 9, "written_by": stated, "elements": {}}))
    with pytest.raises(DocumentError) as refused:
        dd.load(tmp_path / "model.json")
    assert str(refused.value).endswith(f"reads versions 1 to {VERSION}. Type: pip install --upgrade deodar")


def test_files_state_the_deodar_that_wrote_them(tmp_path: Path) -> None:
    write_files(tmp_path)
    version = f"deodar {dd.__version__}"
    for name in (
        "model.json",
        "experiment.json",
        "results/experiment.json",
        "results/model.json",
        "copied.txt",
    ):
        assert json.loads((tmp_path / name).read_text())["written_by"] == version, name
    assert stored.header(tmp_path / "moment.npz")["written_by"] == version
    with zipfile.ZipFile(tmp_path / "packed.deodar") as archive:
        assert json.loads(archive.read("contents.json"))["written_by"] == version
    origin = json.loads(dd.load_record(tmp_path / "record.nc").attrs["deodar"])
    assert origin["made_by"]["deodar"] == dd.__version__
    assert "written_by" not in origin["document"], "records have the bytes that they had"
