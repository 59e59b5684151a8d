"""Records of trials in a store: one object for each piece, whatever stops the run, and named errors."""

from __future__ import annotations

import dataclasses as dc
import errno
import json
import os
import pickle
import random
import shutil
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

from deodar import cli
from deodar.errors import OutputError, OutputExists, ParameterError, RecordError, WorkerError
from deodar.errors import RunWarning as Warned
from deodar.experiments import record_index, row_line, setup
from deodar.experiments.actions import Snapshot
from deodar.experiments.merging import merge_results
from deodar.experiments.record_target import claimed, object_name, require_visible, unseen
from deodar.experiments.results import load_results
from deodar.experiments.stored_records import open_records
from deodar.model import output
from deodar.recording.files import load_record
from deodar.recording.record_store import FolderStore
from deodar.recording.store_address import StoreAddress
from deodar.resources import Resources
from tests.deodar.experiments import clustered
from tests.deodar.experiments.calls import changed
from tests.deodar.recording.failing_store import FailingFileSystem, register

ROOT = Path(__file__).resolve().parents[3]
TRIALS = 8
NAMES = [f"records/0000/{k:08}-{k + 1:08}.zarr.zip" for k in range(0, TRIALS, 2)]
SECRET = "top secret"
ADDRESS = "failing://user:top%20secret@bucket/store"


def made(**changes):
    """Return an experiment with records of different lengths and a snapshot."""
    options = {"watch": ["u.activation"], "every": 10.0, "actions": [Snapshot(50, "at / 50", ["u"])]}
    return changed(clustered.experiment(TRIALS, 400.0), **(options | changes))


@pytest.fixture(autouse=True)
def pieces(monkeypatch):
    """Cut trials into pieces of two, on one core, as workers do."""
    monkeypatch.setenv("NPROC", "1")
    clustered.small_pieces(monkeypatch)
    register()


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the folder of the experiment with a file for each record."""
    folder = tmp_path_factory.mktemp("files") / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("NPROC", "1")
        clustered.small_pieces(patch)
        made().run(folder)
    return folder


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Return the folder of the rows and the store of a run in this process."""
    root = tmp_path_factory.mktemp("whole")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("NPROC", "1")
        clustered.small_pieces(patch)
        made().run(root / "out", records=root / "store")
    return root / "out", root / "store"


@pytest.fixture
def copied(whole, tmp_path):
    """Return a copy of the store, which a test may damage."""
    shutil.copytree(whole[1], tmp_path / "copied")
    return tmp_path / "copied"


def contents(store):
    """Return the content of each file of a store in a folder."""
    return {p.relative_to(store).as_posix(): p.read_bytes() for p in store.rglob("*") if p.is_file()}


def identity(folder):
    """Return what the rows state about their experiment."""
    return json.loads((folder / "trials.jsonl").read_text().splitlines()[0])["about"]


def bare(folder):
    """Return the rows without the names of their objects."""
    rows = [row_line.read(line.encode(), True) for line in clustered.lines(folder)]
    return [{key: cell for key, cell in row.items() if key != "record"} for row in rows]


def stop_after(rows):
    """Return a function that is called with the progress, and stops the run as Ctrl-C does."""

    def watch(progress):
        if progress >= rows:
            raise KeyboardInterrupt

    return watch


def equal_to_files(records, files):
    """Return whether records and snapshots are those in files, to the last bit."""
    return list(records) == list(range(TRIALS)) and all(
        records[k].identical(load_record(files / "records" / f"{k:06}.nc")) for k in records
    )


# ----------------------------------------------------------------------------------------- write and read


@pytest.mark.parametrize("kind", ["folder", "file", "memory", "failing"])
def test_records_in_a_store_are_those_in_files(tmp_path, whole, kind):
    store = {
        "folder": tmp_path / "store",
        "file": (tmp_path / "store").as_uri(),
        "memory": f"memory://{tmp_path.name}/{kind}",
        "failing": "failing://bucket/store",
    }[kind]
    plain = made(actions=[])
    plain.run(tmp_path / "files")
    table = plain.run(tmp_path / "out", records=store)
    assert table.identical(load_results(tmp_path / "files"))
    assert bare(tmp_path / "out") == bare(tmp_path / "files")
    assert not (tmp_path / "out" / "records").exists()
    with open_records(store) as records:
        assert equal_to_files(records, tmp_path / "files")
        assert not records.damaged()
    if kind in ("folder", "file"):
        assert set(contents(tmp_path / "store")) == {"experiment.json", "index.jsonl", *NAMES}


