"""Arrays of records that read what is selected, with several threads."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
import zarr
from xarray.core import indexing

import deodar as dd
from deodar import codec
from deodar.recording import files
from deodar.recording.chunks import COMPRESSORS, ChunkedArray
from deodar.recording.growing import GrowingRecord
from deodar.recording.lazy import LazyArray
from tests.deodar.recording.models import record

SHAPE, CHUNKS = (23, 6, 5), (4, 6, 2)

KEYS: list[tuple[Any, ...]] = [
    (slice(None), slice(None), slice(None)),
    (slice(None), 2, 3),
    (7, slice(None), slice(None)),
    (-1, -2, -3),
    (slice(3, 19, 5), slice(1, 4), 4),
    (slice(20, 2, -3), slice(None, None, -1), slice(4, 0, -2)),
    (np.array([5, 1, 22, 1]), slice(None), np.array([4, 0])),
    (np.array([], int), 1, slice(None)),
    (slice(5, 5), slice(None), slice(None)),
    (np.array([9, 9]), np.array([3]), 0),
]


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> tuple[xarray.Variable, np.ndarray]:
    """Return a variable of many chunks, and its values."""
    path = tmp_path_factory.mktemp("lazy") / "a"
    zarr.create_array(path, shape=SHAPE, chunks=CHUNKS, dtype="float32", compressors=COMPRESSORS)
    array = ChunkedArray(path, codec.parse((path / "zarr.json").read_text(encoding="utf-8")))
    values = np.random.default_rng(1).standard_normal(SHAPE, np.float32)
    array.store((0, 0, 0), values)
    return xarray.Variable(tuple("abc"), indexing.LazilyIndexedArray(LazyArray(array, SHAPE))), values


@pytest.mark.parametrize("key", KEYS)
def test_a_selection_equals_that_of_the_whole_array(
    key: tuple[Any, ...], stored: tuple[xarray.Variable, np.ndarray]
) -> None:
    variable, values = stored
    expected = xarray.Variable(tuple("abc"), values)[key].values
    found = variable[key].values
    assert found.shape == expected.shape and found.tobytes() == expected.tobytes()
    assert found.dtype == values.dtype


def test_a_selection_of_a_selection_reads_its_places(stored: tuple[xarray.Variable, np.ndarray]) -> None:
    variable, values = stored
    assert variable[3:20][::2][:, 1].values.tolist() == values[3:20][::2][:, 1].tolist()
    rows, columns = xarray.Variable("p", [22, 4, 4]), xarray.Variable("p", [0, 1, 4])
    assert variable[rows, 2, columns].values.tolist() == values[[22, 4, 4], 2, [0, 1, 4]].tolist()


def test_many_chunks_are_read_by_several_threads(
    stored: tuple[xarray.Variable, np.ndarray], monkeypatch: pytest.MonkeyPatch
) -> None:
    variable, values = stored
    monkeypatch.setattr("os.cpu_count", lambda: 3)
    seen, read = set[int](), ChunkedArray.read

    def noted(self: ChunkedArray, *arguments: Any) -> np.ndarray:
        seen.add(threading.get_ident())
        return read(self, *arguments)

    monkeypatch.setattr(ChunkedArray, "read", noted)
    assert variable.values.tobytes() == values.tobytes()
    assert seen and threading.get_ident() not in seen
    seen.clear()
    assert variable[0].values.tobytes() == values[0].tobytes()
    assert seen == {threading.get_ident()}


@pytest.mark.parametrize("ending", ["grown", "saved"])
def test_a_record_is_read_without_zarr(ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("deodar.recording.growing.LONGEST_CHUNK", 4)
    whole = record(every=1)
    if ending == "saved":
        dd.save_record(whole, tmp_path / "r.zarr")
    else:
        writer = GrowingRecord(tmp_path / "r.zarr", whole.isel(time=slice(0)))
        writer.put("time", whole["time"].values, {str(n): v.values for n, v in whole.data_vars.items()})
        writer.close(True)
    monkeypatch.setattr("deodar.recording.growing.LONGEST_CHUNK", 8192)
    opened = dd.open_record(tmp_path / "r.zarr")
    with monkeypatch.context() as without:
        without.setattr("zarr.Array.__getitem__", None)
        without.setattr("zarr.core.indexing.BasicIndexer.__init__", None)
        part = opened["u.activation"].isel(x=3).values
    assert part.tolist() == whole["u.activation"].values[:, 3].tolist()
    assert files.load_record(tmp_path / "r.zarr").identical(whole)
