"""A run: state, clock and world of one model (or of a batch of copies), and how they advance."""

from __future__ import annotations

import contextlib
import dataclasses as dc
import math
import time
from collections.abc import Callable, Generator, Mapping, Sequence
from types import EllipsisType
from typing import Any, NamedTuple

import jax
import numpy as np
from jax import Array
from jax.stages import Compiled

from deodar.compiler import hosts
from deodar.compiler.arguments import EitherArray, ProgramState, ProgramValues, packed
from deodar.compiler.body import unbatched
from deodar.compiler.build import Build, cost
from deodar.compiler.copy_batch import Batch
from deodar.compiler.dynamics import Dynamics
from deodar.compiler.executable import ChunkResult, TrialNumbers
from deodar.compiler.leaf_layout import require_range
from deodar.compiler.program import BEGUN, Port
from deodar.declarations import LIMITING
from deodar.element import Arrays
from deodar.errors import NotFinite, TimeError, option
from deodar.model.document import Document
from deodar.model.resolve import Node
from deodar.model.unit import unit_seconds
from deodar.numerics.pytree import PyTree
from deodar.parameters import real, show
from deodar.session.changes import LeafChange, changed_leaves
from deodar.session.clock import Clock
from deodar.session.exchange import Exchange, ExchangeInstant
from deodar.session.failure import CopyIndex, RowSpans, first_steps, not_finite
from deodar.worlds._base import World

CHUNK_SECONDS = 0.2
"""Wall time of a chunk, in seconds; progress, Ctrl-C and non-finite values are handled between chunks."""

PROBE_STEPS = 20
"""Steps of the first chunk (a guess: enough to measure a fast model, little time for a slow one)."""

MOST_STEPS = 2**44
"""Largest number of steps from time 0: 557 years at a step of 1 ms.

Up to it times are exact to a sixteenth of a step (`numerics/exact.py`).
"""


@dc.dataclass(frozen=True)
class _Looked:
    """What followed from pictures, and from which ones.

    Attributes:
        values, constants: those of the run then; both are new objects after a change.
        pictures: readings by the sensor's id.
        seen: what followed.
    """

    values: ProgramValues
    constants: PyTree
    pictures: Mapping[str, np.ndarray]
    seen: Arrays


class Continued(NamedTuple):
    """How the program of a run continues with another document.

    Attributes:
        build: the build of the program, with the new document.
        changed: the leaves with a new value.
    """

    build: Build
    changed: Sequence[LeafChange]

    @property
    def cost(self) -> str:
        """The cost of the change, live or rebuild."""
        return "rebuild" if any(cost(p) == "rebuild" for *_, p in self.changed) else "live"

    @property
    def limiting(self) -> bool:
        """Whether it may change the longest Euler step."""
        return any(p.role in LIMITING for *_, p in self.changed)


@dc.dataclass(frozen=True)
class _Starts:
    """State and keys of each copy at the start of a trial."""

    trials: np.ndarray
    state: Any
    keys: Any


