"""The file of the open document without a document that runs."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

import deodar as dd
from deodar.errors import DocumentError
from deodar.model import edit
from deodar_studio.files.state_store import StateStore
from deodar_studio.files.workspace import Workspace
from deodar_studio.project.confirmation import ConfirmationRequired
from deodar_studio.project.file import DocumentFile


def file(root: Path) -> DocumentFile:
    return DocumentFile(Workspace(root), StateStore(root / "state"), lambda: None)


def test_a_document_is_saved_and_positions_of_panels_are_no_edits(tmp_path: Path) -> None:
    async def scene() -> None:
        f, doc = file(tmp_path), dd.Model("m").document
        await f.open(None, doc)
        with pytest.raises(DocumentError, match="no file yet"):
            await f.save(doc, "", False)
        edited = edit.describe(doc, notes="more")
        assert f.differs(edited) and not f.differs(doc)
        assert await f.save(edited, "m", False) == tmp_path / "m.json"
        assert f.shown == "m.json" and f.differs(doc)
        assert not f.differs(edit.arrange(edited, {"tiles": {"build": []}, "panels": {"p": 1}}))
        assert dd.load(tmp_path / "m.json").document.notes == "more"
        await f.save(edited, "", False)

    asyncio.run(scene())


def test_a_file_that_another_program_wrote_is_replaced_only_on_request(tmp_path: Path) -> None:
    async def scene() -> None:
        f, doc = file(tmp_path), dd.Model("m").document
        await f.open(None, doc)
        place = await f.save(doc, "m", False)
        place.write_text("changed")
        with pytest.raises(ConfirmationRequired, match="replace"):
            await f.save(doc, "", False)
        assert place.read_text() == "changed"
        await f.save(doc, "", True)
        assert dd.load(place).document == doc

    asyncio.run(scene())


def test_a_copy_of_a_document_leaves_the_file(tmp_path: Path) -> None:
    async def scene() -> None:
        f, doc = file(tmp_path), dd.Model("m").document
        place = await f.write(doc, "copy", False)
        assert place.is_file() and f.path is None

    asyncio.run(scene())


def test_unsaved_edits_are_stored_once_and_deleted_when_they_are_saved(tmp_path: Path) -> None:
    async def scene() -> None:
        f, doc = file(tmp_path), dd.Model("m").document
        await f.open(None, doc)
        await f.store_edits(doc)
        assert not (tmp_path / "state" / "unsaved").exists(), "there are none"
        edited = edit.describe(doc, notes="more")
        await f.store_edits(edited)
        assert (await f.stored(f.state.edits))[0].notes == "more"
        [stored] = (tmp_path / "state" / "unsaved").glob("*.json")
        stored.unlink()
        await f.store_edits(edited)
        assert not stored.exists()
        await f.save(edited, "m", False)
        assert not list((tmp_path / "state" / "unsaved").iterdir())

    asyncio.run(scene())


def test_presets_are_listed_by_document(tmp_path: Path) -> None:
    async def scene() -> None:
        f, doc = file(tmp_path), dd.Model("m").document
        await f.save_preset(doc, "weak")
        assert [preset.name for preset in f.saved_files.presets] == ["weak"]
        await f.list_saved("other")
        assert f.saved_files.presets == []
        await f.remove_saved("m", "preset", "weak")
        assert not list((tmp_path / "presets" / "m").iterdir())

    asyncio.run(scene())
