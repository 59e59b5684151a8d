"""NetCDF 3 files: other programs read them, and what is damaged is noticed, also when a part is read."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.errors import DamagedFile, RecordError
from deodar.recording import files, netcdf, portable


@pytest.fixture
def stored() -> xarray.Dataset:
    """Return arrays of each type, some of several checked blocks."""
    draw = np.random.default_rng(0)
    variables = {
        "wide": (("time", "x"), draw.normal(size=(40, 25))),
        "single": (("time",), draw.normal(size=40).astype("f4")),
        "bytes": (("x",), np.arange(25, dtype="i1"), {"units": "mV", "range": [0.0, 2.5], "n": 3}),
        "scalar": ((), np.float64(2.5)),
    }
    return xarray.Dataset(variables, {"x": np.arange(25, dtype="i4")}, {"title": "größe", "k": 7})


@pytest.fixture
def path(stored: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(netcdf, "CHECKED_BYTES", 1000)
    monkeypatch.setattr(netcdf, "BLOCK", 33)
    readers = {str(n): (lambda slab, v=v: v[slab].values) for n, v in stored.variables.items()}
    netcdf.write(stored, readers, tmp_path / "a.nc")
    return tmp_path / "a.nc"


def test_what_was_written_is_read_by_deodar_and_by_another_reader(stored: xarray.Dataset, path: Path) -> None:
    read = netcdf.read(path)
    with xarray.open_dataset(path, engine="scipy", decode_cf=False) as by_scipy:
        for name, variable in stored.variables.items():
            for dataset in (read, by_scipy):
                assert np.array_equal(dataset[name].values, variable.values)
                assert dataset[name].dims == variable.dims
        assert by_scipy.attrs == read.attrs and read.attrs["title"] == "größe" and read.attrs["k"] == 7
        assert list(read["bytes"].attrs["range"]) == [0.0, 2.5] and read["bytes"].attrs["units"] == "mV"


def test_a_selection_equals_that_of_the_whole_array(stored: xarray.Dataset, path: Path) -> None:
    for index in [
        {"time": 3},
        {"time": slice(5, 30, 7), "x": [4, 2]},
        {"time": slice(None, None, -3)},
        {"time": [], "x": 1},
        {"time": -1, "x": slice(3, 4)},
    ]:
        assert np.array_equal(netcdf.read(path)["wide"].isel(index), stored["wide"].isel(index))


def flipped(path: Path, bit: int) -> bytes:
    content = bytearray(path.read_bytes())
    content[bit // 8] ^= 1 << (bit % 8)
    return bytes(content)


def test_each_flipped_bit_of_the_header_is_refused(path: Path) -> None:
    whole, header = path.read_bytes(), netcdf._Header(memoryview(path.read_bytes()))
    header.read()
    for bit in np.random.default_rng(1).permutation(8 * len(header.read_bytes))[:300]:
        path.write_bytes(flipped(path, int(bit)))
        with pytest.raises(DamagedFile):
            # the bits of the name of the proof leave a file without one: `portable` refuses it
            if portable.PROOF not in netcdf.read(path).attrs:
                raise DamagedFile("has no proof")
        path.write_bytes(whole)


def test_a_part_that_is_read_is_compared_with_its_checksum(stored: xarray.Dataset, path: Path) -> None:
    at = path.read_bytes().index(stored["wide"].values.astype(">f8").tobytes())
    path.write_bytes(flipped(path, 8 * (at + 3010)))
    opened = netcdf.read(path)
    assert np.array_equal(opened["wide"].isel(time=slice(0, 15)), stored["wide"].isel(time=slice(0, 15)))
    assert np.array_equal(opened["wide"].isel(time=slice(20, 40)), stored["wide"].isel(time=slice(20, 40)))
    for time in (15, 19):
        with pytest.raises(DamagedFile, match="'wide'"):
            opened["wide"].isel(time=time).load()


@pytest.mark.parametrize("size", [0, 3, 9, 60, 700])
def test_a_file_that_was_cut_is_refused(path: Path, size: int) -> None:
    path.write_bytes(path.read_bytes()[:size])
    with pytest.raises((DamagedFile, ValueError)):
        netcdf.read(path)


def test_a_record_without_the_proof_of_its_version_is_damaged(tmp_path: Path) -> None:
    model = dd.Model("one")
    model.add(dd.Field("u", []))
    path = dd.save_record(dd.simulate(model, 3), tmp_path / "r.nc")
    path.write_bytes(path.read_bytes().replace(portable.PROOF.encode(), portable.PROOF[::-1].encode()))
    for read in (files.load_record, files.open_record):
        with pytest.raises(RecordError, match="no proof"):
            read(path)


@pytest.mark.parametrize("saved", ["r.nc", "r.zarr"])
@pytest.mark.parametrize("opened", ["o.nc", "o.zarr"])
def test_what_another_program_opened_is_saved_without_the_proof_of_its_file(
    tmp_path: Path, opened: str, saved: str
) -> None:
    model = dd.Model("one")
    model.add(dd.Field("u", []))
    record = dd.simulate(model, 3)
    path = dd.save_record(record, tmp_path / opened)
    with xarray.open_dataset(path, decode_cf=False) as by_another:
        assert portable.PROOF in by_another.attrs
        copy = dd.load_record(dd.save_record(by_another, tmp_path / saved))
    assert copy.attrs == record.attrs and copy.equals(record)
    assert not any(portable.CHECKSUMS in variable.attrs for variable in copy.variables.values())


def test_values_that_are_read_are_in_memory_once(tmp_path: Path) -> None:
    values = np.zeros((500, 4000))
    read_slab = {"a": lambda slab: values[slab]}
    netcdf.write(xarray.Dataset({"a": (("t", "x"), values)}), read_slab, tmp_path / "a.nc")
    opened = netcdf.read(tmp_path / "a.nc")
    tracemalloc.start()
    try:
        assert opened["a"].values.nbytes == values.nbytes
        assert tracemalloc.get_traced_memory()[1] < 1.3 * values.nbytes
    finally:
        tracemalloc.stop()
