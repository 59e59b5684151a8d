"""The run of the open document: its compilation, and the engine that takes its steps."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from deodar.declarations import Cost
from deodar.errors import DeodarError, DocumentError, Problem, problems_of
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.progress import Progress
from deodar.recording.provenance import described
from deodar.recording.replay import RecordReader
from deodar.resources import Resources
from deodar.session.exchange import used
from deodar.session.session import Session
from deodar.session.session_at import session_at
from deodar.session.session_snapshot import SessionSnapshot
from deodar.worlds._base import World
from deodar_studio.live.compilation import Compilation, CompileTimes
from deodar_studio.live.engine import Engine
from deodar_studio.messages.to_page import ListedProblem
from deodar_studio.project.change_queue import ChangeQueue
from deodar_studio.project.conversions import Conversions
from deodar_studio.views import view
from deodar_studio.world import embodiment
from deodar_studio.world.embodiment import Embodiment, signals

T = TypeVar("T")


class DocumentRun:
    """Compiles the open document, and makes the engine continue with its changes.

    Args:
        engine: runs the session.
        embodiment: the world of the document.
        conversions: finds the problems for which a document cannot run.
        queue: runs one change after the other.
        times: called with the times of all compilations after each one, in another thread.
        changed: called when pages may have something new to show.

    Attributes:
        model: the document that runs, with its history; None: no document is open, or a record.
        failure: why the document does not run.
        busy: a phrase for the compilation in progress; empty: none.
        compilation: the compilation in progress, or the last one.
    """

    def __init__(
        self,
        engine: Engine,
        embodiment: Embodiment,
        conversions: Conversions,
        queue: ChangeQueue,
        times: Callable[[CompileTimes], None],
        changed: Callable[[], None],
    ) -> None:
        self._engine, self._embodiment, self._conversions = engine, embodiment, conversions
        self._queue, self._times, self._changed = queue, times, changed
        self.model: Model | None = None
        self.failure: Sequence[Problem] = ()
        self.busy = ""
        self.compilation: Compilation | None = None
        self._attempt = 0

    # ------------------------------------------------------------------------------------------------ looking

    @property
    def senses(self) -> bool:
        """Whether the document has sensors or motors and can run."""
        return self.model is not None and bool(signals(self.model.document))

    def failures(self) -> list[ListedProblem]:
        """Return why the document does not run; an empty list if it does."""
        doc = None if self.model is None else self.model.document
        problems, paths = self._engine.failure
        return [
            *view.problems(self.failure, doc, buttons=False),
            *view.problems(problems, doc, paths, buttons=False),
        ]

    def require(self) -> None:
        """Raise DocumentError if no session runs and none is being compiled."""
        doc = self._require().document
        if self._engine.session is None and not self.busy:
            raise DocumentError(
                self.failure or self._conversions.problems(doc) or [Problem("", "the model does not run yet")]
            )

    def _require(self) -> Model:
        if self.model is None:
            raise DocumentError("no document is open")
        return self.model

    # ---------------------------------------------------------------------------------- starting and stopping

    def open(self, model: Model) -> None:
        """Compile and run a document; one with problems is edited, and runs once it has none."""
        self.model = model
        if not self._conversions.problems(model.document):
            self.busy = "compiling"  # set before pages receive the document, so that none considers it ready
            self._queue.start_task(self._start())

    async def close(self) -> None:
        """End the run."""
        self.end()
        self.model, self.failure, self.busy = None, (), ""
        await self._call(lambda: self._engine.load(None))

    def end(self) -> None:
        """Take over nothing that is being compiled or repeated."""
        self._attempt += 1

    async def _start(self) -> None:
        """Compile the document and load it into the engine, unless a later attempt has started meanwhile."""
        model = self._require()
        self._attempt += 1
        attempt = self._attempt
        self.busy, self.failure = "compiling", ()
        self._changed()
        doc = model.document
        times = self._engine.compile_times
        compilation = self.compilation = times.start(doc)

        def make() -> Session:
            session = Session(model, world=self._embodiment.world(doc))
            compilation.phase = "compiling"
            session.program.chunk(())
            if session.program.compiled:
                times.took(doc, compilation.elapsed)
                self._times(times)
            return session

        try:
            session = await asyncio.to_thread(make)
        except Exception as error:  # functions that the document names run during compilation
            self._fail(attempt, problems_of(error))
        else:
            await self._queue.run(lambda: self._take(attempt, session, doc))

    async def _take(self, attempt: int, session: Session, doc: Document) -> None:
        """Load the compiled session into the engine, with the edits that were made since."""
        if attempt != self._attempt:
            return
        await self._call(lambda: self._engine.load(session, leave=True))
        try:
            if self._require().document is not doc:
                await self.adopt(self._require().document)
        except DeodarError as error:
            await self._call(lambda: self._engine.load(None))
            self._fail(attempt, error.problems)
            return
        self.busy = ""  # last, because a page that sees it may send requests that need a session
        self._changed()

    def _fail(self, attempt: int, problems: Sequence[Problem]) -> None:
        if attempt == self._attempt:
            self.busy, self.failure = "", problems
            self._changed()

    async def _restart(self) -> None:
        """Compile a document again that failed before, after an edit."""
        opened = self._queue.session
        async with self._queue.lock:  # waits until the edit is in the history
            if opened != self._queue.session or self.model is None:
                return
            if self._conversions.problems(self.model.document):
                self.busy = ""
                self._changed()
                return
        await self._start()

    # ------------------------------------------------------------------------------------------------ changes

    async def adopt(self, doc: Document) -> Cost:
        """Make the engine continue with a new version of the document, and return the cost.

        If it has problems, the engine continues with the old one, while editing continues.
        """
        model = self._require()
        session = self._engine.session
        if session is None:
            if not self.busy:
                self.busy = "compiling"
                self._queue.start_task(self._restart())
            return "recompile"
        if session.cost(doc) == "recompile" and self._conversions.problems(doc):
            return "recompile"
        if not await self._enter_world(session, doc):
            self.busy = "compiling"
            await self._call(lambda: self._engine.load(None))
            self._queue.start_task(self._restart())
            return "recompile"
        cost: Any = await self._call(lambda: self._engine.adopt(model, doc))
        return cost

    async def _enter_world(self, session: Session, doc: Document) -> bool:
        """Make the session use a world that a document can run in.

        Return False if its present document cannot run there, so that the session must start again.
        """
        world = self._embodiment.world(doc, session.world)
        if world is None or world is session.world:
            return True
        if embodiment.problems(session.document, world):
            return False
        await self._call(lambda: self._engine.see(world))
        return True

    async def embody(self, world: World, kind: str, name: str) -> None:
        """Use another world, at once or, if the document has no sensors, as soon as a document has some.

        Raises:
            WorldError: the world lacks a sensor or motor of the document, or gives it over other axes or in
                another unit, so that a document that runs would not run; the world in use stays.
        """
        session, doc = self._engine.session, self._require().document
        unfinished = bool(self._conversions.problems(doc))
        if not unfinished and not embodiment.missing(world, doc):
            used(doc, world)
        self._embodiment.require(world, kind, name, doc)
        if session is not None and not (unfinished and embodiment.problems(session.document, world)):
            await self._call(lambda: self._engine.see(world))
        self._embodiment.choose(world, kind, name, doc)
        self._conversions.clear()  # its problems may be those with another world
        if session is None:
            self._queue.start_task(self._restart())
        elif unfinished:
            await self.adopt(doc)

    # --------------------------------------------------------------------------------------- moments of a run

    async def play(self) -> None:
        """Let the clock advance the session."""
        await self._call(lambda: self._engine.play(True))

    async def return_to_time(self, time: float) -> Document:
        """Return to a moment of the last minute; return the document of that moment.

        Raises:
            RecordError: the moment cannot be computed again.
        """
        await self._call(lambda: self._engine.branch(time))
        return self._running()

    async def return_to_snapshot(self, snapshot: SessionSnapshot) -> Document:
        """Return to a snapshot; return its document.

        Raises:
            ParameterError: it is of another model.
        """
        await self._call(lambda: self._engine.restore(snapshot))
        return self._running()

    def _running(self) -> Document:
        session = self._engine.session
        assert session is not None
        return session.document

    async def snapshot(self) -> SessionSnapshot:
        """Return the present state."""
        return await self._call(self._engine.snapshot)

    async def repeat(self, record: RecordReader, time: float, trust: bool) -> tuple[Session, int]:
        """Return a session that continues a record from a moment, and the number of the attempt.

        Raises:
            DocumentError: another document was opened during the repetition.
            RecordError: the record cannot be repeated up to this moment, or its repetition differs.
        """
        self._attempt += 1
        attempt = self._attempt

        def progress(done: Progress) -> None:
            self.require_attempt(attempt)
            self.busy = f"repeating the record, {done.share:.0%}"

        def repeat() -> Session:
            progress(Progress(0, 1))
            moment = float(record.times[record.index(time)])
            session = session_at(record.path, moment, trust=trust, on=Resources(progress=progress))
            progress(Progress(1, 1))
            return session

        try:
            return await asyncio.to_thread(repeat), attempt
        finally:
            if attempt == self._attempt:
                self.busy = ""
                self._changed()

    def require_attempt(self, attempt: int) -> None:
        """Raise DocumentError if another document was opened, or another repetition began, since."""
        if attempt != self._attempt:
            raise DocumentError("another request ended the repetition of the record")

    async def continue_with(self, model: Model, session: Session) -> None:
        """Run a session that continues a record, in the world of this session."""
        self.model, doc, world = model, session.document, session.world
        if world is not None:
            kind = type(world).__name__
            self._embodiment.choose(world, kind, str((described(world) or {}).get("file", "")), doc)
        await self._call(lambda: self._engine.load(session))
        await self.play()

    async def resume(self, model: Model, session: Session) -> None:
        """Take up a run that was left, paused at its moment, with the edits that were not compiled yet."""
        self.model = model
        await self._call(lambda: self._engine.load(session))
        if model.document is not session.document:
            await self.adopt(model.document)

    async def _call(self, function: Callable[[], T]) -> T:
        """Run a function in the thread of the engine."""
        return await asyncio.wrap_future(self._engine.call(function))
