"""The session: one running model, stepped by a script, by a clock or by the studio."""

from __future__ import annotations

import dataclasses as dc
import html
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar import renamed
from deodar.compiler.executable import Executable, executable
from deodar.compiler.layout import require_range
from deodar.compiler.plan import ways_of
from deodar.compiler.program import Port
from deodar.compiler.ways import widths
from deodar.errors import ModelError, ParameterError, TimeError, UnknownName, WorldError
from deodar.leaves import get, step_limits
from deodar.model import edit, find
from deodar.model.document import Document
from deodar.model.model import Handle, Model, path_of
from deodar.model.resolve import resolve
from deodar.parameters import FrozenArray, show
from deodar.session import memory, rearrange
from deodar.session.changes import LeafChange, changed_leaves
from deodar.session.cost import SECONDS, StepCost, StepInputs, costs, moment
from deodar.session.keep import keep
from deodar.session.look import Look, PortKey
from deodar.session.meter import Meter
from deodar.session.run import Run, require_duration, require_step, whole
from deodar.session.run_live import run_live
from deodar.session.snapshot import SessionSnapshot, fill, rows
from deodar.worlds._base import World
from deodar.worlds._scene import Scene

LARGEST_SEED = 2**32 - 1


@dc.dataclass(frozen=True)
class Change:
    """One entry of the journal: what was changed, to what, at which tick."""

    tick: int
    what: str
    value: Any


