"""Writing: no file is lost or half-written, and a failure is an error."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import deodar as dd
from deodar.errors import DeodarError, OutputError, OutputExists
from deodar.model import output, partial
from tests.deodar.errors.refused import refused

X = dd.Axis("x", 0, 10, samples=11)


@pytest.fixture
def model() -> dd.Model:
    model = dd.Model("m")
    model.add(dd.Field("u", [X]))
    return model


def _listing(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.rglob("*"))


def test_a_file_that_exists_is_kept_until_force(tmp_path: Path, model: dd.Model) -> None:
    path = tmp_path / "m.json"
    path.write_text("precious")
    refused(lambda: dd.save(model, path), OutputExists, str(path), "exists already", "force=True")
    assert path.read_text() == "precious"
    dd.save(model, path, force=True)
    assert dd.load(path).document == model.document


def _folder(path: Path) -> None:
    path.mkdir()


def _pipe(path: Path) -> None:
    os.mkfifo(path)


def _link(path: Path) -> None:
    neighbour = path.with_name("other.txt")
    neighbour.write_text("precious")
    path.symlink_to(neighbour)


def _broken_link(path: Path) -> None:
    path.symlink_to(path.with_name("nowhere"))


@pytest.mark.parametrize("make", [_folder, _pipe, _link, _broken_link])
@pytest.mark.parametrize("force", [False, True])
def test_a_path_that_is_not_a_regular_file_is_never_replaced(
    tmp_path: Path, model: dd.Model, make: Callable[[Path], None], force: bool
) -> None:
    path = tmp_path / "m.json"
    make(path)
    before = _listing(tmp_path)
    refused(
        lambda: dd.save(model, path, force=force),
        OutputExists,
        "exists and is not a regular file",
        "Choose another name",
    )
    assert _listing(tmp_path) == before
    assert not (tmp_path / "other.txt").exists() or (tmp_path / "other.txt").read_text() == "precious"


def _bad(tmp_path: Path, kind: str) -> Any:
    (tmp_path / "file.txt").write_text("x")
    return {
        "no folder": tmp_path / "no" / "m.json",
        "a file as a folder": tmp_path / "file.txt" / "m.json",
        "too long": tmp_path / ("m" * 300 + ".json"),
        "a nul": f"{tmp_path}/m\0.json",
        "half a character": f"{tmp_path}/m\ud800.json",
        "a number": 5,
        "nothing": None,
    }[kind]


@pytest.mark.parametrize(
    "kind",
    ["no folder", "a file as a folder", "too long", "a nul", "half a character", "a number", "nothing"],
)
def test_a_path_that_cannot_be_written_is_an_error(tmp_path: Path, model: dd.Model, kind: str) -> None:
    path = _bad(tmp_path, kind)
    before = _listing(tmp_path)
    refused(lambda: dd.save(model, path), OutputError)
    assert _listing(tmp_path) == before


def test_a_folder_without_write_permission_is_an_error(
    tmp_path: Path, model: dd.Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(output.os, "access", lambda path, mode: False)
    refused(lambda: dd.save(model, tmp_path / "m.json"), OutputError, "cannot be written to", str(tmp_path))
    assert _listing(tmp_path) == []


def test_permission_denied_while_writing_is_an_error(
    tmp_path: Path, model: dd.Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*args: Any, **kwargs: Any) -> Any:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(partial, "take", lambda *_: None)
    monkeypatch.setattr(tempfile, "mkstemp", refuse)
    refused(
        lambda: dd.save(model, tmp_path / "m.json"),
        OutputError,
        "cannot be written: Permission denied",
        "m.json",
    )
    assert _listing(tmp_path) == []


@pytest.mark.parametrize("method", ["write_bytes", "replace"])
def test_a_full_disk_leaves_nothing_behind(
    tmp_path: Path, model: dd.Model, monkeypatch: pytest.MonkeyPatch, method: str
) -> None:
    (tmp_path / "m.json").write_text("precious")

    def full(self: Path, *args: Any) -> Any:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, method, full)
    refused(
        lambda: dd.save(model, tmp_path / "m.json", force=True),
        OutputError,
        "cannot be written: No space left on device",
    )
    assert _listing(tmp_path) == ["m.json"]
    assert (tmp_path / "m.json").read_text() == "precious"


def test_a_file_is_replaced_only_when_its_content_is_complete(tmp_path: Path) -> None:
    """The content is written beside the final place, which keeps the old file until the new one is
    complete.
    """
    path = tmp_path / "out.bin"
    path.write_bytes(b"old")
    seen: list[bytes] = []

    def content(beside: Path) -> None:
        beside.write_bytes(b"half")
        seen.append(path.read_bytes())
        beside.write_bytes(b"whole")

    output.write(path, content)
    assert seen == [b"old"]
    assert path.read_bytes() == b"whole"
    assert _listing(tmp_path) == ["out.bin"]


def test_an_error_while_writing_leaves_nothing(tmp_path: Path) -> None:
    def content(beside: Path) -> None:
        beside.write_bytes(b"half")
        raise DeodarError("no")

    with pytest.raises(DeodarError):
        output.write(tmp_path / "out.bin", content)
    assert _listing(tmp_path) == []


def test_written_files_have_the_default_permissions(tmp_path: Path, model: dd.Model) -> None:
    dd.save(model, tmp_path / "m.json")
    plain = tmp_path / "plain"
    plain.write_text("x")
    assert (tmp_path / "m.json").stat().st_mode == plain.stat().st_mode
