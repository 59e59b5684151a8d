"""Records that are written during a run: committed as a whole, readable at any moment."""

from __future__ import annotations

import errno
import itertools
import json
import os
import shutil
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.errors import DamagedFile, OutputError, RecordError, RunWarning
from deodar.model import output
from deodar.recording import diverged, files, growing, sound
from deodar.recording.growing import GrowingRecord
from deodar.recording.record import about
from tests.deodar.recording.models import record


@pytest.fixture(scope="module")
def whole() -> xarray.Dataset:
    return record(every=1)


def begin(whole: xarray.Dataset, path: Path, **settings: Any) -> GrowingRecord:
    """Begin the record of a run without samples."""
    return GrowingRecord(path, whole.isel(time=slice(0)), **settings)


def put(writer: GrowingRecord, whole: xarray.Dataset, first: int, stop: int) -> None:
    part = whole.isel(time=slice(first, stop))
    writer.put("time", part["time"].values, {str(n): v.values for n, v in part.data_vars.items()})


def test_samples_are_readable_when_they_are_committed(whole: xarray.Dataset, tmp_path: Path) -> None:
    writer = begin(whole, tmp_path / "r.zarr")
    for first, stop in ((0, 1), (1, 7), (7, 8), (8, 21)):
        put(writer, whole, first, stop)
        writer.commit()
        part = files.load_record(tmp_path / "r.zarr")
        assert part.drop_attrs().identical(whole.isel(time=slice(stop)).drop_attrs())
    writer.close(True)
    assert files.load_record(tmp_path / "r.zarr").identical(whole)
    assert about(dd.open_record(tmp_path / "r.zarr"))["complete"] is True


def test_samples_are_committed_without_a_call(whole: xarray.Dataset, tmp_path: Path) -> None:
    writer = begin(whole, tmp_path / "r.zarr")
    put(writer, whole, 0, 5)
    for _ in range(100):
        writer._thread.join(0.05)
        if dd.open_record(tmp_path / "r.zarr").sizes["time"] == 5:
            break
    else:
        pytest.fail("the samples were not written within 5 s")
    writer.close(False)
    assert about(dd.open_record(tmp_path / "r.zarr"))["complete"] is False