def test_snapshots_are_in_the_object_of_their_trial(files, whole):
    """The label has a character that no name of a file has: the files of snapshots cannot be compared."""
    with open_records(whole[1]) as records:
        assert equal_to_files(records, files)
        for trial in records:
            [label] = records.snapshots(trial)
            snapshot = records.snapshot(trial, label)
            assert label == "at / 50" and snapshot["time"].values.tolist() == [50.0]
            assert snapshot["u.activation"].item() == records[trial]["u.activation"].sel(time=50).item()
        with pytest.raises(RecordError, match=r"trial 3 has no snapshot 'then'. Read one: snapshot\(3, "):
            records.snapshot(3, "then")


def test_an_experiment_of_snapshots_alone_has_no_record(tmp_path):
    made(watch=[]).run(tmp_path / "out", records=tmp_path / "store")
    with (
        open_records(tmp_path / "store") as records,
        pytest.raises(RecordError, match="trial 2 has only snapshots"),
    ):
        assert records.snapshot(2, "at / 50").sizes["time"] == 1
        records[2]


def test_trials_are_selected_by_their_levels(whole, copied):
    (copied / "index.jsonl").unlink()
    for store in (whole[1], copied, whole[0]):
        with open_records(store) as records:
            assert records.levels(5) == {"level": -2.0} and len(records) == TRIALS and 7 in records
            assert list(records.select(level=-2.0)) == [4, 5, 6, 7]
            assert list(records.select({"level": -1.0})) == [0, 1, 2, 3]
            with pytest.raises(RecordError, match=r"there is no factor 'lovel'. Did you mean 'level'"):
                records.select(lovel=1)
            with pytest.raises(RecordError, match=r"no trial with level 3. Levels: level -1.0, -2.0"):
                records.select(level=3)
            with pytest.raises(RecordError, match=r"there is no trial 8. It has trials 0 to 7 \(8\)"):
                records[8]


def test_names_have_two_levels_and_differ_for_pieces_with_gaps():
    assert object_name([12340, 12341]) == "records/0012/00012340-00012341.zarr.zip"
    assert object_name([1_234_567_890]).startswith("records/1234567/1234567890-")
    names = {object_name(piece) for piece in ([0, 1, 2], [0, 2], [0, 1, 3, 2], [0, 3, 2])}
    assert len(names) == 4
    folders = [object_name([k]).rpartition("/")[0] for k in range(0, 10**6, 7)]
    assert max(folders.count(folders[k]) for k in (0, 70_000)) <= 1000


def test_pieces_with_gaps_are_read_without_an_index(tmp_path, monkeypatch):
    """A factor that needs another program has pieces of its own, and shuffled trials leave gaps in them."""
    monkeypatch.setattr(setup, "MOST_COPIES", 250)
    made(
        design="shuffled",
        actions=[],
        factors=[dc.replace(made().factors[0], levels=[2.0, 4.0], path="u.noise")],
    ).run(tmp_path / "out", records=tmp_path / "store")
    (tmp_path / "store" / "index.jsonl").unlink()
    rows = {
        row["trial"]: row
        for row in map(json.loads, (tmp_path / "out" / "trials.jsonl").read_text().splitlines()[1:])
    }
    with open_records(tmp_path / "store") as records:
        assert list(records) == list(range(TRIALS))
        assert all(records.levels(k) == rows[k]["levels"] for k in records)


def test_one_trial_of_a_remote_object_reads_a_part_of_it(tmp_path, monkeypatch):
    monkeypatch.setattr(setup, "MOST_COPIES", 250)
    made(every=None, actions=[]).run(tmp_path / "out", records="failing://bucket/store")
    [size] = [len(file.getvalue()) for name, file in FailingFileSystem.store.items() if name.endswith(".zip")]
    with open_records("failing://bucket/store") as records:
        FailingFileSystem.bytes_read = 0
        first = records[3]
        assert 0 < FailingFileSystem.bytes_read < size / 3
        assert first.attrs["title"] == "decision"


