"""The folder that the studio reads and writes, and the state stored between runs."""

from __future__ import annotations

import base64
import json
import os
import socket
from pathlib import Path
from typing import Any

import pytest

import deodar as dd
from deodar.errors import DeodarError, DocumentError, OutputError
from deodar_studio.files import content
from deodar_studio.files.state_store import StateStore, state_folder
from deodar_studio.files.workspace import UNREADABLE, Workspace
from tests.deodar_studio.models import weighted


@pytest.mark.parametrize(
    "path", ["..", "../x.json", "/etc/passwd", "a/../../x.json", "link/x.json", "a\0b", "folder/../../../x"]
)
def test_paths_outside_of_the_workspace_are_refused(tmp_path: Path, path: str) -> None:
    root = tmp_path / "root"
    root.mkdir()
    (root / "link").symlink_to(tmp_path)
    with pytest.raises(DocumentError):
        Workspace(root).inside(path)


def test_paths_inside_of_the_workspace_are_accepted(tmp_path: Path) -> None:
    space = Workspace(tmp_path)
    (tmp_path / "sub").mkdir()
    (tmp_path / "here").symlink_to(tmp_path / "sub")
    assert space.inside("sub/x.json") == tmp_path.resolve() / "sub" / "x.json"
    assert space.inside("here/x.json") == tmp_path.resolve() / "sub" / "x.json"
    assert space.inside(str(tmp_path / "x.json")) == tmp_path.resolve() / "x.json"
    assert space.inside("") == tmp_path.resolve()


def test_a_workspace_holds_only_what_lies_below_its_root(tmp_path: Path) -> None:
    root = tmp_path / "root"
    (root / "sub").mkdir(parents=True)
    (root / "out").symlink_to(tmp_path / "elsewhere")
    space = Workspace(root)
    assert space.holds(root / "x.json") and space.holds(root / "sub" / "x.json")
    for path in (root, tmp_path / "x.json", root / ".." / "x.json", root / "out", root / "a\0b"):
        assert not space.holds(path), path
    with pytest.raises(DocumentError, match="lies outside the folder"):
        space.folder(tmp_path / "x.json")


def test_a_folder_lists_what_can_be_opened(tmp_path: Path) -> None:
    for name in ("b.json", "A.JSON", ".hidden.json", "photo.JPG", "notes.txt"):
        (tmp_path / name).touch()
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "c.json").touch()
    listed = Workspace(tmp_path).listed("")
    assert (listed.files, listed.folders, listed.pictures, listed.path) == (
        ["A.JSON", "b.json"],
        ["sub"],
        ["photo.JPG"],
        "",
    )
    assert Workspace(tmp_path).listed("sub").path == "sub"
    with pytest.raises(DocumentError, match="no such folder"):
        Workspace(tmp_path).listed("gone")


def test_targets_end_in_json_and_are_in_an_existing_folder(tmp_path: Path) -> None:
    space = Workspace(tmp_path)
    assert space.target("new").name == "new.json"
    (tmp_path / "folder.json").mkdir()
    for path in ("", "  ", "gone/new", "folder.json", "sub/"):
        with pytest.raises(OutputError):
            space.target(path)


def test_a_digest_depends_on_the_content_alone(tmp_path: Path) -> None:
    space, path = Workspace(tmp_path), tmp_path / "a"
    assert space.digest(path) == ""
    path.write_text("one")
    first = space.digest(path)
    path.write_text("two")
    assert first and space.digest(path) not in (first, UNREADABLE)


def test_a_file_that_cannot_be_compared_does_not_count_as_missing(tmp_path: Path) -> None:
    """Saving asks before it replaces a file that has a digest."""
    space = Workspace(tmp_path)
    os.mkfifo(tmp_path / "pipe.json")
    (tmp_path / "folder.json").mkdir()
    with (tmp_path / "huge.json").open("wb") as file:
        file.truncate(2**40)
    for name in ("pipe", "folder", "huge"):
        assert space.digest(tmp_path / f"{name}.json") == UNREADABLE


@pytest.mark.parametrize("what", ["pipe", "link", "device"])
def test_pipes_devices_and_huge_files_are_refused(tmp_path: Path, what: str) -> None:
    place = tmp_path / "x.json"
    match what:
        case "pipe":
            os.mkfifo(place)
        case "link":
            place.symlink_to("/dev/zero")
        case _:
            with socket.socket(socket.AF_UNIX) as listening:
                listening.bind(str(place))
    with pytest.raises(DocumentError):
        Workspace(tmp_path).require_file(place)


def test_a_folder_with_broken_links_is_listed(tmp_path: Path) -> None:
    (tmp_path / "good.json").touch()
    (tmp_path / "loop.json").symlink_to(tmp_path / "loop.json")
    (tmp_path / "a").symlink_to(tmp_path / "b")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    (tmp_path / "gone.json").symlink_to(tmp_path / "nowhere")
    os.mkfifo(tmp_path / "pipe.json")
    listed = Workspace(tmp_path).listed("")
    assert (listed.files, listed.folders) == (["good.json"], [])
    for path in ("loop.json", "a/x.json", "x" * 5000, "/".join(["d"] * 3000)):
        with pytest.raises(DeodarError):
            space = Workspace(tmp_path)
            space.require_file(space.inside(path))


