"""The file of the open document, its stored edits, and the snapshots and presets beside it."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Sequence
from pathlib import Path

from deodar.errors import DocumentError, Problem
from deodar.model.document import Document
from deodar.session.session_snapshot import SessionSnapshot
from deodar_studio.files import saved_files
from deodar_studio.files.file_thread import in_file_thread, try_in_file_thread
from deodar_studio.files.saved_files import SavedFolder, Sort
from deodar_studio.files.state_store import StateStore
from deodar_studio.files.workspace import Workspace
from deodar_studio.messages.to_page import FileProblems, SavedFiles
from deodar_studio.project.confirmation import ConfirmationRequired
from deodar_studio.project.file_state import FileState, plain
from deodar_studio.views import view


class DocumentFile:
    """The file that the open document is saved to, and what was written there and beside it.

    Args:
        workspace: the files below the root.
        store: where unsaved edits are stored.
        changed: called when pages may have something new to show.

    Attributes:
        state: the file, and what is written to it.
        refused: the file that could not be opened, and its problems.
        saved_files: the snapshots and presets of the document, as listed last.
    """

    def __init__(self, workspace: Workspace, store: StateStore, changed: Callable[[], None]) -> None:
        self._workspace, self._store, self._changed = workspace, store, changed
        self.state = FileState()
        self.refused: tuple[str, Sequence[Problem]] = ("", ())
        self.saved_files: SavedFiles = saved_files.NOTHING

    @property
    def path(self) -> Path | None:
        """The file; None: the document has none."""
        return self.state.path

    @property
    def shown(self) -> str:
        """The file as the page names it; empty: the document has none."""
        return "" if self.path is None else self._workspace.shown(self.path)

    def differs(self, doc: Document) -> bool:
        """Return whether a document has edits that are not saved to the file."""
        return self.state.differs(doc)

    # ------------------------------------------------------------------------------------ opening and closing

    async def open(self, path: Path | None, doc: Document) -> None:
        """Continue with the file that a document was read from; None: it has no file."""
        self.state = FileState(path, plain(doc), await self._digest(path), self._store.new_name(), doc)
        if path is not None:
            await try_in_file_thread(lambda: self._store.opened(path))

    def reopen(self, state: FileState) -> None:
        """Continue with the file of a document that was set aside."""
        self.state = state

    def recovered(self, doc: Document, edits: str = "") -> None:
        """State that a document has unsaved edits, which are stored under a name (empty: a new one)."""
        state = dc.replace(self.state, saved=None)
        self.state = dc.replace(state, edits=edits, stored=doc) if edits else state

    def refuse(self, title: str, problems: Sequence[Problem]) -> None:
        """State that a file could not be opened."""
        self.refused = (title, problems)

    def problems(self) -> FileProblems:
        """Return the file that could not be opened, as a message."""
        return FileProblems(file=self.refused[0], problems=view.problems(self.refused[1]))

    def close(self) -> None:
        """Continue without a file."""
        self.state, self.refused, self.saved_files = FileState(), ("", ()), saved_files.NOTHING

    async def opened(self, path: Path) -> None:
        """Add a path to the recent files."""
        await try_in_file_thread(lambda: self._store.opened(path))

    # ------------------------------------------------------------------------------------------------- saving

    async def write(self, doc: Document, path: str, replace: bool) -> Path:
        """Write a document to a path, or to its own file if the path is empty; return the file.

        Raises:
            ConfirmationRequired: without `replace`, if the file is not the document's own, or changed since
                it was read.
            DocumentError: the path is empty and the document has no file, or the file cannot be written.
        """
        place = self._workspace.target(path) if path else self.path
        if place is None:
            raise DocumentError("has no file yet", where=doc.name, fix="Save it under a name")
        now = await self._digest(place)
        if not replace and now and not (place == self.path and now == self.state.digest):
            raise ConfirmationRequired("replace")
        await in_file_thread(lambda: self._workspace.save(doc, place), path or str(place))
        return place

    async def save(self, doc: Document, path: str, replace: bool) -> Path:
        """Write the open document as `write` does, and continue with that file."""
        place = await self.write(doc, path, replace)
        edits = self.state.edits
        self.state = FileState(place, plain(doc), await self._digest(place), edits, doc)
        await try_in_file_thread(lambda: self._store.forget(edits))
        await self.opened(place)
        return place

    async def _digest(self, place: Path | None) -> str:
        if place is None:
            return ""
        return await in_file_thread(lambda: self._workspace.digest(place), str(place))

    # ------------------------------------------------------------------------------------------- stored edits

    async def store_edits(self, doc: Document) -> None:
        """Store the open document if it has unsaved edits that are not stored yet."""
        state = self.state
        if state.stored is not doc and state.differs(doc):
            file = "" if state.path is None else str(state.path)
            await try_in_file_thread(lambda: self._store.store_edits(state.edits, doc, file))
            self.state = dc.replace(self.state, stored=doc)

    async def stored(self, name: str) -> tuple[Document, Path | None]:
        """Return a document whose edits were stored, and its file; None: it has none below the root."""
        doc, file = await in_file_thread(lambda: self._store.read(name), name)
        path = Path(file) if file else None
        return doc, path if path is not None and self._workspace.holds(path) else None

    async def forget(self, name: str) -> None:
        """Delete the edits that are stored under a name, if it is not empty."""
        if name:
            await try_in_file_thread(lambda: self._store.forget(name))

    # ------------------------------------------------------------------------------------- snapshots, presets

    async def list_saved(self, title: str | None) -> None:
        """Read the list of snapshots and presets of a document of that name again; None: no document."""
        found: list[SavedFiles] = [saved_files.NOTHING]
        if title is not None:
            await try_in_file_thread(lambda: found.append(self._folder(title).listed()))
        self.saved_files = found[-1]
        self._changed()

    async def save_snapshot(self, title: str, name: str, snapshot: SessionSnapshot) -> Path:
        """Write the state of a run of a document under a new name; return the file."""
        path = await in_file_thread(lambda: self._folder(title).save_snapshot(name, snapshot), name)
        await self.list_saved(title)
        return path

    async def save_preset(self, doc: Document, name: str) -> Path:
        """Write the values of the parameters under a new name; return the file."""
        path = await in_file_thread(lambda: self._folder(doc.name).save_preset(name, doc), name)
        await self.list_saved(doc.name)
        return path

    async def snapshot(self, title: str, name: str, trust: bool) -> SessionSnapshot:
        """Read a snapshot.

        Raises:
            UnknownName: there is none of this name.
        """
        return await in_file_thread(lambda: self._folder(title).snapshot(name, trust), name)

    async def move_saved(self, title: str, new_title: str) -> None:
        """Move the snapshots and presets of a document to those of its new title, where this is possible."""
        await try_in_file_thread(lambda: self._folder(title).move(new_title))
        await self.list_saved(new_title)

    async def remove_saved(self, title: str, sort: Sort, name: str) -> None:
        """Delete a snapshot or a preset."""
        await in_file_thread(lambda: self._folder(title).remove(sort, name), name)
        await self.list_saved(title)

    def _folder(self, title: str) -> SavedFolder:
        return SavedFolder(self._workspace, title)
