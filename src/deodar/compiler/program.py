"""The program: pure functions of arrays that compute a plan.

Elements see one copy of themselves. Rows of a group, trials and points of a sweep are `vmap`s around them;
rates are `lax.cond`s whose predicate is never batched (under `vmap` a batched predicate would compute both
branches in every step).
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
import functools
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar, cast

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from deodar.compiler.arguments import EitherArray, NoiseKeys, ProgramClock, ProgramState, ProgramValues
from deodar.compiler.body import Body
from deodar.compiler.functions import Constants, Replacements
from deodar.compiler.plan import Call, Plan, Read, RowGroup
from deodar.compiler.sharing import functions, plain_ports
from deodar.compiler.traffic import scope
from deodar.element import BEFORE, Arrays, Element, Setting, Time
from deodar.kind_errors import KindNames, NotHere, errors_of_kind, foreign, require_arrays
from deodar.leaves import bind, leaves, parameter_values
from deodar.numerics.axes import shape
from deodar.numerics.derivatives import without_derivative
from deodar.numerics.exact import LOW, Exact
from deodar.numerics.native import LEAST_NOISE
from deodar.numerics.noise import Cells, block, element_keys, no_block, normal, of_block
from deodar.numerics.sigmoids import SigmoidFunction

T = TypeVar("T")

Buffers = dict[tuple[int, str, int], Array]

BLOCKS_FROM = 1000
"""Cells with noise in all copies from which a step keeps the deviates of the next one: below, drawing every
tick costs less than a branch.
"""


@dc.dataclass(frozen=True)
class Port:
    """A port to read, of one row of a group or of all rows (None): an output port, or the sum at an input
    port.
    """

    group: int
    row: int | None
    name: str


BEGUN = "begun"
"""Key of the tick at which a copy began, among the keys of noise."""


def precision_context(precision: str) -> contextlib.AbstractContextManager[None]:
    """JAX's 64-bit mode for this thread and this block only; no global flag is touched."""
    return jax.enable_x64(True) if precision == "float64" else contextlib.nullcontext()


PICTURE_SAMPLES = 4096
"""Samples from which a reading counts as a picture."""

SEEN = "seen "
"""Begin of the keys of what follows from pictures, among those of readings."""


class Chunk(NamedTuple):
    """The values that are constant during a chunk in one copy of a model; a JAX PyTree.

    Attributes:
        values: the parameters: `vector` (all scalar leaves), `arrays` (by group and leaf), `swept` (one value
            for each sweep); the arrays of a world inside the step under `world`.
        constants: for each group what `prepare` or `hoist` made of them.
        keys: noise keys of the noisy groups; of a world inside the step its own arrays, under `world`.
        sensed: readings of the sensors; of a world inside the step they are in the state.
        clock: `tick` and `origin` (uint32), `start` (document time at the tick `origin`), `dt`, `period` (of
            a world inside, in ticks); empty where no output depends on time.
        still: outputs that stay the same.
    """

    values: ProgramValues
    constants: list[Constants]
    keys: NoiseKeys
    sensed: Mapping[str, EitherArray]
    clock: ProgramClock
    still: Buffers


