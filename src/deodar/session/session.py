"""The session: one running model, advanced by a script, by the wall clock or by the studio."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from deodar.compiler import hosts
from deodar.compiler.build import Build
from deodar.compiler.copy_batch import Batch
from deodar.compiler.device import several
from deodar.compiler.division import distributed
from deodar.compiler.dynamics import Dynamics
from deodar.compiler.executable import Executable
from deodar.compiler.program import Port
from deodar.errors import DeviceError, ModelError, ParameterError, TimeError, UnknownName, WorldError, option
from deodar.model import edit, find
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.model.model import Handle, Model, path_of
from deodar.parameters import FrozenArray, show
from deodar.precision import Arithmetic
from deodar.recording.probe import Probe, probes
from deodar.recording.provenance import stored
from deodar.resources import Resources, use_resources
from deodar.session import agreement, memory
from deodar.session.adopt import adopt, require
from deodar.session.carry import fill, nodes
from deodar.session.cost import SECONDS, StepCost, StepInputs, costs, moment
from deodar.session.journal import Change
from deodar.session.keep import beginning, keep, put_learned
from deodar.session.meter import Meter
from deodar.session.one_thread import OneThread
from deodar.session.port_reader import PortKey, PortReader
from deodar.session.recorder import Recorder
from deodar.session.run import Run, host, require_duration, require_step, whole
from deodar.session.run_live import BETWEEN_EVERY, run_live
from deodar.session.session_snapshot import SessionSnapshot, rows
from deodar.summary import Summarised, Summary
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of
from deodar.worlds._scene import Scene, SceneBox

LARGEST_SEED = 2**32 - 1


class Session(Summarised):
    """A running model.

    Args:
        model: the model in its present state; later edits of the model have no effect on the session.
        dt: Euler step in the document's time unit; None: that of the document, else 1.
        seed: seed of all noise, 0 to 2^32 - 1.
        precision: float32, float64, or float32-exact: single precision with every kernel applied as a matrix,
            however slow (float64 always does so).
        world: the world that provides the sensors and motors of the model.
        trial: trial number for this seed; a single run is trial 0.
        on: its device, or several, which divide the fields; after `join_hosts` they are those of all hosts,
            and every host calls the same methods.

    Attributes:
        device: the device, as given.
        journal: every call that changed a parameter or dt, reset or restored the session, injected an input
            or changed the world, with its tick: `change.method`, `change.arguments`. Together with seed and
            document it repeats the session: `change.repeat(session)`.
    """

    def __init__(
        self,
        model: Model,
        dt: float | None = None,
        seed: int = 0,
        precision: str = "float32",
        world: World | None = None,
        trial: int = 0,
        on: Resources = Resources(),
    ) -> None:
        self._model = model
        self.device = use_resources(on, "dd.Session", "device", "devices").device
        numbers, accuracy = Arithmetic.of(precision)
        distribution = distributed(Batch(), several(on.devices, on.device))[0]
        self._one_thread = OneThread()
        self._learned: SessionSnapshot | None = None
        self._coming_dt: float | None = None
        self.journal: list[Change] = []
        self._recorder: Recorder | None = None
        self._agreed: tuple[Document, str] | None = None
        self._ports: dict[str, tuple[Executable, Port]] = {}
        doc = require_model(model).document
        across = distribution is not None and distribution.across
        hosts.require_one("a world", across and world is not None)
        if across:
            arguments = {"dt": dt, "seed": seed, "trial": trial, "precision": precision}
            hosts.require_equal("the model", stored(doc))
            hosts.require_equal("the arguments of the session", arguments)
        model.require()
        memory.require(graph(doc).nodes, precision, 1, 0)
        step = doc.step if dt is None else dt
        require_step(doc, step)
        dynamics = Dynamics(model, Build(doc, numbers, accuracy, distribution or self.device))
        self._run = Run(dynamics, Batch(), float(step), require_seed(seed), [require_seed(trial)], world)
        agreement.warn(doc, world, stacklevel=2)
        agreement.warn_of_rounding(doc, float(step), numbers, stacklevel=2)

    # ------------------------------------------------------------------------------------------------ running

    def step(self, n: int = 1) -> None:
        """Advance by `n` Euler steps."""
        if isinstance(n, bool) or not isinstance(n, (int, np.integer)) or n < 0:
            raise TimeError(f"a number of steps is a whole number, 0 or above, not {show(n)}")
        steps_left = int(n)
        with self._one_thread:
            while steps_left:
                steps_left -= self._to_new_dt(steps_left)
                if steps_left:
                    self._advance(steps_left if self._coming_dt is None else 0)
                    steps_left = 0 if self._coming_dt is None else steps_left

    def run(self, duration: float) -> None:
        """Advance by a duration in document time: a whole number of steps of the present dt."""
        waiting, time_left = 0, require_duration(duration, "a duration")
        if self._coming_dt is not None:  # the old step is valid up to the tick common to all parts
            waiting = min(-self.tick % self._run.program.plan.ticks, math.floor(time_left / self.dt + 1e-9))
            time_left -= waiting * self.dt
        self.step(waiting + whole(time_left, self.next_dt, "a duration"))

    def run_live(
        self,
        duration: float,
        speed: float | None = 1.0,
        longest_step: float | None = None,
        between: Callable[[], object] | None = None,
        between_every: float = BETWEEN_EVERY,
    ) -> Meter:
        """Advance by a duration in document time, paced to the wall clock; see
        `deodar.session.run_live.run_live`.
        """
        hosts.require_one("a run that follows the wall clock", self.program.across)
        with self._one_thread:
            return run_live(self, duration, speed, longest_step, between, between_every)

    def costs(self, seconds: float = SECONDS) -> StepCost:
        """Measure the cost of each element in a step; see `deodar.session.cost.costs`.

        The run does not change.
        """
        return costs(self.moment(), seconds)

    def moment(self) -> StepInputs:
        """Return the inputs of the next step, for measuring costs; another thread may use them.

        Raises:
            DeviceError: several devices divide the fields, so that no element is computed alone.
        """
        if (parts := self.program.distribution) is not None:
            raise DeviceError(
                f"costs are measured on one device, and {len(parts.devices)} divide the fields",
                fix="Make a session without devices",
            )
        return moment(self._run)

    def reset(self, seed: int | None = None, keep_learned: bool = False) -> None:
        """Reset state, time and noise to the start, with another seed if one is given; parameters stay.

        Elements begin with what `keep` wrote last. After an error nothing changed.

        Args:
            seed: seed of all noise; None: the present one.
            keep_learned: whether learned states (weights, traces, gains) stay as they are now.
        """
        new, run, tick = self.seed if seed is None else require_seed(seed), self._run, self.tick
        with self._one_thread, run.undone_on_error():
            if self._learned is not None:
                adopt(run, beginning(run, self._learned), (self.dt, self.next_dt))
            learned_rows = rows(run.program, host(run.state)) if keep_learned else {}
            run.seed = new
            run.reset()
            if keep_learned:
                put_learned(run, learned_rows)
        self._learned = None
        self.journal.append(Change(tick, "reset", (new, True) if keep_learned else (new,)))
        self._end_record("the session was reset")

    def inject(self, path: str | Handle, amount: np.ndarray | float, n: int = 1) -> None:
        """Inject an external input for `n` Euler steps, without adding an element.

        The result is exactly that of adding `amount` (over the element's axes, or one number) to the
        element's input, with the same noise.
        """
        entry = find.element(self.document, path_of(path))
        self.require_injection(entry.id)
        frozen = FrozenArray(amount)
        # as the journal has it, so that a repetition has the same bits
        exact_amount = frozen.data if frozen.shape else float(frozen.data)
        if self.program.across:
            hosts.require_equal("what is injected", [entry.path, n, frozen.digest])
        g, r = self._run.program.plan.row[entry.id]
        with self._one_thread:
            self.journal.append(Change(self.tick, "inject", (entry.path, frozen, n)))
            for _ in range(n):
                dt, recorder, self._recorder = self.dt, self._recorder, None
                try:
                    self.step()
                finally:
                    self._recorder = recorder
                self._run.put_row(
                    g, r, entry.element.inject(state := self._run.row(g, r), exact_amount, dt) or state
                )
                if recorder is not None:  # a sample at this tick contains the injected input
                    recorder.note()
                    recorder.sample(self._run)

    def _to_new_dt(self, most: int) -> int:
        """Advance to the next tick common to all parts, where a changed dt takes effect.

        At most `most` steps are taken; return their number.
        """
        if self._coming_dt is None:
            return 0
        ticks = self._run.program.plan.ticks
        wait = -self.tick % ticks
        taken = min(wait, most)
        if taken:
            self._advance(taken)
        if taken == wait:
            factor = self.dt / self._coming_dt
            self._run.exchange.restep(self.tick, factor)
            self._run.clock = self._run.clock.at(self._coming_dt)
            self._coming_dt = None
            if self._recorder is not None and self._recorder.open:
                self._recorder.restep(self._run, factor)
        return taken

    def require_injection(self, ident: str) -> None:
        """Raise an error for an element that accepts no external input.

        Raises:
            UnknownName: no element with this id runs.
            ParameterError: the element accepts no external input, or does not run at every tick.
        """
        entry = self.document.by_id().get(ident)
        if entry is None or ident not in self.program.plan.row:
            raise UnknownName(f"the element with the id {ident} does not run")
        g, r = self.program.plan.row[ident]
        if entry.every != 1 or entry.element.inject(self._run.row(g, r), 0.0, self.dt) is None:
            raise ParameterError(
                "takes no input from outside",
                where=entry.path,
                fix="Inject into a field or node that runs at every tick",
            )

    # ----------------------------------------------------------------------------------- reading and changing

    def read_ports(self, reader: PortReader, places: Iterable[PortKey]) -> Mapping[PortKey, np.ndarray]:
        """Read many ports now, with a `PortReader` that was compiled for the running program."""
        return reader.arrays(
            self._run.read_arrays(reader.reader) if reader.reader is not None else [], places
        )

    def require(self, document: Document) -> None:
        """Raise an error for a document that the session cannot continue with.

        Raises:
            TimeError: the step is too long for a time constant.
            WorldError: the world does not have a sensor or motor of the document.
            ParameterError: a state cannot be carried.
        """
        require(self._run, document, (self.dt, self.next_dt))

    def compiled(self, document: Document, model: Model | None = None) -> Executable:
        """Compile the program that this session would run a document with; `model` caches it."""
        build = self._run.build.of(document)
        return Dynamics(model or self._model, build).compiled()

    def precompile(self, program: Executable) -> None:
        """Compile what this session calls of a program; another thread may do it while the session runs."""
        program.chunk(())
        if self._recorder is not None and self._recorder.open:
            self._recorder.compile(program)

    def cost(self, document: Document) -> str:
        """Return the cost of continuing with another document: live, rebuild or recompile."""
        new = self._run.continued(document)
        return "recompile" if new is None else new.cost

    def read(self, path: str | Handle) -> np.ndarray:
        """Return the present value of a port: an array over the port's axes, of shape () for a node.

        The path of a field alone means its activation: `session.read("u")`.
        """
        return self._run.read([self._port(path)])[0]

    def get(self, path: str) -> Any:
        """Return the value of a parameter."""
        return find.value(self.document, path)

    def set(self, path: str | Mapping[str, Any], value: Any = ...) -> str:
        """Change a parameter, or several at once, from the next step on.

        States stay; over other axes they are interpolated where both axes have positions. Return the cost of
        the change: live, rebuild or recompile.

        For example `session.set("u.tau", 30)` or `session.set({"u.tau": 30, "v.tau": 10})`; after an error no
        parameter has changed.
        """
        values = edit.assignments(path, value)
        with self._one_thread:
            cost = adopt(self._run, edit.change_all(self.document, values), (self.dt, self.next_dt))
        self.journal += [
            Change(self.tick, "set", (at, FrozenArray(v) if isinstance(v, np.ndarray) else v))
            for at, v in values.items()
        ]
        return cost

    def edit(self, document: Document) -> str:
        """Continue with another document; elements that remain (by id) keep their states, as with `set`.

        Return the cost.
        """
        with self._one_thread:
            cost = adopt(self._run, document, (self.dt, self.next_dt))
        self._ports.clear()
        self.journal.append(Change(self.tick, "edit", (document,)))
        return cost

    def snapshot(self) -> SessionSnapshot:
        """Return the whole state, for `restore`."""
        run = self._run
        return SessionSnapshot(
            self.document,
            rows(run.program, host(run.state)),
            run.clock,
            run.seed,
            self.precision,
            run.exchange.keep(),
        )

    def restore(self, snapshot: SessionSnapshot, seed: int | None = None) -> None:
        """Restore a snapshot of this session or of another session of the same model.

        Args:
            snapshot: what `snapshot` returned.
            seed: seed of all noise from this moment on, for another future; None: that of the snapshot.
        """
        if not isinstance(snapshot, SessionSnapshot):
            raise ParameterError(
                f"expected a snapshot, got {show(snapshot)}", fix="Take one with session.snapshot()"
            )
        if snapshot.precision != self.precision:
            raise ParameterError(
                f"the snapshot was taken in {snapshot.precision}, this session runs in {self.precision}"
            )
        if not set(self.document.by_id()) & set(snapshot.document.by_id()):
            raise ParameterError(f"the snapshot is of another model, {snapshot.document.name!r}")
        self.go_back(snapshot, self.world, None if seed is None else require_seed(seed))

    def go_back(self, snapshot: SessionSnapshot, world: World | None, seed: int | None = None) -> None:
        """Restore a snapshot of this session with the world of that moment, whatever was edited since.

        After an error nothing changed.
        """
        run, tick, present_seed = self._run, self.tick, self.seed
        with self._one_thread, run.undone_on_error():
            run.clock, run.seed = snapshot.clock, snapshot.seed if seed is None else seed
            if world is not self.world or (
                world is not None and world.repeatable and run.seed != present_seed
            ):
                run.see(world, snapshot.document)  # its noise follows from the seed
            if snapshot.document != self.document:
                run.load(snapshot.document)
            fill(run, snapshot.states, nodes(snapshot.document))
            run.exchange.put(snapshot.world)
        self._coming_dt = None
        self._ports.clear()
        self.journal.append(Change(tick, "restore", (snapshot,) if seed is None else (snapshot, seed)))
        self._end_record("a snapshot was restored")

    def record(
        self,
        path: str | Path,
        record: Probe | Handle | str | Sequence[Probe | Handle | str],
        every: float | None = None,
        force: bool = False,
    ) -> Recorder:
        """Record ports into a file from now on, while the session is advanced by any means.

        All samples are committed twice a second: if the process is killed, less than a second is lost. The
        record states every change of the session with its tick.

        For example `with session.record("night", ["u", dd.Probe("v", every=100)]): session.run(1e6)`.

        Args:
            path: a name that ends in .zarr, or a folder, which gets the record and the model.
            record: paths of ports, handles, or probes with an interval or a condition of their own.
            every: document time between two samples; None: every step. The first sample is the present state.
            force: whether to replace an existing record.

        Raises:
            OutputExists: the path exists.
            OutputError: it cannot be written.
            ParameterError: the session is recorded already, or a port is named twice.
        """
        hosts.require_one("the record of a session", self.program.across)
        if self._recorder is not None and self._recorder.open:
            raise ParameterError(
                f"the session is recorded already, into {self._recorder.path}",
                fix="Close that recorder first",
            )
        self._recorder = Recorder(self._run, self.journal, Path(path), probes(record), every, force)
        return self._recorder

    def keep(self) -> list[str]:
        """Write learned values (weights, traces, gains) back to the model as initial values, for `save`.

        The next `reset` of this session begins with them, too. Return the paths of the parameters.
        """
        snapshot = self.snapshot()
        paths = keep(snapshot, self._model)
        self._learned = snapshot
        return paths

    # ----------------------------------------------------------------------------------- objects in the world

    def scene(self) -> Scene | None:
        """Return the present view of the world from above; None without a world or such a view."""
        if self.world is None:
            return None
        self._run.sense()  # the world advances to the present, whether or not it was read before
        with errors_of(self.world, "scene"):
            return self.world.scene()

    def move(self, name: str, center: Sequence[float]) -> None:
        """Move an object of the world, or its goal; `center` is the new x and y of its middle.

        Raises:
            UnknownName: the world has no object or mark of that name.
            WorldError: it does not fit at the position, or cannot be moved.
        """
        world, scene = self._seen()
        entry = scene.entry(name)
        scene.require_room(name, center, entry.size if isinstance(entry, SceneBox) else None)
        with errors_of(world, "move"):
            world.move(name, center)
        self._note("move", name, tuple(center))

    def place(
        self, name: str, center: Sequence[float], size: Sequence[float], color: Sequence[float] | None = None
    ) -> None:
        """Add an object to the world, or replace the one of the same name.

        Args:
            name: name of the object.
            center: x and y of its middle.
            size: size along x and y.
            color: red, green and blue, 0 to 1; None: that of `World.place`.

        Raises:
            WorldError: it does not fit at the position, a mark has that name, or a value is invalid.
        """
        world, scene = self._seen()
        coloured = () if color is None else (tuple(color),)
        scene.require_room(name, center, size)
        if name in [mark.name for mark in scene.marks]:
            raise WorldError("is the name of a mark", where=name, fix="Choose another name")
        with errors_of(world, "place"):
            world.place(name, center, size, *coloured)
        self._note("place", name, tuple(center), tuple(size), *coloured)

    def remove(self, name: str) -> None:
        """Remove an object from the world."""
        world, scene = self._seen()
        if not isinstance(scene.entry(name), SceneBox):
            raise WorldError("is a mark; it can be moved, not removed", where=name)
        with errors_of(world, "remove"):
            world.remove(name)
        self._note("remove", name)

    def push_body(self, body: str, force: Sequence[float]) -> None:
        """Push a body of the world with a force along x, y and z (N), until the next push of it.

        Raises:
            UnknownName: the world has no such body.
            WorldError: nothing in the world can be pushed, or the force is invalid.
        """
        world, _ = self._seen()
        with errors_of(world, "push"):
            world.push(body, force)
        self._note("push_body", body, tuple(force))

    def narrow_motor(
        self, motor: str, limits: tuple[float, float] | None = None, slew: float | None = None
    ) -> None:
        """Narrow what a motor of the world allows, from its next command on; nothing widens it again.

        Args:
            motor: name of the motor in the world.
            limits: smallest and largest value of each sample; None: as before.
            slew: largest change of each sample, in the unit of the motor per second; None: as before.

        Raises:
            WorldError: the world has no such motor, cannot narrow it, or no value would be left.
        """
        if self.world is None:
            raise WorldError("the session has no world", where=motor)
        if self.world.repeatable:
            self._run.sense()  # it advances to the present with the limits of before
        with errors_of(self.world, "narrow"):
            self.world.narrow(motor, limits, slew)
        self.journal.append(Change(self.tick, "narrow_motor", (motor, limits, slew)))

    def _seen(self) -> tuple[World, Scene]:
        scene = self.scene()
        if self.world is None or scene is None:
            raise WorldError(
                "the session has no world with a view from above",
                fix=option(
                    "Give one:",
                    "world",
                    "arena:blocks",
                    "dd.Arena('blocks')",
                    "start the studio with --world arena:blocks",
                ),
            )
        return self.world, scene

    def _note(self, method: str, name: str, *arguments: Any) -> None:
        new = Change(self.tick, method, (name, *arguments))
        if self.journal:  # only the last of several moves between two steps has an effect
            last = self.journal[-1]
            if (last.tick, last.method, last.arguments[0]) == (new.tick, method, name):
                self.journal.pop()
        self.journal.append(new)

    # --------------------------------------------------------------------------------------------- properties

    @property
    def program(self) -> Executable:
        """The running compiled program."""
        return self._run.program

    @property
    def recorder(self) -> Recorder | None:
        """The recorder that `record` returned last."""
        return self._recorder

    @property
    def world(self) -> World | None:
        """The world that the sensors read; a new one is read from the next step on."""
        return self._run.world

    @world.setter
    def world(self, world: World | None) -> None:
        hosts.require_one("a world", self.program.across and world is not None)
        with self._one_thread:
            self._run.see(world)
        self.journal.append(Change(self.tick, "world", (world,)))

    @property
    def document(self) -> Document:
        """The document with the present values of the parameters."""
        return self._run.doc

    @property
    def dt(self) -> float:
        """Euler step; a new one takes effect (and is read here) at the next tick common to all parts."""
        return self._run.clock.dt

    @dt.setter
    def dt(self, value: float) -> None:
        require_step(self.document, value)
        with self._one_thread:
            self._coming_dt = float(value)
            self.journal.append(Change(self.tick, "dt", (float(value),)))
            self._to_new_dt(0)

    @property
    def next_dt(self) -> float:
        """The Euler step that was set last; it equals `dt` when it has taken effect."""
        return self._coming_dt or self.dt

    @property
    def time(self) -> float:
        """Document time."""
        return self._run.clock.time

    @property
    def tick(self) -> int:
        """Number of steps taken since the start."""
        return self._run.clock.tick

    @property
    def seed(self) -> int:
        """Seed of all noise."""
        return self._run.seed

    @property
    def precision(self) -> str:
        """Precision, float32 or float64."""
        return self.program.precision

    def _summary(self) -> Summary:
        rows = [
            ("tick", self.tick),
            ("dt", f"{self.dt:g}"),
            ("seed", self.seed),
            ("precision", self.precision),
        ]
        title = f"Session of {self.document.name!r} at {self.time:g} {self.document.time_unit}"
        return Summary(title, rows)

    # ------------------------------------------------------------------------------------------------- inside

    def _advance(self, steps: int) -> None:
        """Advance the run, and record the samples that are due."""
        recorder = self._recorder
        if recorder is None or not recorder.open:
            if self.program.across:
                self._advance_together(steps)
            else:
                self._run.advance(steps)
            return
        recorder.note()
        recorder.advance(self._run, steps)

    def _advance_together(self, steps: int) -> None:
        """Advance on all hosts.

        Raises:
            HostsError: they advance by other steps, or other models; or one of them fails.
        """
        doc = self.document
        with hosts.together(True):
            if self._agreed is None or self._agreed[0] is not doc:
                self._agreed = doc, hosts.digest(stored(doc))
            call = {"steps": steps, "seed": self.seed, "model": self._agreed[1]}
            hosts.require_equal("the calls of the session", call)
            self._run.advance(steps)

    def _end_record(self, reason: str) -> None:
        if self._recorder is not None:
            self._recorder.end(reason)

    def _port(self, path: str | Handle) -> Port:
        path, program = path_of(path), self._run.program
        # looked up once for each program: a renamed element has another path
        if self._ports.get(path, (None,))[0] is not program:
            entry, name = find.shown(self.document, path)
            self._ports[path] = (program, program.port(entry.id, name))
        return self._ports[path][1]


def require_model(model: Model) -> Model:
    """Return the model; raise ModelError if it is something else."""
    if not isinstance(model, Model):
        raise ModelError(
            f"expected a model, got {show(model)}",
            fix="Build one with dd.Model(name), or read one with dd.load(file)",
        )
    return model


def require_seed(seed: int) -> int:
    """Return the seed (or trial) as an int; raise ParameterError outside 0 to 2^32 - 1."""
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or not 0 <= seed <= LARGEST_SEED:
        raise ParameterError(f"a seed (or trial) is a whole number from 0 to 2^32 - 1, not {show(seed)}")
    return int(seed)
