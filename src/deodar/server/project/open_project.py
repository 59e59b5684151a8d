"""The open document: its history, its file, and the engine that runs it.

Everything here runs in the thread of the event loop. An invalid change is refused before it enters the
history.
"""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses as dc
from collections import deque
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Literal

import msgspec

from deodar.declarations import Cost
from deodar.errors import DeodarError, DocumentError
from deodar.errors import Problem as Wrong
from deodar.importers import examples, opening, stored_report
from deodar.live.compilation import Compilation
from deodar.live.engine import Engine
from deodar.model import edit, find
from deodar.model.check import check
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.recording import files
from deodar.recording.provenance import described
from deodar.recording.replay import RecordReader
from deodar.server import content, converted, embodiment, record_frames, saved_files, view
from deodar.server.converted import Converted, Status
from deodar.server.embodiment import Embodiment, signals
from deodar.server.file_thread import in_file_thread, try_in_file_thread
from deodar.server.project.change_queue import ChangeQueue
from deodar.server.project.checker import Checker
from deodar.server.project.comparison import RecordComparison
from deodar.server.project.recent_changes import DocumentChange, RecentChanges
from deodar.server.saved_files import SavedFolder
from deodar.server.state_store import StateStore
from deodar.server.to_page import (
    Changed,
    Comparison,
    DocumentView,
    ImportReportView,
    ListedProblem,
    Opened,
    SavedFiles,
)
from deodar.server.workspace import Workspace
from deodar.session.exchange import used
from deodar.session.session import Session
from deodar.session.session_at import session_at
from deodar.worlds._base import World
from deodar.worlds._scene import Scene

Ask = Literal["unsaved", "unsaved_experiment", "replace"]


class ConfirmationRequired(Exception):
    """A question that the user must answer before the request can be repeated.

    Args:
        question: the question.
        file: the file that would be replaced, as the page names it; empty: the one that the request names.
    """

    def __init__(self, question: Ask, file: str = "") -> None:
        self.question: Ask = question
        self.file = file
        super().__init__(question)


@dc.dataclass(frozen=True)
class SetAside:
    """An open document in whose place the record of a trial is shown.

    Attributes:
        model: the document, with its history.
        file: the file that it is saved to.
        saved: the document as saved last.
        digest: the digest of its file as read or written last.
        name: the name under which its unsaved edits are stored.
        stored: the document as stored last under that name.
    """

    model: Model
    file: Path | None
    saved: Document | None
    digest: str
    name: str
    stored: Document | None

    @property
    def unsaved(self) -> bool:
        """Whether the document has edits that are not saved to a file."""
        return _differs(self.model.document, self.saved)


def _differs(doc: Document, saved: Document | None) -> bool:
    return saved is not doc and view.plain(doc) != saved


