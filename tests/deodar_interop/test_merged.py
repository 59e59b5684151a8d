"""The tables of the files of a folder are merged, and a key in two of them is refused."""

from __future__ import annotations

import dataclasses as dc
from pathlib import Path

import pytest

from deodar.errors import ModelError
from deodar.registry import imported
from deodar_interop import _merged


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A package with two files, one of which states no table."""
    folder = tmp_path / "merged_classes"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "fields.py").write_text("CLASSES = {'A': 1, 'B': 2}\n")
    (folder / "other.py").write_text("")
    monkeypatch.syspath_prepend(str(tmp_path))
    return folder.name


def test_every_file_is_read_without_being_listed(package: str) -> None:
    assert _merged.merged(package, "CLASSES") == {"A": 1, "B": 2}


def test_a_key_in_two_files_is_refused(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in imported(package):
        monkeypatch.setattr(module, "CLASSES", {"A": 1}, raising=False)
    with pytest.raises(ModelError, match=r"merged_classes\.other\.CLASSES repeats A"):
        _merged.merged(package, "CLASSES")


@dc.dataclass(frozen=True)
class Kind:
    """Something with names, as `declared` asks for."""

    names: tuple[str, ...]


def test_what_files_define_is_found_by_its_name_once(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    shared = Kind(("A", "B"))
    for module in imported(package):
        monkeypatch.setattr(module, "shared", shared, raising=False)
    assert _merged.declared(package, Kind) == {"A": shared, "B": shared}
    monkeypatch.setattr(imported(package)[1], "other", Kind(("B",)), raising=False)
    with pytest.raises(ModelError, match="merged_classes defines B twice"):
        _merged.declared(package, Kind)