# ----------------------------------------------------------------------------------------- workers and stops


@pytest.mark.parametrize("how", [{"workers": 2}, {"cluster": "local:2"}], ids=["workers", "cluster"])
def test_workers_write_the_same_objects(tmp_path, whole, how):
    made().run(tmp_path / "out", records=tmp_path / "store", on=Resources(**how))
    objects, expected = contents(tmp_path / "store"), contents(whole[1])
    assert {name: objects[name] for name in NAMES} == {name: expected[name] for name in NAMES}
    assert objects["index.jsonl"] == expected["index.jsonl"]
    with pytest.raises(WorkerError, match="in the memory of this process, which workers do not see"):
        made().run(tmp_path / "none", records="memory://nowhere", on=Resources(**how))
    assert not (tmp_path / "none").exists()


KILLED = """
import os, signal, sys
import pytest
from deodar.experiments.rows import Rows
from tests.deodar.experiments import clustered
from tests.deodar.experiments.calls import changed
from tests.deodar.experiments.test_record_store import made

real = Rows.append

def append(self, rows):
    if len(self.found) >= 4:
        os.kill(os.getpid(), signal.SIGKILL)
    return real(self, rows)

Rows.append = append
with pytest.MonkeyPatch.context() as patch:
    clustered.small_pieces(patch)
    made().run(sys.argv[1], records=sys.argv[2])
"""


def test_a_killed_caller_is_resumed_whatever_the_clocks_say(tmp_path, whole):
    """Killed between an object and its rows; files of the store then are from the future, rows from 1970."""
    out, store = tmp_path / "out", tmp_path / "store"
    env = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])}
    done = subprocess.run(
        [sys.executable, "-c", KILLED, out, store], env=env, capture_output=True, timeout=120
    )
    assert done.returncode == -9, done.stderr.decode()[-500:]
    assert len(clustered.lines(out)) == 5 and (store / NAMES[2]).is_file(), "an object without rows"
    assert not (store / "index.jsonl").exists()
    assert list(open_records(store)) == list(range(6))
    for file in store.rglob("*"):
        os.utime(file, (4e9, 4e9))
    os.utime(out / "trials.jsonl", (0, 0))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        made().run(out, records=store)
    assert contents(store) == contents(whole[1])
    assert clustered.lines(out) == clustered.lines(whole[0])


def test_parts_share_a_store_and_the_merged_rows_write_its_index(tmp_path, whole):
    store = tmp_path / "store"
    for name, part in (("second", (4, 8)), ("first", (0, 4))):
        made().run(tmp_path / name, part=part, records=store)
    assert not (store / "index.jsonl").exists() and list(open_records(store)) == list(range(TRIALS))
    assert not merge_results([tmp_path / "first", tmp_path / "second"], tmp_path / "merged").gaps
    made().run(tmp_path / "merged", records=store)
    assert contents(store) == contents(whole[1])


def test_two_parts_may_begin_at_the_same_moment(tmp_path, whole, monkeypatch):
    """The other part states its experiment after this one has looked for it."""
    real, store = FolderStore.sizes, tmp_path / "store"

    def sizes(self, name=""):
        (store / ".experiment.json.1234.json").write_text("half")
        if not list(self.path.glob("e*")):
            shutil.copy(whole[1] / "experiment.json", store)
        return real(self, name)

    monkeypatch.setattr(FolderStore, "sizes", sizes)
    made().run(tmp_path / "out", part=(0, 4), records=store)
    assert set(contents(store)) - {".experiment.json.1234.json"} == {"experiment.json", *NAMES[:2]}


def test_a_worker_that_does_not_see_the_store_is_refused(tmp_path, whole):
    target = claimed(StoreAddress.of(whole[1]), identity(whole[0]), {}, tmp_path, dict)
    assert unseen(pickle.loads(pickle.dumps(target))) == ""
    require_visible(target, ["", ""])
    elsewhere = dc.replace(target, address=StoreAddress.of(tmp_path / "elsewhere"))
    with pytest.raises(WorkerError, match=r"store: a worker does not see.*experiment.json in it is missing"):
        require_visible(target, ["", unseen(elsewhere)])
    with pytest.raises(WorkerError, match=r"another store: experiment.json in it is of another experiment"):
        require_visible(target, [unseen(dc.replace(target, mark=b"another"))])
    lacking = dc.replace(target, address=StoreAddress.of("nonsense://user:pass@bucket/store"))
    with pytest.raises(WorkerError, match=r"a worker does not see the store of the records \(is not the"):
        require_visible(target, [unseen(lacking)])


