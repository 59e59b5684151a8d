"""Records that are written in blocks: NetCDF, CSV tables, and the files of cedar."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import xarray

import deodar as dd
from deodar.errors import OutputExists, RecordError
from deodar.recording import files, portable, table
from deodar.recording.lazy import LazyArray
from deodar.recording.slabs import slabs
from deodar_interop.records import cedar
from tests.deodar.recording.models import record


@pytest.mark.parametrize(
    ("shape", "most"),
    list(itertools.product([(), (5,), (4, 3), (2, 3, 4), (3, 1, 7), (0, 3)], [1, 2, 5, 100])),
)
def test_slabs_cover_an_array_in_its_order(shape: tuple[int, ...], most: int) -> None:
    array = np.arange(np.prod(shape, dtype=int)).reshape(shape)
    parts = [array[slab].ravel() for slab in slabs(shape, most)]
    assert np.array_equal(np.concatenate(parts), array.ravel())
    assert all(part.size <= most for part in parts)


def test_a_large_record_is_the_same_netcdf_file_in_blocks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recording = record(trials=2, sweep={"s.amplitude": [4.0, 8.0]})
    files.save_record(recording, tmp_path / "run.zarr")
    recording = dd.load_record(tmp_path / "run.zarr")
    files.save_record(recording, tmp_path / "whole.nc")
    monkeypatch.setattr(portable, "LARGE", 0)
    monkeypatch.setattr(portable, "BLOCK", 7)
    monkeypatch.setattr(files.netcdf, "BLOCK", 5)
    files.save_record(recording, tmp_path / "blocks.nc")
    assert (tmp_path / "blocks.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes()
    files.save_record(dd.open_record(tmp_path / "run.zarr"), tmp_path / "opened.nc")
    assert files.load_record(tmp_path / "opened.nc").identical(recording)


def test_a_large_record_is_the_same_zarr_record_in_blocks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("deodar.recording.growing.LONGEST_CHUNK", 2)
    recording = record(trials=2, sweep={"s.amplitude": [4.0, 8.0]})
    files.save_record(recording, tmp_path / "whole.zarr")
    monkeypatch.setattr(portable, "LARGE", 0)
    monkeypatch.setattr(portable, "BLOCK", 7)
    sizes, select = list[int](), LazyArray._selected

    def noted(self: LazyArray, key: tuple[Any, ...]) -> np.ndarray:
        found = select(self, key)
        sizes.append(found.size)
        return found

    opened = dd.open_record(tmp_path / "whole.zarr")
    with monkeypatch.context() as watched:
        watched.setattr(LazyArray, "_selected", noted)
        files.save_record(opened, tmp_path / "blocks.zarr")
    assert 0 < max(sizes) <= 7
    assert files.load_record(tmp_path / "blocks.zarr").identical(recording)
    with xarray.open_zarr(tmp_path / "blocks.zarr", chunks=None) as plain:
        assert plain["u.activation"].values.tobytes() == recording["u.activation"].values.tobytes()


def test_other_programs_read_the_netcdf_file(tmp_path: Path) -> None:
    recording = record(trials=2).assign_coords(late=("trial", [0.5, 1.5], {"units": "ms"}))
    files.save_record(recording, tmp_path / "run.nc")
    with scipy.io.netcdf_file(tmp_path / "run.nc", mmap=False) as arrays:
        u = arrays.variables["u.activation"]
        assert u.dimensions == ("trial", "time", "x") and u.data.dtype == ">f4"
        assert np.array_equal(u.data, recording["u.activation"].values)
        assert u.long_name == b"activation of u" and arrays.variables["x"].units == b"deg"
        assert arrays.variables["x"].lower == 0.0 and arrays.variables["x"].periodic == 0
    with xarray.open_dataset(tmp_path / "run.nc", engine="scipy") as decoded:
        assert "late" in decoded.coords and decoded["late"].attrs["units"] == "ms"


def test_a_table_in_blocks_is_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files.save_record(record(trials=2), tmp_path / "run.zarr")
    table.write(dd.load_record(tmp_path / "run.zarr"), tmp_path / "whole.csv")
    monkeypatch.setattr(table, "ROWS", 7)
    table.write(dd.open_record(tmp_path / "run.zarr"), tmp_path / "blocks.csv")
    assert (tmp_path / "blocks.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()


def read(path: Path) -> tuple[tuple[int, ...], np.ndarray, np.ndarray]:
    """Return the sizes, times and values of a file of cedar, whose first axis changes first in a row."""
    first, *rows = path.read_text().splitlines()
    kind, number, *sizes = first.split(",")
    assert (kind, number) == ("Mat", "CV_32F")
    shape = tuple(map(int, sizes))
    times, values = [], []
    for row in rows:
        time, *numbers = row.split(",")
        assert time.endswith(" s")
        times.append(float(time.removesuffix(" s")))
        values.append(np.asarray(numbers, np.float32).reshape(shape, order="F"))
    return shape, np.asarray(times), np.stack(values)


def test_the_files_of_cedar_hold_a_time_and_a_matrix_in_each_row(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cedar, "BLOCK", 25)
    recording = record()
    cedar.save(recording, tmp_path / "recording")
    odd = next(str(name) for name in recording.data_vars if "odd" in str(name))
    for name, file, shape in (
        ("n.activation", "n.activation.csv", (1, 1)),
        ("u.activation", "u.activation.csv", (11, 1)),
        (odd, "_odd_name_._u_-_u_π_.output.csv", (11, 6)),
    ):
        reading = read(tmp_path / "recording" / file)
        assert reading[0] == shape and np.allclose(reading[1], recording["time"].values / 1000, rtol=1e-12)
        assert np.array_equal(reading[2].reshape(recording[name].shape), recording[name].values)
    assert len(list((tmp_path / "recording").iterdir())) == 3
    with pytest.raises(OutputExists):
        cedar.save(recording, tmp_path / "recording")


def test_the_files_of_cedar_have_a_folder_for_each_trial_and_point(tmp_path: Path) -> None:
    recording = record(trials=[3, 5], sweep={"s.amplitude": [4.0, 8.0]})[["n.activation"]]
    cedar.save(recording, tmp_path / "all")
    for amplitude, trial in itertools.product((4, 8), (3, 5)):
        place = tmp_path / "all" / f"s.amplitude={amplitude}" / f"Trial_{trial}" / "n.activation.csv"
        one = recording["n.activation"].sel({"s.amplitude": amplitude, "trial": trial})
        assert np.array_equal(read(place)[2].ravel(), one.values)


def test_cedar_needs_times_in_seconds(tmp_path: Path) -> None:
    recording = record()[["n.activation"]]
    with pytest.raises(RecordError, match=r"n\.activation: has no times"):
        cedar.save(recording.isel(time=0), tmp_path / "none")
    recording["time"].attrs["units"] = "abstract"
    with pytest.raises(RecordError, match="abstract times"):
        cedar.save(recording, tmp_path / "none")
    recording["time"].attrs["units"] = "1 = 64 ms"
    cedar.save(recording.astype(np.float64), tmp_path / "double")
    lines = (tmp_path / "double" / "n.activation.csv").read_text().splitlines()
    assert lines[0] == "Mat,CV_64F,1,1" and lines[2].startswith("0.32 s,")
    assert not (tmp_path / "none").exists()


def test_an_opened_record_has_the_order_and_the_coordinates_of_a_loaded_one(tmp_path: Path) -> None:
    recording = record(trials=2).assign_coords({"too late (π)": ("trial", [0.5, 1.5])})
    for name in ("run.zarr", "run.nc"):
        files.save_record(recording, tmp_path / name)
        opened = dd.open_record(tmp_path / name)
        assert list(opened.data_vars) == list(recording.data_vars) and opened.identical(recording)
        assert set(opened.coords) == set(recording.coords)
