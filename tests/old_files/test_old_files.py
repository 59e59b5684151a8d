"""Files of deodar from document versions 1 to 3, and an experiment of version 2, open, run and resume;
`make.py` made them.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
import pytest
from jax import Array

import deodar as dd
from deodar import registry
from deodar.cli import main
from deodar.compiler.device import find
from deodar.errors import OutputExists
from deodar.experiments import row_line
from deodar.experiments.experiment_migrations import migrate
from deodar.model import document
from deodar.model.kept_presets import kept_presets
from deodar.recording.provenance import made_by
from deodar.recording.repeat import repeat
from deodar_studio.files.state_store import StateStore

OLD = Path(__file__).parent / "version_1"
X = dd.Axis("x", 0, 20, samples=21)

both = pytest.mark.parametrize("old", [OLD, OLD.with_name("version_2")], ids=lambda path: path.name)
"""A test of the files of both versions; other tests use those of version 1."""


def migrated(model: dd.Model, old: Path) -> bool:
    """Return whether a migrated model has the axis of the position and the waypoints of the input."""
    if old.name == "version_1":
        return model["place"].element.axis == X  # type: ignore[attr-defined]
    return np.array_equal(model["input"].element.waypoints.data, [[0, 8], [40, 12]])  # type: ignore[attr-defined]


def written(model: dd.Model, folder: Path) -> dict[str, bytes]:
    """Return the files of a model that is saved now."""
    folder.mkdir()
    dd.save(model, folder / "model.json")
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture
def old() -> Path:
    """Return the files of version 1, for tests that do not use both."""
    return OLD


@pytest.fixture
def stopped(old: Path, tmp_path: Path) -> Path:
    """Copy the folder of a stopped experiment, as if it had begun here."""
    return begun_here(old / "stopped", tmp_path / "stopped")


def begun_here(old: Path, folder: Path) -> Path:
    """Copy the folder of an experiment, as if it had begun on this machine with these libraries."""
    shutil.copytree(old, folder)
    first, *others = (folder / "trials.jsonl").read_text().split("\n")
    content = json.loads(first)
    content["about"]["made_by"] = made_by(find(), content["about"].get("precision", "float32"))
    checked = content.pop("crc32c", None) is not None  # rows of later versions state their checksums
    line = row_line.write(content, checked).decode().rstrip("\n")
    (folder / "trials.jsonl").write_text("\n".join([line, *others]))
    return folder


# -------------------------------------------------------------------------------------- documents and presets


@both
@pytest.mark.parametrize(
    "name", ["choice.json", "choice.deodar", "experiment.model.json", "stopped/model.json"]
)
def test_an_old_document_opens_as_the_present_version(name: str, old: Path, tmp_path: Path) -> None:
    model = dd.load(old / name)
    assert migrated(model, old)
    assert not model.check()
    new = written(model, tmp_path / "one")
    assert json.loads(new["model.json"])["deodar"] == document.VERSION
    assert new == written(dd.load(old / "choice.json"), tmp_path / "other")


@both
def test_an_old_preset_sets_its_values(old: Path) -> None:
    model = dd.load(old / "choice.json")
    model.set("u.tau", 99.0)
    report = dd.apply_preset(model, old / "choice.deodar")
    assert (
        model.get("u.tau") == 10.0
        and migrated(model, old)
        and any(line.verdict == "carried" for line in report.lines)
    )


@both
def test_unsaved_edits_of_the_studio_are_offered_and_open(old: Path, tmp_path: Path) -> None:
    shutil.copytree(old / "state", tmp_path / "state")
    store = StateStore(tmp_path / "state")
    (offered,) = store.stored_edits()
    found, file = store.read(offered.name)
    assert file == "choice.json" and migrated(dd.Model(document=found), old)


# ---------------------------------------------------------------------------------------------------- records


@pytest.mark.parametrize("record", ["version_1/record.nc", "version_1/record.zarr", "version_2/record.nc"])
def test_a_record_is_run_again_from_its_document(record: str) -> None:
    again = repeat(dd.load_record(OLD.parent / record), dd.simulate)
    assert max(again.largest.values()) < 1e-4 and again.compared == 5


def test_a_record_is_run_and_drawn_by_the_commands(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # status 1: last digits differ. The record names a family of processors with several instruction sets
    assert main(["run", str(OLD / "record.nc"), "--out", str(tmp_path / "again.nc")]) in (0, 1)
    assert main(["plot", str(OLD / "record.nc"), "--out", str(tmp_path / "record.png")]) == 0
    assert (tmp_path / "again.nc").exists() and (tmp_path / "record.png").stat().st_size > 1000
    record, old = dd.load_record(tmp_path / "again.nc"), dd.load_record(OLD / "record.nc")
    np.testing.assert_allclose(record["u.activation"], old["u.activation"], atol=1e-4)
    np.testing.assert_allclose(record["n.activation"], old["n.activation"], atol=1e-4)


# ------------------------------------------------------------------------------------------------ experiments


@both
def test_an_old_experiment_is_read(old: Path) -> None:
    assert dd.Experiment.load(old / "experiment.json").check() == []


@both
def test_a_folder_that_was_stopped_is_resumed(old: Path, stopped: Path) -> None:
    assert dd.load_results(stopped).sizes["trial"] == 3
    rows = (stopped / "trials.jsonl").read_text().split("\n")[:4]
    data = dd.Experiment.load(old / "experiment.json").run(stopped)
    whole = dd.load_results(old / "whole")
    assert data.sizes["trial"] == 8 and data["outcome"].values.tolist() == whole["outcome"].values.tolist()
    for name in ("detected", "duration", "strength"):
        np.testing.assert_array_equal(data[name], whole[name])
    np.testing.assert_allclose(data["end"], whole["end"], atol=1e-10)
    assert (stopped / "trials.jsonl").read_text().split("\n")[:4] == rows, "the rows that were there stay"
    for k in range(8):
        name = f"records/{k:06}.nc"
        np.testing.assert_allclose(
            dd.load_record(stopped / name)["n.activation"],
            dd.load_record(old / "whole" / name)["n.activation"],
            atol=1e-10,
        )
    assert dd.Experiment.load(old / "experiment.json").run(stopped).identical(data)


def test_an_experiment_of_version_2_is_read_and_resumed(tmp_path: Path) -> None:
    """Version 3 calls the object of an action `object`; before, it was called `thing`."""
    old = OLD.with_name("experiment_2")
    content = json.loads((old / "experiment.json").read_text())
    assert content["experiment"] == 2 and [action["thing"] for action in content["actions"]] == ["box"] * 3
    experiment = dd.Experiment.load(old / "experiment.json")
    assert experiment.check() == [] and [action.object for action in experiment.plan.actions] == ["box"] * 3
    folder = begun_here(old / "stopped", tmp_path / "stopped")
    assert dd.load_results(folder).sizes["trial"] == 1
    rows = (folder / "trials.jsonl").read_text().split("\n")[:2]
    content = experiment.run(folder)
    assert content.sizes["trial"] == 2 and (folder / "trials.jsonl").read_text().split("\n")[:2] == rows
    assert content["touched"].values.tolist() == [35, 35]


def test_a_folder_of_another_model_is_still_refused(stopped: Path) -> None:
    experiment = dd.Experiment.load(OLD / "experiment.json")
    model = dd.load(OLD / "experiment.model.json")
    model.set("u.tau", 11.0)
    with pytest.raises(OutputExists, match="another experiment: model differ"):
        dd.Experiment.from_data(experiment.to_data() | {"model": model}).run(stopped)


def test_a_folder_whose_document_was_changed_is_still_refused(stopped: Path) -> None:
    """Rows belong to the document whose digest they state, not to one that was written over it."""
    document = stopped / "model.json"
    document.write_text(document.read_text().replace('"tau": 10.0', '"tau": 11.0', 1))
    model = dd.load(document)
    assert model.get("u.tau") == 11.0
    with pytest.raises(OutputExists, match="another experiment: model differ"):
        dd.Experiment.from_data(dd.Experiment.load(OLD / "experiment.json").to_data() | {"model": model}).run(
            stopped
        )


def test_the_table_of_a_folder_is_read() -> None:
    table = dd.load_results(OLD / "whole")
    assert table.sizes["trial"] == 8 and dd.load_record(OLD / "whole" / "trials.nc").identical(table)


# ---------------------------------------------------------- version 3: no windows meant that it was always on

LASTING = OLD.with_name("version_3")


@pytest.mark.parametrize(
    "name", ["always.json", "always.deodar", "experiment.model.json", "whole/model.json", "snapshot.npz"]
)
def test_a_stimulus_without_windows_of_version_3_is_always_on(name: str, tmp_path: Path) -> None:
    path = LASTING / name
    model = dd.Model(document=dd.load_snapshot(path).document) if path.suffix == ".npz" else dd.load(path)
    assert model.get("lasting.windows") is None
    assert [(w.start, w.stop) for w in model.get("cue.windows")] == [(10, 60)]
    dd.save(model, tmp_path / "model.json")
    written = json.loads((tmp_path / "model.json").read_text())
    assert written["deodar"] == document.VERSION and written["elements"]["lasting"]["windows"] is None


def test_a_preset_of_version_3_switches_a_stimulus_to_always_on() -> None:
    model = dd.load(LASTING / "always.json")
    report = dd.apply_preset(model, "always on")
    assert [line.verdict for line in report.lines] == ["carried"] * 2
    assert model.get("cue.windows") is None and model.get("cue.amplitude") == 2.0


def test_a_record_and_a_snapshot_of_version_3_have_the_same_bits() -> None:
    record = dd.load_record(LASTING / "record.nc")
    repetition = repeat(record, dd.simulate)
    assert repetition.compared == 21 and max(repetition.largest.values()) < 1e-6
    session = dd.Session(dd.load(LASTING / "always.json"))
    session.restore(dd.load_snapshot(LASTING / "snapshot.npz"))
    session.run(20)
    np.testing.assert_allclose(session.read("n.activation"), record["n.activation"].sel(time=40), atol=1e-6)


def test_a_session_of_version_3_is_repeated_with_its_changes() -> None:
    """A stimulus was switched to always on by an empty list of windows."""
    record = dd.load_record(LASTING / "session.zarr")
    session = dd.session_at(LASTING / "session.zarr", 100)
    assert session.get("cue.windows") is None
    np.testing.assert_allclose(session.read("n.activation"), record["n.activation"].sel(time=100), atol=1e-6)


def test_an_experiment_of_version_3_is_read_and_resumed(tmp_path: Path) -> None:
    """Its factor has a level without windows, and its action sets an empty list of them."""
    experiment = dd.Experiment.load(LASTING / "experiment.json")
    assert experiment.check() == []
    onsets, strengths = experiment.factors
    assert [changes["cue.windows"] for changes in onsets.sets] == [None, [[20, 40]]]
    assert strengths.sets == [{"lasting.amplitude": 1, "lasting.windows": None}]
    assert experiment.plan.actions == (dd.Set(80, "cue.windows", None),)
    experiment.save(tmp_path / "again.json")
    reread = dd.Experiment.load(tmp_path / "again.json")
    assert reread.factors == experiment.factors and reread.plan.actions == experiment.plan.actions
    folder = begun_here(LASTING / "stopped", tmp_path / "stopped")
    rows = (folder / "trials.jsonl").read_text().split("\n")[:2]
    resumed, whole = experiment.run(folder), dd.load_results(LASTING / "whole")
    assert (folder / "trials.jsonl").read_text().split("\n")[:2] == rows
    assert resumed["when"].values.tolist() == whole["when"].values.tolist()
    np.testing.assert_allclose(resumed["end"], whole["end"], atol=1e-10)


def test_unsaved_edits_of_an_experiment_of_version_3_are_converted(tmp_path: Path) -> None:
    shutil.copytree(LASTING / "state", tmp_path / "state")
    store = StateStore(tmp_path / "state")
    (offered,) = store.stored_edits()
    stored = store.experiment(offered.name)
    assert stored is not None and stored.data["actions"][0]["value"] is None
    assert stored.data["factors"]["how"]["levels"]["weak"]["lasting.windows"] is None


# ----------------------------------------------- version 3: parameters of the same names in kinds of packages


@dataclass(frozen=True)
class Pooling(dd.Coupling):
    """A coupling of a package, with parameters that have the names of those that version 4 changes."""

    windows: Sequence[float] = (1.0, 2.0)
    quadrature: Annotated[str, dd.Recompile(choices=("cell", "none"))] = "none"
    direct: ClassVar = {"output": ("input",)}

    def output(self, at: dd.Setting) -> dict[str, Array]:
        return {"output": at.inputs["input"] * len(self.windows)}


STATED = {"windows": [], "quadrature": "cell"}


@pytest.fixture
def pooled(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Return a document of version 3 with that coupling, beside a stimulus and a field."""
    monkeypatch.setitem(vars(registry)["_kinds"], "Pooling", Pooling)
    elements = {
        "s": {"kind": "Boost", "id": "00000001", "windows": []},
        "k": {"kind": "Pooling", "id": "00000002", **STATED},
        "u": {"kind": "Field", "id": "00000003", "quadrature": "cell"},
    }
    preset = {"name": "wide", "group": "", "values": {"00000001": {"windows": []}, "00000002": STATED}}
    content = {"deodar": 3, "elements": elements, "layout": {"presets": [preset]}}
    (tmp_path / "model.json").write_text(json.dumps(content))
    return tmp_path / "model.json"


