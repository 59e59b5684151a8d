"""A full disk: no half-written file remains, and the caller still has the data."""

from __future__ import annotations

import errno
import hashlib
import os
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

import deodar as dd
from deodar.errors import OutputError
from deodar.experiments.rows import Rows
from deodar.model import output, partial
from deodar.recording import files
from deodar_studio.files.open_folder import OpenFolder
from deodar_studio.files.state_store import StateStore
from deodar_studio.files.workspace import Workspace
from tests.deodar.recording.models import model, record

SMALL = """
import resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
sys.path[:0] = {path!r}
import deodar as dd
from deodar.errors import OutputError
from deodar.recording import files
from deodar_studio.files.open_folder import OpenFolder
from tests.deodar.recording.models import model, record
data = record(trials=3)
before = data.copy(deep=True)
try:
    files.save_record(data, sys.argv[1])
except OutputError as error:
    print(error)
print(data.identical(before))
"""


@pytest.mark.parametrize("suffix", [".zarr", ".nc", ".csv"])
def test_a_failed_write_keeps_the_data_and_leaves_no_file(suffix: str, tmp_path: Path) -> None:
    """The system lets no file grow beyond 1000 bytes."""
    code = SMALL.format(path=sys.path)
    command = [sys.executable, "-B", "-c", code, str(tmp_path / f"record{suffix}")]
    done = subprocess.run(
        command, capture_output=True, text=True, env=os.environ | {"DEODAR_CACHE": "off"}, check=True
    )
    printed, same = done.stdout.splitlines()
    assert (
        f"record{suffix}: cannot be written: File too large" in printed
        and "The data are still in memory" in printed
        and same == "True"
    )
    assert list(tmp_path.iterdir()) == []


QUOTA = """
import resource, sys
sys.path[:0] = {path!r}
import deodar as dd
from deodar.recording import growing
from deodar.session import run
from tests.deodar.recording.models import model
growing.FLUSH_SECONDS = run.CHUNK_SECONDS = 0.005
dd.simulate(model(), 1, record="u")
resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, 60_000))
dd.simulate(model(), 100_000, seed=3, record="u", every=1, out=dd.Output(sys.argv[1], snapshots=100))
"""


def test_a_run_that_fills_its_quota_ends_with_an_error_and_keeps_its_record(tmp_path: Path) -> None:
    """The system lets no file grow beyond 60,000 bytes, which is less than a chunk.

    Samples are written in small pieces, so that the first ones are stored on a machine of any speed.
    """
    command = [sys.executable, "-B", "-c", QUOTA.format(path=sys.path), str(tmp_path / "run")]
    environment = os.environ | {"DEODAR_CACHE": "off"}
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert done.returncode == 1
    assert "File too large" in done.stderr and "is kept" in done.stderr and "--resume" in done.stderr
    recording = files.load_record(tmp_path / "run")
    n = recording.sizes["time"]
    expected = dd.simulate(model(), n - 1, seed=3, record="u", every=1)
    assert 100 < n < 100_001 and recording["u.activation"].equals(expected["u.activation"])


def full(monkeypatch: pytest.MonkeyPatch, code: int = errno.ENOSPC) -> None:
    """Replace the file system by one that reports only at the end that it is full."""

    def refuse(handle: int) -> None:
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(os, "fsync", refuse)