def test_another_division_leaves_objects_that_are_reported_and_kept(tmp_path, monkeypatch):
    out, store = tmp_path / "out", tmp_path / "store"
    real = FolderStore.put

    def put(self, name, content):
        real(self, name, content)
        if name == NAMES[1]:
            raise KeyboardInterrupt

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(FolderStore, "put", put)
        made().run(out, records=store)
    monkeypatch.setattr(setup, "MOST_COPIES", 4)
    with pytest.warns(Warned, match=rf"1 files that no row names.*: {NAMES[1]}. They may be deleted"):
        made().run(out, records=store)
    assert (store / NAMES[1]).is_file()
    with open_records(store) as records:
        assert list(records) == list(range(TRIALS)) and not records.damaged()
        assert all(json.loads(records[k].attrs["deodar"])["trial"] == k for k in records)
    (store / "index.jsonl").unlink()
    with pytest.warns(Warned, match=r"trial \d is in records/0000/.* and in records/0000/"):
        assert list(open_records(store)) == list(range(TRIALS))


# ----------------------------------------------------------------------------------------- what goes wrong


@pytest.mark.parametrize(
    ("mode", "says"),
    [
        ("full", "zarr.zip: the store of the records is full. Make room there. Rows that exist are kept"),
        ("read-only", r"the store of the records cannot be written \(\[Errno 30\] Read-only file system\)"),
        ("forbidden", r"cannot be written \(403: \*\*\* may not write\). Permit it there. Rows that exist"),
        ("gone", "does not see the store of the records: experiment.json in it is missing. Connect"),
        ("silent", r"cannot be read \(ConnectionError: \*\*\*@bucket does not answer\). Rows that exist are"),
    ],
)
def test_a_store_that_fails_half_way_stops_the_rows_and_is_resumed(tmp_path, whole, mode, says):
    out = tmp_path / "out"

    def watch(progress):
        if progress == 4:
            FailingFileSystem.become(mode)

    with pytest.raises(OutputError, match=says) as caught:
        made().run(out, records=ADDRESS, on=Resources(progress=watch))
    assert SECRET not in str(caught.value) and "top%20secret" not in str(caught.value)
    assert bare(out) == bare(whole[0])[:5]
    stored = [name.partition("/store/")[2] for name in FailingFileSystem.names()]
    assert stored == ["experiment.json", *NAMES[:2]], "nothing half there, under no name"
    FailingFileSystem.become("")
    made().run(out, records=ADDRESS)
    assert clustered.lines(out) == clustered.lines(whole[0])
    expected = contents(whole[1])
    objects = {
        name.partition("/store/")[2]: file.getvalue() for name, file in FailingFileSystem.store.items()
    }
    assert objects == expected
    texts = [*objects.values(), *(p.read_bytes() for p in out.iterdir())]
    assert not any(b"secret" in text for text in texts), "credentials are stored nowhere"
    assert json.loads((out / "records.json").read_text()) == {"store": "failing://***@bucket/store"}


@pytest.mark.parametrize("mode", ["full", "read-only", "gone", "silent"])
def test_a_store_that_fails_at_the_start_or_at_the_end_is_an_error(tmp_path, whole, mode):
    FailingFileSystem.become(mode)
    with pytest.raises((OutputError, RecordError), match="the store of the records"):
        made().run(tmp_path / "out", records=ADDRESS)
    assert len(clustered.lines(tmp_path / "out")) == 1
    FailingFileSystem.become(mode, puts=5)  # all but the index
    with pytest.raises(OutputError, match=r"index.jsonl: the store of the records.*Rows that exist are kept"):
        made().run(tmp_path / "out", records=ADDRESS)
    assert clustered.lines(tmp_path / "out") == clustered.lines(whole[0])
    FailingFileSystem.become("")
    assert made().run(tmp_path / "out", records=ADDRESS).identical(load_results(whole[0]))
    with open_records(ADDRESS) as records:
        assert len(records) == TRIALS and not records.damaged()