class Run:
    """The run of one model, or of a batch of copies of it.

    Args:
        dynamics: what is computed.
        copies: the copies that run together.
        dt: Euler step.
        seed: seed of all noise.
        trials: number of the trial of each copy.
        world: the world of the sensors and motors.
        swept: for each entry of the sweep its value in each copy.

    Attributes:
        build: what is computed now; its document has the present values of the parameters.
        program: the compiled program.
    """

    def __init__(
        self,
        dynamics: Dynamics,
        copies: Batch,
        dt: float,
        seed: int,
        trials: TrialNumbers,
        world: World | None,
        swept: Sequence[np.ndarray] | None = None,
    ) -> None:
        self.model, self.seed = dynamics.model, seed
        self.trials: TrialNumbers = trials
        self.swept = swept
        build = dc.replace(dynamics.build, batch=copies)
        self.clock = Clock(0, build.doc.t0, 0, dt)
        self.exchange = Exchange(build.doc, world)
        self._load(build)
        self.probe = PROBE_STEPS
        """Steps of the first chunk, which measures the pace."""
        self.tolerated = 0
        """Number of copies of a batch that may diverge; their errors are stored in `lost`.

        One more copy raises the first error. A single run tolerates none.
        """
        self.lost: dict[tuple[int, ...], NotFinite] = {}
        self.reset()

    # ------------------------------------------------------------------------------------- program and state

    @property
    def doc(self) -> Document:
        """The document with the present values of the parameters."""
        return self.build.doc

    @contextlib.contextmanager
    def undone_on_error(self) -> Generator[None]:
        """Undo what the block changed in the run, if it raises; a world that moved is not moved back."""
        exchange = self.exchange
        before, exchanged = vars(self).copy(), vars(exchange).copy()
        try:
            yield
        except BaseException:
            vars(self).update(before)
            vars(exchange).update(exchanged)
            raise

    def load(self, doc: Document) -> None:
        """Use another document, with a program of its own; the state stays."""
        self._load(self.build.of(doc))

    def _load(self, build: Build) -> None:
        program = Dynamics(self.model, build).compiled()
        require_step(build.doc, self.clock.dt)
        self.exchange.take(build.doc)
        self.exchange.body = build.body
        self.program, self.build = program, build
        self.pace = 0.0
        """Steps per second of wall time; 0 before the first chunk of a program."""
        self.values = program.values(build.doc, self.swept)
        self.constants = program.prepare(self.values)

    def continued(self, doc: Document) -> Continued | None:
        """Return how the program continues with another document; None: that needs another program."""
        build = self.build.continued(doc)
        return Continued(build, changed_leaves(self.doc, doc)) if build.form == self.build.form else None

    def change(self, new: Continued) -> None:
        """Write new values of leaves to the program's vector and arrays, and rebuild constants if needed."""
        vector = np.array(self.values["vector"])
        arrays = {name: np.asarray(a) for name, a in self.values["arrays"].items()}
        for leaf, value, _ in new.changed:
            if isinstance(value, np.ndarray):
                self.program.layout.put_array(arrays, leaf, value)
            else:
                require_range(self.doc, leaf, value, self.program.precision)
                self.program.layout.put(vector, leaf, value)
        values: ProgramValues = {**self.values, "vector": vector, "arrays": {**arrays}}
        if new.cost == "rebuild":
            self.constants = self.program.prepare(values)
        self.values, self.build = values, new.build

    def reset(self) -> None:
        """Reset state, time, noise and world to the start; parameters stay."""
        self._starts: _Starts | None = None
        self.state, self.keys = self.program.init(self.values, self.seed, self.trials)
        self.clock = Clock(0, self.doc.t0, 0, self.clock.dt)
        self.exchange.reset(self.seed, self.trials, self.program.batch, self.program.precision)
        self.shared: Arrays | None = None
        if self.exchange.inside:
            assert self.exchange.world is not None
            self.shared, self.state, self.keys = self.program.embodied(
                self.exchange.world, self.state, self.keys
            )
        self.forget()

    def begin(self, seed: int, trials: TrialNumbers) -> None:
        """Begin again, at time 0, with other trials of a seed."""
        self.seed, self.trials = seed, trials
        self.reset()

    def restart(self, rows: np.ndarray, trials: TrialNumbers) -> None:
        """Begin again in some copies of a batch that `restarts`, at the present tick; in a world on the host
        at time 0.

        Args:
            rows: numbers of these copies.
            trials: for every copy the number of the trial that it begins, or would.
        """
        if self.world is not None and not self.exchange.inside:
            self.begin(self.seed, trials)
            return
        if self._starts is None or np.any(np.take(self._starts.trials, rows, 0) != np.take(trials, rows, 0)):
            # of all copies at once: each of the others takes its own when it begins again
            self._starts = self._begun(trials)
        begun = self._starts
        begun.keys[BEGUN][rows] = self.clock.tick % 2**32

        def taken(array: Array, start: np.ndarray) -> np.ndarray:
            values = np.array(array)
            values[rows] = start[rows]
            return values

        self.state, self.keys = jax.tree.map(taken, (self.state, self.keys), (begun.state, begun.keys))

    def _begun(self, trials: TrialNumbers) -> _Starts:
        values: ProgramValues = self.program.values(self.doc, self.swept)
        state, keys = self.program.init(values, self.seed, trials)
        if self.exchange.inside:
            assert self.world is not None
            self.world.reset(self.seed, np.ravel(trials).tolist(), self.program.precision)
            self.shared, state, keys = self.program.embodied(self.world, state, keys)
        return _Starts(np.asarray(trials), *jax.tree.map(np.array, (state, keys)))

    def sweep(self, columns: Sequence[np.ndarray]) -> None:
        """Give each entry of the sweep other values in the copies; `begin` and `restart` begin with the first
        ones.
        """
        values = self.values.copy()
        values["swept"] = self.program.layout.points(columns)
        self.values = values

    def forget(self) -> None:
        """Discard all readings of sensors, so that the next step reads them again.

        Needed after a change of the program or of the time.
        """
        self.sensed = self.program.blind()
        self.exchange.unread = True
        self._looked: _Looked | None = None

    def readings(self) -> Mapping[str, EitherArray]:
        """Return the readings of the sensors, and what follows from pictures among them.

        That is computed again where a picture or a parameter is new.
        """
        if not self.program.program.picture_calls:
            return self.sensed
        looked, sensed = self._looked, self.sensed
        if (
            looked is None
            or looked.values is not self.values
            or looked.constants is not self.constants
            or any(not np.array_equal(looked.pictures[ident], sensed[ident]) for ident in looked.pictures)
        ):
            seen = self.program.look(self.values, self.constants, sensed)
            pictures = {ident: sensed[ident] for ident in self.program.program.pictures}
            self._looked = looked = _Looked(self.values, self.constants, pictures, seen)
        return {**sensed, **looked.seen}

    @property
    def world(self) -> World | None:
        """The world that the sensors read and the motors move."""
        return self.exchange.world

    # ------------------------------------------------------------------------------------------------ running

    def advance(self, steps: int, progress: Callable[[int], None] | None = None) -> None:
        """Advance by `steps` Euler steps, in chunks."""
        chunk, _ = self.program.chunk(())
        self._steps(chunk, steps, 0, progress)

    def record(
        self,
        steps: int,
        ports: Sequence[Port],
        start: int,
        every: int,
        collect: Callable[[int, tuple[np.ndarray, ...]], None],
        progress: Callable[[int], None] | None = None,
        most: int | None = None,
    ) -> None:
        """Advance by `steps` Euler steps; record after the first `start` of them, then after each `every`.

        `collect(k, arrays)` is called with the records from number k on; each array has the batch axes first,
        then the records. `most` bounds the records of a chunk.
        """
        chunk, capacity = self.program.chunk(ports, most)
        done, taken, due = 0, 0, start
        while due <= steps:
            gap, steady = due - done, self._until_sensing()
            most = min(self._chunk_steps(), steady)
            # a record at the tick of a new reading belongs to the next chunk, which has that reading;
            # if the record belongs to a later chunk: advance, and discard it
            if gap and (gap > most or gap == steady):
                head = min(gap, most)
                self._chunk(chunk, {"head": head, "every": 0, "records": 1}, head)
                done += head
            else:
                room = min(most, steady - 1) - gap
                records = 1 + min((steps - due) // every, capacity - 1, max(0, room) // every)
                used = gap + (records - 1) * every
                seen = self._chunk(chunk, {"head": gap, "every": every, "records": records}, used)
                samples = tuple(
                    hosts.gathered(a)[(slice(None),) * len(self.program.batch.shape) + (slice(0, records),)]
                    for a in seen
                )
                self.require_finite(ports, samples, every)
                collect(taken, samples)
                taken, done, due = taken + records, done + used, due + records * every
            if progress is not None:
                progress(done)
        self._steps(chunk, steps - done, 1, progress, done)
        if self.exchange.inside:
            assert "world" in self.state
            self.exchange.put_now(unbatched(self.state["world"]["now"], self.program.batch.shape))

    def _steps(
        self,
        chunk: Compiled,
        steps: int,
        records: int,
        progress: Callable[[int], None] | None,
        before: int = 0,
    ) -> None:
        done = 0
        while done < steps:
            n = min(steps - done, self._chunk_steps(), self._until_sensing())
            self._chunk(chunk, {"head": n, "every": 0, "records": records}, n)
            done += n
            if progress is not None:
                progress(before + done)

    def _chunk(self, chunk: Compiled, counts: dict[str, int], used: int) -> tuple[Array, ...]:
        self.sense()
        if used:
            self.exchange.read_motors(self.clock.tick, self._period(), self._commands)
        began = time.perf_counter()
        before = self.state
        state, seen, finite = self._call(chunk, before, counts)
        good = hosts.gathered(finite[0])
        if not good.all():
            if self._keeps_others():
                self._lose(self._diverged(before, used, self._new(~good)))
            else:
                self._report(before, used)
        self._require_finite_world(before, state, used)
        self.state = state
        self.clock = self.clock.after(used)
        seconds = time.perf_counter() - began
        if used:
            speed = used / max(seconds, 1e-9)
            self.pace = 0.5 * (self.pace + speed) if self.pace else speed
        return seen

    def _call(self, chunk: Compiled, state: ProgramState, counts: dict[str, int]) -> ChunkResult:
        return self.program.call(
            chunk,
            self._values(),
            self.constants,
            state,
            self.keys,
            self.readings(),
            *self._clock_arrays(counts),
        )

    def read(self, ports: Sequence[Port]) -> list[np.ndarray]:
        """Return the values of ports in the present state."""
        return [hosts.gathered(a) for a in self.read_arrays(self.program.reader(ports))]

    def read_arrays(self, reader: Compiled) -> Sequence[np.ndarray]:
        """Return the values of a compiled reader in the present state."""
        self.sense()
        return self.program.call(
            reader,
            self._values(),
            self.constants,
            self.state,
            self.keys,
            self.readings(),
            *self._clock_arrays(),
        )

    def row(self, group: int, row: int) -> dict[str, np.ndarray]:
        """Return the state of one element of a single run."""
        return {name: hosts.gathered(values)[row] for name, values in self.state["groups"][group].items()}

    def put_row(self, group: int, row: int, state: Mapping[str, np.ndarray]) -> None:
        """Replace the state of one element of a single run."""
        new = host(self.state)
        for name, values in state.items():
            new["groups"][group][name][row] = values
        self.state = new

    def see(self, world: World | None, coming: Document | None = None) -> None:
        """Use another world from now on; `coming` is a document that is loaded next.

        After an error nothing changed.
        """
        with self.undone_on_error():
            self.exchange = Exchange(self.doc if coming is None else coming, world)
            self.exchange.reset(self.seed, self.trials, self.program.batch, self.program.precision)
            self.forget()

    def _clock_arrays(self, counts: Mapping[str, int] | None = None) -> tuple[np.ndarray, np.ndarray]:
        period = self._period() if self.exchange.inside else 1
        # the origin of copies that begin again is their own
        origin = {"start": self.clock.t0} if self.program.batch.restarts else self.clock.origin
        numbers = {**origin, "tick": self.clock.tick % 2**32, "period": period, "dt": self.clock.dt}
        return packed(
            numbers | {k: min(v, 2**31 - 1) for k, v in (counts or {}).items()}, self.program.program.dtype
        )

    def _values(self) -> ProgramValues:
        return self.values if self.shared is None else {**self.values, "world": self.shared}

    def _chunk_steps(self) -> int:
        """Return the number of steps that take about CHUNK_SECONDS; the first chunk measures the pace.

        On several hosts the first one decides, and all hear before a chunk whether one has ended the run.
        """
        n = max(1, min(100_000_000, int(self.pace * CHUNK_SECONDS))) if self.pace else self.probe
        return hosts.of_first("the steps of a chunk", n, self.program.across)

    # ------------------------------------------------------------------------------------------------- worlds

    def _period(self) -> int:
        """Return the ticks between two exchanges with the world; 0 if it never changes."""
        if self.world is None or self.world.period is None:
            return 0
        return whole(self.world.period / self._unit(), self.clock.dt, "the world's period")

    def _unit(self) -> float:
        """Return the milliseconds in a unit of document time."""
        return unit_seconds(self.doc.time_unit) * 1e3

    def _until_sensing(self) -> int:
        """Return the number of steps until the next exchange with the world."""
        return self.exchange.steps(self.clock.tick, self._period() if self.exchange.live else 0)

    def sense(self) -> None:
        """Advance the world to the present tick and read the sensors; a second call changes nothing."""
        if self.exchange.live:
            instant = ExchangeInstant(self.clock.tick, self.clock.time, self._unit())
            self.exchange.read(
                instant, self._period(), self.clock.dt, self.program.program.dtype, self.sensed
            )

    def _commands(self, motors: Sequence[str]) -> list[np.ndarray]:
        return self.read([self.program.port(ident, "output") for ident in motors]) if motors else []

    # ----------------------------------------------------------------------------- values that are not finite

    def _keeps_others(self) -> bool:
        return self.tolerated > 0 and bool(self.program.batch.shape)

    def _new(self, bad: np.ndarray, after: float = math.inf) -> list[tuple[int, ...]]:
        """Return the indices of bad copies that are not lost yet, or lost in a step later than `after`."""
        return [
            place
            for place in map(tuple, np.argwhere(bad).tolist())
            if place not in self.lost or self.lost[place].step > after
        ]

    def _lose(self, errors: Mapping[tuple[int, ...], NotFinite]) -> None:
        """Continue without some copies; raise the error of the first one if more are lost than tolerated."""
        # keep the earlier error, so that the result does not depend on chunks
        for place, error in errors.items():
            if place not in self.lost or error.step < self.lost[place].step:
                self.lost[place] = error
        if len(self.lost) > self.tolerated:
            raise next(iter(self.lost.values()))

    def _report(self, before: ProgramState, used: int) -> None:
        """Find the first step at which a value was not finite, and raise."""
        step, names = self._search(before, used, [...])[...]
        self._go(before, step - 1)
        raise not_finite(self._without_state(...) or names, self.clock.after(1), self.doc.time_unit)

    def _go(self, before: ProgramState, steps: int) -> None:
        """Set the state and the clock to a step within a chunk, from the state at its start."""
        chunk, _ = self.program.chunk(())
        self.state, _, _ = self._call(chunk, before, {"head": steps, "every": 0, "records": 0})
        self.clock = self.clock.after(steps)

    def _diverged(
        self, before: ProgramState, used: int, copies: Sequence[tuple[int, ...]]
    ) -> dict[tuple[int, ...], NotFinite]:
        """Return for each of these copies an error with the first step at which a value was not finite."""
        bad_steps = self._search(before, used, copies)
        out: dict[tuple[int, ...], NotFinite] = {}
        state, clock = self.state, self.clock
        for step in sorted({step for step, _ in bad_steps.values()}):
            self._go(before, step - 1)
            for copy, (first, names) in bad_steps.items():
                if first == step:
                    out[copy] = not_finite(
                        self._without_state(copy) or names, self.clock.after(1), self.doc.time_unit
                    )
            self.state, self.clock = state, clock
        return {copy: out[copy] for copy in copies}

    def _search(
        self, before: ProgramState, used: int, copies: Sequence[CopyIndex]
    ) -> dict[CopyIndex, tuple[int, list[str]]]:
        """Return for each copy the first step after which a value was not finite, and the elements.

        Steps are counted from the start of a chunk.
        """
        chunk, _ = self.program.chunk(())

        def bad(n: int) -> list[np.ndarray]:
            _, _, finite = self._call(chunk, before, {"head": n, "every": 0, "records": 0})
            return [~hosts.gathered(f) for f in finite[1]]

        groups = self.program.plan.groups
        bad_steps = first_steps(bad, 0, max(used, 1), copies)
        return {
            copy: (n, [self._path(node) for g, r in rows for node in [groups[g].nodes[r]]])
            for copy, (n, rows) in bad_steps.items()
        }

    def _without_state(self, copy: tuple[int, ...] | EllipsisType) -> list[str]:
        """Return the first elements without a state whose output is not finite now in a copy (`...`: in any).

        They are the cause of non-finite states that read them.
        """
        plan = self.program.plan
        groups = list(
            dict.fromkeys(
                c.group
                for c in plan.calls
                if c.role == "output" and not plan.groups[c.group].like.element.stateful
            )
        )
        ports = [
            Port(g, r, next(iter(plan.groups[g].like.outs)))
            for g in groups
            for r in range(plan.groups[g].rows)
        ]
        values = zip(ports, self.read(ports) if ports else [], strict=True)
        bad = {(p.group, p.row): not np.isfinite(value[copy]).all() for p, value in values}
        for g in groups:
            names = [self._path(n) for r, n in enumerate(plan.groups[g].nodes) if bad[g, r]]
            if names:
                return names
        return []

    def require_finite(self, ports: Sequence[Port], samples: Sequence[np.ndarray], every: int) -> None:
        """Raise NotFinite for records that are not finite although all states are: outputs of couplings."""
        lead = len(self.program.batch.shape)
        for port, values in zip(ports, samples, strict=True):
            good = np.isfinite(values)
            if good.all():
                continue
            node = self.program.plan.groups[port.group].nodes[port.row or 0]
            if port.name in node.element.undefined():
                good |= np.isnan(values)
            if not good.all():
                spoilt = np.asarray(~good.reshape(*values.shape[: lead + 1], -1).all(-1))
                end = self.clock.tick - (values.shape[lead] - 1) * every
                name = f"{self._path(node)}.{port.name}"

                def error(when: np.ndarray, name: str = name, end: int = end) -> NotFinite:
                    return not_finite(
                        [name],
                        dc.replace(self.clock, tick=end + int(np.argmax(when)) * every),
                        self.doc.time_unit,
                    )

                if not self._keeps_others():
                    raise error(np.asarray(spoilt.reshape(-1, values.shape[lead]).any(0)))
                self._lose({copy: error(spoilt[copy]) for copy in self._new(np.asarray(spoilt.any(-1)), end)})

    def _require_finite_world(self, before: ProgramState, state: ProgramState, used: int) -> None:
        """Raise NotFinite if a world inside the step has sensor values that are not finite.

        Without this check the error would appear later, in an element of the model.
        """
        if (
            not self.exchange.inside
            or "world" not in state
            or all(np.isfinite(a).all() for a in jax.tree.leaves(state["world"]["now"]))
        ):
            return
        chunk, _ = self.program.chunk(())
        sensors, shape = list(state["world"]["now"]), self.program.batch.shape

        def bad(n: int) -> list[np.ndarray]:
            after, _, _ = self._call(chunk, before, {"head": n, "every": 0, "records": 0})
            assert "world" in after
            sensed = after["world"]["now"]
            return [~np.isfinite(sensed[name]).reshape(*shape, -1).all(-1, keepdims=True) for name in sensors]

        def error(step: int, rows: RowSpans) -> NotFinite:
            clock, names = self.clock.after(step), [sensors[k] for k, _ in rows]
            return NotFinite(
                f"{', '.join(names)} of the world {type(self.world).__name__} became infinite or undefined in"
                f" step {clock.tick} (time {clock.time:g} {self.doc.time_unit})",
                names,
                fix="Check the elements that drive its motors",
                step=clock.tick,
            )

        if not self._keeps_others():
            raise error(*first_steps(bad, 0, max(used, 1), [...])[...])
        spoilt = np.any(
            [~np.isfinite(value).reshape(*shape, -1).all(-1) for value in state["world"]["now"].values()],
            axis=0,
        )
        bad_steps = first_steps(bad, 0, max(used, 1), self._new(spoilt, self.clock.tick))
        self._lose({copy: error(step, rows) for copy, (step, rows) in bad_steps.items()})

    def _path(self, node: Node) -> str:
        """Return the path of a node in the present document, where it may have been renamed."""
        entry = self.doc.by_id().get(node.id)
        return entry.path if entry is not None else node.path


def require_step(doc: Document, dt: float) -> None:
    """Raise TimeError for a step longer than an element allows.

    With such a step the Euler method would be inaccurate or diverge.
    """
    if not 0 < (real(dt) or 0) < math.inf:
        raise TimeError(f"dt is {show(dt)}; expected a number above 0, in {doc.time_unit}")
    if abs(doc.t0) / dt > MOST_STEPS:
        raise TimeError(
            f"time {doc.t0:g} {doc.time_unit} is {abs(doc.t0) / dt:.3g} steps of dt = {dt:g} from time 0;"
            f" times are exact up to {MOST_STEPS:.3g}",
            where="t0",
            fix="Start at a time nearer to 0, or take a larger dt",
        )
    for e in doc.entries:
        for problem in e.too_long(dt, doc.time_unit):
            raise TimeError([problem])


def require_duration(duration: float, what: str) -> float:
    """Return a duration as a float; raise TimeError unless it is finite and 0 or above."""
    number = real(duration)
    if number is None or not 0 <= number < math.inf:
        raise TimeError(f"{what} is {show(duration)}; expected a number, 0 or above")
    return number


def whole(duration: float, dt: float, what: str) -> int:
    """Return the number of steps of dt in a duration; raise TimeError unless it is a whole number."""
    duration = require_duration(duration, what)
    n = duration / dt
    if n > MOST_STEPS:
        raise TimeError(
            f"{what} of {duration:g} is {n:.3g} steps of dt = {dt:g}; at most {MOST_STEPS:.3g} can be counted"
        )
    if abs(n - round(n)) > 1e-6 + 1e-14 * n:
        neighbours = [k * dt for k in (int(n), int(n) + 1)]
        raise TimeError(
            f"{what} of {duration:g} is not a multiple of dt = {dt:g}",
            fix=f"Use {neighbours[0]:g} or {neighbours[1]:g}",
        )
    if duration > 0 and round(n) == 0:
        raise TimeError(f"{what} of {duration:g} is shorter than a step of dt = {dt:g}", fix=f"Use {dt:g}")
    return round(n)


def gaps(every: Sequence[float | None], dt: float) -> list[int]:
    """Return the steps between two samples for each interval; None: every step."""
    counts = [1 if time is None else whole(time, dt, "every") for time in every]
    if 0 in counts:
        raise TimeError("every is 0; expected at least one step")
    return counts


def require_sampled(every: float | None, gap: int, steps: int, dt: float) -> None:
    """Raise TimeError for a stated interval between samples that is longer than the whole run."""
    if every is not None and gap > steps > 0:
        raise TimeError(
            f"every is {every:g}, and the run lasts {steps * dt:g}, so only its start would be recorded",
            fix=option("Take at most", "every", f"{steps * dt:g}"),
        )


def host(tree: PyTree) -> PyTree:
    """Copy a PyTree of arrays to the host."""
    return jax.tree.map(lambda a: np.array(hosts.gathered(a)), tree)
