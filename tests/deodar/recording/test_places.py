"""Names of results that do not exist yet."""

from __future__ import annotations

from pathlib import Path

import pytest

from deodar.errors import OutputError
from deodar.recording import places


def test_a_free_name_has_the_first_number_without_a_file_folder_or_link(tmp_path: Path) -> None:
    assert places.free(tmp_path, "run", ".zarr") == tmp_path / "run-001.zarr"
    (tmp_path / "run-001").mkdir()
    (tmp_path / "run-002").touch()
    (tmp_path / "run-003").symlink_to(tmp_path / "gone")
    (tmp_path / "run-005").touch()
    assert places.free(tmp_path, "run") == tmp_path / "run-004"
    assert places.free(tmp_path, "run", ".zarr") == tmp_path / "run-001.zarr"


@pytest.mark.parametrize(
    ("name", "written"), [("a b/c", "a_b_c"), ("../x", "x"), ("", "record"), ("é" * 99, "é" * 80)]
)
def test_a_free_name_has_no_characters_that_file_names_must_not_have(
    tmp_path: Path, name: str, written: str
) -> None:
    assert places.free(tmp_path, name) == tmp_path / f"{written}-001"


def test_a_folder_that_holds_all_numbers_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(places, "MOST_NUMBERED", 3)
    for n in range(1, 4):
        (tmp_path / f"run-{n:03}").touch()
    with pytest.raises(OutputError, match="results called run") as caught:
        places.free(tmp_path, "run")
    assert caught.value.problems[0].fix == "Choose a name: out=..."