def test_a_folder_that_is_full_holds_no_part_of_an_object(tmp_path, monkeypatch):
    real = output.sync

    def sync(path):
        if path.parent.name == "0000":
            raise OSError(errno.ENOSPC, "No space left on device")
        real(path)

    monkeypatch.setattr(output, "sync", sync)
    with pytest.raises(OutputError, match=r"00000001.zarr.zip: the store of the records is full. Make room"):
        made().run(tmp_path / "out", records=tmp_path / "store")
    assert set(contents(tmp_path / "store")) == {"experiment.json"}


def test_a_disk_that_is_unmounted_half_way_is_not_written_to_this_machine(tmp_path, whole):
    """The empty folder on which it was mounted remains."""
    out, store, elsewhere = tmp_path / "out", tmp_path / "store", tmp_path / "away"

    def watch(progress):
        if progress == 2 and not elsewhere.exists():
            store.rename(elsewhere)
            store.mkdir()

    with pytest.raises(OutputError, match="does not see the store of the records"):
        made().run(out, records=store, on=Resources(progress=watch))
    assert not list(store.iterdir()) and bare(out) == bare(whole[0])[:3]
    with pytest.raises(RecordError, match=r"lacks 1 of the 1 objects with the records of.*Connect the store"):
        made().run(out, records=store)
    assert not list(store.iterdir())
    made().run(out, records=elsewhere)
    assert contents(elsewhere) == contents(whole[1]), "a store that was moved is continued"
    assert json.loads((out / "records.json").read_text()) == {"store": str(elsewhere)}


def test_a_resumed_run_names_the_store_of_its_rows(tmp_path, files):
    out, store = tmp_path / "out", tmp_path / "store"
    with pytest.raises(KeyboardInterrupt):
        made().run(out, records=store, on=Resources(progress=stop_after(4)))
    with pytest.raises(RecordError, match=rf"lacks 2 of the 2 objects.*Continue with records='{store}'"):
        made().run(out, records=tmp_path / "other")
    assert not (tmp_path / "other").exists()
    with pytest.raises(RecordError, match=rf"of 4 trials are in the store {store}.*records='{store}'"):
        made().run(out)
    shutil.copytree(files, tmp_path / "files")
    with pytest.raises(RecordError, match=r"8 trials have rows whose records are not in a store.*Leave out"):
        made().run(tmp_path / "files", records=store)
    made().run(out, records=store)
    assert made().run(out).identical(load_results(out)), "a complete table needs no store"


def test_a_store_of_another_experiment_or_of_something_else_is_refused(tmp_path, copied):
    with pytest.raises(OutputExists, match=r"holds records of another experiment: limit differ. Name"):
        made(limit=300.0).run(tmp_path / "out", records=copied)
    (tmp_path / "notes").mkdir()
    (tmp_path / "notes" / "notes.txt").write_text("mine")
    with pytest.raises(OutputExists, match=r"is not a store of records.*it holds notes.txt"):
        made().run(tmp_path / "out 2", records=tmp_path / "notes")
    with pytest.raises(OutputError, match="the store of the records is not there"):
        made().run(tmp_path / "out 3", records=tmp_path / "none" / "store")
    for text, says in (
        ("{", "experiment.json in it is damaged"),
        (
            '{"records": 2, "experiment": {}}',
            r"is a store of version 2; this deodar, .*, reads version 1\. Type: pip install",
        ),
    ):
        (copied / "experiment.json").write_text(text)
        with pytest.raises(RecordError, match=says):
            made().run(tmp_path / "out 4", records=copied)
        with pytest.raises(RecordError, match=says):
            open_records(copied)
    with pytest.raises(RecordError, match=r"is not a store of records: it has no experiment.json"):
        open_records(tmp_path)
    for wrong in (
        lambda: made().run(tmp_path / "out 5", records=tmp_path / "out 5"),
        lambda: open_records(tmp_path / "out 4"),
    ):
        with pytest.raises(RecordError, match=r"is the folder of the rows.*are read by dd.load_record"):
            wrong()