def test_a_link_that_appears_after_the_check_is_not_followed(tmp_path: Path) -> None:
    root, outside = tmp_path / "root", tmp_path / "outside"
    for folder in (root / "sub" / "deep", outside / "deep"):
        folder.mkdir(parents=True)
    space, doc = Workspace(root), dd.Model("m").document
    place = space.target("sub/deep/mine")
    (root / "sub").rename(root / "old")
    (root / "sub").symlink_to(outside)
    for attempt in (lambda: space.save(doc, place), lambda: space.require_file(place)):
        with pytest.raises(DeodarError):
            attempt()
    assert list((outside / "deep").iterdir()) == []
    (root / "sub").unlink()
    (root / "old").rename(root / "sub")
    place.symlink_to(outside / "target.json")
    with pytest.raises(DeodarError, match="not a regular file"):
        space.save(doc, place)
    assert not (outside / "target.json").exists()


@pytest.mark.parametrize("exchanged", ["folder", "document", "arrays"])
def test_a_link_that_appears_while_a_document_is_opened_is_not_followed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, exchanged: str
) -> None:
    """The file is replaced at the last moment, just before it is opened."""
    root, outside = tmp_path / "root", tmp_path / "outside"
    for folder in (root / "sub", outside):
        folder.mkdir(parents=True)
        dd.save(weighted(1), folder / "m.json")
    space = Workspace(root)
    place = space.inside("sub/m.json")
    assert content.load(space, place) == weighted(1).document
    opens, arrays = os.open, next((root / "sub").glob("m.*.npz"))

    def exchange(path: Any, *arguments: Any, **named: Any) -> int:
        name = {"folder": "sub", "document": "m.json", "arrays": arrays.name}[exchanged]
        target = root / "sub" if exchanged == "folder" else root / "sub" / name
        if path == name and not target.is_symlink():
            target.rename(tmp_path / "old")
            target.symlink_to(outside if exchanged == "folder" else outside / name)
        return opens(path, *arguments, **named)

    monkeypatch.setattr(os, "open", exchange)
    with pytest.raises(DeodarError, match=r"symbolic links|Not a directory"):
        content.load(space, place)
    assert not content.is_foreign(space, place)


def test_a_package_is_opened_from_the_workspace(tmp_path: Path) -> None:
    dd.save(weighted(1), tmp_path / "m.deodar")
    space = Workspace(tmp_path)
    assert content.load(space, space.inside("m.deodar")) == weighted(1).document
    with pytest.raises(DocumentError, match="no such file") as refused:
        content.load(space, space.inside("n.deodar"))
    assert "m.deodar" in refused.value.problems[0].fix


def test_a_package_that_was_dropped_is_read_from_its_content(tmp_path: Path) -> None:
    dd.save(weighted(1), tmp_path / "m.deodar")
    dropped = base64.b64encode((tmp_path / "m.deodar").read_bytes()).decode()
    assert content.read_package(dropped, "m.deodar") == weighted(1).document
    for wrong, why in (
        ("?", "base64"),
        ("", "not a package"),
        (base64.b64encode(b"{}").decode(), "not a package"),
        (dropped[:400], "damaged"),
    ):
        with pytest.raises(DocumentError, match=why):
            content.read_package(wrong, "m.deodar")


def test_a_document_is_saved_with_its_arrays_and_previous_ones_are_removed(tmp_path: Path) -> None:
    space = Workspace(tmp_path)
    for seed in (1, 2):
        model = weighted(seed)
        space.save(model.document, space.target("m"))
        assert dd.load(tmp_path / "m.json").document == model.document
    assert len(list(tmp_path.iterdir())) == 2


def test_unsaved_edits_are_kept_until_they_are_discarded(tmp_path: Path) -> None:
    store = StateStore(tmp_path)
    model = dd.Model("mine")
    model.add(dd.Field("u", [dd.Axis("x", 0, 10, samples=11)], kernel=[dd.Gaussian(1, 2)]))
    name = store.new_name()
    store.store_edits(name, model.document, "/somewhere/mine.json")
    assert store.stored_edits() == [], "this process still holds them"
    note = next((tmp_path / "unsaved").glob("*.note"))
    note.write_text(json.dumps(json.loads(note.read_text()) | {"process": [os.getpid(), 1.0]}))
    assert [(r.name, r.title, r.file) for r in store.stored_edits()] == [
        (name, "mine", "/somewhere/mine.json")
    ]
    document, file = store.read(name)
    assert document == model.document and file == "/somewhere/mine.json"
    store.forget(name)
    assert store.stored_edits() == [] and not list((tmp_path / "unsaved").iterdir())


@pytest.mark.parametrize("name", ["", "..", "../../etc", "0123456789abcde", "0123456789abcdeg", "*"])
def test_names_of_unsaved_edits_are_not_paths(tmp_path: Path, name: str) -> None:
    for what in (StateStore(tmp_path).forget, StateStore(tmp_path).read):
        with pytest.raises(DeodarError, match="no unsaved edits"):
            what(name)


def test_recent_files_are_the_last_ones_that_exist(tmp_path: Path) -> None:
    store = StateStore(tmp_path / "state")
    for k in range(20):
        (tmp_path / f"{k}.json").touch()
        store.opened(tmp_path / f"{k}.json")
    store.opened(tmp_path / "12.json")
    (tmp_path / "19.json").unlink()
    names = [p.stem for p in store.recent()]
    assert names[:3] == ["12", "18", "17"] and len(names) == 11


def test_an_unusable_state_folder_is_ignored(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    store = StateStore(tmp_path / "file")
    store.store_edits(store.new_name(), dd.Model("m").document, "")
    store.opened(tmp_path / "x.json")
    assert store.stored_edits() == [] and store.recent() == []
    (tmp_path / "recent.json").write_text("{broken")
    assert StateStore(tmp_path).recent() == []


def test_the_state_folder_is_set_by_the_environment(own_state: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert state_folder() == own_state
    monkeypatch.delenv("DEODAR_STATE")
    assert "deodar" in str(state_folder())
