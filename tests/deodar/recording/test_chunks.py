"""Chunks that deodar writes as files: Zarr and xarray read every layout of them back."""

from __future__ import annotations

import itertools
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
import zarr
import zarr.codecs

from deodar import codec
from deodar.errors import DamagedFile, RecordError
from deodar.recording import files, portable
from deodar.recording.chunks import COMPRESSORS, ChunkedArray
from deodar.recording.growing import GrowingRecord
from tests.deodar.recording.models import record

ZSTD = (zarr.codecs.ZstdCodec(level=1), zarr.codecs.Crc32cCodec())


def created(
    path: Path, shape: tuple[int, ...], chunks: tuple[int, ...], dtype: str, compressors: Any = COMPRESSORS
) -> ChunkedArray:
    """Create an array with Zarr, and open it as chunks."""
    zarr.create_array(
        path,
        shape=shape,
        chunks=chunks,
        dtype=dtype,
        compressors=compressors,
        fill_value=np.nan if dtype.startswith("f") else 0,
    )
    return opened(path)


def opened(path: Path) -> ChunkedArray:
    return ChunkedArray(path, codec.parse((path / "zarr.json").read_text(encoding="utf-8")))


LAYOUTS = [
    ((9,), (4,)),
    ((9, 5), (4, 5)),
    ((3, 9, 5), (2, 4, 5)),
    ((3, 4, 9, 2, 3), (2, 4, 4, 2, 3)),
    ((2, 7, 6, 5), (1, 3, 4, 2)),
]


@pytest.mark.parametrize("compressors", [COMPRESSORS, ZSTD, ZSTD[:1]], ids=["blosc", "zstd", "plain"])
@pytest.mark.parametrize("dtype", ["float32", "float64", "int64", "bool"])
@pytest.mark.parametrize(("shape", "chunks"), LAYOUTS)
def test_zarr_reads_blocks_that_are_written_anywhere(
    shape: tuple[int, ...], chunks: tuple[int, ...], dtype: str, compressors: Any, tmp_path: Path
) -> None:
    array = created(tmp_path / "a", shape, chunks, dtype, compressors)
    expected = np.full(shape, array.fill, dtype)
    rng = np.random.default_rng(len(shape))
    for _ in range(6):
        start = [int(rng.integers(n)) for n in shape]
        size = [int(rng.integers(1, n - first + 1)) for first, n in zip(start, shape, strict=True)]
        values = (rng.standard_normal(size) * 3).astype(dtype)
        if dtype.startswith("f"):
            values[rng.random(size) < 0.2] = np.nan
        array.store(start, values)
        block = tuple(slice(a, a + n) for a, n in zip(start, size, strict=True))
        expected[block] = values
        assert array.load(start, size).tobytes() == values.tobytes()
        found: Any = zarr.open_array(tmp_path / "a", mode="r")
        assert np.asarray(found[...]).tobytes() == expected.tobytes()
    assert array.load([0] * len(shape), shape).tobytes() == expected.tobytes()


def test_values_of_other_orders_and_types_are_stored_in_c_order(tmp_path: Path) -> None:
    array = created(tmp_path / "a", (4, 6), (4, 6), "float32")
    values = np.arange(24.0).reshape(6, 4).T
    assert not values.flags.c_contiguous
    array.store((0, 0), values)
    array.store((0, 0), values.astype(">f8"))
    found: Any = zarr.open_array(tmp_path / "a", mode="r")
    assert np.asarray(found[...]).tolist() == values.tolist()


def test_a_chunk_that_is_nan_has_a_file_and_a_missing_one_is_nan(tmp_path: Path) -> None:
    array = created(tmp_path / "a", (8, 3), (4, 3), "float32")
    array.store((4, 0), np.full((4, 3), np.nan, np.float32))
    assert [array.path((k, 0)).is_file() for k in range(2)] == [False, True]
    assert np.isnan(array.load((0, 0), (8, 3))).all()


@pytest.mark.parametrize("damage", ["cut", "changed", "longer", "empty"])
def test_a_damaged_chunk_is_not_read(damage: str, tmp_path: Path) -> None:
    array = created(tmp_path / "a", (4, 50), (4, 50), "float32")
    array.store((0, 0), np.arange(200, dtype=np.float32).reshape(4, 50))
    content = array.path((0, 0)).read_bytes()
    middle = len(content) // 2
    array.path((0, 0)).write_bytes(
        {
            "cut": content[:-3],
            "changed": content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :],
            "longer": content + b"1234",
            "empty": b"",
        }[damage]
    )
    with pytest.raises(DamagedFile):
        array.load((0, 0), (4, 50))
    with pytest.raises(DamagedFile):
        array.store((1, 0), np.zeros((1, 50), np.float32))