class OpenProject:
    """The open document, if any.

    Methods that change it must be called through `queue`.

    Attributes:
        queue: runs one change after the other.
        trust: whether functions that documents name may be run.
        version: number of changes that pages must receive.
        model: the document being edited, with its history.
        file: the file that the document is saved to.
        file_problems: the file that could not be opened, and its problems.
        failure: why the document does not run.
        busy: a phrase for the compilation in progress; empty: none.
        compilation: the compilation in progress, or the last one.
        record: the open record, whose document `model` has; None: the document runs.
        aside: the document in whose place the open record is shown; None: the record is not that of a trial.
        comparison: the comparison of the open record with another one.
        scene: the view of the record's world at its start, and a sentence on what it does not contain.
        saved_files: the snapshots and presets of the document, as listed last.
        checker: finds the warnings after changes of single parameters.
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
        self.workspace, self.store, self.engine, self.embodiment = workspace, store, engine, embodiment
        self.trust, self._changed = trust, changed
        self.queue = ChangeQueue()
        self.version = 0
        self.model: Model | None = None
        self.file: Path | None = None
        self.file_problems: tuple[str, Sequence[Wrong]] = ("", ())
        self.failure: Sequence[Wrong] = ()
        self.busy = ""
        self.compilation: Compilation | None = None
        self.record: RecordReader | None = None
        self.aside: SetAside | None = None
        self.scene: tuple[Scene | None, str] = (None, "")
        self.comparison: RecordComparison | None = None
        self.checker = Checker(
            lambda: (self.version, None if self.model is None else self.model.document),
            self._check,
            self.queue,
            changed,
        )
        self.saved_files = saved_files.NOTHING
        self._name = ""
        self._saved: Document | None = None
        self._stored: Document | None = None
        self._digest = ""
        self._gesture: object = None
        self._recent = RecentChanges()
        self._converted: deque[Converted] = deque(maxlen=3)  # that of the last version, and coming ones
        self._converting = asyncio.Lock()
        self._opened: Opened | None = None
        self._report: tuple[Any, ImportReportView] = (None, view.NO_REPORT)  # as the layout has it, converted
        self._attempt = 0

    # ------------------------------------------------------------------------------------------------ looking

    @property
    def session(self) -> int:
        """Counter that increases when a document is opened or closed."""
        return self.queue.session

    async def opened(self) -> Opened:
        """Return the whole document as a message, without one if none is open.

        It is converted in a thread, once for all pages.
        """
        async with self._converting:
            now = (self.session, self.version)
            if self._opened is None or (self._opened.session, self._opened.version) != now:
                self._opened = await self._convert_whole()
            return self._opened

    async def _convert_whole(self) -> Opened:
        session, version, model, opened = self.session, self.version, self.model, self.record
        if model is None:
            return Opened(session=session, version=version, document=None)
        doc, history = model.document, model.history
        file = "" if self.file is None else self.workspace.shown(self.file)
        status = (self.unsaved, history.depth, history.ahead)
        before = self._converted[-1] if self._converted else None

        def convert() -> tuple[Converted, DocumentView]:
            made = self._convert(doc, before)
            return made, view.document(doc, file, *status, made)

        made, shown = await asyncio.to_thread(convert)
        self._converted.append(made)
        if opened is not None:
            record = view.record(opened, self.workspace.shown(opened.path))
            elements = [msgspec.structs.replace(e, pushable=False) for e in shown.elements]
            shown = msgspec.structs.replace(shown, record=record, problems=[], elements=elements)
        return Opened(session=session, version=version, document=shown)

    def changes_since(self, session: int, version: int) -> list[DocumentChange] | None:
        """Return the changes from a version to the present one; None if a page needs the whole document."""
        return self._recent.between(version, self.version) if session == self.session else None

    def report(self) -> ImportReportView:
        """Return the import report of the open document; it is converted once."""
        doc = None if self.model is None else self.model.document
        kept = None if doc is None else doc.layout.get(stored_report.KEY)
        if doc is None or kept is None:
            return view.NO_REPORT
        if self._report[0] is not kept:
            self._report = (kept, view.import_report(doc))
        return self._report[1]

    @property
    def unsaved(self) -> bool:
        """Whether the document has edits that are not saved to a file."""
        return self.model is not None and self.record is None and _differs(self.model.document, self._saved)

    @property
    def edits(self) -> str:
        """Name under which the unsaved edits of the open document are stored; empty if none is open."""
        return self._name if self.aside is None else self.aside.name

    @property
    def senses(self) -> bool:
        """Whether the open document has sensors or motors and can run."""
        return self.model is not None and self.record is None and bool(signals(self.model.document))

    def failures(self) -> list[ListedProblem]:
        """Return why the document does not run; an empty list if it does."""
        doc = None if self.model is None else self.model.document
        found, paths = self.engine.failure
        return [*view.problems(self.failure, doc), *view.problems(found, doc, paths)]

    # ------------------------------------------------------------------------------------ opening and closing

    async def open_file(self, path: Path, discard: bool) -> str:
        """Open a document or a record; an example or a file of another tool has no file afterwards.

        Problems of the file are stored in `file_problems`, which the page shows. Return a sentence on the
        import of a file of another tool, otherwise an empty string.
        """
        self._ask_unsaved(discard)
        if await in_file_thread(lambda: path.is_dir() or files.is_record(path), str(path)):
            await self._open_record(path)
            return ""
        foreign = await in_file_thread(lambda: content.is_foreign(self.workspace, path), str(path))
        own = None if foreign or examples.holds(path) else path
        await self._open(lambda: content.load(self.workspace, path), own, str(path), discard)
        return self._reported() if foreign else ""

    async def _open_record(self, path: Path) -> None:
        try:
            record, scene = await in_file_thread(lambda: record_frames.opened(path), str(path))
        except DeodarError as error:
            await self._refuse(str(path), error)
            return
        await self._leave()
        self._show(record, scene)
        await try_in_file_thread(lambda: self.store.opened(path))
        self._moved()

    def _show(self, record: RecordReader, scene: tuple[Scene | None, str]) -> None:
        self.record, self.scene = record, scene
        self.model = Model(document=record.document)

    async def open_trial(self, path: Path) -> None:
        """Open the record of a trial, and set the open document aside until `reopen`.

        Raises:
            DeodarError: the record cannot be read; the document stays open.
        """
        record, scene = await in_file_thread(lambda: record_frames.opened(path), str(path))
        await self.store_edits()
        aside = self.aside
        if self.model is not None and self.record is None:
            aside = SetAside(self.model, self.file, self._saved, self._digest, self._name, self._stored)
        self._name, self.aside = "", None  # its stored edits stay
        await self._leave()
        self.aside = aside
        self._show(record, scene)
        self._moved()

    async def reopen(self) -> None:
        """Open the document that was set aside, with its history and its unsaved edits, if there is one."""
        aside, self.aside = self.aside, None
        if aside is None:
            return
        await self._leave()
        self.model, self.file, self._saved, self._digest = aside.model, aside.file, aside.saved, aside.digest
        self._name, self._stored = aside.name, aside.stored
        self._run_opened()

    async def open_record_model(self, discard: bool) -> None:
        """Open the document of the open record, as a document without a file."""
        record = self.record
        if record is None:
            raise DocumentError("no record is open")
        await self._open(lambda: record.document, None, record.document.name, discard)

    async def compare(self, path: Path, changed: Callable[[], None]) -> None:
        """Compare the open record with another one; `changed` is called in another thread."""
        record = self.record
        if record is None:
            raise DocumentError("no record is open", fix="Open one, then compare it with another one")
        found = await in_file_thread(lambda: RecordComparison(record, path, changed), str(path))
        self.end_comparison()
        self.comparison = found
        self._changed()

    def end_comparison(self) -> None:
        """Show the open record alone."""
        if self.comparison is not None:
            self.comparison.end()
        self.comparison = None
        self._changed()

    def compared(self) -> Comparison:
        """Return the comparison as a message."""
        found = self.comparison
        if found is None:
            return view.NO_COMPARISON
        return view.comparison(found, self.workspace.shown(found.other.path))

    async def refresh(self) -> bool:
        """Read what was added to a record that grows; return whether something was."""
        record = self.record
        if record is None or record.complete:
            return False
        grew: list[bool] = []
        known = record.notes
        await try_in_file_thread(lambda: grew.append(record.refresh()))
        if record is self.record and record.notes != known:
            self._moved()
        return any(grew)

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
        if file is None or file != self.file or self.record is not None:
            await self._open(read, file, title, discard)

    async def recover(self, name: str, discard: bool) -> None:
        """Open stored unsaved edits."""
        if await self._open_stored(name, discard) is not None and self.model is not None:
            self._saved = None
            self._name, self._stored = name, self.model.document
            self._moved()

    async def recover_model(self, name: str, discard: bool) -> None:
        """Open the model of an experiment whose edits were stored; it has unsaved edits itself if its file
        contains another document.
        """
        doc = await self._open_stored(name, discard)
        file = self.file
        if doc is None or file is None:
            return
        with contextlib.suppress(DeodarError, OSError):
            saved = await in_file_thread(lambda: content.load(self.workspace, file), str(file))
            if view.plain(saved) == view.plain(doc):
                return
        self._saved = None
        self._moved()

    async def _open_stored(self, name: str, discard: bool) -> Document | None:
        """Open a stored document; None: it could not be opened."""
        self._ask_unsaved(discard)
        doc, file = await in_file_thread(lambda: self.store.read(name), name)
        path = Path(file) if file else None
        if path is not None and not self.workspace.holds(path):
            path = None
        await self._open(lambda: doc, path, doc.name, True)
        return None if self.model is None else doc

    async def close(self, discard: bool) -> None:
        """Close the document."""
        self._ask_unsaved(discard)
        await self._leave()
        self._moved()

    async def _open(self, read: Callable[[], Document], file: Path | None, title: str, discard: bool) -> None:
        self._ask_unsaved(discard)
        try:
            doc = await in_file_thread(read, title)
        except DeodarError as error:
            await self._refuse(title, error)
            return
        await self._leave()
        self.model = Model(document=doc, trusted=self.trust)
        self.file, self._saved, self._digest = file, view.plain(doc), await self._hash(file)
        self._name, self._stored = self.store.new_name(), doc
        if file is not None:
            await try_in_file_thread(lambda: self.store.opened(file))
        self._run_opened()

    def _run_opened(self) -> None:
        """Show the document that was opened, and compile it."""
        if self._conversion(self._require().document).problems:  # it is edited, and runs once it has none
            self._moved()
            return
        self.busy = "compiling"  # set before pages receive the document, so that no page considers it ready
        self._moved()
        self.queue.start_task(self._start())

    async def _refuse(self, title: str, error: DeodarError) -> None:
        """Show the problems of a file that cannot be opened."""
        await self._leave()
        self.file_problems = (title, error.problems)
        self._moved()

    async def _leave(self) -> None:
        for name in (self._name, "" if self.aside is None else self.aside.name):
            if name:
                await try_in_file_thread(lambda name=name: self.store.forget(name))
        self.queue.session += 1
        self._attempt += 1
        self.model, self.file, self._saved, self._name, self._gesture = None, None, None, "", None
        self.file_problems, self.failure, self.busy = ("", ()), (), ""
        self.record, self.aside, self.scene, self.saved_files = None, None, (None, ""), saved_files.NOTHING
        self._converted.clear()
        self.end_comparison()
        await asyncio.wrap_future(self.engine.call(lambda: self.engine.load(None)))

    async def _start(self) -> None:
        """Compile the document and load it into the engine, unless a later attempt has started meanwhile."""
        model = self._require()
        self._attempt += 1
        attempt = self._attempt
        self.busy, self.failure = "compiling", ()
        self._changed()
        doc = model.document
        times = self.engine.compile_times
        compilation = self.compilation = times.start(doc)

        def make() -> Session:
            session = Session(model, world=self.embodiment.world(doc))
            compilation.phase = "compiling"
            session.program.chunk(())
            if session.program.compiled:
                times.took(doc, compilation.elapsed)
                self.store.store_compile_times(times.known)
            return session

        try:
            session = await asyncio.to_thread(make)
        except DeodarError as error:
            self._fail(attempt, error.problems)
        except Exception as error:  # functions that the document names run during compilation
            self._fail(attempt, [Wrong("", f"{type(error).__name__}: {error}")])
        else:
            await self.queue.run(lambda: self._take(attempt, session, doc))

    async def _take(self, attempt: int, session: Session, doc: Document) -> None:
        """Load the compiled session into the engine, with the edits that were made since."""
        if attempt != self._attempt:
            return
        await asyncio.wrap_future(self.engine.call(lambda: self.engine.load(session)))
        try:
            if self._require().document is not doc:
                await self._adopt(self._require().document)
        except DeodarError as error:
            await asyncio.wrap_future(self.engine.call(lambda: self.engine.load(None)))
            self._fail(attempt, error.problems)
            return
        self.busy = ""  # last, because a page that sees it may send requests that need a session
        self._changed()

    def _fail(self, attempt: int, problems: Sequence[Wrong]) -> None:
        if attempt == self._attempt:
            self.busy, self.failure = "", problems
            self._changed()

    def _ask_unsaved(self, discard: bool) -> None:
        unsaved = self.unsaved if self.aside is None else self.aside.unsaved
        if unsaved and not discard:
            raise ConfirmationRequired("unsaved")

    # ------------------------------------------------------------------------------------------------- saving

    async def save(self, path: str, replace: bool) -> Path:
        """Write the document to a path, or to its own file if the path is empty; return the file.

        Raises:
            ConfirmationRequired: without `replace`, if the file is not the document's own, or changed since
                it was read.
            DocumentError: the path is empty and the document has no file, or the file cannot be written.
        """
        model = self._require()
        place = self.workspace.target(path) if path else self.file
        if place is None:
            raise DocumentError("has no file yet", where=model.name, fix="Save it under a name")
        own = self.file is not None and place == self.file
        now = await self._hash(place)
        if not replace and now and not (own and now == self._digest):
            raise ConfirmationRequired("replace")
        doc = model.document
        await in_file_thread(lambda: self.workspace.save(doc, place), path or str(place))
        if self.record is not None:
            return place
        self.file, self._saved, self._digest, self._stored = (
            place,
            view.plain(doc),
            await self._hash(place),
            doc,
        )
        await try_in_file_thread(lambda: self.store.forget(self._name))
        await try_in_file_thread(lambda: self.store.opened(place))
        self._moved()
        return place

    async def _hash(self, place: Path | None) -> str:
        return "" if place is None else await in_file_thread(lambda: self.workspace.digest(place), str(place))

    async def store_edits(self) -> None:
        """Store unsaved edits, if they are new."""
        if self.model is not None and self.unsaved and self._stored is not self.model.document:
            doc, name, file = self.model.document, self._name, "" if self.file is None else str(self.file)
            await try_in_file_thread(lambda: self.store.store_edits(name, doc, file))
            self._stored = doc

    # ------------------------------------------------------------------------------------------------ editing

    async def set(self, element: str, parameter: str, value: Any, gesture: object) -> Cost:
        """Change a parameter of an element, or, with an empty element, a document parameter."""
        model = self._require()
        doc = model.document
        if not element:
            if parameter not in [k.name for k in doc.parameters]:
                raise DocumentError("there is no such document parameter", where=parameter)
            new = edit.document_parameter(doc, parameter, value)
            return await self._commit(new, gesture)
        entry = find.entry(doc, element)
        new = edit.put(doc, element, parameter, view.read_value(doc, entry, parameter, value))
        shown = view.shown_value(new, element, parameter)
        return await self._commit(new, gesture, (element, parameter, shown))

    async def change(self, how: Callable[[Document], Document], gesture: object = None) -> Cost:
        """Apply a function to the document, as one step of undo.

        Changes in sequence with the same `gesture` (not None) are one step together.
        """
        return await self._commit(how(self._require_model().document), gesture)

    async def describe(self, values: dict[str, Any]) -> None:
        """Change general properties of the document."""
        await self.change(lambda doc: edit.describe(doc, **values))

    def require_run(self) -> None:
        """Raise DocumentError if no session runs and none is being compiled."""
        doc = self._require_model().document
        if self.engine.session is None and not self.busy:
            raise DocumentError(
                self.failure or self._conversion(doc).problems or [Wrong("", "the model does not run yet")]
            )

    async def run_from(self, time: float) -> None:
        """Continue the run from an earlier moment of the last minute, with the parameters of that moment.

        Notes, name and layout of the document stay.

        Raises:
            RecordError: the moment cannot be computed again.
        """
        self.require_run()
        await asyncio.wrap_future(self.engine.call(lambda: self.engine.branch(time)))
        await self._follow_run()
        await asyncio.wrap_future(self.engine.call(lambda: self.engine.play(True)))

    async def run_record_from(self, time: float) -> None:
        """Open a copy of the document of the open record, and let it run from a moment of the record.

        Raises:
            DocumentError: no record is open, or another document was opened during the repetition.
            RecordError: the record cannot be repeated up to this moment, or its repetition differs.
        """
        record = self.record
        if record is None:
            raise DocumentError("no record is open")
        self._attempt += 1
        attempt = self._attempt

        def progress(done: int, steps: int) -> None:
            if attempt != self._attempt:
                raise DocumentError("another request ended the repetition of the record")
            self.busy = f"repeating the record, {100 * done // max(steps, 1)} %"

        def repeat() -> Session:
            progress(0, 1)
            moment = float(record.times[record.index(time)])
            session = session_at(record.path, moment, trust=self.trust, progress=progress)
            progress(1, 1)
            return session

        try:
            session = await asyncio.to_thread(repeat)
        finally:
            if attempt == self._attempt:
                self.busy = ""
                self._changed()
        await self.queue.run(lambda: self._take_over(attempt, session))

    async def _take_over(self, attempt: int, session: Session) -> None:
        """Open the document of a session that continues a record, and let it run."""
        if attempt != self._attempt:
            raise DocumentError("another request ended the repetition of the record")
        doc, world = session.document, session.world
        self.aside = None  # the stored edits of the document stay
        await self._leave()
        self.model = Model(document=doc, trusted=self.trust)
        self._saved, self._digest = view.plain(doc), ""
        self._name, self._stored = self.store.new_name(), doc
        if world is not None:
            kind = type(world).__name__
            self.embodiment.choose(world, kind, str((described(world) or {}).get("file", "")), doc)
        await asyncio.wrap_future(self.engine.call(lambda: self.engine.load(session)))
        await asyncio.wrap_future(self.engine.call(lambda: self.engine.play(True)))
        self._moved()

    def end(self) -> None:
        """End the repetition of a record, if one is computed."""
        self._attempt += 1

    async def list_saved(self) -> None:
        """Read the list of snapshots and presets of the open document again."""
        doc = None if self.model is None or self.record is not None else self.model.document
        found: list[SavedFiles] = [saved_files.NOTHING]
        if doc is not None:
            await try_in_file_thread(lambda: found.append(SavedFolder(self.workspace, doc.name).listed()))
        self.saved_files = found[-1]
        self._changed()

    async def save_snapshot(self, name: str) -> Path:
        """Save the present state of the run under a new name; return the file."""
        self.require_run()
        snapshot = await asyncio.wrap_future(self.engine.call(self.engine.snapshot))
        folder = SavedFolder(self.workspace, self._require().document.name)
        path = await in_file_thread(lambda: folder.save_snapshot(name, snapshot), name)
        await self.list_saved()
        return path

    async def save_preset(self, name: str) -> Path:
        """Save the present values of the parameters under a new name; return the file."""
        doc = self._require_model().document
        path = await in_file_thread(
            lambda: SavedFolder(self.workspace, doc.name).save_preset(name, doc), name
        )
        await self.list_saved()
        return path

    async def return_to(self, name: str) -> None:
        """Return to a snapshot; its elements, connections and parameters are one step of undo.

        Raises:
            UnknownName: there is none of this name.
            ParameterError: it is of another model.
        """
        self.require_run()
        folder = SavedFolder(self.workspace, self._require().document.name)
        snapshot = await in_file_thread(lambda: folder.snapshot(name, self.trust), name)
        await asyncio.wrap_future(self.engine.call(lambda: self.engine.restore(snapshot)))
        await self._follow_run()

    async def remove_saved(self, sort: saved_files.Sort, name: str) -> None:
        """Delete a snapshot or a preset."""
        folder = SavedFolder(self.workspace, self._require_model().document.name)
        await in_file_thread(lambda: folder.remove(sort, name), name)
        await self.list_saved()

    async def _follow_run(self) -> None:
        """Take over elements, connections and parameters of the running session, as one step of undo."""
        model, session = self._require_model(), self.engine.session
        assert session is not None
        now = model.document
        doc = dc.replace(session.document, name=now.name, notes=now.notes, layout=now.layout)
        if doc != now:
            model.history.commit(doc)
            self._gesture = None
            self._moved()

    async def embody(self, world: World, kind: str, name: str) -> None:
        """Use another world, at once or, if the document has no sensors, as soon as a document has some.

        Raises:
            WorldError: the world lacks a sensor or motor of the document, or gives it over other axes or in
                another unit, so that a document that runs would not run; the world in use stays.
        """
        model, session = self._require_model(), self.engine.session
        doc = model.document
        unfinished = bool(self._conversion(doc).problems)
        if not unfinished and not embodiment.missing(world, doc):
            used(doc, world)
        self.embodiment.choose(world, kind, name, doc)
        self._converted.clear()  # its problems may be those with another world
        if session is None:
            self.queue.start_task(self._restart())
        else:
            if not (unfinished and embodiment.problems(session.document, world)):
                await asyncio.wrap_future(self.engine.call(lambda: self.engine.see(world)))
            if unfinished:
                await self._adopt(doc)
        self._moved()

    def touch(self) -> None:
        """Send everything to all pages again, after a change outside the document."""
        self._moved()

    async def arrange(self, layout: dict[str, Any], undoable: bool) -> None:
        """Change parts of the layout; without `undoable`, in all documents of the history."""
        model = self._require()
        before = model.document
        if undoable:
            merged = {k: v for k, v in {**before.layout, **layout}.items() if v is not None}
            model.history.commit(edit.arrange(before, merged))
            self._gesture = None
        else:  # a drag of a slider continues, and redo remains
            edit.arrange_everywhere(model.history, layout)
        self._edited(before, "live")

    async def lay_out(self, how: Callable[[Document], Document]) -> None:
        """Apply a function that changes only the layout, as one step of undo; records have a layout too."""
        model = self._require()
        before = model.document
        new = how(before)
        if new is not before:
            model.history.commit(new)
            self._gesture = None
            self._edited(before, "live")

    def document(self) -> Document:
        """Return the open document, also that of a record; raise DocumentError if none is open."""
        return self._require().document

    async def undo(self) -> None:
        """Undo the last change."""
        self._require_model()
        await self._travel(lambda h: h.undo(), lambda h: h.redo())

    async def redo(self) -> None:
        """Redo the change that was undone last."""
        self._require_model()
        await self._travel(lambda h: h.redo(), lambda h: h.undo())

    async def _travel(
        self, there: Callable[[edit.UndoHistory], bool], back: Callable[[edit.UndoHistory], bool]
    ) -> None:
        history = self._require().history
        if not there(history):
            return
        doc = history.document
        back(history)  # the history moves only after the engine has accepted the document
        before = history.document
        cost = await self._adopt(doc)
        there(history)
        self._gesture = None
        self._edited(before, cost)

    async def _commit(self, doc: Document, gesture: object, leaf: tuple[str, str, Any] | None = None) -> Cost:
        model = self._require_model()
        before = model.document
        if doc is before or doc == before:
            return "live"
        cost = await self._adopt(doc)
        if gesture is not None and gesture == self._gesture:
            model.history.amend(doc)
        else:
            model.history.commit(doc)
        self._gesture = gesture
        if leaf is None or cost == "recompile":
            self._edited(before, cost)
        else:
            self.version += 1
            element, parameter, value = leaf
            change = Changed(
                version=self.version,
                element=element,
                parameter=parameter,
                value=value,
                cost=cost,
                unsaved=self.unsaved,
                undo=model.history.depth,
                redo=model.history.ahead,
            )
            self._recent.add(change)
            self._changed()
            self.checker.start()
        return cost

    async def _adopt(self, doc: Document) -> Cost:
        """Make the engine continue with a document, and return the cost.

        If the document has problems, the engine continues with the old one, while editing continues.
        """
        model = self._require()
        session = self.engine.session
        if session is None:
            if not self.busy:
                self.busy = "compiling"
                self.queue.start_task(self._restart())
            return "recompile"
        if session.cost(doc) == "recompile" and self._conversion(doc).problems:
            return "recompile"
        if not await self._enter_world(session, doc):
            self.busy = "compiling"
            await asyncio.wrap_future(self.engine.call(lambda: self.engine.load(None)))
            self.queue.start_task(self._restart())
            return "recompile"
        cost: Any = await asyncio.wrap_future(self.engine.call(lambda: self.engine.adopt(model, doc)))
        return cost

    async def _enter_world(self, session: Session, doc: Document) -> bool:
        """Make the session use a world that a document can run in.

        Return False if its present document cannot run there, so that the session must start again.
        """
        world = self.embodiment.world(doc, session.world)
        if world is None or world is session.world:
            return True
        if embodiment.problems(session.document, world):
            return False
        await asyncio.wrap_future(self.engine.call(lambda: self.engine.see(world)))
        return True

    async def _restart(self) -> None:
        """Compile a document again that failed before, after an edit."""
        session = self.session
        async with self.queue.lock:  # waits until the edit is in the history
            if session != self.session or self.model is None:
                return
            if self._conversion(self.model.document).problems:
                self.busy = ""
                self._changed()
                return
        await self._start()

    def _reported(self) -> str:
        """Return the first line of the import report, which the importer writes at the start of the notes."""
        return "" if self.model is None else self.model.document.notes.partition("\n")[0]

    def _require_model(self) -> Model:
        """Return the document that runs; that of a record neither runs nor changes."""
        if self.record is not None:
            raise DocumentError(
                "is a record, which neither runs nor changes",
                where=self.workspace.shown(self.record.path),
                fix="Run its model: the button Run its model opens a copy of the document",
            )
        return self._require()

    def _require(self) -> Model:
        if self.model is None:
            raise DocumentError("no document is open")
        return self.model

    def _conversion(self, doc: Document) -> Converted:
        """Return a document as parts of messages; the last ones are kept."""
        found = next((c for c in self._converted if c.document is doc), None)
        if found is None:
            found = self._convert(doc, self._converted[-1] if self._converted else None)
            self._converted.append(found)
        return found

    def _convert(self, doc: Document, before: Converted | None) -> Converted:
        """Convert a document; where its structure is sound, its problems are those with the world."""
        made = converted.convert(doc, before)
        if made.problems or self.record is not None:
            return made
        world = self._present_world(doc)
        wrong = embodiment.problems(doc, world)
        return dc.replace(made, problems=wrong, warnings=() if wrong else embodiment.warnings(doc, world))

    def _present_world(self, doc: Document) -> World | None:
        """Return the world that a document would run in."""
        session = self.engine.session
        return self.embodiment.world(doc, None if session is None else session.world)

    def _check(self, doc: Document) -> Sequence[Wrong]:
        """Return the problems of a document, or else its warnings."""
        found = check(doc)
        if any(p.severity == "problem" for p in found):
            return found
        world = self._present_world(doc)
        return embodiment.problems(doc, world) or [*embodiment.warnings(doc, world), *found]

    def _edited(self, before: Document, cost: Cost) -> None:
        """Start a new version after an edit, which pages receive as a patch."""
        model = self._require()
        old, new = self._conversion(before), self._conversion(model.document)
        status = Status(self.version + 1, self.unsaved, model.history.depth, model.history.ahead, cost)
        found = converted.patch(old, new, status, lambda: view.problems(new.problems, model.document))
        if found is None:
            self._moved()
            return
        self.version += 1
        self._recent.add(found)
        self._changed()
        if self.record is None:
            self.checker.start()

    def _moved(self) -> None:
        """Start a new version, for which every page needs the whole document."""
        self.version += 1
        self.checker.found = None
        self._recent.clear()
        self._changed()