class Program:
    """The functions of one plan in one precision.

    Arguments they share:
        chunk: what stays the same from step to step.
        state: `groups` (one entry a group) and `held` (new states of slow groups that are not yet visible);
            `world` where it is inside the step.
        drawn: noise of the fast groups for both ticks of a block (`draw`); without them it is drawn every
            tick.

    `copies`: how many copies of the model are computed at once; 0 where no branch serves all of them, and on
    a device that waits at every branch.
    `replaced`: functions that replace those of `numerics`.
    `pictures`: whether what follows from pictures alone is an argument, under the keys of `look`.
    """

    def __init__(
        self,
        plan: Plan,
        precision: str,
        sweep: Sequence[Sequence[int]] = (),
        body: Body | None = None,
        copies: int = 1,
        replaced: Replacements | None = None,
        pictures: bool = False,
    ) -> None:
        self.plan = plan
        replaced = replaced or Replacements()
        self.jumps = [_jumps(group) if replaced.refuses else frozenset[str]() for group in plan.groups]
        self.kernels = replaced.kernels
        self.body = body
        self.precision = precision
        self.dtype: np.dtype[np.floating] = np.dtype(precision)
        self.sweep = [tuple(s) for s in sweep]
        self.noisy_groups = [g for g, group in enumerate(plan.groups) if group.noise is not None]
        self.paired_groups = self._paired_groups(copies)
        self.slow_groups = [
            g for g, group in enumerate(plan.groups) if group.like.every > 1 and group.like.element.stateful
        ]
        self.constant_calls = [c for c in plan.calls if plan.groups[c.group].still]
        self.picture_calls = self._picture_calls() if pictures else []
        self.step_calls = [
            c for c in plan.calls if not (plan.groups[c.group].still or plan.groups[c.group].sensory)
        ]
        self.sensory_calls = self._sensory_calls()
        self.rebuilt = [self._swept_constants(group) for group in plan.groups]
        self.settings = [
            Setting(plain_ports(g.like.ins), plain_ports(g.like.outs), self.dtype) for g in plan.groups
        ]
        self.functions = [
            functions(g.like, g.strategy, replaced.kernels, replaced.tapped) for g in plan.groups
        ]

    def _paired_groups(self, copies: int) -> list[int]:
        """Return the groups whose noise is drawn for two ticks at once, where that is worth it."""
        groups = {g: self.plan.groups[g] for g in self.noisy_groups}
        paired = [g for g, group in groups.items() if group.like.every == 1 and group.like.element.stateful]
        cells = copies * sum(groups[g].rows * _cells(groups[g]) for g in paired)
        return paired if cells >= (LEAST_NOISE if self.kernels is not None else BLOCKS_FROM) else []

    # --------------------------------------------------------------------------------------- prepare and init

    def prepare(self, values: ProgramValues) -> list[Constants]:
        """Constants of every group; with a sweep axis where a swept parameter rebuilds them."""
        out: list[Constants] = []
        for g in range(len(self.plan.groups)):
            if self.rebuilt[g]:
                out.append(
                    jax.vmap(lambda swept, g=g: self._prepared(g, {**values, "swept": swept}))(
                        values["swept"]
                    )
                )
            else:
                out.append(self._prepared(g, {**values, "swept": ()}))
        return out

    def prepare_one(self, values: ProgramValues) -> list[Constants]:
        """Constants of every group of one copy, for one value of each sweep."""
        return [self._prepared(g, values) for g in range(len(self.plan.groups))]

    def init(self, values: ProgramValues, seed: Array, trial: Array) -> tuple[ProgramState, NoiseKeys]:
        """Return the state at the start, and the noise keys of a trial."""
        return self.begin(values), self.keys(seed, trial)

    def begin(self, values: ProgramValues) -> ProgramState:
        """Return the state at the start."""
        groups = [self._each(g, _initial, values) for g in range(len(self.plan.groups))]
        return {"groups": groups, "held": {str(g): groups[g] for g in self.slow_groups}}

    def keys(self, seed: Array, trial: Array) -> NoiseKeys:
        """Return the noise keys of a trial."""
        return {str(g): element_keys(seed, trial, _numbers(self.plan.groups[g])) for g in self.noisy_groups}

    # -------------------------------------------------------------------------------------------------- steps

    def hoist(self, values: ProgramValues, constants: list[Constants]) -> list[Constants]:
        """Return the values that groups compute from constants and live parameters once per chunk."""
        return [
            self._each(g, self.functions[g].hoist, values, {"constants": constants[g]})
            for g in range(len(self.plan.groups))
        ]

    def steady(
        self, values: ProgramValues, constants: list[Constants], sensed: Mapping[str, EitherArray]
    ) -> Buffers:
        """Outputs that stay the same while parameters and sensors do: evaluated once a chunk."""
        places = {key: (g, port, 0) for key, (g, port) in self._keys(self.picture_calls).items()}
        buffers: Buffers = {place: jnp.asarray(sensed[f"{SEEN}{key}"]) for key, place in places.items()}
        chunk = Chunk(values, constants, {}, sensed, cast("ProgramClock", {}), {})
        for call in self.constant_calls:
            if call not in self.picture_calls:
                self._output(call, buffers, chunk, {}, jnp.uint32(0))
        return buffers

    def look(
        self, values: ProgramValues, constants: list[Constants], sensed: Mapping[str, EitherArray]
    ) -> Arrays:
        """Return the outputs that follow from pictures alone.

        They are computed when a picture is new, not in each chunk: a chunk between two exchanges with a world
        may be a single step, and a camera has a new picture only at some exchanges.
        """
        buffers: Buffers = {}
        chunk = Chunk(values, self.hoist(values, constants), {}, sensed, cast("ProgramClock", {}), {})
        sensors = [c for c in self.constant_calls if self.plan.groups[c.group].like.id in self.pictures]
        for call in (*sensors, *self.picture_calls):
            self._output(call, buffers, chunk, {}, jnp.uint32(0))
        return {
            f"{SEEN}{key}": buffers[g, port, 0] for key, (g, port) in self._keys(self.picture_calls).items()
        }

    def unseen(self) -> dict[str, np.ndarray]:
        """Return the outputs of `look` before a picture is seen: zeros."""
        return {
            f"{SEEN}{key}": np.zeros(of, self.dtype) for key, of in self._shapes(self.picture_calls).items()
        }

    @functools.cached_property
    def pictures(self) -> list[str]:
        """The ids of the sensors whose readings `look` uses."""
        pairs = [(c.group, port) for c in self.picture_calls for port in self.plan.groups[c.group].like.reads]
        sources = {r.source[0] for pair in pairs for r in self.plan.reads[pair]}
        return [ident for ident in self.plan.sensors if self.plan.row[ident][0] in sources]

    def _picture_calls(self) -> list[Call]:
        """Return the calls, among those that stay the same, that follow from readings alone, at least one of
        which is as large as a picture.
        """
        groups, calls = self.plan.groups, list[Call]()
        for call in self.constant_calls:
            node, before = groups[call.group].like, {c.group for c in calls}
            sources = {r.source[0] for port in node.reads for r in self.plan.reads[call.group, port]}
            large = {
                g
                for g in sources
                if groups[g].like.element.external
                and math.prod(shape(groups[g].like.outs["output"])) >= PICTURE_SAMPLES
            }
            readings = {g for g in sources if groups[g].like.element.external}
            if call.role == "output" and sources <= readings | before and sources & (large | before):
                calls.append(call)
        return calls

    def undrawn(self) -> Arrays:
        """The blocks before the first is drawn."""
        rows = {g: self.plan.groups[g].rows for g in self.paired_groups}
        empty = {g: no_block(self._drawn(g), self.dtype, self.kernels) for g in self.paired_groups}
        return {str(g): jnp.broadcast_to(empty[g], (rows[g], *empty[g].shape)) for g in self.paired_groups}

    def draw(self, keys: NoiseKeys, tick: Array, start: Array, drawn: Arrays) -> Arrays:
        """The blocks that `tick` lies in: drawn at even ticks and at the tick `start` of the chunk."""
        age = _since(keys, tick)

        def anew() -> Arrays:
            return {
                str(g): jax.vmap(lambda key, g=g: self._block(g, key, age))(keys[str(g)])
                for g in self.paired_groups
            }

        if not self.paired_groups:
            return drawn
        if (kernels := self.kernels) is not None:  # a kernel contains the branch
            first = _since(keys, start)
            rows = jax.vmap(lambda key, row: kernels.noise(key, age, first, row))
            return {g: rows(keys[g], drawn[g]) for g in drawn}
        # the predicate is that of all copies; a branch is a computation of its own, which XLA fuses with no
        # other
        return lax.cond((tick % jnp.uint32(2) == 0) | (tick == start), anew, lambda: drawn)

    def unperceived(self) -> Arrays:
        """Return what follows from readings before the first is made."""
        shapes = self._shapes([call for calls in self.sensory_calls.values() for call in calls])
        return {key: jnp.zeros(of, self.dtype) for key, of in shapes.items()}

    def perceive(
        self, chunk: Chunk, state: ProgramState, tick: Array, start: Array, perceived: Arrays
    ) -> Arrays:
        """Return what follows from readings of the world: computed when the readings are new, and at the tick
        `start` of the chunk, since parameters may have changed before it.
        """
        outputs = dict(perceived)
        seeing = self._seeing(chunk, state) if self.sensory_calls else chunk
        for periods, calls in self.sensory_calls.items():
            before = {key: outputs[key] for key in self._keys(calls)}
            period = jnp.uint32(periods) * jnp.maximum(chunk.clock["period"], jnp.uint32(1))
            # the predicate is that of all copies, like the one of `draw`
            outputs |= lax.cond(
                (tick % period == 0) | (tick == start),
                functools.partial(self._perceive, calls, seeing, outputs, tick),
                lambda before=before: before,
            )
        return outputs

    def _perceive(self, calls: Sequence[Call], chunk: Chunk, perceived: Arrays, tick: Array) -> Arrays:
        buffers = {**chunk.still, **self._perceived(perceived)}
        sensors = [c for c in self.step_calls if self.plan.groups[c.group].like.element.external]
        for call in (*sensors, *calls):
            self._output(call, buffers, chunk, {}, tick)
        return {key: buffers[g, port, 0] for key, (g, port) in self._keys(calls).items()}

    def _keys(self, calls: Sequence[Call]) -> dict[str, tuple[int, str]]:
        """Return the group and port of each output of sensory groups, by the key of its values."""
        slots = [(c.group, port) for c in calls for port in self.plan.groups[c.group].like.outs]
        return {array_key(g, port): (g, port) for g, port in slots}

    def _shapes(self, calls: Sequence[Call]) -> dict[str, tuple[int, ...]]:
        """Return the shape of each of these outputs, by its key."""
        groups = self.plan.groups
        return {
            key: (groups[g].rows, *shape(groups[g].like.outs[port]))
            for key, (g, port) in self._keys(calls).items()
        }

    def _perceived(self, perceived: Arrays) -> Buffers:
        """Return what follows from readings as buffers."""
        keys = self._keys([call for calls in self.sensory_calls.values() for call in calls])
        return {(g, port, 0): perceived[key] for key, (g, port) in keys.items()}

    def _sensory_calls(self) -> dict[int, list[Call]]:
        """Return the calls of sensory groups by the periods of the world after which they change, the longest
        first: what changes rarely comes before what reads it.
        """
        groups, period_of = self.plan.groups, dict[int, int]()

        def periods(g: int) -> int:
            if g not in period_of:
                node = groups[g].like
                sources = {r.source[0] for port in node.reads for r in self.plan.reads[g, port]}
                period_of[g] = (
                    self.body.periods(node.id)
                    if self.body is not None and node.element.external
                    else math.gcd(*(periods(source) for source in sources))
                )
            return period_of[g]

        calls = [c for c in self.plan.calls if groups[c.group].sensory]
        lengths = sorted({periods(c.group) for c in calls}, reverse=True)
        return {n: [c for c in calls if periods(c.group) == n] for n in lengths}

    def step(
        self, chunk: Chunk, state: ProgramState, drawn: Arrays, tick: Array, perceived: Arrays
    ) -> ProgramState:
        """The state at tick + 1: every output at t is read, then all new states are committed together.

        A world stays as it is, until `advance`.
        """
        chunk = self._seeing(chunk, state)
        buffers, old = dict(chunk.still), state["groups"]
        buffers |= self._perceived(perceived)
        new, coming = list(old), dict(state["held"])
        for call in self.step_calls:
            group = self.plan.groups[call.group]
            if call.role == "output":
                self._output(call, buffers, chunk, (new if call.instant else old)[call.group], tick)
            else:
                time = self._time(chunk.clock, tick, group)
                inputs = self._inputs(call.group, buffers)
                for port in group.like.element.reads_own_output:
                    inputs[port] = buffers[call.group, port, 0]

                def run(g: int = call.group, inputs: Arrays = inputs, time: Time = time) -> Arrays:
                    noise = self._noise(g, chunk.keys, tick, drawn.get(str(g)))
                    return self._advance(g, chunk, old[g], inputs, noise, time)

                new[call.group] = self._gated(call.group, run, old, coming, tick)
        if self.body is None:
            return {"groups": new, "held": coming}
        commands = {
            ident: buffers[g, "output", 0][r] for ident in self.body.motors for g, r in [self.plan.row[ident]]
        }
        assert "world" in state
        world = self.body.listen(state["world"], commands, tick, chunk.clock["period"])
        return {"groups": new, "held": coming, "world": world}

    def advance(self, chunk: Chunk, state: ProgramState, tick: Array) -> ProgramState:
        """The state with the world of `tick`, to which the model has advanced."""
        if self.body is None:
            return state
        assert "world" in chunk.values and "world" in chunk.keys and "world" in state
        world = self.body.advance(
            chunk.values["world"], chunk.keys["world"], state["world"], tick, chunk.clock["period"]
        )
        return {**state, "world": world}

    def injectable(self, g: int) -> bool:
        """Return whether the rows of a group take external input."""
        return type(self.plan.groups[g].like.element).inject is not Element.inject

    def injected(
        self, g: int, row: int, values: ProgramValues, state: Arrays, amount: Array, dt: float
    ) -> Arrays:
        """Return the state of a group after a step in which an amount was added to the input of a row."""
        leaves_of_row = {path: leaf[row] for path, leaf in self._leaves(g, values).items()}
        element = bind(self.plan.groups[g].like.element, self._value(g, leaves_of_row))
        row_state: Any = {name: rows[row] for name, rows in state.items()}
        new = element.inject(row_state, cast("Any", amount), dt)
        assert new is not None
        return {**state, **{name: state[name].at[row].set(value) for name, value in new.items()}}

    def _seeing(self, chunk: Chunk, state: ProgramState) -> Chunk:
        if self.body is None:
            return chunk
        assert "world" in state
        return chunk._replace(sensed={**chunk.sensed, **self.body.sensed(state["world"])})

    def observe(
        self, ports: Sequence[Port], chunk: Chunk, state: ProgramState, tick: Array
    ) -> tuple[Array, ...]:
        """Ports at the state's own time; connections that read `current` see that same state."""
        chunk = self._seeing(chunk, state)
        buffers = dict(chunk.still)
        for call in self.plan.needed([(p.group, p.name) for p in ports]):
            if not self.plan.groups[call.group].still:
                self._output(call, buffers, chunk, state["groups"][call.group], tick, present=True)
        return tuple(self._port(p, buffers) for p in ports)

    def finite(self, state: ProgramState) -> tuple[Array, list[Array]]:
        """Return whether all numbers are finite, and for each group in which rows."""
        out: list[Array] = []
        for g, group in enumerate(self.plan.groups):
            good = jnp.ones((group.rows,), bool)
            for leaf in jax.tree.leaves(state["groups"][g]):
                good = good & jnp.all(jnp.isfinite(leaf).reshape(group.rows, -1), axis=1)
            out.append(good)
        return jnp.all(jnp.stack([jnp.all(good) for good in out])) if out else jnp.ones((), bool), out

    # ---------------------------------------------------------------------------------------------- one group

    def _prepared(self, g: int, values: ProgramValues) -> Constants:
        return self._each(g, self.functions[g].prepare, values, only="rebuild")

    def _output(
        self, call: Call, buffers: Buffers, chunk: Chunk, state: Arrays, tick: Array, present: bool = False
    ) -> None:
        g, group = call.group, self.plan.groups[call.group]
        time = self._time(chunk.clock, tick, group)
        passed = {port for out in group.like.outs for port in group.like.passes(out)}
        inputs = self._inputs(g, buffers, passed, present)
        if port := group.like.element.external:
            inputs[port] = jnp.asarray(chunk.sensed[group.like.id], self.dtype)[None]
        noise = None if group.like.element.stateful else self._noise(g, chunk.keys, tick)
        read = self._reading(g, chunk, state, inputs, noise)
        out = self._each(g, functools.partial(self._outputs, g), chunk.values, read, time)
        for port, axes in group.like.outs.items():
            buffers[g, port, call.instant] = jnp.broadcast_to(
                jnp.asarray(out[port], self.dtype), (group.rows, *shape(axes))
            )

    def _advance(
        self, g: int, chunk: Chunk, state: Arrays, inputs: Arrays, noise: Array | None, time: Time
    ) -> Arrays:
        read = self._reading(g, chunk, state, inputs, noise)
        new = self._each(g, functools.partial(self._advanced, g), chunk.values, read, time)
        return jax.tree.map(lambda a, b: jnp.asarray(a, b.dtype), new, read["state"])

    def _outputs(self, g: int, element: Element, at: Setting) -> Arrays:
        """Return the outputs of one row, which spread over the declared axes."""
        out, ports = self.functions[g].output(element, at), self.plan.groups[g].like.outs
        shapes = {port: shape(axes) for port, axes in ports.items()}
        if foreign(element):
            require_arrays(element, "output", out, shapes)
        return out

    def _advanced(self, g: int, element: Element, at: Setting) -> Arrays:
        """Return the new state of one row, of the form of the state."""
        new = self.functions[g].advance(element, at)
        if foreign(element):
            require_arrays(element, "advance", new, at.state)
        return new

    def _reading(
        self, g: int, chunk: Chunk, state: Arrays, inputs: Arrays, noise: Array | None
    ) -> dict[str, Any]:
        """Return what the rows of a group read in a step, so that gradients through jumps are refused."""
        if self.jumps[g]:
            state, inputs = self._refused(g, state), self._refused(g, inputs)
        return {"state": state, "inputs": inputs, "constants": chunk.constants[g], "noise": noise}

    def _refused(self, g: int, arrays: Arrays) -> Arrays:
        node, names = self.plan.groups[g].like, self.jumps[g]
        paths = ", ".join(node.path for node in self.plan.groups[g].nodes)

        def guarded(name: str, value: Array) -> Array:
            if name not in names:
                return value
            refusal = (
                f"{paths} ({type(node.element).__name__}): jumps as {name} changes, and has no derivative"
            )
            return without_derivative(value, refusal)

        return {name: guarded(name.removesuffix(LOW), value) for name, value in arrays.items()}

    def _gated(
        self,
        g: int,
        run: Callable[[], Arrays],
        old: Sequence[Arrays],
        coming_states: dict[str, Arrays],
        tick: Array,
    ) -> Arrays:
        """A part of multiple k reads at ticks that are multiples of k; its new state is visible k ticks
        later.
        """
        k = self.plan.groups[g].like.every
        if k == 1:
            return run()
        coming = lax.cond(tick % jnp.uint32(k) == 0, run, lambda: coming_states[str(g)])
        coming_states[str(g)] = coming
        due = (tick + jnp.uint32(1)) % jnp.uint32(k) == 0
        return jax.tree.map(lambda a, b: jnp.where(due, a, b), coming, old[g])

    def _block(self, g: int, key: Array, tick: Array) -> Array:
        return block(self._drawn(g), key, tick, self.dtype)

    def _drawn(self, g: int) -> Cells:
        """Return the cells of a row of a group for which noise is drawn; in their shape where devices divide
        it.
        """
        group = self.plan.groups[g]
        return _cells(group) if self.plan.shards is None else shape(group.noise or ())

    def _noise(self, g: int, keys: NoiseKeys, tick: Array, drawn: Array | None = None) -> Array | None:
        group = self.plan.groups[g]
        if group.noise is None:
            return None
        cells, age = shape(group.noise), _since(keys, tick)
        if drawn is not None:
            return jax.vmap(lambda row: of_block(row, age))(drawn).reshape(group.rows, *cells)
        age = age // jnp.uint32(group.like.every)
        shaped = self.plan.shards is not None
        return jax.vmap(lambda key: normal(cells, key, age, self.dtype, shaped))(keys[str(g)])

    def _time(self, clock: ProgramClock, tick: Array, group: RowGroup) -> Time:
        if not clock:
            return Time.at(0.0, 0.0, self.dtype)
        return Time(clock["start"], tick - clock["origin"], clock["dt"], group.like.every)

    def _inputs(
        self, g: int, buffers: Buffers, only: set[str] | None = None, present: bool = False
    ) -> Arrays:
        ports = [p for p in self.plan.groups[g].like.reads if only is None or p in only]
        return {p: self._sum(g, p, buffers, present) for p in ports}

    def _sum(self, g: int, port: str, buffers: Buffers, present: bool) -> Array:
        group = self.plan.groups[g]
        total: Array | None = None
        for read in self.plan.reads[g, port]:
            source, source_port, instant = read.source
            part = gather(buffers[source, source_port, 0 if present else instant], read)
            total = part if total is None else total + part
        if total is None:
            total = jnp.zeros((group.rows, *shape(group.like.ins[port])), self.dtype)
        return total

    def _port(self, p: Port, buffers: Buffers) -> Array:
        is_output = p.name in self.plan.groups[p.group].like.outs
        rows = buffers[p.group, p.name, 0] if is_output else self._sum(p.group, p.name, buffers, present=True)
        return rows if p.row is None else rows[p.row]

    def _each(
        self,
        g: int,
        fn: Callable[[Element, Setting], T],
        values: ProgramValues,
        read: Mapping[str, Any] | None = None,
        time: Time = BEFORE,
        only: str = "",
    ) -> T:
        """fn(element, setting) over the rows of a group, the element bound to its row's parameters, and the
        setting with the row of each value in `read`.
        """
        group, at = self.plan.groups[g], dc.replace(self.settings[g], time=time)
        if self.plan.shards is not None:
            fn = jax.named_scope(scope(group.like.id))(fn)
        parameters = self._leaves(g, values)

        def of_row(parameters: Arrays, read: Mapping[str, Any]) -> T:
            element = bind(group.like.element, self._value(g, parameters, only))
            with errors_of_kind(element, group.like.path, _names(element, read)):
                return fn(element, dc.replace(at, **read))

        if group.rows == 1:
            out = of_row(*jax.tree.map(lambda a: a[0], (parameters, read or {})))
            return jax.tree.map(lambda a: jnp.asarray(a)[None], out)
        return jax.vmap(of_row, axis_size=group.rows)(parameters, read or {})

    def _value(
        self, g: int, leaves_of_row: Arrays, only: str = ""
    ) -> Callable[[str], Array | Exact | NotHere | None]:
        """Return the function that gives the value of a leaf of a row by its path."""
        group = self.plan.groups[g]

        def value(path: str) -> Array | Exact | NotHere | None:
            if only and path in group.cost and group.cost[path] != only:
                return NotHere(path)
            leaf = leaves_of_row.get(path)
            return Exact(leaf, leaves_of_row[path + LOW]) if path in group.exact else leaf

        return value

    def _leaves(self, g: int, values: ProgramValues) -> Arrays:
        group = self.plan.groups[g]
        out: Arrays = {}
        vector, arrays = cast("Array", values["vector"]), cast("Arrays", values["arrays"])
        for path, offset in group.offset.items():
            leaf = vector[offset : offset + group.rows]
            for places, value in zip(self.sweep, values["swept"], strict=False):
                for place in places:
                    if offset <= place < offset + group.rows:
                        leaf = jnp.where(np.arange(group.rows) == place - offset, value, leaf)
            out[path] = leaf
        for path in group.arrays:
            out[path] = arrays[array_key(g, path)]
        return self._refused(g, out) if self.jumps[g] else out

    def _swept_constants(self, group: RowGroup) -> bool:
        for path, offset in group.offset.items():
            inside = any(offset <= place < offset + group.rows for places in self.sweep for place in places)
            if inside and group.cost[path] == "rebuild":
                return True
        return False


