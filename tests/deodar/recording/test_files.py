"""Records as files: they are read exactly, never half-written, and never overwrite other files."""

from __future__ import annotations

import csv
import json
import os
from pathlib import Path

import numpy as np
import pandas
import pytest
import xarray

import deodar as dd
from deodar.recording import files
from deodar.recording.provenance import KEY
from deodar.recording.record import about
from tests.deodar.recording.models import record


@pytest.fixture(scope="module")
def recorded() -> xarray.Dataset:
    return record(trials=3, sweep={"s.amplitude": [1.0, 2.0]})


@pytest.mark.parametrize("suffix", [".zarr", ".nc"])
def test_a_saved_record_is_equal_when_loaded(recorded: xarray.Dataset, suffix: str, tmp_path: Path) -> None:
    path = files.save_record(recorded, tmp_path / f"record{suffix}")
    loaded = files.load_record(path)
    assert loaded.identical(recorded)
    assert all(
        loaded[name].dtype == recorded[name].dtype and loaded[name].dims == recorded[name].dims
        for name in recorded.variables
    )
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("suffix", [".zarr", ".nc"])
def test_an_opened_record_reads_only_what_is_selected(
    recorded: xarray.Dataset, suffix: str, tmp_path: Path
) -> None:
    opened = dd.open_record(files.save_record(recorded, tmp_path / f"record{suffix}"))
    assert not any(v.variable._in_memory for v in opened.data_vars.values() if suffix == ".zarr")
    part = {"s.amplitude": 1, "trial": 2, "time": slice(1, 3)}
    assert opened["u.activation"].isel(part).identical(recorded["u.activation"].isel(part))
    assert opened.identical(recorded)


@pytest.mark.parametrize("names", [["u.output", "n.activation"], ["n.activation", "u.output"]])
def test_an_opened_record_lists_variables_in_the_order_in_which_they_were_asked_for(
    names: list[str], tmp_path: Path
) -> None:
    """A record that is written during its run has a folder for each of them, in any order."""
    model = dd.Model("two")
    for name in "un":
        model.add(dd.Field(name))
    assert list(dd.simulate(model, 3, record=names, out=tmp_path / "record.zarr").data_vars) == names
    assert list(dd.open_record(tmp_path / "record.zarr").data_vars) == names


def test_a_damaged_record_names_itself_when_opened(recorded: xarray.Dataset, tmp_path: Path) -> None:
    path = files.save_record(recorded, tmp_path / "record.zarr")
    (path / "zarr.json").write_text("{")
    with pytest.raises(dd.errors.RecordError, match=r"record\.zarr"):
        dd.open_record(path)


def test_xarray_opens_a_saved_record_without_a_warning(recorded: xarray.Dataset, tmp_path: Path) -> None:
    plain = recorded[["u.activation"]]
    files.save_record(plain, tmp_path / "record.zarr")
    files.save_record(plain, tmp_path / "record.nc")
    for opened in (
        xarray.open_zarr(tmp_path / "record.zarr"),
        xarray.open_dataset(tmp_path / "record.nc", engine="scipy"),
    ):
        assert opened["u.activation"].dims == plain["u.activation"].dims
        assert np.array_equal(opened["u.activation"].values, plain["u.activation"].values)
        opened.close()


def test_csv_has_a_row_for_every_sample(recorded: xarray.Dataset, tmp_path: Path) -> None:
    path = files.save_record(recorded[["n.activation", "u.activation"]], tmp_path / "record.csv")
    rows = list(csv.reader(path.read_text().splitlines()))
    head = rows[0]
    assert {"time", "trial", "s.amplitude"} <= set(head)
    text = path.read_text()
    sample = float(recorded["u.activation"].isel({"s.amplitude": 1, "trial": 2, "time": 3, "x": 4}))
    assert any(
        cell and abs(float(cell) - sample) < 1e-6 for row in rows[1:] for cell in row[-2:] if _number(cell)
    ), text[:400]
    with pytest.raises(dd.errors.RecordError):
        files.load_record(path)


def test_pandas_reads_the_table_as_it_is(recorded: xarray.Dataset, tmp_path: Path) -> None:
    path = files.save_record(recorded[["n.activation"]], tmp_path / "record.csv")
    table = pandas.read_csv(path)
    assert (
        list(table.columns) == ["s.amplitude", "trial", "time", "n.activation"]
        and len(table) == recorded["n.activation"].size
    )
    activation = (
        table.set_index(["s.amplitude", "trial", "time"])["n.activation"].to_xarray().astype(np.float32)
    )
    assert np.array_equal(
        activation.transpose(*recorded["n.activation"].dims).values, recorded["n.activation"].values
    )


