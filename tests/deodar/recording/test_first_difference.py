"""The first difference of two records."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray

import deodar as dd
from deodar.errors import RecordError
from deodar.recording import replay
from deodar.recording.first_difference import first_differences
from deodar.recording.replay import RecordReader
from tests.deodar.recording.test_replay import model


@pytest.fixture(scope="module")
def record() -> xarray.Dataset:
    return dd.simulate(model(), duration=200, record=["u.activation", "n.output"], trials=2)


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(replay, "FEWEST", 16)


def opened(record: xarray.Dataset, path: Path) -> RecordReader:
    return RecordReader(dd.save_record(record, path))


def found(one: RecordReader, other: RecordReader) -> list[tuple[str, float, tuple[int, ...], dict[str, int]]]:
    shares: list[float] = []
    differences = first_differences(one, other, lambda share: shares.append(share) or True)
    assert shares == sorted(shares) and shares[-1] == 1.0
    return [(d.path, d.time, d.index, dict(d.copy)) for d in differences]


def changed(record: xarray.Dataset, *places: tuple[str, tuple[int, ...], float]) -> xarray.Dataset:
    new = record.copy(deep=True)
    for name, place, sample in places:
        new[name].values[place] = sample
    return new


@pytest.mark.parametrize("suffix", [".zarr", ".nc"])
def test_equal_records_have_no_difference(record: xarray.Dataset, tmp_path: Path, suffix: str) -> None:
    with_nan = changed(record, ("n.output", (0, 7), np.nan))
    one, other = (opened(with_nan, tmp_path / f"{name}{suffix}") for name in "ab")
    assert found(one, other) == []


@pytest.mark.parametrize("suffix", [".zarr", ".nc"])
def test_each_port_has_its_first_difference_and_the_earliest_is_first(
    record: xarray.Dataset, tmp_path: Path, suffix: str
) -> None:
    new = changed(
        record,
        ("u.activation", (0, 150, 3), 9.0),
        ("u.activation", (1, 120, 4), 9.0),
        ("u.activation", (1, 120, 5), 99.0),
        ("u.activation", (1, 130, 5), 99.0),
        ("n.output", (0, 77), 0.5),
    )
    one, other = opened(record, tmp_path / f"a{suffix}"), opened(new, tmp_path / f"b{suffix}")
    assert found(one, other) == [
        ("n.output", 77.0, (), {"trial": 0}),
        ("u.activation", 120.0, (5,), {"trial": 1}),
    ]
    first = first_differences(one, other, lambda share: True)[1]
    assert first.values == (float(record["u.activation"].values[1, 120, 5]), 99.0)


def test_a_value_that_is_missing_in_one_record_differs(record: xarray.Dataset, tmp_path: Path) -> None:
    new = changed(record, ("u.activation", (0, 3, 2), np.nan))
    assert found(opened(record, tmp_path / "a.zarr"), opened(new, tmp_path / "b.zarr")) == [
        ("u.activation", 3.0, (2,), {"trial": 0})
    ]


def test_moments_of_one_record_alone_are_left_out(record: xarray.Dataset, tmp_path: Path) -> None:
    new = changed(record, ("n.output", (0, 40), 0.5), ("n.output", (0, 41), 0.5)).isel(time=slice(0, 100, 3))
    assert found(opened(record, tmp_path / "a.nc"), opened(new, tmp_path / "b.nc")) == []
    new = changed(record, ("n.output", (1, 42), 0.5)).isel(time=slice(0, 100, 3))
    one, other = opened(record, tmp_path / "c.nc"), opened(new, tmp_path / "d.nc")
    assert found(one, other) == found(other, one) == [("n.output", 42.0, (), {"trial": 1})]


def test_a_comparison_can_be_ended(record: xarray.Dataset, tmp_path: Path) -> None:
    one, other = (
        opened(record, tmp_path / "a.zarr"),
        opened(changed(record, ("n.output", (0, 1), 9)), tmp_path / "b.zarr"),
    )
    calls: list[float] = []
    assert first_differences(one, other, lambda share: bool(calls.append(share))) == []
    assert len(calls) == 1


def test_records_without_a_common_port_are_refused(record: xarray.Dataset, tmp_path: Path) -> None:
    one = opened(record[["u.activation"]], tmp_path / "a.zarr")
    with pytest.raises(RecordError, match="no recorded port in common"):
        found(one, opened(record[["n.output"]], tmp_path / "b.zarr"))
    with pytest.raises(RecordError, match="other trials"):
        found(one, opened(record.isel(trial=[0]), tmp_path / "c.zarr"))
