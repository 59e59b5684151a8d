r"""The step of a document as pure functions, which everything that runs a model shares.

Sessions, records, trials and environments compile these functions for many steps (`Dynamics.compiled`);
gradients, continuation, maps, tuning and exporters call them.

Equation:
    x_{n+1} = \Phi(x_n, i_n;\; p, n, k),\qquad y_n = O(x_n, i_n;\; p, n, k),\qquad x_0 = \mathrm{init}(p, k)

where x is the state, i the inputs, p the parameters, n the tick (a uint32; the time is t0 + n dt) and k the
key: the seed and the trial, by which noise is drawn exactly as `simulate` draws it.

    prepared = d.prepare(parameters)
    state = d.init(parameters, key)
    state = d.step(prepared, state, inputs, tick, key)
    values = d.observe(prepared, state, inputs, tick, key, ports)

Arguments and results are PyTrees of arrays, so that `jit`, `grad`, `vmap` and `scan` of JAX apply:

    parameters: by path; a number for each scalar, and for an array parameter an array of its shape. In the
        units of their declarations.
    state: arrays over the axes of each element, elements of equal structure stacked; `Dynamics.named` gives
        them by path. A world inside the step is part of it.
    inputs: by path; of a sensor its reading over its axes, which is 0 where none is given; of a field or node
        what is added to its input during the step, as `Session.inject` adds it.
    key: as `Dynamics.key` makes it.

In double precision they are called inside `Dynamics.context()`, or with `jax_enable_x64`.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
from collections.abc import Generator, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.core import Tracer

from deodar.compiler.arguments import BodyState, NoiseKeys, ProgramState, ProgramValues, packed, unpacked
from deodar.compiler.build import Build
from deodar.compiler.copy_batch import Batch
from deodar.compiler.executable import Executable, executable
from deodar.compiler.functions import Constants
from deodar.compiler.program import Chunk, Port, Program, array_key, precision_context
from deodar.element import Arrays
from deodar.errors import ParameterError, UnknownName, WorldError, did_you_mean
from deodar.leaves import get
from deodar.model import find
from deodar.model.document import Document, Leaf
from deodar.model.model import Model
from deodar.model.unit import unit_seconds
from deodar.numerics.axes import shape
from deodar.numerics.exact import LOW
from deodar.parameters import FrozenArray
from deodar.summary import Summarised, Summary

ByPath = Mapping[str, Any]
"""Arrays or numbers by path: of parameters, or of inputs."""


class TrialKey(NamedTuple):
    """The key of a trial of a seed; a JAX PyTree.

    Attributes:
        noise: the words that key the noise of each element; the arrays that a world has for this trial.
        shared: arrays that a world inside the step has for all trials.
        world: the state of the world at the start; None without one.
    """

    noise: NoiseKeys
    shared: Arrays
    world: BodyState | None


class PreparedStep(NamedTuple):
    """What follows from parameters alone; a JAX PyTree.

    Attributes:
        values: the parameters.
        constants: kernels and other constants of each group.
        chunk: the same with the outputs that stay constant while no sensor reads anything.
    """

    values: ProgramValues
    constants: list[Constants]
    chunk: Chunk


@dc.dataclass(frozen=True, repr=False)
class Dynamics(Summarised):
    """The dynamics of a document in a precision, on a device, with a world inside the step or without.

    All runs get their programs here: those of sessions, records, trials and environments.

    Attributes:
        model: the model that keeps the programs.
        build: what the program is built from: the document of the model, or one made from it, with the Euler
            step and the time at tick 0; the precision, the device, and the world inside the step.
        drives: for each parameter of the pure functions the leaves that it drives.
        width: number of copies for which the pure functions choose their operations.
        plain: whether the pure functions do without compiled kernels, so that they have derivatives.
    """

    model: Model
    build: Build
    drives: Mapping[str, Sequence[Leaf]] = dc.field(default_factory=dict[str, Sequence[Leaf]])
    width: int = 1
    plain: bool = True

    def compiled(self, **changes: Any) -> Executable:
        """Return the program of the build, or of the build with changes; the model keeps it, so that it
        compiles once.
        """
        return executable(self.model, dc.replace(self.build, **changes))

    # ------------------------------------------------------------------------------------------ what they are

    @property
    def doc(self) -> Document:
        """The document."""
        return self.build.doc

    @property
    def precision(self) -> str:
        """Float32 or float64."""
        return self.build.precision

    @property
    def dt(self) -> float:
        """The Euler step, in document time."""
        return float(self.doc.step)

    @property
    def parameters(self) -> dict[str, np.ndarray]:
        """The present values of the parameters."""
        return dict(self._present)

    @cached_property
    def executable(self) -> Executable:
        """The program whose functions are called."""
        points = self.width if self.width > 1 else None
        sweep = tuple(tuple(self.drives[name]) for name in self._numbers)
        return self.compiled(batch=Batch(points=points, sweep=sweep), plain=self.plain)

    def context(self) -> contextlib.AbstractContextManager[None]:
        """Return the context in which the functions are called and traced: the precision of the model."""
        return precision_context(self.precision)

    def named(self, state: ProgramState) -> dict[str, Array]:
        """Return the arrays of a state by element and name, such as `u.activation`."""
        plan = self.executable.plan
        return {
            f"{entry.path}.{name}": rows[plan.row[entry.id][1]]
            for entry in self.doc.entries
            if entry.id in plan.row
            for name, rows in state["groups"][plan.row[entry.id][0]].items()
        }

    def replaced(self, state: ProgramState, arrays: ByPath) -> ProgramState:
        """Return a state with other arrays, by element and name as in `named`."""
        groups = [dict(group) for group in state["groups"]]
        places = {f"{e.path}.{n}": (e.id, n) for e in self.doc.entries for n in self._arrays_of(e.id, state)}
        for path, value in arrays.items():
            if path not in places:
                raise UnknownName(f"no state is called {path!r}", fix=did_you_mean(path, places))
            ident, name = places[path]
            g, r = self.executable.plan.row[ident]
            groups[g][name] = jnp.asarray(groups[g][name]).at[r].set(value)
        slow = {g: groups[int(g)] for g in state["held"]}
        return {**state, "groups": groups, "held": {**state["held"], **slow}}

    # ---------------------------------------------------------------------------------------- the functions

    def key(self, seed: Any = 0, trial: Any = 0) -> TrialKey:
        """Return the key of a trial.

        Args:
            seed: seed of all noise, 0 to 2^32 - 1.
            trial: number of the trial, 0 to 2^32 - 1; with a world both are numbers, since it begins on the
                host.
        """
        with self._traced() as program:
            if self.build.body is None:
                return TrialKey(program.keys(jnp.uint32(seed), jnp.uint32(trial)), {}, None)
            if isinstance(seed, Tracer) or isinstance(trial, Tracer):
                raise WorldError(
                    "a world begins on the host, for a seed and a trial that are numbers",
                    fix="Make the keys outside of jit, grad and vmap, and give them as arguments",
                )
            empty: ProgramState = {"groups": [], "held": {}}
            with jax.ensure_compile_time_eval():
                noise = program.keys(jnp.uint32(seed), jnp.uint32(trial))
                self.build.body.world.reset(int(seed), [int(trial)], self.precision)
                shared, state, noise = self.executable.embodied(self.build.body.world, empty, noise)
            assert "world" in state
            # outside of jit a world would index its arrays of the host by traced values
            return jax.tree.map(jnp.asarray, TrialKey(noise, shared, state["world"]))

    def constants(self, parameters: ByPath | None = None) -> list[Constants]:
        """Return the constants that only parameters that rebuild change, such as the weights of kernels.

        `prepare` accepts them, so that copies share those of the groups that are not `rebuilt`.
        """
        with self._traced() as program:
            return program.prepare_one(self._values(parameters))

    @property
    def rebuilt(self) -> list[bool]:
        """Whether the constants of each group depend on a parameter."""
        arrays = {self.executable.plan.row[ident][0] for ident, _ in self._arrays.values()}
        return [swept or g in arrays for g, swept in enumerate(self.executable.program.rebuilt)]

    def prepare(
        self, parameters: ByPath | None = None, constants: list[Constants] | None = None
    ) -> PreparedStep:
        """Return what follows from parameters alone: kernels, and outputs that stay constant.

        Args:
            parameters: values by path; those that are left out, or None, keep their present values.
            constants: what `constants` returned for these parameters; None: they are computed.
        """
        with self._traced() as program:
            values = self._values(parameters)
            group_constants = program.prepare_one(values) if constants is None else constants
            return PreparedStep(values, group_constants, self._chunk(program, values, group_constants, {}))

    def init(self, parameters: ByPath | None = None, key: TrialKey | None = None) -> ProgramState:
        """Return the state at tick 0.

        Args:
            parameters: values by path, as for `prepare`.
            key: key of the trial; None: that of seed 0 and trial 0.
        """
        trial_key = self.key() if key is None else key
        with self._traced() as program:
            state: ProgramState = jax.tree.map(jnp.asarray, program.begin(self._values(parameters)))
            if trial_key.world is not None:
                state["world"] = trial_key.world
            return state

    def step(
        self, prepared: PreparedStep, state: ProgramState, inputs: ByPath, tick: Any, key: TrialKey
    ) -> ProgramState:
        """Return the state at the next tick.

        Args:
            prepared: what `prepare` returned.
            state: the state at `tick`.
            inputs: readings of sensors, and what is added to inputs, by path.
            tick: number of steps since the start.
            key: key of the trial.
        """
        with self._traced() as program:
            readings, amounts = self._divided(inputs)
            chunk, tick = self._now(program, prepared, readings, key), jnp.uint32(tick)
            perceived = program.perceive(chunk, state, tick, tick, program.unperceived())
            new = program.step(chunk, state, {}, tick, perceived)
            groups = list(new["groups"])
            for ident, amount in amounts.items():
                g, r = self.executable.plan.row[ident]
                groups[g] = program.injected(g, r, chunk.values, groups[g], amount, self.dt)
            coming = tick + jnp.uint32(1)
            return program.advance(chunk, {**new, "groups": groups}, coming)

    def observe(
        self,
        prepared: PreparedStep,
        state: ProgramState,
        inputs: ByPath,
        tick: Any,
        key: TrialKey,
        ports: Sequence[str],
    ) -> dict[str, Array]:
        """Return the values of ports at a tick by path; the path of a field alone means its activation.

        Args:
            prepared: what `prepare` returned.
            state: the state at `tick`.
            inputs: readings of sensors by path; what is added to inputs is no part of a state.
            tick: number of steps since the start.
            key: key of the trial.
            ports: paths of the ports.
        """
        with self._traced() as program:
            readings, _ = self._divided(inputs)
            places = [self._place(path) for path in ports]
            chunk = self._now(program, prepared, readings, key)
            return dict(zip(ports, program.observe(places, chunk, state, jnp.uint32(tick)), strict=True))

    # ------------------------------------------------------------------------------------------------- inside

    @contextlib.contextmanager
    def _traced(self) -> Generator[Program]:
        """Return the program, in the context in which its functions are traced."""
        if self.precision == "float64" and jnp.result_type(float) != np.float64:
            raise ParameterError(
                "the functions compute in double precision, and JAX is set to single precision",
                fix="Call them inside `with dynamics.context():`, or set jax_enable_x64",
            )
        narrow = jax.enable_x64(False) if self.precision == "float32" else contextlib.nullcontext()
        with narrow, jax.default_matmul_precision("highest"):
            yield self.executable.program

    @cached_property
    def _arrays(self) -> dict[str, Leaf]:
        """The leaves of the parameters that are arrays."""
        return {
            name: leaves[0]
            for name, leaves in self.drives.items()
            if len(leaves) == 1 and isinstance(self._value(leaves[0]), FrozenArray)
        }

    @cached_property
    def _numbers(self) -> list[str]:
        """The parameters that are numbers."""
        return [name for name in self.drives if name not in self._arrays]

    def _value(self, leaf: Leaf) -> Any:
        return get(find.entry(self.doc, leaf[0]).element, leaf[1])

    @cached_property
    def _present(self) -> dict[str, np.ndarray]:
        def value(leaves: Sequence[Leaf]) -> Any:
            parameter = self._value(leaves[0]) if leaves else 0.0
            return parameter.data if isinstance(parameter, FrozenArray) else parameter

        return {name: np.asarray(value(leaves), self.precision) for name, leaves in self.drives.items()}

    @cached_property
    def _base(self) -> ProgramValues:
        return {**self.executable.values(self.doc), "swept": ()}

    def _values(self, parameters: ByPath | None) -> ProgramValues:
        """Return the parameters of the program."""
        replaced, present = {} if parameters is None else parameters, self._present
        for name in replaced:
            if name not in present:
                raise UnknownName(
                    f"{name!r} is no parameter of these dynamics",
                    fix=did_you_mean(name, present) if present else "Name it: dd.dynamics(model, [path])",
                )
        dtype = self.executable.program.dtype
        arguments = {
            name: jnp.asarray(value if (new := replaced.get(name)) is None else new, dtype)
            for name, value in present.items()
        }
        for name, value in arguments.items():
            if value.shape != present[name].shape:
                raise ParameterError(
                    f"has the shape {list(value.shape)}; expected {list(present[name].shape)}", where=name
                )
        swept: list[Any] = [arguments[name] for name in self._numbers]
        # the digits that rounding takes from a number, which a given one does not have
        swept += [jnp.zeros((), dtype)] * (len(self.executable.layout.swept) - len(swept))
        arrays = dict(self._base["arrays"])
        for name, (ident, path) in self._arrays.items():
            g, r = self.executable.plan.row[ident]
            arrays[array_key(g, path)] = jnp.asarray(arrays[array_key(g, path)]).at[r].set(arguments[name])
            if (low := array_key(g, path + LOW)) in arrays:
                arrays[low] = jnp.asarray(arrays[low]).at[r].set(0)
        return {"vector": jnp.asarray(self._base["vector"]), "arrays": arrays, "swept": tuple(swept)}

    @cached_property
    def _packed(self) -> tuple[np.ndarray, np.ndarray]:
        period = 1
        if self.build.body is not None:
            lasts = self.build.body.world.period
            unit = unit_seconds(self.doc.time_unit) * 1e3
            period = 0 if lasts is None else round(lasts / unit / self.dt)
        clock = {"period": period, "start": self.doc.t0, "dt": self.dt}
        return packed(clock, np.dtype(self.precision))

    def _chunk(
        self, program: Program, values: ProgramValues, constants: list[Constants], readings: Arrays
    ) -> Chunk:
        sensed: Any = {**self.executable.blind(), **readings}
        sensed = {**sensed, **program.look(values, constants, sensed)}
        hoisted = program.hoist(values, constants)
        still = program.steady(values, hoisted, sensed)
        clock = unpacked(*map(jnp.asarray, self._packed))
        return Chunk(values, hoisted, {}, sensed, clock, still)

    def _now(self, program: Program, prepared: PreparedStep, readings: Arrays, key: TrialKey) -> Chunk:
        chunk = prepared.chunk
        if readings:
            chunk = self._chunk(program, prepared.values, prepared.constants, readings)
        values: ProgramValues = chunk.values
        if self.build.body is not None:
            values = {**values, "world": key.shared}
        return chunk._replace(values=values, keys=key.noise)

    def _divided(self, inputs: ByPath) -> tuple[Arrays, Arrays]:
        """Return the readings of sensors, and what is added to inputs, by id."""
        readings, amounts = dict[str, Array](), dict[str, Array]()
        plan, dtype = self.executable.plan, self.executable.program.dtype
        for path, value in inputs.items():
            entry = find.element(self.doc, path)
            g, _ = plan.row[entry.id]
            array = jnp.asarray(value, dtype)
            if entry.id in plan.sensors:
                if self.build.body is not None:
                    raise WorldError("reads the world, so that it has no input of its own", where=path)
                readings[entry.id] = jnp.broadcast_to(array, shape(plan.groups[g].like.outs["output"]))
            elif entry.every == 1 and self.executable.program.injectable(g):
                amounts[entry.id] = array
            else:
                raise ParameterError(
                    "takes no input from outside",
                    where=path,
                    fix="Give one to a sensor, or to a field or node that runs at every tick",
                )
        return readings, amounts

    def _place(self, path: str) -> Port:
        entry, port = find.shown(self.doc, path)
        return self.executable.port(entry.id, port)

    def _arrays_of(self, ident: str, state: ProgramState) -> Sequence[str]:
        row = self.executable.plan.row
        return list(state["groups"][row[ident][0]]) if ident in row else []

    def _summary(self) -> Summary:
        rows = [("parameters", ", ".join(self.drives) or "none")]
        return Summary(f"Dynamics of {self.doc.name!r}, {self.precision}", rows)
