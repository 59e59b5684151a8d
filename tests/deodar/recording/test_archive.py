"""Records in one zip file: they are read back exactly, by other programs too, and damage is noticed."""

from __future__ import annotations

import io
import random
import zipfile

import numpy as np
import pytest
import xarray
import zarr

from deodar.errors import RecordError
from deodar.recording import archive
from deodar.recording.archive import Archive, ArchiveWriter


@pytest.fixture
def record():
    """Return a record of many types: numbers, truth values, texts, one number, and nothing."""
    times = np.arange(5) * 0.5
    values = np.random.default_rng(1).normal(size=(5, 4)).astype(np.float32)
    return xarray.Dataset(
        {
            "a field.activation": (("time", "x"), values, {"long_name": "activation of a field"}),
            "moving": ("time", times > 1),
            "count": ("time", np.arange(5, dtype=np.uint8)),
            "label": ("time", np.asarray(["a", "b", "", "ü", "a"])),
            "one": ((), np.float64(np.nan)),
            "none": (("time", "nothing"), np.zeros((5, 0))),
        },
        {"time": ("time", times, {"units": "ms"}), "x": ("x", np.arange(4.0))},
        {"deodar": '{"trial": 3}', "title": "a model"},
    )


def _written(record, count=2):
    writer = ArchiveWriter()
    for number in range(count):
        writer.add(f"{number:08}", record.isel(time=slice(5 - number)))
    return writer.close({"trials": [0, 1]})


def test_records_of_different_lengths_are_read_back_exactly(record):
    content = _written(record)
    opened = Archive(io.BytesIO(content), "here")
    assert opened.attributes == {"trials": [0, 1]}
    assert opened.read("00000000").identical(record)
    assert opened.read("00000001").identical(record.isel(time=slice(4)))
    assert content == _written(record), "equal records give equal bytes"
    opened.close()


def test_an_array_of_several_chunks_is_read_back(record, monkeypatch):
    monkeypatch.setattr(archive, "CHUNK_BYTES", 40)
    content = _written(record, 1)
    names = zipfile.ZipFile(io.BytesIO(content)).namelist()
    assert [name for name in names if "activation/c/" in name] == [
        f"00000000/a_field.activation/c/{k}/0" for k in range(3)
    ]
    assert Archive(io.BytesIO(content), "here").read("00000000").identical(record)


def test_other_programs_open_a_record_by_its_name(record, tmp_path):
    (tmp_path / "some.zarr.zip").write_bytes(_written(record))
    with zarr.storage.ZipStore(tmp_path / "some.zarr.zip") as store:
        loaded = xarray.open_zarr(store, group="00000001", zarr_format=3, consolidated=False).load()
    np.testing.assert_array_equal(loaded["a_field.activation"], record["a field.activation"][:4])
    assert loaded["moving"].dtype == bool and loaded["time"].attrs["units"] == "ms"


def test_chunks_are_compressed_once(record):
    entries = zipfile.ZipFile(io.BytesIO(_written(record))).infolist()
    assert {entry.compress_type for entry in entries} == {zipfile.ZIP_STORED}


def test_damage_is_an_error_and_never_another_value(record):
    content, chance = _written(record), random.Random(4)
    wrong = 0
    for _ in range(150):
        damaged = bytearray(content)
        for _ in range(chance.choice((1, 1, 8))):
            damaged[chance.randrange(len(damaged))] ^= 1 << chance.randrange(8)
        if chance.random() < 0.2:
            del damaged[chance.randrange(len(damaged)) :]
        try:
            opened = Archive(io.BytesIO(bytes(damaged)), "here")
            arrays = [opened.read(f"{k:08}") for k in (0, 1)]
        except RecordError as error:
            assert str(error).startswith("here: ") and "may be damaged" in str(error)
            wrong += 1
        else:
            assert arrays[0].identical(record) and arrays[1].identical(record.isel(time=slice(4)))
    assert wrong > 75


def test_another_file_is_refused():
    with pytest.raises(RecordError, match="here: cannot be read as a file of records"):
        Archive(io.BytesIO(b"something else"), "here")
