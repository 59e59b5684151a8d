"""The open document: its history, its file, its run, and the record that may be shown in its place.

Everything here runs in the thread of the event loop. An invalid change is refused before it enters the
history.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Sequence
from pathlib import Path

import msgspec

from deodar.errors import DeodarError, Problem
from deodar.importers import examples, opening
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.recording import files
from deodar.session.session import Session
from deodar.worlds._base import World
from deodar_studio.files import content
from deodar_studio.files.file_thread import in_file_thread
from deodar_studio.files.state_store import StateStore
from deodar_studio.files.workspace import Workspace
from deodar_studio.live.compilation import CompileTimes
from deodar_studio.live.engine import Engine
from deodar_studio.messages.to_page import DocumentView, Edited, Opened
from deodar_studio.project.change_queue import ChangeQueue
from deodar_studio.project.confirmation import ConfirmationRequired
from deodar_studio.project.conversions import Conversions
from deodar_studio.project.file import DocumentFile
from deodar_studio.project.file_state import plain
from deodar_studio.project.history import DocumentHistory
from deodar_studio.project.record import OpenRecord, SetAside
from deodar_studio.project.run import DocumentRun
from deodar_studio.streams import record_frames
from deodar_studio.views import view
from deodar_studio.views.converted import Converted
from deodar_studio.world import embodiment
from deodar_studio.world.embodiment import Embodiment

UNTITLED = "untitled"
"""Title of a new document."""


class OpenProject:
    """The open document, if any, in four parts that do not know each other.

    Here are the requests that need several of the parts: those that open, close and save a document, and
    those that take the document of a run into the history. Methods that change the document must be called
    through `queue`.

    Attributes:
        queue: runs one change after the other.
        trust: whether functions that documents name may be run.
        history: the document, its edits, and the version of changes.
        file: the file of the document, its stored edits, its snapshots and presets.
        run: its compilation and the engine.
        record: the open record, its comparison, and the document set aside for it.
    """

    def __init__(
        self,
        workspace: Workspace,
        store: StateStore,
        engine: Engine,
        embodiment: Embodiment,
        trust: bool,
        changed: Callable[[], None],
    ) -> None:
        self._workspace, self._engine, self._embodiment = workspace, engine, embodiment
        self.trust = trust
        self.queue = ChangeQueue()
        self._conversions = Conversions(self._judge)
        self.record = OpenRecord(workspace.shown, changed, lambda: self.history.touch())
        self.file = DocumentFile(workspace, store, changed)

        def times(known: CompileTimes) -> None:
            store.store_compile_times(known.known)

        self.run = DocumentRun(engine, embodiment, self._conversions, self.queue, times, changed)
        self.history = DocumentHistory(
            self.queue, self._conversions, self.run.adopt, self.file.differs, changed
        )
        self._converting = asyncio.Lock()
        self._opened: Opened | None = None

    # ------------------------------------------------------------------------------------------------ looking

    @property
    def session(self) -> int:
        """Counter that increases when a document is opened or closed."""
        return self.queue.session

    @property
    def edits(self) -> str:
        """Name under which the unsaved edits of the open document are stored; empty if none is open."""
        aside = self.record.aside
        return (self.file.state if aside is None else aside.file).edits

    async def opened(self) -> Opened:
        """Return the whole document as a message, without one if none is open.

        It is converted in a thread, once for all pages.
        """
        async with self._converting:
            now = (self.session, self.history.version)
            if self._opened is None or (self._opened.session, self._opened.version) != now:
                self._opened = await self._convert_whole()
            return self._opened

    async def _convert_whole(self) -> Opened:
        session, version, model, reader = (
            self.session,
            self.history.version,
            self.history.model,
            self.record.reader,
        )
        if model is None:
            return Opened(session=session, version=version, document=None)
        doc, history = model.document, model.history
        file = self.file.shown
        status = (self.history.unsaved, history.depth, history.ahead)
        before = self._conversions.latest

        def convert() -> tuple[Converted, DocumentView]:
            made = self._conversions.convert(doc, before)
            return made, view.document(doc, file, *status, made)

        made, shown = await asyncio.to_thread(convert)
        self._conversions.add(made)
        if reader is not None:
            record = view.record(reader, self._workspace.shown(reader.path))
            elements = [msgspec.structs.replace(e, pushable=False) for e in shown.elements]
            shown = msgspec.structs.replace(shown, record=record, problems=[], elements=elements)
        return Opened(session=session, version=version, document=shown)

    def changes_since(self, session: int, version: int) -> list[Edited] | None:
        """Return the changes from a version to the present one; None if a page needs the whole document."""
        return self.history.changes_since(version) if session == self.session else None

    def _judge(self, doc: Document) -> tuple[Sequence[Problem], Sequence[Problem]]:
        """Return the problems of a document in the world that it would run in, or else its warnings there.

        That of a record has neither: it does not run.
        """
        if self.record.reader is not None:
            return (), ()
        session = self._engine.session
        world = self._embodiment.world(doc, None if session is None else session.world)
        problems = embodiment.problems(doc, world)
        return problems, () if problems else embodiment.warnings(doc, world)

    # ------------------------------------------------------------------------------------ opening and closing

    async def open_file(self, path: Path, discard: bool) -> str:
        """Open a document or a record; an example or a file of another tool has no file afterwards.

        Problems of the file are stored in `file.refused`, which the page shows. Return a sentence on the
        import of a file of another tool, otherwise an empty string.
        """
        self._ask_unsaved(discard)
        if await in_file_thread(lambda: path.is_dir() or files.is_record(path), str(path)):
            await self._open_record(path)
            return ""
        foreign = await in_file_thread(lambda: content.is_foreign(self._workspace, path), str(path))
        own = None if foreign or examples.holds(path) else path
        await self._open(lambda: content.load(self._workspace, path), own, str(path), discard)
        return self._reported() if foreign else ""

    async def _open_record(self, path: Path) -> None:
        try:
            record, scene = await in_file_thread(lambda: record_frames.opened(path), str(path))
        except DeodarError as error:
            await self._refuse(str(path), error)
            return
        await self._leave()
        self.record.open(record, scene)
        self.history.open(Model(document=record.document), self._workspace.shown(path))
        await self.file.opened(path)
        self.history.touch()

    async def open_trial(self, path: Path) -> None:
        """Open the record of a trial, and set the open document aside until `reopen`.

        Raises:
            DeodarError: the record cannot be read; the document stays open.
        """
        record, scene = await in_file_thread(lambda: record_frames.opened(path), str(path))
        await self.store_edits()
        aside, model = self.record.aside, self.history.model
        if model is not None and self.record.reader is None:
            aside = SetAside(model, self.file.state, self._engine.session)
        await self._leave(forget=False)
        self.record.open(record, scene, aside)
        self.history.open(Model(document=record.document), self._workspace.shown(path))
        self.history.touch()

    async def reopen(self) -> None:
        """Open the document that was set aside, with its history, its unsaved edits and its run, if there is
        one. The run is paused at the moment at which it was left.
        """
        aside = self.record.aside
        if aside is None:
            return
        await self._leave(forget=False)
        self.file.reopen(aside.file)
        if aside.session is None:
            self._run_opened(aside.model)
            return
        self.history.open(aside.model)
        await self.run.resume(aside.model, aside.session)
        self.history.touch()

    async def open_record_model(self, discard: bool) -> None:
        """Open the document of the open record, as a document without a file."""
        record = self.record.require()
        await self._open(lambda: record.document, None, record.document.name, discard)

    async def open_copy(self, read: Callable[[], Document], title: str, discard: bool) -> None:
        """Open a document without a file: an example, or a package that was dropped on the page."""
        await self._open(read, None, title, discard)

    async def open_text(self, text: str, title: str, discard: bool) -> str:
        """Open a document, or a file of another tool, given as text; return as `open_file` does."""
        await self._open(lambda: content.read(text, title), None, title, discard)
        return "" if opening.tool_for(text.encode()) is None else self._reported()

    async def open_model(
        self, read: Callable[[], Document], file: Path | None, title: str, discard: bool
    ) -> None:
        """Open the model of an experiment, which has that file, unless this file is open already."""
        if file is None or file != self.file.path or self.record.reader is not None:
            await self._open(read, file, title, discard)

    async def recover(self, name: str, discard: bool) -> None:
        """Open stored unsaved edits."""
        await self._open_stored(name, discard)
        if self.history.model is not None:
            self.file.recovered(self.history.model.document, name)
            self.history.touch()

    async def recover_model(self, name: str, discard: bool) -> None:
        """Open the model of an experiment whose edits were stored; it has unsaved edits itself if its file
        contains another document.
        """
        doc = await self._open_stored(name, discard)
        file = self.file.path
        if self.history.model is None or file is None:
            return
        with contextlib.suppress(DeodarError, OSError):
            saved = await in_file_thread(lambda: content.load(self._workspace, file), str(file))
            if plain(saved) == plain(doc):
                return
        self.file.recovered(doc)
        self.history.touch()

    async def _open_stored(self, name: str, discard: bool) -> Document:
        self._ask_unsaved(discard)
        doc, file = await self.file.stored(name)
        await self._open(lambda: doc, file, doc.name, True)
        return doc

    async def close(self, discard: bool) -> None:
        """Close the document."""
        self._ask_unsaved(discard)
        await self._leave()
        self.history.touch()

    async def _open(self, read: Callable[[], Document], file: Path | None, title: str, discard: bool) -> None:
        self._ask_unsaved(discard)
        try:
            doc = await in_file_thread(read, title)
        except DeodarError as error:
            await self._refuse(title, error)
            return
        await self._leave()
        await self.file.open(file, doc)
        self._run_opened(Model(document=doc, trusted=self.trust))

    def _run_opened(self, model: Model) -> None:
        """Show a document that was opened, and compile it."""
        self.history.open(model)
        self.run.open(model)
        self.history.touch()

    async def _refuse(self, title: str, error: DeodarError) -> None:
        """Show the problems of a file that cannot be opened."""
        await self._leave()
        self.file.refuse(title, error.problems)
        self.history.touch()

    async def _leave(self, forget: bool = True) -> None:
        """Close the document or record; `forget`: delete the unsaved edits that are stored."""
        aside = self.record.aside
        for name in (self.file.state.edits, "" if aside is None else aside.file.edits) if forget else ():
            await self.file.forget(name)
        self.queue.session += 1
        self.history.close()
        self.file.close()
        self.record.close()
        self._conversions.clear()
        await self.run.close()

    def _ask_unsaved(self, discard: bool) -> None:
        aside = self.record.aside
        if not discard and (self.history.unsaved if aside is None else aside.unsaved):
            raise ConfirmationRequired("unsaved")

    def _reported(self) -> str:
        """Return the first line of the import report, which the importer writes at the start of the notes."""
        model = self.history.model
        return "" if model is None else model.document.notes.partition("\n")[0]

    # ------------------------------------------------------------------------------------------------- saving

    async def save(self, path: str, replace: bool) -> Path:
        """Write the document as `DocumentFile.save` does; that of a record remains without a file.

        A document without a title gets the name of its file, and so do its snapshots and presets.
        """
        doc = self.history.document()
        if self.record.reader is not None:
            return await self.file.write(doc, path, replace)
        untitled = bool(path) and doc.name == UNTITLED
        if untitled:
            doc = edit.describe(doc, name=self._workspace.target(path).stem)
        place = await self.file.save(doc, path, replace)
        if untitled:
            await self.history.rename(doc.name)
            await self.file.move_saved(UNTITLED, doc.name)
        self.history.touch()
        return place

    async def store_edits(self) -> None:
        """Store unsaved edits, if they are new."""
        if self.history.unsaved:
            await self.file.store_edits(self.history.document())

    async def list_saved(self) -> None:
        """Read the list of snapshots and presets of the open document again."""
        model = None if self.record.reader is not None else self.history.model
        await self.file.list_saved(None if model is None else model.name)

    async def save_snapshot(self, name: str) -> Path:
        """Save the present state of the run under a new name; return the file."""
        self.require_run()
        snapshot = await self.run.snapshot()
        return await self.file.save_snapshot(self.history.document().name, name, snapshot)

    # ------------------------------------------------------------------------------------------------ running

    def require_run(self) -> None:
        """Raise DocumentError if no session runs and none is being compiled."""
        self.history.require_edited()
        self.run.require()

    async def embody(self, world: World, kind: str, name: str) -> None:
        """Use another world, as `DocumentRun.embody` does."""
        self.history.require_edited()
        await self.run.embody(world, kind, name)
        self.history.touch()

    async def return_to(self, name: str) -> None:
        """Return to a snapshot; its elements, connections and parameters are one step of undo.

        Raises:
            UnknownName: there is none of this name.
            ParameterError: it is of another model.
        """
        self.require_run()
        snapshot = await self.file.snapshot(self.history.document().name, name, self.trust)
        self.history.follow(await self.run.return_to_snapshot(snapshot))

    async def run_from(self, time: float) -> None:
        """Continue the run from an earlier moment of the last minute, with the parameters of that moment.

        Raises:
            RecordError: the moment cannot be computed again.
        """
        self.require_run()
        self.history.follow(await self.run.return_to_time(time))
        await self.run.play()

    async def run_record_from(self, time: float) -> None:
        """Open a copy of the document of the open record, and let it run from a moment of the record.

        Raises:
            DocumentError: no record is open, or another document was opened during the repetition.
            RecordError: the record cannot be repeated up to this moment, or its repetition differs.
        """
        session, attempt = await self.run.repeat(self.record.require(), time, self.trust)

        async def take_over() -> None:
            self.run.require_attempt(attempt)
            await self._continue(session)

        await self.queue.run(take_over)

    async def _continue(self, session: Session) -> None:
        """Open the document of a session that continues a record, and let it run."""
        await self._leave(forget=False)  # the stored edits of a document set aside stay
        model = Model(document=session.document, trusted=self.trust)
        await self.file.open(None, session.document)
        self.history.open(model)
        await self.run.continue_with(model, session)
        self.history.touch()
