"""The document that is open: its history, its file, and the engine that runs it.

Lives in the thread of the event loop. What a change would break is refused before it enters the history.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Literal

from deodar.declarations import Cost
from deodar.errors import DeodarError, DocumentError
from deodar.errors import Problem as Wrong
from deodar.importers import examples, opening
from deodar.live.engine import Engine
from deodar.model import edit, find
from deodar.model.check import problems
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.server import content, view
from deodar.server.aside import aside, attempt
from deodar.server.checker import Checker
from deodar.server.embodiment import Embodiment
from deodar.server.keeper import Keeper
from deodar.server.recent_changes import RecentChanges
from deodar.server.to_page import Changed, DocumentView, ListedProblem
from deodar.server.turns import Turns
from deodar.server.workspace import Workspace
from deodar.session.session import Session
from deodar.worlds._base import World

Ask = Literal["unsaved", "replace"]


class Asks(Exception):
    """A question that the person has to settle first."""

    def __init__(self, question: Ask) -> None:
        self.question: Ask = question
        super().__init__(question)


class OpenProject:
    """What is open, if anything.

    Whatever changes it is called through `turns`.

    Attributes:
        turns: one change after the other.
        version: counts what a page has to be told.
        model: the document being edited, with its history.
        file: where it is saved.
        trouble: the file that could not be opened, and what is wrong with it.
        failure: why the document does not run.
        busy: what is being made, in words.
        checker: finds the warnings after single changes.
    """

    def __init__(
        self,
        workspace: Workspace,
        keeper: Keeper,
        engine: Engine,
        embodiment: Embodiment,
        trust: bool,
        changed: Callable[[], None],
    ) -> None:
        self.workspace, self.keeper, self.engine, self.embodiment = workspace, keeper, engine, embodiment
        self._trust, self._changed = trust, changed
        self.turns = Turns()
        self.version = 0
        self.model: Model | None = None
        self.file: Path | None = None
        self.trouble: tuple[str, Sequence[Wrong]] = ("", ())
        self.failure: Sequence[Wrong] = ()
        self.busy = ""
        self.checker = Checker(
            lambda: (self.version, None if self.model is None else self.model.document), self.turns, changed
        )
        self._name = ""
        self._saved: Document | None = None
        self._kept: Document | None = None
        self._digest = ""
        self._gesture: object = None
        self._recent = RecentChanges()
        self._attempt = 0

    # ------------------------------------------------------------------------------------------------ looking

    @property
    def session(self) -> int:
        """Counts the documents that were opened."""
        return self.turns.session

    def view(self) -> DocumentView | None:
        """The document for the page."""
        if self.model is None:
            return None
        history = self.model.history
        file = "" if self.file is None else self.workspace.shown(self.file)
        return view.document(self.model.document, file, self.unsaved, history.depth, history.ahead)

    def changes_since(self, session: int, version: int) -> list[Changed] | None:
        """Single changes that bring a page from that version to this one; None if it needs the whole
        document.
        """
        return self._recent.between(version, self.version) if session == self.session else None

    @property
    def unsaved(self) -> bool:
        """Whether there are edits that no file holds."""
        return (
            self.model is not None
            and self._saved is not self.model.document
            and view.plain(self.model.document) != self._saved
        )

    def failures(self) -> list[ListedProblem]:
        """Why nothing runs, if so."""
        doc = None if self.model is None else self.model.document
        found, paths = self.engine.failure
        return [*view.problems(self.failure, doc), *view.problems(found, doc, paths)]

    # ------------------------------------------------------------------------------------ opening and closing

    async def open_file(self, path: Path, discard: bool) -> str:
        """Open a document; an example, or a file of another tool, as one without a file.

        What is wrong with it becomes the trouble that the page shows.
        Of a file of another tool it answers in a sentence what became of it, otherwise nothing.
        """
        self._ask_unsaved(discard)
        foreign = await aside(lambda: content.is_foreign(self.workspace, path), str(path))
        own = None if foreign or examples.holds(path) else path
        await self._open(lambda: content.load(self.workspace, path), own, str(path), discard)
        return self._reported() if foreign else ""

    async def open_copy(self, read: Callable[[], Document], title: str, discard: bool) -> None:
        """Open a document as one without a file: an example, or a package that was dropped on the page."""
        await self._open(read, None, title, discard)

    async def open_text(self, text: str, title: str, discard: bool) -> str:
        """Open a document, or a file of another tool, given as text; answers as `open_file` does."""
        await self._open(lambda: content.read(text, title), None, title, discard)
        return "" if opening.tool_for(text.encode()) is None else self._reported()

    async def recover(self, name: str, discard: bool) -> None:
        """Go on with unsaved edits that were kept."""
        self._ask_unsaved(discard)
        doc, file = await aside(lambda: self.keeper.read(name), name)
        path = Path(file) if file else None
        if path is not None and not self.workspace.holds(path):
            path = None
        await self._open(lambda: doc, path, doc.name, True)
        if self.model is not None:
            self._saved = None
            self._name, self._kept = name, self.model.document
            self._moved()

    async def close(self, discard: bool) -> None:
        """No document any more."""
        self._ask_unsaved(discard)
        await self._leave()
        self._moved()

    async def _open(self, read: Callable[[], Document], file: Path | None, title: str, discard: bool) -> None:
        self._ask_unsaved(discard)
        try:
            doc = await aside(read, title)
            if found := problems(doc):
                raise DocumentError(found)
        except DeodarError as error:
            await self._leave()
            self.trouble = (title, error.problems)
            self._moved()
            return
        await self._leave()
        self.model = Model(document=doc, trusted=self._trust)
        self.file, self._saved, self._digest = file, view.plain(doc), await self._hash(file)
        self._name, self._kept = self.keeper.new_name(), doc
        if file is not None:
            await attempt(lambda: self.keeper.opened(file))
        self.busy = "compiling"  # before a page is told of the document, so that none takes it for ready
        self._moved()
        self.turns.beside(self._start())

    async def _leave(self) -> None:
        if self._name:
            await attempt(lambda: self.keeper.forget(self._name))
        self.turns.session += 1
        self._attempt += 1
        self.model, self.file, self._saved, self._name, self._gesture = None, None, None, "", None
        self.trouble, self.failure, self.busy = ("", ()), (), ""
        await asyncio.wrap_future(self.engine.call(lambda: self.engine.load(None)))

    async def _start(self) -> None:
        """Compile the document and give it to the engine, unless a later attempt began meanwhile."""
        model = self._require()
        self._attempt += 1
        attempt = self._attempt
        self.busy, self.failure = "compiling", ()
        self._changed()
        doc = model.document

        def make() -> Session:
            session = Session(model, world=self.embodiment.world(doc))
            session.program.chunk(())
            return session

        try:
            session = await asyncio.to_thread(make)
        except DeodarError as error:
            self._fail(attempt, error.problems)
        except Exception as error:  # code from outside that runs while it is compiled
            self._fail(attempt, [Wrong("", f"{type(error).__name__}: {error}")])
        else:
            await self.turns.take(lambda: self._take(attempt, session, doc))

    async def _take(self, attempt: int, session: Session, doc: Document) -> None:
        """Let the engine run what was compiled, with the edits that were made since."""
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
        self.busy = ""  # only now: who sees it may ask for what needs a session
        self._changed()

    def _fail(self, attempt: int, problems: Sequence[Wrong]) -> None:
        if attempt == self._attempt:
            self.busy, self.failure = "", problems
            self._changed()

    def _ask_unsaved(self, discard: bool) -> None:
        if self.unsaved and not discard:
            raise Asks("unsaved")

    # ------------------------------------------------------------------------------------------------- saving

    async def save(self, path: str, replace: bool) -> Path:
        """Write the document; asks before it writes over what is not its own, or what changed since it was
        read.
        """
        model = self._require()
        place = self.workspace.target(path) if path else self.file
        if place is None:
            raise DocumentError("has no file yet", where=model.name, fix="Save it under a name")
        own = self.file is not None and place == self.file
        now = await self._hash(place)
        if not replace and now and not (own and now == self._digest):
            raise Asks("replace")
        doc = model.document
        await aside(lambda: self.workspace.save(doc, place), path or str(place))
        self.file, self._saved, self._digest, self._kept = (
            place,
            view.plain(doc),
            await self._hash(place),
            doc,
        )
        await attempt(lambda: self.keeper.forget(self._name))
        await attempt(lambda: self.keeper.opened(place))
        self._moved()
        return place

    async def _hash(self, place: Path | None) -> str:
        return "" if place is None else await aside(lambda: self.workspace.digest(place), str(place))

    async def keep(self) -> None:
        """Keep unsaved edits, if there are new ones."""
        if self.model is not None and self.unsaved and self._kept is not self.model.document:
            doc, name, file = self.model.document, self._name, "" if self.file is None else str(self.file)
            await attempt(lambda: self.keeper.keep(name, doc, file))
            self._kept = doc

    # ------------------------------------------------------------------------------------------------ editing

    async def set(self, element: str, parameter: str, value: Any, gesture: object) -> Cost:
        """Change a parameter of an element, or (empty element) of the document."""
        model = self._require()
        doc = model.document
        if not element:
            if parameter not in [k.name for k in doc.knobs]:
                raise DocumentError("there is no such document parameter", where=parameter)
            new = edit.knob(doc, parameter, value)
            return await self._commit(new, gesture)
        entry = find.entry(doc, element)
        new = edit.put(doc, element, parameter, view.read_value(doc, entry, parameter, value))
        shown = view.shown_value(new, element, parameter)
        return await self._commit(new, gesture, (element, parameter, shown))

    async def change(self, how: Callable[[Document], Document]) -> Cost:
        """Any other change, as one step of undo."""
        return await self._commit(how(self._require().document), None)

    async def describe(self, values: dict[str, Any]) -> None:
        """Change general properties."""
        await self.change(lambda doc: edit.describe(doc, **values))

    def require_run(self) -> None:
        """Refuse to run what does not run and is not being made."""
        if self.engine.session is None and not self.busy:
            raise DocumentError(self.failure or [Wrong("", "no document is open")])

    async def embody(self, world: World) -> None:
        """Let the sensors read another world; where there is none to read, it waits for a document that
        senses.
        """
        model, session = self._require(), self.engine.session
        self.embodiment.world(model.document)
        if session is None:
            self.turns.beside(self._restart())
        elif session.program.plan.sensors:
            await asyncio.wrap_future(self.engine.call(lambda: self.engine.see(world)))
        self._changed()

    def touch(self) -> None:
        """Something beside the document changed that pages show."""
        self._moved()

    async def arrange(self, layout: dict[str, Any], undoable: bool) -> None:
        """Change parts of the layout."""
        model = self._require()
        merged = {k: v for k, v in {**model.document.layout, **layout}.items() if v is not None}
        new = edit.arrange(model.document, merged)
        if undoable:
            model.history.commit(new)
        else:
            model.history.amend(new)
        self._gesture = None
        self._moved()

    async def undo(self) -> None:
        """Take the last change back."""
        await self._travel(lambda h: h.undo(), lambda h: h.redo())

    async def redo(self) -> None:
        """Make the change again that was taken back."""
        await self._travel(lambda h: h.redo(), lambda h: h.undo())

    async def _travel(
        self, there: Callable[[edit.UndoHistory], bool], back: Callable[[edit.UndoHistory], bool]
    ) -> None:
        history = self._require().history
        if not there(history):
            return
        doc = history.document
        back(history)  # nobody sees the other document before the engine takes it
        await self._adopt(doc)
        there(history)
        self._gesture = None
        self._moved()

    async def _commit(self, doc: Document, gesture: object, leaf: tuple[str, str, Any] | None = None) -> Cost:
        model = self._require()
        if doc == model.document:
            return "live"
        cost = await self._adopt(doc)
        if gesture is not None and gesture == self._gesture:
            model.history.amend(doc)
        else:
            model.history.commit(doc)
        self._gesture = gesture
        if leaf is None or cost == "recompile":
            self._moved()
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
        """Let the engine go on with a document.

        One with problems is edited on, while what runs stays as it was.
        """
        model = self._require()
        session = self.engine.session
        if session is None:
            if not self.busy:
                self.busy = "compiling"
                self.turns.beside(self._restart())
            return "recompile"
        if session.cost(doc) == "recompile" and problems(doc):
            return "recompile"
        cost: Any = await asyncio.wrap_future(self.engine.call(lambda: self.engine.adopt(model, doc)))
        return cost

    async def _restart(self) -> None:
        """Try again to compile what did not, now that it was edited."""
        session = self.session
        async with self.turns.lock:  # the edit enters the history first
            if session != self.session or self.model is None:
                return
            if problems(self.model.document):
                self.busy = ""
                self._changed()
                return
        await self._start()

    def _reported(self) -> str:
        """What became of the file that was just imported: the first line of the notes, where its report
        begins.
        """
        return "" if self.model is None else self.model.document.notes.partition("\n")[0]

    def _require(self) -> Model:
        if self.model is None:
            raise DocumentError("no document is open")
        return self.model

    def _moved(self) -> None:
        """Every page needs the whole document again."""
        self.version += 1
        self.checker.found = None
        self._recent.clear()
        self._changed()