def _since(keys: NoiseKeys, tick: Array) -> Array:
    """Return the ticks since a copy began, by which its noise is drawn."""
    return tick - cast("Array", keys[BEGUN]) if BEGUN in keys else tick


def array_key(g: int, path: str) -> str:
    """Key of an array leaf among the values."""
    return f"{g}:{path}"


def gather(x: Array, read: Read) -> Array:
    """Sum of the rows of the source that `read` names for each row; fixed order of summation."""
    table = read.table
    if table.shape[1] == 1 and read.whole:
        same = x.shape[0] == table.shape[0] and np.array_equal(table[:, 0], np.arange(x.shape[0]))
        return x if same else x[table[:, 0]]
    if not read.whole:
        x = jnp.concatenate([x, jnp.zeros((1, *x.shape[1:]), x.dtype)])
    total = x[table[:, 0]]
    for column in range(1, table.shape[1]):
        total = total + x[table[:, column]]
    for rows, blocks in read.more:
        blocks = jnp.asarray(blocks)

        def add(n: int, part: Array, blocks: Array = blocks) -> Array:
            for column in range(blocks.shape[1]):
                part = part + x[blocks[n, column]]
            return part

        total = total.at[rows].set(lax.fori_loop(0, blocks.shape[0], add, total[rows]))
    return total


