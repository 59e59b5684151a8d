"""A record read one moment at a time."""

from __future__ import annotations

import os
import shutil
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.errors import RecordError, UnknownName
from deodar.recording import replay
from deodar.recording.replay import RecordReader

X = dd.Axis("x", 0, 10, samples=11)


def model() -> dd.Model:
    model = dd.Model("m")
    u = model.add(dd.Field("u", [X], noise=0.5, kernel=[dd.Gaussian(1, 2)]))
    model.add(dd.GaussianStimulus("s", [X], center=5, amplitude=2)) >> u
    model.add(dd.Field("n", [], resting_level=-1, noise=0.1))
    return model


@pytest.fixture(scope="module")
def record() -> xarray.Dataset:
    return dd.simulate(
        model(),
        duration=40,
        record=["u.activation", "n.output"],
        every=2,
        trials=3,
        sweep={"s.amplitude": [1, 4]},
    )


@pytest.fixture(params=["zarr", "nc"])
def reader(record: xarray.Dataset, tmp_path: Path, request: pytest.FixtureRequest) -> RecordReader:
    path = tmp_path / f"r.{request.param}"
    dd.save_record(record, path)
    return RecordReader(path)


def place(reader: RecordReader, path: str) -> tuple[str, str]:
    element, port = path.split(".")
    return next(e.id for e in reader.document.entries if e.path == element), port


def test_frames_are_those_of_the_record(reader: RecordReader, record: xarray.Dataset) -> None:
    assert np.array_equal(reader.times, np.arange(0, 41, 2)) and reader.complete and not reader.notes
    assert {d: list(v) for d, v in reader.copies.items()} == {"s.amplitude": [1, 4], "trial": [0, 1, 2]}
    u, n = place(reader, "u.activation"), place(reader, "n.output")
    assert set(reader.ports) == {u, n} and reader.axes(u) == (X,) and reader.axes(n) == ()
    for k in (0, 7, 20, 7):
        for copy in ({}, {"trial": 2}, {"s.amplitude": 1, "trial": 1}):
            where = {"time": k, "trial": 0, "s.amplitude": 0, **copy}
            for port, name in ((u, "u.activation"), (n, "n.output")):
                frame = reader.frame(port, k, copy)
                np.testing.assert_array_equal(frame, record[name].isel(where).values)


def test_the_moment_up_to_a_time_is_found(reader: RecordReader) -> None:
    assert [reader.index(t) for t in (-np.inf, -1, 0, 1.9, 2, 39, 40, np.inf)] == [0, 0, 0, 0, 1, 19, 20, 20]


def test_samples_cover_the_record_evenly(reader: RecordReader, record: xarray.Dataset) -> None:
    u = place(reader, "u.activation")
    for most, stride in ((1000, 1), (21, 1), (10, 3), (1, 21)):
        parts = list(reader.samples(u, {"trial": 1}, most))
        times, values = (np.concatenate([p[i] for p in parts]) for i in range(2))
        assert np.array_equal(times, reader.times[::stride])
        chosen = record["u.activation"].isel(
            {"trial": 1, "s.amplitude": 0, "time": slice(None, None, stride)}
        )
        np.testing.assert_array_equal(values, chosen.values)


def test_a_port_that_was_not_recorded_is_named(reader: RecordReader) -> None:
    with pytest.raises(UnknownName, match=r"u\.output.*not recorded.*record=.*u\.output"):
        reader.axes(place(reader, "u.output"))


def test_a_damaged_chunk_is_an_error_of_its_frames_alone(record: xarray.Dataset, tmp_path: Path) -> None:
    path = dd.save_record(record, tmp_path / "r.zarr")
    reader = RecordReader(path)
    for chunk in (path / "u.activation" / "c").rglob("*"):
        if chunk.is_file():
            chunk.write_bytes(b"damaged")
    with pytest.raises(RecordError, match=r"u\.activation.*cannot be read at this moment"):
        reader.frame(place(reader, "u.activation"), 3, {})
    assert reader.frame(place(reader, "n.output"), 3, {}) is not None


