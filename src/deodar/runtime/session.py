"""The session: one running model, stepped by hand, by a clock or by a studio."""

from __future__ import annotations

import dataclasses as dc
from typing import Any

import numpy as np

from deodar.compiler.executable import Executable, executable
from deodar.compiler.plan import cost
from deodar.compiler.program import Port, array_key
from deodar.errors import ModelError, ParameterError, TimeError, UnknownName
from deodar.leaves import get, leaves, structure
from deodar.model import edit, find
from deodar.model.document import Document
from deodar.model.model import Model
from deodar.model.resolve import resolve
from deodar.parameters import FrozenArray, show
from deodar.runtime import memory
from deodar.runtime.run import Clock, Run, host, require_step, whole
from deodar.worlds._base import World

Tree = Any
LARGEST_SEED = 2**32 - 1


@dc.dataclass(frozen=True)
class Snapshot:
    """The whole state of a session at one moment: state, noise, time and parameters."""

    document: Document
    state: Tree
    keys: Tree
    clock: Clock
    seed: int


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

    Attributes:
        journal: every change of a parameter or of dt, every reset and restore, with its tick; with seed and document it repeats the
            session.
    """

    def __init__(
        self, model: Model, dt: float | None = None, seed: int = 0, precision: str = "float32", world: World | None = None, trial: int = 0
    ) -> None:
        self._model = model
        self._precision = precision
        self._coming_dt: float | None = None
        self.journal: list[Change] = []
        doc = require_model(model).document
        model.require()
        memory.require(resolve(doc)[0], precision, 1, 0)
        step = doc.step if dt is None else dt
        require_step(doc, step)
        self._run = Run(executable(model, doc, precision), doc, float(step), require_seed(seed), [require_seed(trial)], world)

    # -------------------------------------------------------------------------------- running

    def step(self, n: int = 1) -> None:
        """So many Euler steps."""
        if isinstance(n, bool) or not isinstance(n, (int, np.integer)) or n < 0:
            raise TimeError(f"a number of steps is a whole number, 0 or above, not {show(n)}")
        left = int(n)
        while left:
            left -= self._to_new_dt(left)
            if left:
                self._run.advance(left if self._coming_dt is None else 0)
                left = 0 if self._coming_dt is None else left

    def run(self, duration: float) -> None:
        """So much document time; a whole number of steps."""
        self.step(whole(duration, self._coming_dt or self.dt, "a duration"))

    def reset(self) -> None:
        """State, time and noise back to the start; parameters stay."""
        self.journal.append(Change(self.tick, "reset", 0))
        self._run.reset()

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
            self._run.clock = self._run.clock.at(self._coming_dt)
            self._coming_dt = None
        return taken

    # -------------------------------------------------------------------------------- looking and changing

    def read(self, path: str) -> np.ndarray:
        """What a port holds now: an array over the port's axes in their order, of shape () for a node."""
        return self._run.read([self._port(path)])[0]

    def get(self, path: str) -> Any:
        """The value of a parameter."""
        found = find.target(self.document, path)
        if found.entry is None:
            return next(k.value for k in self.document.knobs if k.name == found.knob)
        return get(found.entry.element, found.parameter)

    def set(self, path: str, value: Any) -> str:
        """Change a parameter from the next step on; states stay. Returns what it cost: live, rebuild or recompile."""
        found = find.target(self.document, path)
        if found.entry is None:
            doc = edit.knob(self.document, found.knob, value)
        else:
            doc = edit.put(self.document, found.entry.id, found.parameter, value)
        cost = self._adopt(doc)
        self.journal.append(Change(self.tick, path, _plain(value)))
        return cost

    def edit(self, document: Document) -> str:
        """Go on with another document; elements that stay (by id) keep their states."""
        cost = self._adopt(document)
        self.journal.append(Change(self.tick, "document", document.name))
        return cost

    def snapshot(self) -> Snapshot:
        """The whole state, to go back to."""
        return Snapshot(self.document, host(self._run.state), host(self._run.keys), self._run.clock, self._run.seed)

    def restore(self, snapshot: Snapshot) -> None:
        """Back to a snapshot, of this session or of another one of the same model."""
        self.journal.append(Change(self.tick, "restore", snapshot.clock.tick))
        if snapshot.document != self.document:
            self._adopt(snapshot.document)
        self._run.state, self._run.keys = snapshot.state, snapshot.keys
        self._run.clock, self._run.seed, self._run.read_at = snapshot.clock, snapshot.seed, -1
        self._coming_dt = None

    # -------------------------------------------------------------------------------- properties

    @property
    def document(self) -> Document:
        """The document with the parameters as they now are."""
        return self._run.doc

    @property
    def dt(self) -> float:
        """Euler step; a new one takes effect at the next tick common to all parts."""
        return self._run.clock.dt

    @dt.setter
    def dt(self, value: float) -> None:
        require_step(self.document, value)
        self._coming_dt = float(value)
        self.journal.append(Change(self.tick, "dt", float(value)))
        self._to_new_dt(0)

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
        return f"<Session of {self.document.name!r} at {self.time:g} {self.document.time_unit}, dt {self.dt:g}, seed {self.seed}>"

    def _repr_html_(self) -> str:
        d = self.document
        return f"<b>{d.name}</b>: time {self.time:g} {d.time_unit} (tick {self.tick}), dt {self.dt:g}, seed {self.seed}, {self.precision}"

    # -------------------------------------------------------------------------------- inside

    def _port(self, path: str) -> Port:
        entry, name = find.port(self.document, path)
        return self._run.program.port(entry.id, name)

    def _adopt(self, doc: Document) -> str:
        old, new = self.document, doc
        changed = _changed(old, new)
        if changed is not None and all(self._run.program.holds(leaf) for leaf, _, _ in changed):
            require_step(new, self.dt)
            return self._change(new, changed)
        require_step(new, self.dt)
        program = executable(self._model, new, self._precision)
        self._migrate(program, new)
        return "recompile"

    def _change(self, doc: Document, changed: list[tuple[tuple[str, str], Any, str]]) -> str:
        """New values of leaves the program has: the vector, and `prepare` where they rebuild."""
        run = self._run
        vector, arrays = run.values["vector"].copy(), dict(run.values["arrays"])
        for leaf, value, _ in changed:
            if isinstance(value, np.ndarray):
                g, r = run.program.plan.row[leaf[0]]
                rows = arrays[array_key(g, leaf[1])].copy()
                rows[r] = value
                arrays[array_key(g, leaf[1])] = rows
            else:
                vector[run.program.place(leaf)] = value
        values = run.values | {"vector": vector, "arrays": arrays}
        costs = {cost for _, _, cost in changed}
        if "rebuild" in costs:
            run.constants = run.program.prepare(values)
        run.values, run.doc = values, doc
        return "rebuild" if "rebuild" in costs else "live"

    def _migrate(self, program: Executable, doc: Document) -> None:
        """Take over a new program: states are kept by id where their shapes are the same, others start anew."""
        run = self._run
        old_plan, old = run.program.plan, host(run.state)
        run.load(program, doc)
        fresh, run.keys = program.init(run.values, run.seed, run.trials)
        state = host(fresh)
        for ident, (g, r) in program.plan.row.items():
            if ident not in old_plan.row:
                continue
            og, orow = old_plan.row[ident]
            _copy_row(old["groups"][og], orow, state["groups"][g], r)
            if str(g) in state["held"]:
                source = old["held"].get(str(og), old["groups"][og])
                _copy_row(source, orow, state["held"][str(g)], r)
        run.state = state
        run.sensed, run.read_at = program.blind(), -1