class Session:
    """A model that runs.

    Args:
        model: the model, as it now is; later edits of the model do not reach the session.
        dt: Euler step in the document's time unit; none: the document's own, else 1.
        seed: seed of all noise, 0 to 2^32 - 1.
        precision: float32 or float64.
        world: what provides the sensors that the model names.
        trial: which trial of the seed this is; a single run is trial 0.
        device: where it runs: cpu, gpu, or one of several as gpu:1; none: the CPU.
        accuracy: default, or exact: every kernel by its matrix, however much longer that takes (double
            precision always is).

    Attributes:
        device: where it runs, as it was given.
        journal: every change of a parameter or of dt, every reset and restore, every hand in the world, with
            its tick; with seed and document it repeats the session.
    """

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            raise renamed.no_member(self, name)

    def __init__(
        self,
        model: Model,
        dt: float | None = None,
        seed: int = 0,
        precision: str = "float32",
        world: World | None = None,
        trial: int = 0,
        device: str | None = None,
        accuracy: str = "default",
    ) -> None:
        self._model = model
        self.device, self._accuracy = device, accuracy
        self._precision = precision
        self._coming_dt: float | None = None
        self.journal: list[Change] = []
        self._ports: dict[str, tuple[Executable, Port]] = {}
        doc = require_model(model).document
        model.require()
        memory.require(resolve(doc)[0], precision, 1, 0)
        step = doc.step if dt is None else dt
        require_step(doc, step)
        self._run = Run(
            self.compiled(doc), doc, float(step), require_seed(seed), [require_seed(trial)], world
        )

    # ------------------------------------------------------------------------------------------------ running

    def step(self, n: int = 1) -> None:
        """Advance by `n` Euler steps."""
        if isinstance(n, bool) or not isinstance(n, (int, np.integer)) or n < 0:
            raise TimeError(f"a number of steps is a whole number, 0 or above, not {show(n)}")
        left = int(n)
        while left:
            left -= self._to_new_dt(left)
            if left:
                self._run.advance(left if self._coming_dt is None else 0)
                left = 0 if self._coming_dt is None else left

    def run(self, duration: float) -> None:
        """Advance by a duration in document time: a whole number of steps of the present dt."""
        waiting, rest = 0, require_duration(duration, "a duration")
        if self._coming_dt is not None:  # up to the tick common to all parts the old step still counts
            waiting = min(-self.tick % self._run.program.plan.ticks, math.floor(rest / self.dt + 1e-9))
            rest -= waiting * self.dt
        self.step(waiting + whole(rest, self.next_dt, "a duration"))

    def run_live(
        self,
        duration: float,
        speed: float | None = 1.0,
        longest_step: float | None = None,
        between: Callable[[], object] | None = None,
    ) -> Meter:
        """Advance by a duration in document time, paced to the wall clock; see
        `deodar.session.run_live.run_live`.
        """
        return run_live(self, duration, speed, longest_step, between)

    def costs(self, seconds: float = SECONDS) -> StepCost:
        """What each element costs in a step, measured now; see `deodar.session.cost.costs`.

        The run is not touched.
        """
        return costs(self.moment(), seconds)

    def moment(self) -> StepInputs:
        """What costs are measured at: it may be handed to another thread."""
        return moment(self._run)

    def reset(self, seed: int | None = None) -> None:
        """State, time and noise back to the start, with another seed if one is given; parameters stay."""
        new = self.seed if seed is None else require_seed(seed)
        self.journal.append(Change(self.tick, "reset", new))
        self._run.seed = new
        self._run.reset()

    def inject(self, path: str | Handle, amount: np.ndarray | float, n: int = 1) -> None:
        """Inject an external input for `n` Euler steps, without adding an element.

        Exactly as if `amount` (over the element's axes, or one number) were added to its input, noise
        included.
        """
        entry = find.element(self.document, path_of(path))
        self.require_push(entry.id)
        self.journal.append(Change(self.tick, f"push {entry.path}", (FrozenArray(amount), n)))
        g, r = self._run.program.plan.row[entry.id]
        for _ in range(n):
            dt = self.dt
            self.step()
            self._run.put_row(g, r, entry.element.inject(state := self._run.row(g, r), amount, dt) or state)

    def _to_new_dt(self, most: int) -> int:
        """Steps taken until a changed dt may take effect: the next tick common to all parts."""
        if self._coming_dt is None:
            return 0
        ticks = self._run.program.plan.ticks
        wait = -self.tick % ticks
        taken = min(wait, most)
        if taken:
            self._run.advance(taken)
        if taken == wait:
            self._run.exchange.restep(self.tick, self.dt / self._coming_dt)
            self._run.clock = self._run.clock.at(self._coming_dt)
            self._coming_dt = None
        return taken

    def require_push(self, ident: str) -> None:
        """Refuse to push an element that takes no input from outside."""
        entry = self.document.by_id().get(ident)
        if entry is None or ident not in self.program.plan.row:
            raise UnknownName(f"the element with the id {ident} does not run")
        g, r = self.program.plan.row[ident]
        if entry.every != 1 or entry.element.inject(self._run.row(g, r), 0.0, self.dt) is None:
            raise ParameterError(
                "takes no input from outside",
                where=entry.path,
                fix="Push a field or node that runs at every tick",
            )

    # ----------------------------------------------------------------------------------- looking and changing

    def look(self, look: Look, places: Iterable[PortKey]) -> Mapping[PortKey, np.ndarray]:
        """Many ports now, through a look that was compiled for the program that runs."""
        return look.arrays(self._run.look(look.reader) if look.ports else [], places)

    def require(self, document: Document) -> None:
        """Refuse a document that could not go on here: a step too long for a time constant, a sensor that the
        world does not have.
        """
        for step in {self.dt, self.next_dt}:
            require_step(document, step)
        self._run.exchange.require(document)

    def compiled(self, document: Document, model: Model | None = None) -> Executable:
        """The program that this session would run a document with; `model`: which keeps it."""
        return executable(
            model or self._model, document, self._precision, device=self.device, accuracy=self._accuracy
        )

    def cost(self, document: Document) -> str:
        """What going on with another document would cost: live, rebuild or recompile."""
        return self._cost(document, changed_leaves(self.document, document))

    def _cost(self, document: Document, changed: Sequence[LeafChange] | None) -> str:
        if changed is None or not all(self.program.holds(leaf) and not off for leaf, _, _, off in changed):
            return "recompile"
        if "rebuild" not in {cost for _, _, cost, _ in changed}:
            return "live"
        exact, old = self._accuracy == "exact" or self._precision == "float64", self.document
        return (
            "rebuild"
            if exact or widths(old) == widths(document) or ways_of(old) == ways_of(document)
            else "recompile"
        )

    def read(self, path: str | Handle) -> np.ndarray:
        """Return what a port holds now: an array over the port's axes in their order, of shape () for a node.

        The path of a field alone means its activation: `session.read("u")`.
        """
        return self._run.read([self._port(path)])[0]

    def get(self, path: str) -> Any:
        """The value of a parameter."""
        found = find.target(self.document, path)
        if found.entry is None:
            return next(k.value for k in self.document.knobs if k.name == found.knob)
        return get(found.entry.element, found.parameter)

    def set(self, path: str | Mapping[str, Any], value: Any = ...) -> str:
        """Change a parameter, or several at once, from the next step on; states stay.

        Returns what it cost: live, rebuild or recompile.

        For example `session.set("u.tau", 30)` or `session.set({"u.tau": 30, "v.tau": 10})`; after an error
        none is changed.
        """
        values = edit.assignments(path, value)
        cost = self._adopt(edit.change_all(self.document, values))
        self.journal += [
            Change(self.tick, at, FrozenArray(v) if isinstance(v, np.ndarray) else v)
            for at, v in values.items()
        ]
        return cost

    def edit(self, document: Document) -> str:
        """Go on with another document; elements that stay (by id) keep their states."""
        cost = self._adopt(document)
        self._ports.clear()
        self.journal.append(Change(self.tick, "document", document))
        return cost

    def snapshot(self) -> SessionSnapshot:
        """The whole state, to go back to."""
        run = self._run
        return SessionSnapshot(
            self.document,
            rows(run.program, run.state),
            run.clock,
            run.seed,
            self._precision,
            run.exchange.keep(),
        )

    def restore(self, snapshot: SessionSnapshot) -> None:
        """Back to a snapshot, of this session or of another one of the same model."""
        if not isinstance(snapshot, SessionSnapshot):
            raise ParameterError(f"{show(snapshot)} is no snapshot", fix="Take one with session.snapshot()")
        if snapshot.precision != self._precision:
            raise ParameterError(
                f"the snapshot was taken in {snapshot.precision}, this session runs in {self._precision}"
            )
        if not set(self.document.by_id()) & set(snapshot.document.by_id()):
            raise ParameterError(f"the snapshot is of another model, {snapshot.document.name!r}")
        self.journal.append(Change(self.tick, "restore", snapshot))
        run, clock, seed = self._run, self._run.clock, self._run.seed
        try:
            run.clock, run.seed, self._coming_dt = snapshot.clock, snapshot.seed, None
            if snapshot.document != self.document:
                run.load(self.compiled(snapshot.document), snapshot.document)
                self._ports.clear()
        except BaseException:
            run.clock, run.seed = clock, seed
            raise
        fill(run, snapshot.states)
        run.exchange.put(snapshot.world)

    def keep(self) -> list[str]:
        """Take what elements have learned (weights, traces, gains) into the model, for `save`: what they
        start from. Returns its paths.
        """
        return keep(self.snapshot(), self._model)

    # ------------------------------------------------------------------------------------ a hand in the world

    def scene(self) -> Scene | None:
        """The world from above, now; None where there is none, or nothing to draw."""
        if self.world is None:
            return None
        self._run.sense()  # a hand finds the world at the present, whether or not somebody looked before
        return self.world.scene()

    def move(self, name: str, center: Sequence[float]) -> None:
        """Put a thing of the world, or its goal, elsewhere: x and y of its middle.

        Refused where it does not fit.
        """
        self._note(*rearrange.move(*self._seen(), name, center))

    def place(self, name: str, center: Sequence[float], size: Sequence[float]) -> None:
        """Put a thing into the world, or another one in the place of one of that name.

        Refused where it does not fit.
        """
        self._note(*rearrange.place(*self._seen(), name, center, size))

    def remove(self, name: str) -> None:
        """Take a thing out of the world."""
        self._note(*rearrange.remove(*self._seen(), name))

    def _seen(self) -> tuple[World, Scene]:
        scene = self.scene()
        if self.world is None or scene is None:
            raise WorldError(
                "there is no world that is seen from above",
                fix="Give one: --world arena:blocks, or world=Arena('blocks')",
            )
        return self.world, scene

    def _note(self, what: str, value: Any) -> None:
        if self.journal and (self.journal[-1].tick, self.journal[-1].what) == (self.tick, what):
            self.journal.pop()  # of several moves between two steps the last counts
        self.journal.append(Change(self.tick, what, value))

    # --------------------------------------------------------------------------------------------- properties

    @property
    def program(self) -> Executable:
        """The compiled program that runs."""
        return self._run.program

    @property
    def world(self) -> World | None:
        """What the sensors read; another one is read from the next step on."""
        return self._run.world

    @world.setter
    def world(self, world: World | None) -> None:
        self._run.see(world)
        self.journal.append(Change(self.tick, "world", None if world is None else world.describe()))

    @property
    def document(self) -> Document:
        """The document with the parameters as they now are."""
        return self._run.doc

    @property
    def dt(self) -> float:
        """Euler step; a new one takes effect (and is read here) at the next tick common to all parts."""
        return self._run.clock.dt

    @dt.setter
    def dt(self, value: float) -> None:
        require_step(self.document, value)
        self._coming_dt = float(value)
        self.journal.append(Change(self.tick, "dt", float(value)))
        self._to_new_dt(0)

    @property
    def next_dt(self) -> float:
        """The Euler step that was set last: `dt`, once it has taken effect."""
        return self._coming_dt or self.dt

    @property
    def time(self) -> float:
        """Document time."""
        return self._run.clock.time

    @property
    def tick(self) -> int:
        """Steps taken since the start."""
        return self._run.clock.tick

    @property
    def seed(self) -> int:
        """Seed of all noise."""
        return self._run.seed

    @property
    def precision(self) -> str:
        """float32 or float64."""
        return self._precision

    def __repr__(self) -> str:
        return (
            f"<Session of {self.document.name!r} at {self.time:g} {self.document.time_unit}, dt {self.dt:g},"
            f" seed {self.seed}>"
        )

    def _repr_html_(self) -> str:
        d, how = self.document, f"dt {self.dt:g}, seed {self.seed}, {self.precision}"
        return f"<b>{html.escape(d.name)}</b>: time {self.time:g} {d.time_unit} (tick {self.tick}), {how}"

    # ------------------------------------------------------------------------------------------------- inside

    def _port(self, path: str | Handle) -> Port:
        path, program = path_of(path), self._run.program
        if (
            self._ports.get(path, (None,))[0] is not program
        ):  # found once for each program: a renamed element has another path
            entry, name = find.shown(self.document, path)
            self._ports[path] = (program, program.port(entry.id, name))
        return self._ports[path][1]

    def _adopt(self, doc: Document) -> str:
        run = self._run
        changed = changed_leaves(run.doc, doc)
        by = doc.by_id()
        if changed is None or any(
            limit.path == path for (i, path), *_ in changed for limit in step_limits(by[i].element)
        ):
            self.require(doc)  # other leaves change no limit of the step
        if changed is not None and self._cost(doc, changed) != "recompile":
            return self._change(doc, changed)
        states = rows(run.program, run.state)
        run.load(self.compiled(doc), doc)
        fill(run, states)
        return "recompile"

    def _change(self, doc: Document, changed: Sequence[LeafChange]) -> str:
        """New values of leaves the program has: the vector, and `prepare` where they rebuild."""
        run = self._run
        vector, arrays = run.values["vector"].copy(), dict(run.values["arrays"])
        for leaf, value, _, _ in changed:
            if isinstance(value, np.ndarray):
                run.program.layout.put_array(arrays, leaf, value)
            else:
                require_range(run.doc, leaf, value, self._precision)
                run.program.layout.put(vector, leaf, value)
        values = run.values | {"vector": vector, "arrays": arrays}
        costs = {cost for _, _, cost, _ in changed}
        if "rebuild" in costs:
            run.constants = run.program.prepare(values)
        run.values, run.doc = values, doc
        return "rebuild" if "rebuild" in costs else "live"


def require_model(model: Any) -> Model:
    """The model, refused if it is something else."""
    if not isinstance(model, Model):
        raise ModelError(
            f"{show(model)} is no model", fix="Build one with dd.Model(name), or read one with dd.load(file)"
        )
    return model


def require_seed(seed: Any) -> int:
    """The seed (or trial) as a number, refused outside 0 to 2^32 - 1."""
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or not 0 <= seed <= LARGEST_SEED:
        raise ParameterError(f"a seed (or trial) is a whole number from 0 to 2^32 - 1, not {show(seed)}")
    return int(seed)