def test_chunks_are_kept_up_to_a_limit(reader: RecordReader, monkeypatch: pytest.MonkeyPatch) -> None:
    u = place(reader, "u.activation")
    reads: list[int] = []
    read = RecordReader._read
    monkeypatch.setattr(RecordReader, "_read", lambda *a: reads.append(1) or read(*a))
    for k in (3, 4, 3):
        reader.frame(u, k, {})
    assert len(reads) == 1
    monkeypatch.setattr(replay, "MOST_CACHED", 0)
    reader.frame(u, 3, {"trial": 1})
    for k in (3, 4):
        reader.frame(u, k, {"trial": 2})
    assert len(reads) == 4


def test_a_record_without_its_document_is_refused(record: xarray.Dataset, tmp_path: Path) -> None:
    plain = dd.save_record(record.assign_attrs(deodar="{}"), tmp_path / "r.zarr")
    with pytest.raises(RecordError, match="does not state the document"):
        RecordReader(plain)
    with pytest.raises(RecordError, match="no such record"):
        RecordReader(tmp_path / "other.zarr")


def test_an_incomplete_record_says_so(record: xarray.Dataset, tmp_path: Path) -> None:
    text = record.attrs["deodar"].replace('"complete": true', '"complete": false')
    part = record.isel(time=slice(5)).assign_attrs(deodar=text)
    assert text != record.attrs["deodar"]
    reader = RecordReader(dd.save_record(part, tmp_path / "r.zarr"))
    assert not reader.complete and "incomplete" in reader.notes[0] and len(reader.times) == 5
    assert not reader.refresh()
    shutil.rmtree(tmp_path / "r.zarr")
    dd.save_record(record, tmp_path / "r.zarr")
    assert reader.refresh() and reader.complete and len(reader.times) == 21 and not reader.notes
    assert reader.frame(place(reader, "u.activation"), 20, {}) is not None


def test_ports_with_intervals_of_their_own_have_their_last_sample_at_each_moment(
    record: xarray.Dataset, tmp_path: Path
) -> None:
    sparse = record.isel(trial=0, drop=True).isel({"s.amplitude": 0}, drop=True)
    slow = sparse["n.output"].isel(time=slice(1, None, 4)).rename(time="n.output.time")
    path = dd.save_record(sparse.drop_vars("n.output").assign({"n.output": slow}), tmp_path / "r.zarr")
    reader = RecordReader(path)
    n = place(reader, "n.output")
    assert len(reader.times) == 21 and reader.frame(n, 0, {}) is None
    for k in (1, 4, 5, 20):
        np.testing.assert_array_equal(reader.frame(n, k, {}), slow.values[(k - 1) // 4])
    assert [len(t) for t, _ in reader.samples(n, {}, 100)] == [5]


def test_a_saved_record_has_chunks_of_whole_frames_of_one_copy(
    record: xarray.Dataset, tmp_path: Path
) -> None:
    opened = dd.open_record(dd.save_record(record, tmp_path / "r.zarr"))
    assert opened["u.activation"].encoding["chunks"] == (1, 1, 21, 11)
    assert opened["n.output"].encoding["chunks"] == (1, 1, 21)


def test_a_record_written_during_a_run_is_read(tmp_path: Path) -> None:
    record = dd.simulate(model(), duration=300, record=["u.activation", "n.output"], out=tmp_path / "r.zarr")
    reader = RecordReader(tmp_path / "r.zarr")
    u = place(reader, "u.activation")
    for k in (0, 123, 300):
        np.testing.assert_array_equal(reader.frame(u, k, {}), record["u.activation"].values[k])


def test_a_chunk_that_is_lost_while_the_record_is_open_is_a_note_and_no_warning(tmp_path: Path) -> None:
    path = tmp_path / "r.zarr"
    dd.simulate(model(), 40, record=["u.activation"], out=dd.Output(path))
    reader = RecordReader(path)
    assert not reader.notes
    (path / "u.activation" / "c" / "0" / "0").unlink()
    os.utime(path / "zarr.json", (0, 0))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert reader.refresh()
    assert "left out" in reader.notes[0]