def _copy_row(source: Tree, row: int, target: Tree, to: int) -> None:
    for name, values in source.items():
        if name in target and target[name].shape[1:] == values.shape[1:]:
            target[name][to] = values[row]


def _changed(old: Document, new: Document) -> list[tuple[tuple[str, str], Any, str]] | None:
    """Leaves with another value, and what each costs; None where more than leaves changed."""
    if old.connections != new.connections or [(e.id, e.every) for e in old.entries] != [(e.id, e.every) for e in new.entries]:
        return None
    out: list[tuple[tuple[str, str], Any, str]] = []
    for before, after in zip(old.entries, new.entries, strict=True):
        if before.element is after.element:
            continue
        if structure(before.element) != structure(after.element):
            return None
        was = {path: value for path, value, _ in leaves(before.element)}
        out += [((after.id, path), value, cost(p)) for path, value, p in leaves(after.element) if np.any(value != was[path])]
    return out


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else f"array {value.digest}" if isinstance(value, FrozenArray) else value


def require_model(model: Any) -> Model:
    """The model, refused if it is something else."""
    if not isinstance(model, Model):
        raise ModelError(f"{show(model)} is no model", fix="Build one with dd.Model(name), or read one with dd.load(file)")
    return model


def require_seed(seed: Any) -> int:
    """The seed (or trial) as a number, refused outside 0 to 2^32 - 1."""
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or not 0 <= seed <= LARGEST_SEED:
        raise ParameterError(f"a seed (or trial) is a whole number from 0 to 2^32 - 1, not {show(seed)}")
    return int(seed)


__all__ = ["Change", "Session", "Snapshot", "UnknownName"]