def test_parameters_of_a_package_keep_their_values(pooled: Path) -> None:
    model = dd.load(pooled)
    assert (model.get("k.windows"), model.get("k.quadrature")) == ((), "cell")
    assert (model.get("s.windows"), model.get("u.quadrature")) == (None, "cell-0.1")
    (preset,) = kept_presets(model.document)
    assert preset.values == {"00000001": {"windows": None}, "00000002": STATED}


def test_an_experiment_leaves_parameters_of_a_package_as_they_are(pooled: Path) -> None:
    values = {f"{path}.{name}": plain for path in "ksu" for name, plain in STATED.items()}
    actions = [{"kind": "Set", "at": 1, "path": path, "value": plain} for path, plain in values.items()]
    factors = {"how": {"path": "k.windows", "levels": [[], [1.0]]}, "all": {"levels": {"old": values}}}
    content = {"experiment": 3, "name": "e", "model": pooled.name, "limit": 10, "actions": actions}
    new = migrate(content | {"factors": factors}, dd.load(pooled).document)
    converted: Any = {**values, "s.windows": None, "u.quadrature": "cell-0.1"}
    ours = {path: plain for path, plain in converted.items() if path not in ("s.quadrature", "u.windows")}
    rows: Any = new["actions"]
    assert {row["path"]: row["value"] for row in rows}.items() >= ours.items()
    levels: Any = new["factors"]
    assert levels["all"]["levels"]["old"].items() >= ours.items()
    assert levels["how"] == factors["how"]
    pooled.with_name("e.json").write_text(json.dumps(content | {"actions": actions[:1]}))
    assert dd.Experiment.load(pooled.with_name("e.json")).plan.actions == (dd.Set(1, "k.windows", []),)


def test_unsaved_edits_of_an_experiment_leave_parameters_of_a_package_as_they_are(
    pooled: Path, tmp_path: Path
) -> None:
    """As its file, they are converted with the document of the model."""
    unsaved, name = tmp_path / "unsaved", "0123456789abcdef"
    unsaved.mkdir()
    pooled.rename(unsaved / f"{name}.json")
    paths = ("k.windows", "s.windows")
    content = {
        "name": "e",
        "actions": [{"kind": "Set", "at": 1, "path": path, "value": []} for path in paths],
    }
    for version in ({}, {"version": 3}):
        note = {"title": "e", "experiment": {**version, "data": content, "file": ""}}
        (unsaved / f"{name}.note").write_text(json.dumps(note))
        experiment = StateStore(tmp_path).experiment(name)
        assert experiment is not None
        rows: Any = experiment.data["actions"]
        assert [row["value"] for row in rows] == [[], None]