def test_a_chunk_of_another_array_is_not_read(tmp_path: Path) -> None:
    other = created(tmp_path / "other", (8, 50), (8, 50), "float32")
    other.store((0, 0), np.zeros((8, 50), np.float32))
    array = created(tmp_path / "a", (4, 50), (4, 50), "float32")
    array.store((0, 0), np.zeros((4, 50), np.float32))
    array.path((0, 0)).write_bytes(other.path((0, 0)).read_bytes())
    with pytest.raises(DamagedFile):
        array.load((0, 0), (4, 50))


@pytest.mark.parametrize("compressors", [None, zarr.codecs.GzipCodec()])
def test_other_encodings_are_refused_by_name(compressors: Any, tmp_path: Path) -> None:
    with pytest.raises(RecordError, match=r"encoded by bytes.*cannot continue"):
        created(tmp_path / "a", (4, 5), (4, 5), "float32", compressors)


def test_folders_of_chunks_are_created_but_never_that_of_the_array(tmp_path: Path) -> None:
    array = created(tmp_path / "a", (4, 5), (2, 5), "float32")
    array.store((0, 0), np.zeros((4, 5), np.float32))
    assert sorted(p.name for p in (tmp_path / "a" / "c").iterdir()) == ["0", "1"]
    (tmp_path / "a").rename(tmp_path / "b")
    with pytest.raises(FileNotFoundError):
        array.store((0, 0), np.zeros((4, 5), np.float32))
    assert not (tmp_path / "a").exists()


PIECES: list[dict[str, int]] = [{}, {"trial": 2}, {"u.resting_level": 1}]


@pytest.mark.parametrize("piece", PIECES, ids=["whole", "trials", "points"])
def test_xarray_reads_a_record_of_several_leading_dimensions(
    piece: dict[str, int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("deodar.recording.growing.LONGEST_CHUNK", 3)
    recorded = record(trials=3, sweep={"u.resting_level": [-6, -5]})
    values = {str(name): v.values for name, v in recorded.data_vars.items()}
    writer = GrowingRecord(tmp_path / "r.zarr", recorded.isel(time=slice(0)), piece=piece)
    sizes = {"u.resting_level": 2, "trial": 3}
    steps = [range(0, n, piece.get(name, n)) for name, n in sizes.items()]
    for starts in itertools.product(*steps):
        region = tuple(
            slice(first, min(n, first + piece.get(name, n)))
            for first, (name, n) in zip(starts, sizes.items(), strict=True)
        )
        for first, stop in ((0, 2), (2, recorded.sizes["time"])):
            part = {name: v[region][:, :, first:stop] for name, v in values.items()}
            writer.put("time", recorded["time"].values[first:stop], part, first, region)
            writer.commit()
    with xarray.open_zarr(tmp_path / "r.zarr", chunks=None) as plain:
        names = {old: new for new, old in codec.parse(plain.attrs[portable.KEY])["names"].items()}
        for name, array in values.items():
            assert plain[names.get(name, name)].values.tobytes() == array.tobytes()
    writer.close(True)
    assert files.load_record(tmp_path / "r.zarr").identical(recorded)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        alone = xarray.open_zarr(tmp_path / "r.zarr", consolidated=False, chunks=None)
    for name, array in values.items():
        assert alone[names.get(name, name)].values.tobytes() == array.tobytes()


def test_a_record_of_an_earlier_version_continues_with_its_own_compressor(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = record(every=1)
    with monkeypatch.context() as earlier:
        earlier.setattr("deodar.recording.growing.COMPRESSORS", ZSTD)
        writer = GrowingRecord(tmp_path / "r.zarr", whole.isel(time=slice(0)))
        part = whole.isel(time=slice(0, 7))
        writer.put("time", part["time"].values, {str(n): v.values for n, v in part.data_vars.items()})
        writer.close(False)
    writer = GrowingRecord.resumed(tmp_path / "r.zarr", {"time": 5})
    part = whole.isel(time=slice(5, None))
    writer.put("time", part["time"].values, {str(n): v.values for n, v in part.data_vars.items()})
    writer.close(True)
    assert files.load_record(tmp_path / "r.zarr").identical(whole)