def test_a_store_for_nothing_is_refused(tmp_path):
    with pytest.raises(ParameterError, match=r"the trials record nothing. Name ports in watch="):
        made(watch=[], actions=[]).run(tmp_path / "out", records=tmp_path / "store")
    with pytest.raises(ParameterError, match=r"needs a folder of rows, which name the records. Name it too"):
        made().run(records=tmp_path / "store")
    with pytest.raises(ParameterError, match=r"is not the address of a store.*such as s3://BUCKET/NAME"):
        made().run(tmp_path / "out", records="nonsense://bucket/store")
    assert not list(tmp_path.iterdir())


# ----------------------------------------------------------------------------------------- damage


def test_a_damaged_index_is_noticed_and_the_objects_are_listed(copied, whole):
    file, chance = copied / "index.jsonl", random.Random(2)
    content = file.read_bytes()
    lines = content.splitlines(keepends=True)
    damaged = [
        b"",
        b"\n",
        b"null\n",
        b"[]\n" + b"".join(lines[1:]),
        b"".join(lines[:-1]),
        b"".join(lines[1:]),
    ]
    damaged += [content.replace(b'"index":1', b'"index":7'), content.replace(b'"index": 1', b'"index": 7')]
    damaged += [content[: chance.randrange(len(content))] for _ in range(10)]
    for _ in range(30):
        flipped = bytearray(content)
        flipped[chance.randrange(len(flipped))] ^= 1 << chance.randrange(8)
        damaged.append(bytes(flipped))
    with open_records(whole[1]) as records:
        expected = {k: records.levels(k) for k in records}
    noticed = 0
    for text in damaged:
        file.write_bytes(text)
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            records = open_records(copied)
        noticed += bool(warned)
        assert all("index.jsonl is damaged" in str(warning.message) for warning in warned)
        assert list(records) == list(range(TRIALS))
        if warned:
            assert {k: records.levels(k) for k in records} == expected
        records.close()
    assert noticed >= len(damaged) - 8, "a letter of the header may differ without harm"


def test_an_index_names_nothing_outside_of_its_store(copied):
    outside = copied.parent / "outside.zarr.zip"
    shutil.copy(copied / NAMES[0], outside)
    for name in ("../outside.zarr.zip", "records/../../outside.zarr.zip", str(outside)):
        indexed = record_index.IndexedObject(name, outside.stat().st_size, "", {0: {}, 1: {}})
        (copied / "index.jsonl").write_bytes(record_index.text([indexed]))
        with pytest.warns(Warned, match=r"index.jsonl is damaged"), open_records(copied) as records:
            assert len(records) == TRIALS


def test_objects_that_are_missing_or_damaged_are_named(copied):
    (copied / NAMES[0]).unlink()
    content = bytearray((copied / NAMES[1]).read_bytes())
    content[300] ^= 1
    (copied / NAMES[1]).write_bytes(content)
    (copied / NAMES[2]).write_bytes(b"short")
    (copied / "records" / "0000" / ".left.zarr.zip").write_bytes(b"under its first name")
    with open_records(copied) as records:
        assert records.damaged() == {
            NAMES[0]: "it is missing",
            NAMES[1]: "its checksum is that of another content",
            NAMES[2]: f"it has 5 bytes, not {records._objects[4].size}",
        }
        with pytest.raises(RecordError, match=r"00000001.zarr.zip: there is no such file of records"):
            records[0]
        assert records[6].sizes["time"] > 1
    (copied / "index.jsonl").unlink()
    with open_records(copied) as records:
        assert list(records) == [2, 3, 4, 5, 6, 7] and set(records.damaged()) == {NAMES[1], NAMES[2]}


# ----------------------------------------------------------------------------------------- the command line


def test_the_command_writes_into_a_store_and_says_how_to_resume(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    made().save("here.json")
    call = ["experiment", "here.json", "--no-progress", "--out", "out", "--records"]
    FailingFileSystem.become("full", puts=3)
    assert cli.main([*call, "failing://user:top%20secret@bucket/store"]) == 1
    error = capsys.readouterr().err
    assert "is full" in error and "--out out --records 'failing://***@bucket/store'" in error
    FailingFileSystem.become("")
    assert cli.main([*call, "failing://user:top%20secret@bucket/store"]) == 0
    assert "Records written to failing://***@bucket/store; dd.open_records" in capsys.readouterr().out
    assert cli.main([*call, "failing://user:top%20secret@bucket/store", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["records"] == "failing://***@bucket/store"