def _initial(element: Element, at: Setting) -> Arrays:
    """Return the state of one row at the start."""
    state = element.init(at)
    if foreign(element):
        require_arrays(element, "init", state, None)
    return state


def _names(element: Element, read: Mapping[str, Any]) -> KindNames:
    """Return the names that a method of an element may read."""
    return KindNames(element.ports(), tuple(read.get("inputs", ())), tuple(read.get("state", ())))


def _jumps(group: RowGroup) -> frozenset[str]:
    """Return the names of inputs, states and parameters of a group in which it has no derivative."""
    element, node = group.like.element, group.like
    names = {path for path, _, p in leaves(element) if p.role in ("moment", "duration")}
    names |= set(element.jumps_at())
    if any(isinstance(v, SigmoidFunction) and v.jumps for _, v in parameter_values(element)):
        setting = Setting(node.ins, node.outs, np.dtype("float32"))
        names |= {*node.ins, *group.offset, *group.arrays, *jax.eval_shape(lambda: element.init(setting))}
    return frozenset(names)


def _cells(group: RowGroup) -> int:
    """The number of cells with noise in each row of a group."""
    return math.prod(shape(group.noise or ()))


def _numbers(group: RowGroup) -> np.ndarray:
    """The ids of a group as the numbers that key their noise."""
    return np.array([int(n.id, 16) for n in group.nodes], np.uint32)
