"""The state that all pages share: the project, the engine, and the notification of pages."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import sys
from collections.abc import Awaitable, Callable, Iterable, Iterator
from pathlib import Path

from deodar import __version__
from deodar.errors import UnknownName, WorldError
from deodar.session.meter import Meter
from deodar.session.session import Session
from deodar.worlds._base import World
from deodar_studio.catalogue import gallery, plots, templates
from deodar_studio.experiment.open_experiment import OpenExperiment
from deodar_studio.experiment.run_place import MOST_WORKERS, USUAL_WORKERS
from deodar_studio.field_analysis.field_tuning import FieldTuning
from deodar_studio.field_analysis.regime_measurement import RegimeMeasurement
from deodar_studio.files.content import is_experiment
from deodar_studio.files.file_thread import in_file_thread, started, try_in_file_thread
from deodar_studio.files.state_store import StateStore, state_folder
from deodar_studio.files.workspace import Workspace
from deodar_studio.live.compilation import CompileTimes
from deodar_studio.live.engine import Engine
from deodar_studio.live.unwaited import UnwaitedThreads
from deodar_studio.messages.message import Message, made_of
from deodar_studio.messages.to_page import (
    CompilingView,
    Gallery,
    RecordingView,
    RunClock,
    TimelineView,
    Welcome,
)
from deodar_studio.pages.page import Page
from deodar_studio.project.open_project import OpenProject
from deodar_studio.streams.record_frames import RecordFrames
from deodar_studio.streams.source import FrameSource, RunFrames
from deodar_studio.views import view
from deodar_studio.world.embodiment import Embodiment, signals

STORE_SECONDS = 3.0
"""Wall time between two checks for unsaved edits to store, in seconds."""


CLOSING_SECONDS = 10.0
"""Longest wall time for which the end waits for each of its parts, in seconds; a disk or a robot may not
answer.
"""

FOLLOW_SECONDS = 0.5
"""Wall time between two checks whether a record grew, in seconds."""

ABSENT_SECONDS = 5.0
"""Wall time after which a run that moves a robot pauses when the last page has gone, in seconds; a page that
is loaded again is back earlier.
"""


class Hub:
    """The project, the engine and the connected pages.

    Everything but the engine runs in the thread of the event loop.

    Args:
        root: the folder below which files are read and written.
        trust: whether functions that documents name may be run.
        world: the world that sensors read; None: examples of worlds are used.
        private: whether only the user who started the studio can use it (see `Service.private`).
        unattended: whether a run that moves a robot continues while no page is open.
    """

    def __init__(
        self,
        root: Path,
        trust: bool,
        world: World | None,
        private: bool = False,
        unattended: bool = False,
    ) -> None:
        self._loop = asyncio.get_running_loop()
        self._threads = UnwaitedThreads()
        self._loop.set_default_executor(self._threads)
        self._wake_scheduled = False
        self._gallery = Gallery(recent=[], recoveries=[])
        self.pages: set[Page] = set()
        self._connected = 0
        self._unattended = unattended
        self._absence: asyncio.TimerHandle | None = None
        self.workspace = Workspace(root)
        self.store = StateStore(state_folder())
        self.embodiment = Embodiment(world)
        self.engine = Engine(self.from_thread)
        self.engine.compile_times = CompileTimes(self.store.compile_times())
        self.project = OpenProject(
            self.workspace, self.store, self.engine, self.embodiment, trust, self.notify
        )
        self.experiment = OpenExperiment(self.project, self.workspace, self.store, self.from_thread, private)
        self.measurement = RegimeMeasurement(self.from_thread)
        self.field_tuning = FieldTuning(self.from_thread)
        self.welcome = Welcome(
            version=__version__,
            root=str(self.workspace.root),
            usual_workers=USUAL_WORKERS,
            most_workers=MOST_WORKERS,
            clusters=private,
            kinds=view.kinds(),
            experiment=view.experiment_forms(),
            examples=gallery.examples(),
            templates=templates.listed(),
            plots=plots.views(),
        )
        self._storing = asyncio.create_task(_repeat(self._store, STORE_SECONDS))
        self._following = asyncio.create_task(_repeat(self._follow, FOLLOW_SECONDS))

    # ---------------------------------------------------------------------------------------------- notifying

    def notify(self) -> None:
        """Wake all pages, which check for news."""
        self._wake_scheduled = False
        for page in self.pages:
            page.wake()

    def from_thread(self) -> None:
        """Call `notify` from any thread; further calls before it has run are merged."""
        if not self._wake_scheduled:
            self._wake_scheduled = True
            with contextlib.suppress(RuntimeError):  # the loop is closed, and no page is left
                self._loop.call_soon_threadsafe(self.notify)

    async def open(self, place: Path, discard: bool, discard_experiment: bool) -> str:
        """Open a document, a record or an experiment; return a sentence on the import of another tool's file.

        Raises:
            ConfirmationRequired: without `discard`, if the document has unsaved edits, or, without
                `discard_experiment`, the open experiment.
        """
        if not await in_file_thread(lambda: is_experiment(self.workspace, place), str(place)):
            return await self.project.open_file(place, discard)
        await self.experiment.open(place, discard, discard_experiment)
        await self.experiment.check()
        return ""

    async def gallery(self) -> Gallery:
        """Return recent files and unsaved edits; the last result if the state folder does not answer."""
        own = self.project.edits, self.experiment.edits

        def read() -> None:
            recent = [self.workspace.shown(p) for p in self.store.recent() if self.workspace.holds(p)]
            kept = [r for r in self.store.stored_edits() if r.name not in own]
            self._gallery = Gallery(recent=recent, recoveries=kept)

        await try_in_file_thread(read)
        return self._gallery

    def clock(self, timeline: TimelineView | None) -> RunClock:
        """Return the time and status of the run, and the timeline of a page."""
        engine, published, session = self.engine, self.engine.published, self.engine.session
        injection, meter = engine.injection, Meter() if session is None else engine.pace.meter(session)
        return made_of(
            RunClock,
            meter,
            frame=0,
            running=engine.running,
            time=published.time,
            tick=published.tick,
            dt=self._dt(session),
            seed=0 if session is None else session.seed,
            speed=engine.pace.speed,
            factor=engine.pace.factor if engine.running else 0.0,
            steps=engine.pace.steps if engine.running else 0.0,
            longest=engine.pace.longest,
            busy=self.project.run.busy or engine.busy,
            compiling=self._compiling(),
            failure=self.project.run.failures(),
            world=self._world(session),
            senses=self.project.run.senses,
            pushing="" if injection is None else injection.element,
            timeline=timeline,
            recording=self._recording(session),
        )

    def _world(self, session: Session | None) -> str:
        """Return a phrase for the world that the running document uses."""
        used = session is not None and signals(session.document)
        return self.embodiment.label(session.world) if session is not None and used else ""

    def _dt(self, session: Session | None) -> float:
        """Return the present step; of a document that is not compiled, the one that it will run with."""
        model = self.project.history.model
        return session.dt if session is not None else 1.0 if model is None else model.document.step

    def _compiling(self) -> CompilingView | None:
        project, engine = self.project, self.engine
        found = project.run.compilation if project.run.busy else engine.compilation if engine.busy else None
        if found is None:
            return None
        return CompilingView(phase=found.phase, elapsed=round(found.elapsed, 1), expected=found.expected)

    def _recording(self, session: Session | None) -> RecordingView | None:
        recorder = None if session is None else session.recorder
        if recorder is None:
            return None
        return RecordingView(path=self.workspace.shown(recorder.path), ended=recorder.ended)

    def source(self, page: Page) -> FrameSource:
        """Return what a page watches: the run, or the open record."""
        record = self.project.record.reader
        if record is None:
            page.frames = None
            return RunFrames(self.engine)
        if page.frames is None or page.frames.record is not record:
            page.frames = RecordFrames(record, self.project.record.scene[0], self.from_thread)
        return page.frames

    def other_source(self, page: Page) -> RecordFrames | None:
        """Return the record that the open one is compared with; None: there is none."""
        comparison, frames = self.project.record.comparison, page.frames
        if comparison is None or frames is None:
            page.others = None
        elif page.others is None or page.others.record is not comparison.other:
            page.others = RecordFrames(comparison.other, None, self.from_thread)
            page.others.choose(frames.copy)
        return page.others

    async def in_engine(self, function: Callable[[], object]) -> None:
        """Run a function in the engine's thread, and wait for its end."""
        await asyncio.wrap_future(self.engine.call(function))

    def topics(self) -> Iterator[Message | None]:
        """Yield what every page knows besides the document, each as a message; None: nothing to say."""
        project = self.project
        model = project.history.model
        doc = None if model is None else model.document
        yield project.file.problems()
        yield project.history.checker.found
        yield project.history.report()
        yield view.costs(self.engine.cost_report)
        for analysis in (self.measurement, self.field_tuning):
            if analysis.message.element and (doc is None or analysis.session != project.session):
                analysis.stop()
            yield analysis.shown(doc)
        yield project.record.compared()
        yield project.file.saved_files
        yield self.experiment.view()

    # ----------------------------------------------------------------------------------------------- watching

    def new_page(self) -> Page:
        """Make a page with a new number; its connection lets it enter when the socket is open."""
        self._connected += 1
        return Page(self._connected)

    def enter(self, page: Page) -> None:
        """Add a page whose socket is open."""
        self.pages.add(page)
        if self._absence is not None:
            self._absence.cancel()
            self._absence = None
        self.engine.attended = True

    def watch(self) -> None:
        """Make the engine publish the ports and time courses that all pages watch."""
        streams = [s for p in self.pages for s in p.streams.values()]
        places = {s.place for s in streams if s.request is None and s.place is not None}
        requests = list(dict.fromkeys(s.request for s in streams if s.request is not None))
        self.engine.call(lambda: self.engine.show(places, requests))

    def leave(self, page: Page) -> None:
        """Remove a page that disconnected, and end what it injects and pushes.

        The run continues; one that moves a robot pauses when no page comes within `ABSENT_SECONDS`.
        """
        self.pages.discard(page)
        if self.engine.injection is not None and page.pushes:
            self.engine.call(lambda: self.engine.inject(None))
        if page.pushed:
            self.engine.call(lambda: self.engine.rearrange(lambda session: _let_go(session, page.pushed)))
        self.watch()
        if not self.pages and not self._unattended:
            self._absence = self._loop.call_later(ABSENT_SECONDS, self._miss)

    def _miss(self) -> None:
        """Let a run that moves a robot pause: no page is there by which anybody could stop it."""
        self.engine.attended = False

    # ------------------------------------------------------------------------------------------------- ending

    async def _store(self) -> None:
        """Store unsaved edits."""

        async def store() -> None:
            await self.project.store_edits()
            await self.experiment.store_edits()

        await self.project.queue.run(store)  # `forget` cannot run while edits are written

    async def _follow(self) -> None:
        """Show what is added to a record or to followed rows, and check the open experiment."""
        if await self.project.record.refresh():
            self.notify()
        await self.experiment.check()
        await self.experiment.follow()

    async def close(self) -> None:
        """Put motors to rest, store unsaved edits and end the rest; a part that fails stops no other."""
        self._storing.cancel()
        self._following.cancel()
        if self._absence is not None:
            self._absence.cancel()
        self.engine.call(lambda: self.engine.play(False))
        self.project.run.end()
        await _attempt(self.project.store_edits())
        await _attempt(self.experiment.store_edits())
        # compilations may hold all threads of the pool
        for end in (
            self.experiment.end,
            self.measurement.end,
            self.field_tuning.end,
            self.engine.close,
            self.embodiment.close,
        ):
            await _attempt(asyncio.wrap_future(started(end)))

    def working(self) -> bool:
        """Return whether a thread still works after the event loop has ended, such as one that compiles."""
        return self._threads.working(0.1) or self.engine.working()


async def _attempt(work: Awaitable[None]) -> None:
    """Await a part of the end for a time; an error is written to the terminal."""
    try:
        async with asyncio.timeout(CLOSING_SECONDS):
            await work
    except TimeoutError:
        sys.stderr.write(f"deodar studio: a part of the end takes longer than {CLOSING_SECONDS:g} s\n")
    except Exception as error:  # the rest ends all the same
        sys.stderr.write(f"deodar studio: {error}\n")


async def _repeat(work: Callable[[], Awaitable[None]], seconds: float) -> None:
    """Call a function again and again; an error is written to the terminal once, until another one occurs."""
    reported = ""
    while True:
        await asyncio.sleep(seconds)
        try:
            await work()
        except Exception as error:
            if repr(error) != reported:
                logging.getLogger("deodar.studio").exception("%s failed", work.__name__)
            reported = repr(error)


def _let_go(session: Session, bodies: Iterable[str]) -> None:
    """End the pushes of bodies that the world still has."""
    for body in bodies:
        with contextlib.suppress(WorldError, UnknownName):
            session.push_body(body, (0.0, 0.0, 0.0))
