"""The state that all pages share: the project, the engine, and the notification of pages."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Awaitable, Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from deodar import __version__
from deodar.errors import DocumentError, UnknownName, WorldError
from deodar.model.model import Model
from deodar.session.meter import Meter
from deodar.session.session import Session
from deodar.worlds._base import World
from deodar_studio.catalogue import gallery, plots, templates
from deodar_studio.experiment.open_experiment import OpenExperiment
from deodar_studio.experiment.run_place import MOST_WORKERS, USUAL_WORKERS
from deodar_studio.field_analysis.field_tuning import FieldTuning
from deodar_studio.field_analysis.regime_measurement import RegimeMeasurement
from deodar_studio.files.file_thread import try_in_file_thread
from deodar_studio.files.state_store import StateStore, state_folder
from deodar_studio.files.workspace import Workspace
from deodar_studio.live.compilation import CompileTimes
from deodar_studio.live.engine import Engine
from deodar_studio.live.published import CostReport
from deodar_studio.messages.message import made_of
from deodar_studio.messages.to_page import (
    CompilingView,
    Costs,
    CostView,
    Gallery,
    RecordingView,
    Regime,
    RunClock,
    TimelineView,
    Tuning,
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


FOLLOW_SECONDS = 0.5
"""Wall time between two checks whether a record grew, in seconds."""


class Hub:
    """The project, the engine and the connected pages.

    Everything but the engine runs in the thread of the event loop.

    Args:
        root: the folder below which files are read and written.
        trust: whether functions that documents name may be run.
        world: the world that sensors read; None: examples of worlds are used.
        private: whether only the user who started the studio can use it (see `Service.private`).
    """

    def __init__(self, root: Path, trust: bool, world: World | None, private: bool = False) -> None:
        self._loop = asyncio.get_running_loop()
        self._wake_scheduled = False
        self._gallery = Gallery(recent=[], recoveries=[])
        self._sent_costs: tuple[CostReport, Costs] | None = None
        self.pages: set[Page] = set()
        self._connected = 0
        self.workspace = Workspace(root)
        self.store = StateStore(state_folder())
        self.embodiment = Embodiment(world)
        self.engine = Engine(self._from_engine)
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

    def _from_engine(self) -> None:
        """Call `notify` from the engine's thread; further calls before it has run are merged."""
        if not self._wake_scheduled:
            self._wake_scheduled = True
            with contextlib.suppress(RuntimeError):  # the loop is closed, and no page is left
                self._loop.call_soon_threadsafe(self.notify)

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
            page.frames = RecordFrames(record, self.project.record.scene[0], self._from(page))
        return page.frames

    def other_source(self, page: Page) -> RecordFrames | None:
        """Return the record that the open one is compared with; None: there is none."""
        comparison, frames = self.project.record.comparison, page.frames
        if comparison is None or frames is None:
            page.others = None
        elif page.others is None or page.others.record is not comparison.other:
            page.others = RecordFrames(comparison.other, None, self._from(page))
            page.others.choose(frames.copy)
        return page.others

    async def in_engine(self, function: Callable[[], object]) -> None:
        """Run a function in the engine's thread, and wait for its end."""
        await asyncio.wrap_future(self.engine.call(function))

    def from_thread(self) -> None:
        """Wake all pages, from any thread."""
        with contextlib.suppress(RuntimeError):  # the loop is closed, and no page is left
            self._loop.call_soon_threadsafe(self.notify)

    def _from(self, page: Page) -> Callable[[], None]:
        """Return a function that wakes a page from any thread."""

        def wake() -> None:
            with contextlib.suppress(RuntimeError):  # the loop is closed, and no page is left
                self._loop.call_soon_threadsafe(page.wake)

        return wake

    def costs(self) -> Costs:
        """Return the cost of the elements as last measured."""
        report = self.engine.cost_report
        if self._sent_costs is None or self._sent_costs[0] is not report:
            found = report.costs
            listed = () if found is None else found.elements
            elements = [made_of(CostView, c, element=c.id) for c in listed]
            problems = view.problems(report.problems, None)
            step = 0.0 if found is None else found.step
            self._sent_costs = (
                report,
                Costs(measuring=report.measuring, step=step, elements=elements, problems=problems),
            )
        return self._sent_costs[1]

    def measure_regime(self, element: str) -> None:
        """Measure the regime of a field or node of the open document.

        Raises:
            DocumentError: no document is open, or it has no such element.
            WorkerError: a part of the model cannot be sent to another process.
        """
        self.measurement.start(self.project.session, self._copied(element), element)

    def tune_field(self, element: str, parameters: Sequence[str], requirements: Sequence[Any]) -> None:
        """Tune a field of the open document.

        Raises:
            DocumentError: no document is open, or it has no such element.
            WorkerError: a part of the model cannot be sent to another process.
        """
        model = self._copied(element)
        self.field_tuning.start(self.project.session, model, element, parameters, requirements)

    def _copied(self, element: str) -> Model:
        """Return the model of the open document, which has this element."""
        doc = self.project.history.document()
        if element not in doc.by_id():
            raise DocumentError("the document has no such element", where=element)
        return Model(document=doc, trusted=self.project.trust)

    def analyses(self) -> list[Regime | Tuning]:
        """Return the regime and the tuning as last computed; empty ones if another document was opened
        since.
        """
        model, session = self.project.history.model, self.project.session
        for one in (self.measurement, self.field_tuning):
            if one.message.element and (model is None or one.session != session):
                one.stop()
        doc = None if model is None else model.document
        return [self.measurement.shown(doc), self.field_tuning.shown(doc)]

    # ----------------------------------------------------------------------------------------------- watching

    def new_page(self) -> Page:
        """Make a page with a new number; its connection adds it to `pages` when the socket is open."""
        self._connected += 1
        return Page(self._connected)

    def watch(self) -> None:
        """Make the engine publish the ports and time courses that all pages watch."""
        streams = [s for p in self.pages for s in p.streams.values()]
        places = {s.place for s in streams if s.request is None and s.place is not None}
        requests = list(dict.fromkeys(s.request for s in streams if s.request is not None))
        self.engine.call(lambda: self.engine.show(places, requests))

    def leave(self, page: Page) -> None:
        """Remove a page that disconnected; the run continues, and what the page injects and pushes ends."""
        self.pages.discard(page)
        if self.engine.injection is not None and page.pushes:
            self.engine.call(lambda: self.engine.inject(None))
        if page.pushed:
            self.engine.call(lambda: self.engine.rearrange(lambda session: _let_go(session, page.pushed)))
        self.watch()

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
        """Store unsaved edits and stop the engine."""
        self._storing.cancel()
        self._following.cancel()
        self.project.run.end()
        await self.project.store_edits()
        await self.experiment.store_edits()
        await asyncio.to_thread(self.experiment.end)
        await asyncio.to_thread(self.measurement.end)
        await asyncio.to_thread(self.field_tuning.end)
        await asyncio.to_thread(self.engine.close)
        self.embodiment.close()


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