def test_variables_over_other_dimensions_leave_cells_empty_for_pandas(
    recorded: xarray.Dataset, tmp_path: Path
) -> None:
    table = pandas.read_csv(
        files.save_record(recorded[["n.activation", "u.activation"]], tmp_path / "record.csv")
    )
    nodes, fields = table["n.activation"].notna(), table["u.activation"].notna()
    assert (
        nodes.sum() == recorded["n.activation"].size
        and fields.sum() == recorded["u.activation"].size
        and not (nodes & fields).any()
    )


def test_the_metadata_of_a_table_are_in_a_file_beside_it(recorded: xarray.Dataset, tmp_path: Path) -> None:
    """They follow the W3C's metadata for tabular data: the name of the file, and an entry for each column."""
    path = files.save_record(recorded[["n.activation", "u.activation"]], tmp_path / "record.csv")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["record.csv", "record.csv-metadata.json"]
    metadata = json.loads((tmp_path / "record.csv-metadata.json").read_text())
    assert (
        metadata["@context"] == "http://www.w3.org/ns/csvw"
        and metadata["url"] == "record.csv"
        and metadata["dc:title"] == recorded.attrs["title"]
    )
    columns = {c["titles"]: c for c in metadata["tableSchema"]["columns"]}
    assert list(columns) == list(pandas.read_csv(path).columns)
    assert columns["time"]["schema:unitText"] == "ms" and columns["u.activation"]["datatype"] == "float"
    assert json.loads(metadata["notes"][0][KEY])["seed"] == about(recorded)["seed"]


def test_metadata_of_another_table_are_never_replaced(recorded: xarray.Dataset, tmp_path: Path) -> None:
    (tmp_path / "record.csv-metadata.json").write_text("mine")
    with pytest.raises(dd.errors.OutputExists, match=r"record\.csv-metadata\.json"):
        files.save_record(recorded[["n.activation"]], tmp_path / "record.csv")
    assert [p.name for p in tmp_path.iterdir()] == ["record.csv-metadata.json"]


def _number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


@pytest.mark.parametrize("suffix", [".zarr", ".nc", ".csv"])
def test_nothing_is_replaced_without_force(recorded: xarray.Dataset, suffix: str, tmp_path: Path) -> None:
    small = recorded[["n.activation"]]
    path = files.save_record(small, tmp_path / f"record{suffix}")
    with pytest.raises(dd.errors.OutputExists, match="force=True"):
        files.save_record(small, path)
    files.save_record(small + 0 if suffix == ".csv" else small, path, force=True)
    assert {p.name for p in tmp_path.iterdir()} - {"record.csv-metadata.json"} == {path.name}


def test_a_folder_that_is_not_a_record_is_never_replaced(recorded: xarray.Dataset, tmp_path: Path) -> None:
    small = recorded[["n.activation"]]
    (tmp_path / "thesis.zarr").mkdir()
    (tmp_path / "thesis.zarr" / "chapter.txt").write_text("do not lose me")
    os.mkfifo(tmp_path / "pipe.nc")
    (tmp_path / "folder.nc").mkdir()
    os.symlink(tmp_path / "elsewhere", tmp_path / "link.csv")
    for name in ("thesis.zarr", "pipe.nc", "folder.nc", "link.csv"):
        with pytest.raises(dd.errors.OutputExists):
            files.save_record(small, tmp_path / name, force=True)
    assert (tmp_path / "thesis.zarr" / "chapter.txt").read_text() == "do not lose me"
    with pytest.raises(dd.errors.OutputError, match="does not exist"):
        files.save_record(small, tmp_path / "missing" / "record.nc")
    with pytest.raises(dd.errors.RecordError, match="names no format"):
        files.save_record(small, tmp_path / "record.xyz")


def test_a_failed_write_leaves_no_file(
    recorded: xarray.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files, "_write_zarr", full)
    monkeypatch.setattr(files, "_write_netcdf", full)
    for name in ("record.zarr", "record.nc"):
        with pytest.raises(dd.errors.OutputError, match="No space left"):
            files.save_record(recorded, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_damaged_and_foreign_files_are_an_error_that_names_them(
    recorded: xarray.Dataset, tmp_path: Path
) -> None:
    good = files.save_record(recorded, tmp_path / "good.nc").read_bytes()
    (tmp_path / "cut.nc").write_bytes(good[: len(good) // 2])
    (tmp_path / "noise.nc").write_bytes(b"\x00\x01nonsense" * 50)
    (tmp_path / "text.txt").write_text("hello")
    (tmp_path / "empty.zarr").mkdir()
    xarray.Dataset({"a": ("t", np.arange(3.0))}).to_netcdf(tmp_path / "foreign.nc", engine="scipy")
    for name in ("cut.nc", "noise.nc", "text.txt", "empty.zarr", "foreign.nc", "missing.zarr"):
        with pytest.raises(dd.errors.RecordError) as caught:
            files.load_record(tmp_path / name)
        assert name in str(caught.value)
