"""What all pages share: the project, the engine, and who is to be told when something happened."""

from __future__ import annotations

import asyncio
import contextlib
from pathlib import Path

from deodar import __version__
from deodar.live.bill import Bill
from deodar.live.engine import Engine
from deodar.server import gallery, view
from deodar.server.aside import attempt
from deodar.server.embodiment import Embodiment
from deodar.server.keeper import Keeper, state_folder
from deodar.server.page import Page
from deodar.server.project import OpenProject
from deodar.server.to_page import Costs, CostView, Gallery, RunClock, Welcome
from deodar.server.workspace import Workspace
from deodar.session.meter import Meter
from deodar.worlds._base import World

KEEP_SECONDS = 3.0
"""Wall time between two looks for unsaved edits to keep."""


class Hub:
    """Made in the event loop's thread, where everything but the engine lives."""

    def __init__(self, root: Path, trust: bool, world: World | None) -> None:
        self._loop = asyncio.get_running_loop()
        self._told = False
        self._gallery = Gallery(recent=[], recoveries=[])
        self._told_costs: tuple[Bill, Costs] | None = None
        self.pages: set[Page] = set()
        self._connected = 0
        self.workspace = Workspace(root)
        self.keeper = Keeper(state_folder())
        self.embodiment = Embodiment(world)
        self.engine = Engine(self._from_engine)
        self.project = OpenProject(
            self.workspace, self.keeper, self.engine, self.embodiment, trust, self.tell
        )
        self.welcome = Welcome(
            version=__version__,
            root=str(self.workspace.root),
            kinds=view.kinds(),
            examples=gallery.examples(),
        )
        self._keeping = asyncio.create_task(self._keep())

    # ------------------------------------------------------------------------------------------------ telling

    def tell(self) -> None:
        """Something changed: every page looks whether it concerns it."""
        self._told = False
        for page in self.pages:
            page.wake()

    def _from_engine(self) -> None:
        """The same from the engine's thread, once for many calls."""
        if not self._told:
            self._told = True
            with contextlib.suppress(RuntimeError):  # the loop is closed: nobody is left to be told
                self._loop.call_soon_threadsafe(self.tell)

    async def gallery(self) -> Gallery:
        """Recent files and unsaved edits, as the state folder holds them; where it does not answer, as it
        held them last.
        """

        def read() -> None:
            recent = [self.workspace.shown(p) for p in self.keeper.recent() if self.workspace.holds(p)]
            self._gallery = Gallery(recent=recent, recoveries=self.keeper.kept())

        await attempt(read)
        return self._gallery

    def clock(self, frame: int) -> RunClock:
        """Where the run is."""
        engine, shot, session = self.engine, self.engine.shot, self.engine.session
        hand, meter = engine.hand, Meter() if session is None else engine.pace.meter(session)
        return RunClock(
            frame=frame,
            running=engine.running,
            time=shot.time,
            tick=shot.tick,
            dt=1.0 if session is None else session.dt,
            seed=0 if session is None else session.seed,
            speed=engine.pace.speed,
            factor=engine.pace.factor if engine.running else 0.0,
            steps=engine.pace.steps if engine.running else 0.0,
            lag=meter.lag,
            worst=meter.worst,
            lost=meter.lost,
            overruns=meter.overruns,
            longest=engine.pace.longest,
            lengthened=meter.lengthened,
            busy=self.project.busy or engine.busy,
            failure=self.project.failures(),
            world=self.embodiment.label,
            senses=session is not None and bool(session.program.plan.sensors),
            pushing="" if hand is None else hand.element,
        )

    def costs(self) -> Costs:
        """What elements cost, as far as it was measured."""
        bill = self.engine.bill
        if self._told_costs is None or self._told_costs[0] is not bill:
            found = bill.costs
            listed = () if found is None else found.elements
            elements = [
                CostView(element=c.id, path=c.path, kind=c.kind, us=c.us, alike=c.alike, once=c.once)
                for c in listed
            ]
            problems = view.problems(bill.problems, None)
            step = 0.0 if found is None else found.step
            self._told_costs = (
                bill,
                Costs(measuring=bill.measuring, step=step, elements=elements, problems=problems),
            )
        return self._told_costs[1]

    # ----------------------------------------------------------------------------------------------- watching

    def new_page(self) -> Page:
        """A page with a number of its own; once its socket is open it belongs to `pages`."""
        self._connected += 1
        return Page(self._connected)

    def watch(self) -> None:
        """Tell the engine what all pages together look at."""
        streams = [s for p in self.pages for s in p.streams.values()]
        places = {s.place for s in streams if s.wish is None}
        wishes = list(dict.fromkeys(s.wish for s in streams if s.wish is not None))
        self.engine.call(lambda: self.engine.show(places, wishes))

    def leave(self, page: Page) -> None:
        """A page is gone; the run goes on."""
        self.pages.discard(page)
        if self.engine.hand is not None and page.pushes:
            self.engine.call(lambda: self.engine.inject(None))
        self.watch()

    # ------------------------------------------------------------------------------------------------- ending

    async def _keep(self) -> None:
        while True:
            await asyncio.sleep(KEEP_SECONDS)
            await self.project.turns.take(self.project.keep)  # no edit is forgotten while it is written

    async def close(self) -> None:
        """End the engine; unsaved edits stay kept."""
        self._keeping.cancel()
        await self.project.keep()
        await asyncio.to_thread(self.engine.close)
