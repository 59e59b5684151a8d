"""The folder that is read and written, and what is kept between runs."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

import deodar as dd
from deodar.errors import DeodarError, DocumentError, OutputError
from deodar.server.keeper import Keeper, state_folder
from deodar.server.workspace import Workspace, digest


@pytest.mark.parametrize("path", ["..", "../x.json", "/etc/passwd", "a/../../x.json", "link/x.json", "a\0b", "folder/../../../x"])
def test_paths_outside_are_refused(tmp_path: Path, path: str) -> None:
    root = tmp_path / "root"
    root.mkdir()
    (root / "link").symlink_to(tmp_path)
    with pytest.raises(DocumentError):
        Workspace(root).inside(path)


def test_paths_inside_are_taken(tmp_path: Path) -> None:
    space = Workspace(tmp_path)
    (tmp_path / "sub").mkdir()
    (tmp_path / "here").symlink_to(tmp_path / "sub")
    assert space.inside("sub/x.json") == tmp_path.resolve() / "sub" / "x.json"
    assert space.inside("here/x.json") == tmp_path.resolve() / "sub" / "x.json"
    assert space.inside(str(tmp_path / "x.json")) == tmp_path.resolve() / "x.json"
    assert space.inside("") == tmp_path.resolve()


def test_a_folder_lists_what_can_be_opened(tmp_path: Path) -> None:
    for name in ("b.json", "A.JSON", ".hidden.json", "photo.JPG", "notes.txt"):
        (tmp_path / name).touch()
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "c.json").touch()
    listed = Workspace(tmp_path).listed(7, "")
    assert (listed.files, listed.folders, listed.pictures, listed.path) == (["A.JSON", "b.json"], ["sub"], ["photo.JPG"], "")
    assert Workspace(tmp_path).listed(7, "sub").path == "sub"
    with pytest.raises(DocumentError, match="no such folder"):
        Workspace(tmp_path).listed(7, "gone")


def test_targets_end_in_json_and_stand_in_a_folder(tmp_path: Path) -> None:
    space = Workspace(tmp_path)
    assert space.target("new").name == "new.json"
    (tmp_path / "folder.json").mkdir()
    for path in ("", "  ", "gone/new", "folder.json", "sub/"):
        with pytest.raises(OutputError):
            space.target(path)


def test_a_digest_is_of_the_content(tmp_path: Path) -> None:
    path = tmp_path / "a"
    assert digest(path) == ""
    path.write_text("one")
    first = digest(path)
    path.write_text("two")
    assert first and digest(path) != first


def test_unsaved_edits_are_kept_until_forgotten(tmp_path: Path) -> None:
    keeper = Keeper(tmp_path)
    model = dd.Model("mine")
    model.add(dd.Field("u", [dd.Axis("x", 0, 10, samples=11)], kernel=[dd.Gaussian(1, 2)]))
    name = keeper.new_name()
    keeper.keep(name, model.document, "/somewhere/mine.json")
    assert keeper.kept() == [], "this process still holds them"
    note = next((tmp_path / "unsaved").glob("*.note"))
    note.write_text(json.dumps(json.loads(note.read_text()) | {"process": [os.getpid(), 1.0]}))
    assert [(r.name, r.title, r.file) for r in keeper.kept()] == [(name, "mine", "/somewhere/mine.json")]
    document, file = keeper.read(name)
    assert document == model.document and file == "/somewhere/mine.json"
    keeper.forget(name)
    assert keeper.kept() == [] and not list((tmp_path / "unsaved").iterdir())


@pytest.mark.parametrize("name", ["", "..", "../../etc", "0123456789abcde", "0123456789abcdeg", "*"])
def test_names_of_edits_are_no_paths(tmp_path: Path, name: str) -> None:
    for what in (Keeper(tmp_path).forget, Keeper(tmp_path).read):
        with pytest.raises(DeodarError, match="no unsaved edits"):
            what(name)


def test_recent_files_are_the_last_ones_that_are_still_there(tmp_path: Path) -> None:
    keeper = Keeper(tmp_path / "state")
    for k in range(20):
        (tmp_path / f"{k}.json").touch()
        keeper.opened(tmp_path / f"{k}.json")
    keeper.opened(tmp_path / "12.json")
    (tmp_path / "19.json").unlink()
    names = [p.stem for p in keeper.recent()]
    assert names[:3] == ["12", "18", "17"] and len(names) == 11


def test_a_state_folder_that_cannot_be_used_fails_nothing(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    keeper = Keeper(tmp_path / "file")
    keeper.keep(keeper.new_name(), dd.Model("m").document, "")
    keeper.opened(tmp_path / "x.json")
    assert keeper.kept() == [] and keeper.recent() == []
    (tmp_path / "recent.json").write_text("{broken")
    assert Keeper(tmp_path).recent() == []


def test_the_state_folder_may_be_named(own_state: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert state_folder() == own_state
    monkeypatch.delenv("DEODAR_STATE")
    assert "deodar" in str(state_folder())