@pytest.mark.parametrize("suffix", [".zarr", ".nc", ".csv"])
def test_a_disk_that_is_full_when_a_file_is_flushed_is_an_error(
    suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recording = record()
    full(monkeypatch)
    with pytest.raises(OutputError, match="No space left"):
        files.save_record(recording, tmp_path / f"record{suffix}")
    assert list(tmp_path.iterdir()) == []


def test_a_failed_write_keeps_the_existing_document(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    model = dd.Model("kept")
    dd.save(model, tmp_path / "kept.json")
    full(monkeypatch)
    with pytest.raises(OutputError, match="No space left"):
        dd.save(dd.Model("other"), tmp_path / "kept.json", force=True)
    assert dd.load(tmp_path / "kept.json").name == "kept" and [p.name for p in tmp_path.iterdir()] == [
        "kept.json"
    ]


def test_a_file_system_without_fsync_is_accepted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    full(monkeypatch, errno.EINVAL)
    files.save_record(record(), tmp_path / "record.zarr")
    assert files.load_record(tmp_path / "record.zarr").sizes["time"]


def test_a_record_is_flushed_to_disk_before_it_is_renamed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The files of a record are written to the disk first, then its folders, and its name last."""
    events: list[tuple[str, str]] = []
    sync, rename = output._sync, Path.rename
    monkeypatch.setattr(
        output, "_sync", lambda path, mode: (sync(path, mode), events.append(("sync", str(path))))[0]
    )
    monkeypatch.setattr(
        Path, "rename", lambda self, to: (events.append(("rename", str(to))), rename(self, to))[1]
    )
    files.save_record(record(), tmp_path / "record.zarr")
    named = events.index(("rename", str(tmp_path / "record.zarr")))
    assert events[named + 1 :] == [("sync", str(tmp_path))]
    before = {Path(path).name for _, path in events[:named]}
    assert {p.name for p in (tmp_path / "record.zarr").rglob("*")} <= before


def test_a_document_is_flushed_to_disk_before_it_is_renamed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    events: list[str] = []
    replace = Path.replace
    monkeypatch.setattr(
        output, "_sync", lambda path, mode: events.append("folder" if path.is_dir() else "file")
    )
    monkeypatch.setattr(Path, "replace", lambda self, to: (events.append("replace"), replace(self, to))[1])
    dd.save(dd.Model("m"), tmp_path / "m.json")
    assert events == ["file", "replace", "folder"]


def test_rows_that_were_written_in_part_are_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Otherwise the next row would continue half a line."""
    rows = Rows(tmp_path / "rows.jsonl", {"name": "e"})
    rows.append([{"key": "1"}])
    before = (tmp_path / "rows.jsonl").read_bytes()
    with monkeypatch.context() as patch:
        full(patch)
        with pytest.raises(OutputError, match="No space left"):
            rows.append([{"key": "2"}])
    assert (tmp_path / "rows.jsonl").read_bytes() == before and set(rows.found) == {"1"}
    rows.append([{"key": "2"}])
    assert set(Rows(tmp_path / "rows.jsonl", {"name": "e"}).found) == {"1", "2"}


def test_appended_rows_and_the_name_of_a_new_file_are_flushed_to_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    events: list[tuple[str, int]] = []
    path, fsync = tmp_path / "rows.jsonl", os.fsync

    def watched(handle: int) -> None:
        kind = "folder" if stat.S_ISDIR(os.fstat(handle).st_mode) else "file"
        events.append((kind, path.read_bytes().count(b"\n")))
        fsync(handle)

    monkeypatch.setattr(os, "fsync", watched)
    rows = Rows(path, {"name": "e"})
    rows.append([{"key": "1"}, {"key": "2"}])
    assert events == [("file", 1), ("folder", 1), ("file", 3)]


def test_the_studio_flushes_a_file_to_disk_before_it_is_renamed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    waited: list[list[str]] = []
    monkeypatch.setattr(os, "fsync", lambda handle: waited.append(sorted(p.name for p in tmp_path.iterdir())))
    with OpenFolder(tmp_path) as folder:
        folder.write("a.json", b"1")
    assert len(waited) == 2 and waited[0][0].startswith(".a.json.") and waited[1] == ["a.json"]


def test_a_failed_write_of_the_studio_keeps_the_existing_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with OpenFolder(tmp_path) as folder:
        folder.write("a.json", b"1")
        full(monkeypatch)
        with pytest.raises(OutputError, match=r"a\.json: cannot be written: No space left.*in memory"):
            folder.write("a.json", b"2")
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("a.json", b"1")]


def test_a_file_that_is_not_durable_is_not_flushed_to_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    full(monkeypatch)
    output.write(tmp_path / "a", b"1", durable=False, private=True)
    assert (tmp_path / "a").read_bytes() == b"1"
    if os.name == "posix":
        assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o600


def test_a_studio_whose_save_fails_leaves_no_array_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    document, space = dd.load("example:color_search").document, Workspace(tmp_path)
    space.save(document, space.target("m.json"))
    before, write = sorted(tmp_path.iterdir()), OpenFolder.write

    def full(self: OpenFolder, name: str, content: bytes) -> None:
        if name.endswith(".json"):
            raise output.failed(Path(name), OSError(28, "No space left on device"))
        write(self, name, content)

    monkeypatch.setattr(OpenFolder, "write", full)
    for name in ("m.json", "other.json"):
        with pytest.raises(OutputError, match="No space left"):
            space.save(document, space.target(name))
        assert sorted(tmp_path.iterdir()) == before
    assert dd.load(tmp_path / "m.json").document == document


def test_what_a_killed_studio_left_of_unsaved_edits_is_removed(tmp_path: Path) -> None:
    store, unsaved = StateStore(tmp_path), tmp_path / "unsaved"
    unsaved.mkdir()
    with partial.file(unsaved / "0123456789abcdef.json") as beside:
        pass
    beside.write_bytes(b"half")
    array_files: dict[bytes, str] = {}
    for age, content in ((0, b"young"), (10**9, b"old")):
        name = f"0123456789abcdef.{hashlib.sha256(content).hexdigest()[:8]}.npz"
        (unsaved / name).write_bytes(content)
        os.utime(unsaved / name, (time.time() - age,) * 2)
        array_files[content] = name
    store.store_edits("fedcba9876543210", model().document, "")
    assert sorted(path.name for path in unsaved.iterdir()) == [
        array_files[b"young"],  # its document may follow
        "fedcba9876543210.json",
        "fedcba9876543210.note",
    ]
