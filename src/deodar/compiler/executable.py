"""Executables of one model, compiled ahead of time, so that a run does not trace.

One executable runs any number of steps: the numbers of steps and records are arguments, not part of the
program.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
import functools
import time
from collections.abc import Callable, Generator, Hashable, Mapping, Sequence
from typing import Any, TypeVar, cast

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from jax.core import Tracer
from jax.sharding import Sharding
from jax.stages import Compiled, Traced

from deodar.compiler import cache, host, hosts
from deodar.compiler.arguments import (
    EitherArray,
    NoiseKeys,
    ProgramArguments,
    ProgramClock,
    ProgramState,
    ProgramValues,
    packed,
    unpacked,
)
from deodar.compiler.body import batched
from deodar.compiler.build import Build
from deodar.compiler.device import Device
from deodar.compiler.division import DividedCopies, Division
from deodar.compiler.functions import Constants, Replacements
from deodar.compiler.leaf_layout import LeafLayout
from deodar.compiler.plan import Plan, plan
from deodar.compiler.program import BEGUN, Chunk, Port, Program, precision_context
from deodar.compiler.shard import DividedFields
from deodar.element import Arrays
from deodar.errors import TrustFix, Untrusted
from deodar.kind_errors import leaked
from deodar.leaves import parameter_values
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.model.kind_contract import errors_in
from deodar.model.model import Model
from deodar.numerics import native
from deodar.numerics.axes import Axes, shape
from deodar.numerics.pytree import PyTree
from deodar.parameters import FrozenArray
from deodar.worlds._base import World
from deodar.worlds._failure import errors_of
from deodar.worlds._pure import PureWorld

Result = TypeVar("Result")

OneCopy = Callable[[ProgramValues, list[Constants], ProgramState, NoiseKeys], Result]
"""A function of one copy of a model."""

TrialNumbers = Sequence[int] | Sequence[Sequence[int]]
"""The number of each trial, by which it draws noise; with `Batch.own_noise` for each point."""

Stepped = tuple[Array, ProgramState, Arrays, Arrays]
"""Tick, state, the noise drawn for two ticks, and what follows from the latest readings of the world."""

Inner = tuple[Array, list[Arrays], dict[str, Arrays], Arrays, Arrays]
"""Tick, state of the groups, states that are held, commands of motors, and the noise drawn for two ticks."""

Recorded = tuple[Stepped, tuple[Array, ...]]
"""What steps carry, and a buffer of records for each port."""

ChunkResult = tuple[ProgramState, tuple[Array, ...], tuple[Array, list[Array]]]
"""The state after a chunk, the records of each port, and the result of `Program.finite`."""

MOST_KEPT = 16
"""Most executables that one model keeps; the oldest are dropped first."""

SHARED_BYTES = 8 * 2**20
"""Arrays among the parameters, in bytes, beyond which an executable belongs to its model alone: it holds
them.
"""

RARELY: cache.CompilerOptions = {"xla_backend_optimization_level": 0}
"""Options for functions that run once, or when a width changes, where `host` does not support them: they
compile in half the time.
"""

BUFFER_BYTES = 16 * 2**20
"""Size of the recording buffer of a chunk."""


class Executable:
    """The compiled functions of one document structure, precision and batch.

    Attributes:
        plan: the plan they compute.
        device: where they run; of several devices the first that belongs to this host.
        distribution: the devices among which a program is divided; None: it runs on one.
        across: whether these devices belong to several hosts.
        division: how it is divided among them.
        fields: the same, if the fields of one copy are divided.
        part: the copies that one device computes.
        kernels: the compiled kernels that it calls, if there are any.
        traced: how many functions were traced so far; running does not change it.
        compiled: how many of them were not found in the cache.
        seconds: CPU time spent on planning, tracing and compiling.
    """

    def __init__(self, build: Build) -> None:
        began = time.process_time()
        batch, body, fields = build.batch, build.body, build.fields
        self.batch, self.body, self.part = batch, body, build.part
        self.distribution, self.device, self.precision = build.distribution, build.device, build.precision
        self.across = self.distribution is not None and self.distribution.across
        self.kernels = build.kernels
        self.plan: Plan = plan(build)
        self.fields = fields and DividedFields(fields, self.plan, np.dtype(self.precision).itemsize)
        self.layout = LeafLayout(self.plan, self.precision, batch.sweep)
        # a block of two deviates is drawn in one branch for all copies, unless a kernel contains the branch
        alike = self.kernels is not None or batch.restarts % 2 == 0
        self.program = Program(
            self.plan,
            self.precision,
            self.layout.swept,
            body,
            copies=self.part.size if self.device.platform == "cpu" and alike else 0,
            replaced=Replacements(self.kernels, self.fields and self.fields.tapped, build.plain),
            pictures=body is None and batch.points is None and self.distribution is None,
        )
        self.division: Division | None = self.fields
        if self.distribution is not None and self.fields is None:
            self.division = DividedCopies(self.distribution, batch, self.program.rebuilt)
        self.traced = 0
        self.compiled = 0
        self.seconds = 0.0
        self._compiled_parts: dict[Hashable, Any] = {}
        values: ProgramValues = self.values(build.doc)
        self._example: ProgramArguments | None = None
        self._prepare, constants = self.once(self.program.prepare, values)
        numbers = np.zeros(batch.numbered, np.uint32)
        self._init, (state, keys) = self.once(self._start, values, np.uint32(0), numbers)
        self._example = self._forms(values, constants, state, keys)
        if self.fields is not None:
            self.fields.require(self.chunk(())[0].as_text() or "")
        self.seconds = time.process_time() - began

    def _forms(
        self, values: ProgramValues, constants: list[Constants], state: ProgramState, keys: NoiseKeys
    ) -> ProgramArguments:
        """Return the shapes, types and places of the arguments of a chunk."""
        if self.body is not None:
            with errors_of(self.body.world, "reset"):
                self.body.world.reset(0, [0] * self.batch.size, self.precision)
            shared, state, keys = self.embodied(self.body.world, state, keys)
            values = {**values, "world": shared}
        sensed = {**self.blind(), **self.program.unseen()}
        clock = packed({"period": 1}, self.program.dtype)
        example = ProgramArguments(values, constants, state, keys, sensed, *clock)
        if self.division is None:
            return jax.tree.map(_form, example)
        return jax.tree.map(_form, example, self.division.shardings(example))

    # ------------------------------------------------------------------------------------------------- values

    def values(self, doc: Document, swept: Sequence[np.ndarray] | None = None) -> ProgramValues:
        """The parameters of a document of this structure, on the host."""
        return self.layout.values(doc, self.batch.points or 1, swept)

    # ---------------------------------------------------------------------------------------------- functions

    def prepare(self, values: ProgramValues) -> list[Constants]:
        """Return the constants of the groups."""
        return self._placed(self.call(self._prepare, values), "constants")

    def embodied(
        self, world: World, state: ProgramState, keys: NoiseKeys
    ) -> tuple[Arrays, ProgramState, NoiseKeys]:
        """What all copies share of a world inside the step, which has begun, and state and keys with what
        each has of it.
        """
        body = self.body
        assert body is not None and isinstance(world, PureWorld)
        shared, world_copies, now = world.parts()
        joined = world.call(
            body.reads,
            lambda of: jax.vmap(dc.replace(body, world=of).begin, in_axes=(None, 0, 0)),
            shared,
            world_copies,
            now,
        )
        return (
            shared,
            {**state, "world": batched(joined, self.batch.shape)},
            {**keys, "world": batched(world_copies, self.batch.shape)},
        )

    def init(self, values: ProgramValues, seed: int, trials: TrialNumbers) -> tuple[ProgramState, NoiseKeys]:
        """Return the state at the start and the noise keys, for the given trials of a seed."""
        state, keys = self.call(self._init, values, np.uint32(seed), np.asarray(trials, np.uint32))
        return self._placed(state, "state"), self._placed(keys, "keys")

    def _placed(self, tree: Result, part: str) -> Result:
        """Return arrays on the devices where a part of the arguments is expected."""
        if self.division is None or self._example is None:
            return tree
        forms: PyTree = getattr(self._example, part)
        forms_of_tree = {key: forms[key] for key in tree} if isinstance(tree, dict) else forms
        with precision_context(self.precision):
            return jax.tree.map(lambda a, form: hosts.placed(a, form.sharding), tree, forms_of_tree)

    def chunk(self, ports: Sequence[Port], most: int | None = None) -> tuple[Compiled, int]:
        """Return the executable that steps and records, and the capacity of its buffer in records.

        `most` bounds the capacity: a chunk of few steps should not fill a large buffer.
        """
        key = ("chunk", tuple(ports), most)
        if key not in self._compiled_parts:
            capacity = min(self.capacity(ports), most or 2**31)
            chunk = self._divided(lambda *a: self._chunk(ports, capacity, ProgramArguments(*a)))
            self._compiled_parts[key] = (chunk, capacity)
        return self._compiled_parts[key]

    def reader(self, ports: Sequence[Port]) -> Compiled:
        """Return the executable that reads ports of a state."""
        key = ("read", tuple(ports))
        if key not in self._compiled_parts:
            self._compiled_parts[key] = self.new_reader(ports)
        return self._compiled_parts[key]

    def new_reader(self, ports: Sequence[Port]) -> Compiled:
        """The same, for a caller that keeps it itself."""
        return self._divided(lambda *a: self._read(ports, ProgramArguments(*a)))

    def _divided(self, function: Callable[..., Any]) -> Compiled:
        """Compile a function of the arguments of a program, divided among the devices."""
        assert self._example is not None
        whole = function if self.division is None else self.division.divided(function)
        return self.compile(whole, *self._example)[0]

    def look(
        self, values: ProgramValues, constants: list[Constants], sensed: Mapping[str, EitherArray]
    ) -> Arrays:
        """Return what follows from pictures among the readings, as a further part of them."""
        if not self.program.picture_calls:
            return {}
        if "look" not in self._compiled_parts:
            assert self._example is not None
            example = self._example
            readings = {ident: example.sensed[ident] for ident in self.program.pictures}
            self._compiled_parts["look"] = self.compile(
                lambda values, *others: self.program.look(_unswept(values), *others),
                example.values,
                example.constants,
                readings,
            )[0]
        readings = {ident: sensed[ident] for ident in self.program.pictures}
        return self.call(self._compiled_parts["look"], values, constants, readings)

    def call(self, executable: Callable[..., Any] | Compiled, *args: Any) -> Any:
        """Run an executable in the precision it was compiled for."""
        with precision_context(self.precision):
            if not self.across or not isinstance(executable, Compiled):
                return executable(*args)
            assert self.distribution is not None
            hosts.connect(self.distribution.devices)
            with hosts.calling(True):
                return executable(*jax.tree.map(_argument, args, executable.input_shardings[0]))

    def port(self, ident: str, name: str) -> Port:
        """Return the port of an element in the program."""
        g, r = self.plan.row[ident]
        return Port(g, r, name)

    def axes(self, port: Port) -> Axes:
        """Return the axes of a port."""
        node = self.plan.groups[port.group].like
        return node.outs[port.name] if port.name in node.outs else node.ins[port.name]

    def capacity(self, ports: Sequence[Port]) -> int:
        """Return the number of records that fit into the buffer of one chunk."""
        cells = sum(int(np.prod(shape(self.axes(p)), dtype=int)) for p in ports) * self.batch.size
        return max(1, min(16384, BUFFER_BYTES // max(1, cells * self.program.dtype.itemsize)))

    # ------------------------------------------------------------------------------------------------- traced

    def _start(self, values: ProgramValues, seed: Array, trials: Array) -> tuple[ProgramState, NoiseKeys]:
        of_trial = self.program.init
        if self.batch.trials is not None:
            many = jax.vmap(of_trial, in_axes=(None, None, 0))
        else:

            def many(values: ProgramValues, seed: Array, trial: Array) -> tuple[ProgramState, NoiseKeys]:
                return of_trial(values, seed, trial[0])

        if self.batch.points is None:
            state, keys = many(_unswept(values), seed, trials)
        else:
            seed_axis = 0 if self.batch.own_noise else None
            of_points = jax.vmap(many, in_axes=(self._swept_axes(values), None, seed_axis))
            state, keys = of_points(values, seed, trials)
        if self.batch.restarts:
            keys = {**keys, BEGUN: jnp.zeros(self.batch.shape, jnp.uint32)}
        return state, keys

    def _chunk(self, ports: Sequence[Port], capacity: int, arguments: ProgramArguments) -> ChunkResult:
        clock = unpacked(arguments.whole, arguments.real)

        def one_copy(
            values: ProgramValues, constants: list[Constants], state: ProgramState, keys: NoiseKeys
        ) -> ChunkResult:
            return self._run(
                ports, capacity, self._begin(values, constants, keys, arguments.sensed, clock), state
            )

        return self._batched(one_copy, arguments)

    def _read(self, ports: Sequence[Port], arguments: ProgramArguments) -> tuple[Array, ...]:
        clock = unpacked(arguments.whole, arguments.real)

        def one_copy(
            values: ProgramValues, constants: list[Constants], state: ProgramState, keys: NoiseKeys
        ) -> tuple[Array, ...]:
            chunk = self._begin(values, constants, keys, arguments.sensed, clock)
            return self.program.observe(ports, chunk, state, clock["tick"])

        return self._batched(one_copy, arguments)

    def _begin(
        self,
        values: ProgramValues,
        constants: list[Constants],
        keys: NoiseKeys,
        sensed: Mapping[str, EitherArray],
        clock: ProgramClock,
    ) -> Chunk:
        """Return the values that are constant during a chunk of one copy."""
        if BEGUN in keys:
            clock = cast("ProgramClock", {**clock, "origin": keys[BEGUN]})
        constants = self.program.hoist(values, constants)
        still = self.program.steady(values, constants, sensed)
        return Chunk(values, constants, keys, sensed, clock, still)

    def _batched(self, of_copy: OneCopy[Result], arguments: ProgramArguments) -> Result:
        values, constants, state, keys = arguments[:4]
        if self.part.trials == 1:
            of_copy = _alone(of_copy)
        elif self.part.trials is not None:
            # also for models without state and noise
            of_copy = jax.vmap(of_copy, in_axes=(None, None, 0, 0), axis_size=self.part.trials)
        if self.batch.points is None:
            return of_copy(_unswept(values), constants, state, keys)
        rebuilt = [0 if swept else None for swept in self.program.rebuilt]
        return jax.vmap(of_copy, in_axes=(self._swept_axes(values), rebuilt, 0, 0))(
            values, constants, state, keys
        )

    def _swept_axes(self, values: ProgramValues) -> PyTree:
        return {**dict.fromkeys(values), "swept": tuple(0 for _ in values["swept"])}

    def _run(self, ports: Sequence[Port], capacity: int, chunk: Chunk, state: ProgramState) -> ChunkResult:
        """`head` steps, a record, then `every` steps and a record until there are `records`; without ports
        `head` steps.
        """
        program, clock = self.program, chunk.clock
        head, every, records = (clock[name].astype(jnp.int32) for name in ("head", "every", "records"))
        leaves_of, tree = jax.tree.flatten(state)
        shapes = [leaf.shape for leaf in leaves_of]

        def full(flat: ProgramState) -> ProgramState:
            return jax.tree.unflatten(
                tree, [a.reshape(s) for a, s in zip(jax.tree.leaves(flat), shapes, strict=True)]
            )

        # between steps arrays have one axis: loops over a short last axis cost up to three times as much
        def flat(state: ProgramState) -> ProgramState:
            if self.fields is not None:
                # without the axis of a single row a step replaces the state in place; with it, it is copied
                rows = jax.tree.map(lambda a: a[0] if a.shape[0] == 1 else a, state)
                return self.fields.constrained(rows)
            return jax.tree.map(lambda a: a.reshape(a.shape[0], -1) if a.shape[0] > 1 else a.ravel(), state)

        def steps(n: Array, start: Stepped) -> Stepped:
            # the tick is the only counter: XLA runs more than eight operations by a scheduler, which takes
            # 0.3 us of a step
            end = start[0] + n.astype(jnp.uint32)

            def one_step(carry: Stepped) -> Stepped:
                tick, state, drawn, perceived = carry
                drawn = program.draw(chunk.keys, tick, clock["tick"], drawn)
                now = full(state)
                perceived = program.perceive(chunk, now, tick, clock["tick"], perceived)
                new = program.step(chunk, now, drawn, tick, perceived)
                tick += jnp.uint32(1)
                return tick, flat(program.advance(chunk, new, tick)), drawn, perceived

            def period(carry: Stepped) -> Stepped:
                """Advance to the next exchange with the world, or to the end.

                What changes only in an exchange is constant in the inner loop; as the result of a branch it
                would be copied in each step.
                """
                tick, state, drawn, perceived = carry
                perceived = program.perceive(chunk, full(state), tick, clock["tick"], perceived)
                stop = tick + jnp.minimum(end - tick, clock["period"] - tick % clock["period"])
                assert "world" in state
                world = state["world"]

                def inner_step(carry: Inner) -> Inner:
                    tick, groups, held, commands, drawn = carry
                    drawn = program.draw(chunk.keys, tick, clock["tick"], drawn)
                    now = full({"groups": groups, "held": held, "world": {**world, "commands": commands}})
                    new = flat(program.step(chunk, now, drawn, tick, perceived))
                    assert "world" in new
                    return tick + jnp.uint32(1), new["groups"], new["held"], new["world"]["commands"], drawn

                begun = tick, state["groups"], state["held"], world["commands"], drawn
                tick, groups, held, commands, drawn = lax.while_loop(
                    lambda c: c[0] != stop, inner_step, begun
                )
                now = full({"groups": groups, "held": held, "world": {**world, "commands": commands}})
                return tick, flat(program.advance(chunk, now, tick)), drawn, perceived

            nested = program.body is not None and program.body.holds
            return lax.while_loop(lambda carry: carry[0] != end, period if nested else one_step, start)

        begun = clock["tick"], flat(state), program.undrawn(), program.unperceived()
        if not ports:
            state = self._parts(full(steps(head, begun)[1]))
            return state, (), program.finite(state)
        buffers = tuple(jnp.zeros((capacity, *shape(self.axes(p))), program.dtype) for p in ports)
        buffers = self._recorded(ports, buffers)

        def segment(r: Array, carry: Recorded) -> Recorded:
            stepped, buffers = carry
            stepped = steps(jnp.where(r == 0, head, every), stepped)
            seen = program.observe(ports, chunk, full(stepped[1]), stepped[0])
            return (
                stepped,
                tuple(
                    lax.dynamic_update_index_in_dim(b, s, r, 0) for b, s in zip(buffers, seen, strict=True)
                ),
            )

        (_, state, *_), buffers = lax.fori_loop(0, records, segment, (begun, buffers))
        state = self._parts(full(state))
        return state, self._recorded(ports, buffers), program.finite(state)

    def _parts(self, state: ProgramState) -> ProgramState:
        return state if self.fields is None else self.fields.constrained(state)

    def _recorded(self, ports: Sequence[Port], values: tuple[Array, ...]) -> tuple[Array, ...]:
        if self.fields is None:
            return values
        pairs = zip(ports, values, strict=True)
        return tuple(self.fields.recorded(p.group, p.name, a) for p, a in pairs)

    # ---------------------------------------------------------------------------------------------- compiling

    def compile(
        self, function: Callable[..., Any], *args: Any, options: cache.CompilerOptions | None = None
    ) -> tuple[Compiled, PyTree]:
        """The executable of a function for arguments of these shapes, and the shapes of what it returns."""
        with self._settings():
            places = (self.device,) if self.distribution is None else self.distribution.devices
            return self._compiled(self._traced(function, *args), options, places)

    def once(self, function: Callable[..., Any], *args: Any) -> tuple[Callable[..., Any], PyTree]:
        """The same for a function that runs once, or when a width changes: evaluated with NumPy where that is
        possible, else compiled.
        """
        with self._settings():
            traced = self._traced(function, *args)
            if host.supports(traced.jaxpr.jaxpr):
                return self._evaluated(traced), traced.out_info
            return self._compiled(traced, RARELY, (self.device,))

    @contextlib.contextmanager
    def _settings(self) -> Generator[None]:
        """Trace and compile for the device and the precision, and add the CPU time to `seconds`."""
        began = time.process_time()
        # full precision of products: otherwise some processors multiply with fewer digits (TF32)
        with (
            precision_context(self.precision),
            jax.default_device(self.device),
            jax.default_matmul_precision("highest"),
        ):
            yield
        self.seconds += time.process_time() - began

    def _traced(self, function: Callable[..., Any], *args: Any) -> Traced:
        self.traced += 1
        # unused arguments stay: two programs that differ in which argument they use must not look alike to
        # the cache
        traced = jax.jit(function, keep_unused=True).trace(*args)
        # JAX finds a traced value of an earlier program when the program is called, and not whose it is
        if any(isinstance(constant, Tracer) for constant in getattr(traced, "_consts", ())):
            raise leaked({group.like.path: group.like.element for group in self.plan.groups})
        return traced

    def _compiled(
        self, traced: Traced, options: cache.CompilerOptions | None, places: Sequence[Device]
    ) -> tuple[Compiled, PyTree]:
        executable, fresh = cache.compile(
            traced.lower(),
            {**cache.options(self.device), **(options or {})},
            places[0],
            native.version(self.kernels),
            places[1:],
        )
        self.compiled += fresh
        return executable, traced.out_info

    def _evaluated(self, traced: Traced) -> Callable[..., Any]:
        function, tree = traced.jaxpr, jax.tree.structure(traced.out_info)

        def evaluate(*args: Any) -> Any:
            results = jax.tree.unflatten(tree, host.evaluate(function, jax.tree.leaves(args)))
            return results if self.division is not None else jax.device_put(results, self.device)

        return evaluate

    def blind(self) -> dict[str, np.ndarray]:
        """Return the readings of sensors without a world: zeros."""
        out: dict[str, np.ndarray] = {}
        for ident in self.plan.sensors:
            g, _ = self.plan.row[ident]
            out[ident] = np.zeros(shape(self.plan.groups[g].like.outs["output"]), self.program.dtype)
        return out


def _argument(a: Any, sharding: Sharding) -> Any:
    """Return an argument where a program of several hosts expects it; JAX places what all devices have."""
    return a if sharding.is_fully_replicated else hosts.placed(a, sharding)


def _unswept(values: ProgramValues) -> ProgramValues:
    return {**values, "swept": ()}


def _form(a: Array, sharding: Sharding | None = None) -> jax.ShapeDtypeStruct:
    """Shape, type and place of an array: all that compiling asks for, so that an executable keeps no state
    alive.
    """
    return jax.ShapeDtypeStruct(a.shape, a.dtype, sharding=sharding)


def _alone(of_copy: OneCopy[Result]) -> OneCopy[Result]:
    """The function of one trial as that of a batch of one: it has the bits of a single run."""

    def single(
        values: ProgramValues, constants: list[Constants], state: ProgramState, keys: NoiseKeys
    ) -> Result:
        out = of_copy(values, constants, *jax.tree.map(lambda a: a[0], (state, keys)))
        return jax.tree.map(lambda a: jnp.asarray(a)[None], out)

    return single


def executable(model: Model, build: Build) -> Executable:
    """Return the program of a build; the model keeps it, so that it compiles once."""
    require_trust(model, build.doc)
    if build.doc is model.document:
        model.require()  # which names the lines of a script
    graph(build.doc).required()
    with errors_in(build.doc):
        return _executable(model, build)


def _executable(model: Model, build: Build) -> Executable:
    program = model.programs.get(build.key)
    if program is None:
        while len(model.programs) >= MOST_KEPT:
            model.programs.pop(next(iter(model.programs)), None)  # another thread may have dropped it
        program = _shared(build) if _bytes(build.doc) <= SHARED_BYTES else Executable(build)
        model.programs[build.key] = program
    return program


@functools.lru_cache(maxsize=48)
def _shared(build: Build) -> Executable:
    """The executable of all models of this process that ask for the same: one that is built again, as by a
    notebook cell, compiles nothing.
    """
    return Executable(build)


def _bytes(doc: Document) -> int:
    """Return the size in bytes of the arrays among the parameters of a document."""
    leaves = (leaf for e in doc.entries for _, leaf in parameter_values(e.element))
    return sum(leaf.data.nbytes for leaf in leaves if isinstance(leaf, FrozenArray))


def require_trust(model: Model, doc: Document) -> None:
    """Raise an error if a document from another source refers to a function and is not trusted."""
    if model.trusted:
        return
    for e in doc.entries:
        name = e.element.external_code()
        if name:
            raise Untrusted(
                f"the document asks to run the function {name!r}",
                where=e.path,
                fix=TrustFix(
                    "If you trust it: dd.load(file, trust=True); after unpickling"
                    " dd.Model(document=model.document, trusted=True)",
                    "If you trust it: --trust",
                    "Open it without them, or state your trust where the studio is started",
                ),
            )