def test_a_wall_clock_that_is_set_back_delays_no_sample(
    whole: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each call of the wall clock returns an earlier time than the last one; `monotonic` runs on."""
    back = itertools.count(1_700_000_000.0, -3600.0)
    monkeypatch.setattr("time.time", lambda: next(back))
    monkeypatch.setattr(growing, "METADATA_SECONDS", 0.1)
    writer = begin(whole, tmp_path / "r.zarr")
    metadata = tmp_path / "r.zarr" / "u.activation" / "zarr.json"
    for stop in (5, 9):
        put(writer, whole, 0 if stop == 5 else 5, stop)
        for _ in range(100):
            writer._thread.join(0.05)
            if json.loads(metadata.read_text())["shape"][0] == stop:
                break
        else:
            pytest.fail("the samples were not written within 5 s")
        assert dd.open_record(tmp_path / "r.zarr").sizes["time"] == stop
    writer.close(False)


def test_waiting_samples_hold_no_buffer_that_is_much_larger() -> None:
    buffer = np.zeros((100, 11), np.float32)
    small, large = growing._held(buffer[:49]), growing._held(buffer[:50])
    assert not np.shares_memory(small, buffer) and np.shares_memory(large, buffer)
    assert growing._held(buffer) is buffer


def test_chunks_end_in_the_middle_of_samples(
    whole: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(growing, "LONGEST_CHUNK", 4)
    writer = begin(whole, tmp_path / "r.zarr")
    for first, stop in ((0, 3), (3, 13), (13, 14), (14, 21)):
        put(writer, whole, first, stop)
        writer.commit()
    writer.close(True)
    assert files.load_record(tmp_path / "r.zarr").identical(whole)
    chunks = sorted(p.name for p in (tmp_path / "r.zarr" / "u.activation" / "c").iterdir())
    assert chunks == ["0", "1", "2", "3", "4", "5"]


def test_xarray_opens_a_record_that_grows_up_to_the_last_commit(
    whole: xarray.Dataset, tmp_path: Path
) -> None:
    writer = begin(whole, tmp_path / "r.zarr")
    put(writer, whole, 0, 6)
    writer.commit()
    put(writer, whole, 6, 9)
    with xarray.open_zarr(tmp_path / "r.zarr", chunks=None) as opened:
        assert opened["u.activation"].values.tolist() == whole["u.activation"].values[:6].tolist()
    writer.close(True)


def test_a_resumed_record_continues_after_the_given_samples(
    whole: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(growing, "LONGEST_CHUNK", 4)
    writer = begin(whole, tmp_path / "r.zarr")
    put(writer, whole, 0, 15)
    writer.close(False)
    writer = GrowingRecord.resumed(tmp_path / "r.zarr", {"time": 6})
    put(writer, whole, 6, 21)
    writer.close(True)
    assert files.load_record(tmp_path / "r.zarr").identical(whole)


def test_two_regions_that_are_written_in_turns_keep_their_samples_and_times(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One is three chunks ahead of the other; some of their samples come between two commits, in turns."""
    monkeypatch.setattr(growing, "LONGEST_CHUNK", 4)
    whole = record(every=1, trials=2)
    writer = begin(whole, tmp_path / "r.zarr", piece={"trial": 1})

    def add(trial: int, first: int, stop: int) -> None:
        part = whole.isel(time=slice(first, stop), trial=slice(trial, trial + 1))
        arrays = {str(n): v.values for n, v in part.data_vars.items()}
        writer.put("time", part["time"].values, arrays, first, (slice(trial, trial + 1),))

    ends = [0, 0]
    for k in range(21):
        for trial, n in ((0, 3), (1, 1)):
            stop = min(ends[trial] + n, 21)
            if stop > ends[trial]:
                add(trial, ends[trial], stop)
                ends[trial] = stop
        if k % 3 == 0:
            writer.commit()
            stored = dd.open_record(tmp_path / "r.zarr")
            assert stored["time"].values.tolist() == whole["time"].values[: max(ends)].tolist()
            for trial, end in enumerate(ends):
                for name in whole.data_vars:
                    kept = stored[name].isel(trial=trial, time=slice(end)).values
                    np.testing.assert_array_equal(kept, whole[name].isel(trial=trial, time=slice(end)).values)
    writer.close(True)
    assert files.load_record(tmp_path / "r.zarr").identical(whole)


@pytest.mark.skipif(os.name != "posix", reason="other systems do not lock folders")
def test_a_second_writer_is_refused(whole: xarray.Dataset, tmp_path: Path) -> None:
    writer = begin(whole, tmp_path / "r.zarr")
    with pytest.raises(RecordError, match="written by another process"):
        GrowingRecord.resumed(tmp_path / "r.zarr", {"time": 0})
    writer.close(True)
    GrowingRecord.resumed(tmp_path / "r.zarr", {"time": 0}).close(False)


def test_a_full_disk_is_an_error_of_the_next_call_and_keeps_what_was_committed(
    whole: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = begin(whole, tmp_path / "r.zarr")
    put(writer, whole, 0, 6)
    writer.commit()

    def refuse(*_: Any, **__: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as full:
        full.setattr(output, "replace", refuse)
        put(writer, whole, 6, 9)
        with pytest.raises(OutputError, match="No space left"):
            writer.commit()
        with pytest.raises(OutputError, match="No space left"):
            put(writer, whole, 9, 12)
        with pytest.raises(OutputError, match="No space left"):
            writer.close(True)
    stored = files.load_record(tmp_path / "r.zarr")
    assert stored.sizes["time"] == 6 and about(stored)["complete"] is False
    GrowingRecord.resumed(tmp_path / "r.zarr", {"time": 6}).close(False)


@pytest.mark.parametrize("committed", [0, 6])
@pytest.mark.parametrize("longest", [4, 21])
def test_a_full_disk_keeps_the_samples_that_fit(
    whole: xarray.Dataset, tmp_path: Path, committed: int, longest: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Chunks of 4 samples, and one chunk; samples that are committed already, and none."""
    monkeypatch.setattr(growing, "LONGEST_CHUNK", longest)
    path, replace = tmp_path / "r.zarr", output.replace
    writer = begin(whole, path)
    if committed:
        put(writer, whole, 0, committed)
        writer.commit()
    shutil.copytree(path, tmp_path / "all.zarr")
    undisturbed = GrowingRecord.resumed(tmp_path / "all.zarr", {"time": committed})
    put(undisturbed, whole, committed, 21)
    undisturbed.close(False)
    free = (size(tmp_path / "all.zarr") - size(path)) * 2 // 3  # of the bytes that the rest needs
    limit = size(path) + free

    def limited(place: Path, content: bytes) -> None:
        if size(path) + len(content) > limit:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        replace(place, content)

    with monkeypatch.context() as full:
        full.setattr(output, "replace", limited)
        put(writer, whole, committed, 21)
        with pytest.raises(OutputError, match="No space left"):
            writer.commit()
        writer.abandon()
    partly = files.load_record(path)
    assert committed < partly.sizes["time"] < 21
    assert partly.drop_attrs().identical(whole.isel(time=slice(partly.sizes["time"])).drop_attrs())
    continued = GrowingRecord.resumed(path, {"time": partly.sizes["time"]})
    put(continued, whole, partly.sizes["time"], 21)
    continued.close(True)
    assert files.load_record(path).identical(whole)


def size(path: Path) -> int:
    """Return the bytes of all chunks of a record."""
    return sum(p.stat().st_size for p in path.glob("*/c/**/*") if p.is_file())


@pytest.mark.parametrize("how", ["removed", "replaced"])
def test_a_record_that_is_taken_away_is_not_created_again(
    whole: xarray.Dataset, tmp_path: Path, how: str
) -> None:
    path = tmp_path / "r.zarr"
    writer = begin(whole, path)
    put(writer, whole, 0, 6)
    writer.commit()
    path.rename(tmp_path / "moved.zarr")
    if how == "replaced":
        files.save_record(whole, path)
    put(writer, whole, 6, 9)
    with pytest.raises(OutputError, match="removed or replaced"):
        writer.commit()
    with pytest.raises(OutputError, match="removed or replaced"):
        writer.close(True)
    assert path.exists() == (how == "replaced")
    assert files.load_record(tmp_path / "moved.zarr").sizes["time"] == 6


@pytest.mark.parametrize("how", ["missing", "cut", "changed", "longer"])
def test_a_damaged_chunk_ends_the_record_before_it(
    whole: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, how: str
) -> None:
    monkeypatch.setattr(growing, "LONGEST_CHUNK", 4)
    writer = begin(whole, tmp_path / "r.zarr")
    put(writer, whole, 0, 21)
    writer.close(True)
    chunk = tmp_path / "r.zarr" / "u.activation" / "c" / "2" / "0"
    content = bytearray(chunk.read_bytes())
    if how == "missing":
        chunk.unlink()
    elif how == "cut":
        chunk.write_bytes(content[:-7])
    elif how == "longer":
        chunk.write_bytes(content + b"1234")
    else:
        content[len(content) // 2] ^= 255
        chunk.write_bytes(content)
    with pytest.warns(RunWarning, match=r"r.zarr: 13 of 21 samples of time are left out"):
        stored = files.load_record(tmp_path / "r.zarr")
    assert stored.sizes["time"] == 8
    assert stored.drop_attrs().identical(whole.isel(time=slice(8)).drop_attrs())
    assert "13 of 21 samples of time are left out" in stored.attrs[sound.DAMAGED]
    assert "u.activation" in stored.attrs[sound.DAMAGED]
    lazy = files.opened(tmp_path / "r.zarr")
    assert lazy.sizes["time"] == (8 if how == "missing" else 21)
    if how != "missing":
        with pytest.raises(DamagedFile, match=r"r.zarr.*chunk 2, 0 of u.activation cannot be read"):
            lazy["u.activation"].load()


def test_the_provenance_of_a_killed_record_is_readable_without_its_arrays(
    whole: xarray.Dataset, tmp_path: Path
) -> None:
    begin(whole, tmp_path / "r.zarr").close(False)
    shutil.rmtree(tmp_path / "r.zarr" / "u.activation")
    text = json.loads((tmp_path / "r.zarr" / "zarr.json").read_text())
    assert json.loads(text["attributes"]["deodar"])["complete"] is False


def test_a_commit_waits_for_samples_that_came_during_an_earlier_one(
    whole: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, free, write = threading.Event(), threading.Event(), GrowingRecord._write

    def slow(self: GrowingRecord, *arguments: Any) -> None:
        begun.set()
        free.wait(10)
        write(self, *arguments)

    monkeypatch.setattr(GrowingRecord, "_write", slow)
    writer = begin(whole, tmp_path / "r.zarr")
    writer.annotate("changes", "[]")
    assert begun.wait(10)
    put(writer, whole, 0, 6)
    threading.Timer(0.2, free.set).start()
    writer.commit()
    assert dd.open_record(tmp_path / "r.zarr").sizes["time"] == 6
    writer.close(True)


def test_a_run_waits_for_a_slow_disk(
    whole: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The writer holds no more than PENDING_BYTES and what one call adds."""
    monkeypatch.setattr(growing, "PENDING_BYTES", 1000)
    writer = begin(whole, tmp_path / "r.zarr")
    for first in range(21):
        put(writer, whole, first, first + 1)
        assert writer._bytes < 1000 + 4 * (11 + 1 + 66)
    writer.close(True)
    assert files.load_record(tmp_path / "r.zarr").identical(whole)


def test_a_blank_copy_is_nan_from_the_start(tmp_path: Path) -> None:
    recorded = record(trials=3)
    writer = begin(recorded, tmp_path / "r.zarr", piece={"trial": 2})
    values = {str(n): v.values for n, v in recorded.data_vars.items()}
    for part in (slice(0, 2), slice(2, 3)):
        writer.put("time", recorded["time"].values, {n: v[part] for n, v in values.items()}, 0, (part,))
    writer.commit()
    writer.blank((1,))
    writer.close(True)
    stored = files.load_record(tmp_path / "r.zarr")
    assert all(np.isnan(v.values[1]).all() for v in stored.data_vars.values())
    assert stored.isel(trial=[0, 2]).identical(recorded.isel(trial=[0, 2]))


def test_a_flush_that_fails_at_the_end_is_an_error(
    whole: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = begin(whole, tmp_path / "r.zarr")
    put(writer, whole, 0, 6)

    def refuse(path: Path) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(output, "sync_tree", refuse)
    with pytest.raises(OutputError, match="No space left"):
        writer.close(True)


def test_a_record_of_a_newer_version_is_named(
    whole: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as newer:
        newer.setattr("deodar.recording.portable.VERSION", 9)
        writer = begin(whole, tmp_path / "r.zarr")
        put(writer, whole, 0, 3)
        writer.close(True)
    for read in (dd.open_record, dd.load_record):
        with pytest.raises(RecordError, match="of version 9"):
            read(tmp_path / "r.zarr")


def test_a_chunk_that_is_nan_is_not_missing(tmp_path: Path) -> None:
    recorded = record(trials=3)
    recorded["u.activation"].values[:] = np.nan
    writer = begin(recorded, tmp_path / "r.zarr")
    values = {str(n): v.values for n, v in recorded.data_vars.items()}
    writer.put("time", recorded["time"].values, values, 0, (slice(0, 3),))
    writer.close(True)
    found = files.load_record(tmp_path / "r.zarr")
    assert sound.DAMAGED not in found.attrs and found.sizes["time"] == 5


@pytest.mark.parametrize("complete", [False, True])
def test_samples_of_an_earlier_run_stay_until_they_are_written_again(
    whole: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, complete: bool
) -> None:
    monkeypatch.setattr(growing, "LONGEST_CHUNK", 4)
    writer = begin(whole, tmp_path / "r.zarr")
    put(writer, whole, 0, 15)
    writer.close(False)
    writer = GrowingRecord.resumed(tmp_path / "r.zarr", {"time": 6})
    put(writer, whole, 6, 9)
    writer.close(complete)
    n = 9 if complete else 15
    record = files.load_record(tmp_path / "r.zarr")
    assert record.drop_attrs().identical(whole.isel(time=slice(n)).drop_attrs())


def test_the_second_piece_of_copies_leaves_the_times_of_the_first(tmp_path: Path) -> None:
    recorded = record(trials=4)
    writer = begin(recorded, tmp_path / "r.zarr", piece={"trial": 2})
    values = {str(n): v.values for n, v in recorded.data_vars.items()}
    first, second = slice(0, 2), slice(2, 4)
    writer.put("time", recorded["time"].values, {n: v[first] for n, v in values.items()}, 0, (first,))
    writer.put(
        "time", recorded["time"].values[:2], {n: v[second][:, :2] for n, v in values.items()}, 0, (second,)
    )
    writer.close(False)
    found = files.load_record(tmp_path / "r.zarr")
    assert found["time"].values.tolist() == recorded["time"].values.tolist()
    assert found.isel(trial=first).drop_attrs().identical(recorded.isel(trial=first).drop_attrs())
    assert np.isnan(found["u.activation"].values[2:, 2:]).all()


def test_a_missing_chunk_of_copies_ends_an_incomplete_record(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(growing, "LONGEST_CHUNK", 2)
    recorded = record(trials=4)
    writer = begin(recorded, tmp_path / "r.zarr", piece={"trial": 2})
    part = slice(0, 2)
    values = {str(n): v.values[part] for n, v in recorded.data_vars.items()}
    writer.put("time", recorded["time"].values, values, 0, (part,))
    writer.close(False)
    assert files.load_record(tmp_path / "r.zarr").sizes["time"] == 5
    (tmp_path / "r.zarr" / "u.activation" / "c" / "0" / "1" / "0").unlink()
    with pytest.warns(RunWarning, match="left out"):
        found = files.load_record(tmp_path / "r.zarr")
    assert found.sizes["time"] == 2 and "u.activation" in found.attrs[sound.DAMAGED]


def test_a_record_that_was_removed_is_not_completed(whole: xarray.Dataset, tmp_path: Path) -> None:
    writer = begin(whole, tmp_path / "r.zarr")
    put(writer, whole, 0, 6)
    writer.commit()
    shutil.rmtree(tmp_path / "r.zarr")
    with pytest.raises(OutputError, match="removed or replaced"):
        writer.close(True)
    assert not (tmp_path / "r.zarr").exists()


def test_coordinates_are_added_again(whole: xarray.Dataset, tmp_path: Path) -> None:
    """A run that is made longer may lose further copies."""
    recorded = record(trials=3)
    begin(recorded, tmp_path / "r.zarr").close(True, diverged.coordinate({"trial": 3}, {(1,): "first"}))
    coordinate = diverged.coordinate({"trial": 3}, {(1,): "first", (2,): "second"})
    GrowingRecord.resumed(tmp_path / "r.zarr", {}).close(True, coordinate)
    found = files.load_record(tmp_path / "r.zarr")
    assert found["diverged"].values.tolist() == ["", "first", "second"]
    assert found.attrs["diverged"].startswith("2 of 3")


def test_a_resumed_record_states_its_new_settings_at_once(whole: xarray.Dataset, tmp_path: Path) -> None:
    writer = begin(whole, tmp_path / "r.zarr")
    put(writer, whole, 0, 6)
    writer.close(True)
    writer = GrowingRecord.resumed(tmp_path / "r.zarr", {"time": 6}, {"duration": 99.0})
    stated = about(dd.open_record(tmp_path / "r.zarr"))
    assert stated["complete"] is False and stated["duration"] == 99
    writer.close(True)
