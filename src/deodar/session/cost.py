"""Measure the cost of each element of a running model, in microseconds per step.

Each group of equal elements is compiled alone, with the present values of its inputs, and timed; the whole
step is timed in the same way. The run is not changed: all measurements use its state at one moment.
"""

from __future__ import annotations

import dataclasses as dc
import math
import time
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from deodar.codec import JsonObject
from deodar.compiler.arguments import (
    EitherArray,
    NoiseKeys,
    ProgramClock,
    ProgramState,
    ProgramValues,
    packed,
    unpacked,
)
from deodar.compiler.executable import ChunkResult, Executable
from deodar.compiler.functions import Constants
from deodar.compiler.plan import Plan
from deodar.compiler.program import Chunk, Port, Program, array_key
from deodar.element import Arrays
from deodar.errors import TimeError
from deodar.model.document import Document
from deodar.numerics.pytree import PyTree
from deodar.parameters import real, show
from deodar.summary import Summarised, Summary

if TYPE_CHECKING:
    from deodar.session.run import Run

SECONDS = 1.0
"""Wall time, in seconds, of the measurements of all parts together, without their compilation."""

SHORTEST = 1e-3
"""Least wall time of a timed call, in seconds: well above its overhead and the resolution of the clock."""

REPEATS = 3
"""Least number of timings of each part; the fastest counts, because disturbances only make a call slower."""


@dc.dataclass(frozen=True, repr=False)
class ElementCost(Summarised):
    """Cost of one element.

    Attributes:
        id: id of the element.
        path: path of the element; a connection that resamples or delays has its own path.
        kind: kind of the element.
        us: microseconds per step; for an element that runs at every k-th tick the mean over all ticks.
        alike: number of elements of equal structure that are computed together; they share the time equally.
        once: whether the element is constant and is computed once per chunk, which costs nothing in a step.
    """

    id: str
    path: str
    kind: str
    us: float
    alike: int
    once: bool

    def _summary(self) -> Summary:
        cost = "once a chunk" if self.once else f"{self.us:.3f} us a step"
        return Summary(f"{self.kind} {self.path}: {cost}")


@dc.dataclass(frozen=True, repr=False)
class StepCost(Summarised):
    """Cost of a step, element by element.

    Attributes:
        elements: cost of each element, the most expensive first.
        step: microseconds of the step, measured as a whole.
    """

    elements: tuple[ElementCost, ...]
    step: float

    @property
    def sum(self) -> float:
        """Microseconds of all elements, each measured alone.

        It differs from `step`: elements that are computed together may be fused or run in parallel, and an
        element that is computed alone starts with a warm cache.
        """
        return math.fsum(c.us for c in self.elements)

    def share(self, cost: ElementCost) -> float:
        """Return the share of an element in the sum, 0 to 1."""
        return cost.us / self.sum if self.sum else 0.0

    def data(self) -> JsonObject:
        """Return the cost as plain numbers, for JSON."""
        rows = [dc.asdict(c) | {"share": self.share(c)} for c in self.elements]
        return {"step_us": self.step, "sum_us": self.sum, "elements": rows}

    def __str__(self) -> str:
        rows = [
            (
                c.path,
                c.kind,
                *(("once a chunk", "") if c.once else (f"{c.us:.3f}", f"{100 * self.share(c):.1f} %")),
            )
            for c in self.elements
        ]
        head = ("element", "kind", "us a step", "share")
        widths = [max(len(r[k]) for r in [head, *rows]) for k in range(4)]
        lines = [
            f"{p:{widths[0]}}  {k:{widths[1]}}  {u:>{widths[2]}}  {s:>{widths[3]}}".rstrip()
            for p, k, u, s in [head, *rows]
        ]
        return "\n".join(
            [
                *lines,
                "",
                f"Sum {self.sum:.3f} us, each measured alone; the whole step takes {self.step:.3f} us.",
            ]
        )

    def _summary(self) -> Summary:
        rows = [
            (
                c.path,
                c.kind,
                *(("once a chunk", "") if c.once else (f"{c.us:.3f}", f"{100 * self.share(c):.1f} %")),
            )
            for c in self.elements
        ]
        title = f"Step of {self.step:.3f} us; its elements, each measured alone, take {self.sum:.3f} us"
        return Summary(title, rows, ("element", "kind", "us a step", "share"))


GroupCarry = tuple[Array, ProgramState, tuple[Array, ...]]
"""Tick, state and outputs of one group between its steps."""


@dc.dataclass(frozen=True)
class StepInputs:
    """Everything that a step depends on, at one moment; it does not change when the run continues."""

    program: Executable
    document: Document
    values: ProgramValues
    constants: list[Constants]
    state: ProgramState
    keys: NoiseKeys
    sensed: Mapping[str, EitherArray]
    clock: Mapping[str, float]


class _GroupArguments(NamedTuple):
    """The arguments of the step of one group; a JAX PyTree."""

    values: ProgramValues
    arrays: dict[str, EitherArray]
    constants: Constants
    state: ProgramState
    keys: NoiseKeys
    inputs: list[Array]
    shown: tuple[Array, ...]
    sensed: Mapping[str, EitherArray]
    clock: ProgramClock


def moment(run: Run) -> StepInputs:
    """Return the inputs of the next step of a run."""
    clock = {**run.clock.origin, "tick": run.clock.tick % 2**32, "dt": run.clock.dt, "period": 1}
    return StepInputs(
        run.program, run.doc, run.values, run.constants, run.state, run.keys, dict(run.readings()), clock
    )


def costs(at: StepInputs, seconds: float = SECONDS) -> StepCost:
    """Measure the cost of a step, as a whole and element by element.

    Args:
        at: state and inputs at one moment.
        seconds: wall time of the measurements of all parts together. The first call also compiles the parts,
            which takes about as long as the compilation of the model.

    Raises:
        TimeError: `seconds` is not above 0.
    """
    budget = real(seconds)
    if budget is None or not 0 < budget < math.inf:
        raise TimeError(f"the time for measuring is {show(seconds)}; expected a number of seconds above 0")
    plan, used = at.program.plan, _read_ports(at)
    buffers = _buffers(at, used)
    groups = [
        g
        for g, group in enumerate(plan.groups)
        if not group.still and (group.like.element.stateful or used[g])
    ]
    share = budget / (len(groups) + 1)
    us = {g: _timed(_alone(at, g, used[g], buffers), plan.groups[g].like.every, share) for g in groups}
    step = _timed(_together(at), plan.ticks, share)
    by = at.document.by_id()
    element_costs = [
        ElementCost(
            n.id,
            by[n.id].path if n.id in by else n.path,
            type(n.element).__name__,
            us.get(g, 0.0) / group.rows,
            group.rows,
            group.still,
        )
        for g, group in enumerate(plan.groups)
        for n in group.nodes
    ]
    return StepCost(tuple(sorted(element_costs, key=lambda c: (-c.us, c.path))), step)


# ------------------------------------------------------------------------------------------- timed functions


def _read_ports(at: StepInputs) -> list[list[Port]]:
    """Return for each group the output ports that are read: others are not computed in a step."""
    plan = at.program.plan
    read = {r.source[:2] for reads in plan.reads.values() for r in reads}
    return [
        [Port(g, None, name) for name in group.like.outs if (g, name) in read]
        for g, group in enumerate(plan.groups)
    ]


def _buffers(at: StepInputs, used: Sequence[Sequence[Port]]) -> dict[tuple[int, str], Array]:
    """Return the values of those ports at this moment."""
    ports = [p for some in used for p in some]
    if not ports:
        return {}
    reader = at.program.new_reader(ports)
    seen = at.program.call(
        reader,
        at.values,
        at.constants,
        at.state,
        at.keys,
        at.sensed,
        *packed(at.clock, at.program.program.dtype),
    )
    return {(p.group, p.name): rows for p, rows in zip(ports, seen, strict=True)}


def _together(at: StepInputs) -> Callable[[int], ChunkResult]:
    """Return a function that takes `n` steps of the whole model."""
    chunk, _ = at.program.chunk(())

    def call(n: int) -> ChunkResult:
        clock = packed({**at.clock, "head": n}, at.program.program.dtype)
        return at.program.call(chunk, at.values, at.constants, at.state, at.keys, at.sensed, *clock)

    return call


def _alone(
    at: StepInputs, g: int, ports: Sequence[Port], held_by: dict[tuple[int, str], Array]
) -> Callable[[int], GroupCarry]:
    """Return a function that takes `n` steps of one group, with constant inputs and an advancing state."""
    plan, precision = at.program.plan, at.program.precision
    group, count = plan.groups[g], len(plan.groups)
    program = Program(dc.replace(plan, calls=[c for c in plan.calls if c.group == g]), precision)
    program.paired_groups = [g] if g in at.program.program.paired_groups else []
    alone = Program(Plan([group], [], {}, {}, {}, plan.size, 1), precision)
    arrays = {array_key(0, path): at.values["arrays"][array_key(g, path)] for path in group.arrays}
    sources = sorted({r.source[:2] for port in group.like.reads for r in plan.reads[g, port]})

    def only(part: Any) -> list[Any]:
        return [part if k == g else None for k in range(count)]

    def run(arguments: _GroupArguments, n: Array) -> GroupCarry:
        values, clock, keys = arguments.values, arguments.clock, arguments.keys
        settled = only(alone.hoist({**values, "arrays": arguments.arrays}, [arguments.constants])[0])

        def step(tick: Array, state: ProgramState, drawn: Arrays) -> tuple[ProgramState, tuple[Array, ...]]:
            # without the barrier XLA would compute all that depends on the inputs alone once, before the loop
            rows_read, tick = lax.optimization_barrier((arguments.inputs, tick))
            buffers = {
                (*source, instant): rows
                for source, rows in zip(sources, rows_read, strict=True)
                for instant in (0, 1)
            }
            chunk = Chunk(values, settled, keys, arguments.sensed, clock, buffers)
            observed = program.observe(ports, chunk, state, tick)
            return program.step(chunk, state, drawn, tick, {}), observed

        def body(_: Array, carry: tuple[GroupCarry, Arrays]) -> tuple[GroupCarry, Arrays]:
            (tick, state, observed), drawn = carry
            drawn = program.draw(keys, tick, clock["tick"], drawn)
            state, observed = step(tick, state, drawn)
            return (tick + jnp.uint32(1), state, observed), drawn

        begun = (clock["tick"], arguments.state, arguments.shown)
        return lax.fori_loop(0, n, body, (begun, program.undrawn()))[0]

    state: ProgramState = {
        "groups": only(at.state["groups"][g]),
        "held": {k: v for k, v in at.state["held"].items() if k == str(g)},
    }
    keys = {k: v for k, v in at.keys.items() if k == str(g)}
    inputs, observed = [held_by[source] for source in sources], tuple(held_by[g, p.name] for p in ports)
    args = _GroupArguments(
        at.values,
        arrays,
        at.constants[g],
        state,
        keys,
        inputs,
        observed,
        at.sensed,
        unpacked(*packed(at.clock, at.program.program.dtype)),
    )
    executable, _ = at.program.compile(run, args, np.int32(0))
    return lambda n: at.program.call(executable, args, np.int32(n))


# ----------------------------------------------------------------------------------------------------- timing


def _timed(call: Callable[[int], tuple[PyTree, ...]], multiple: int, seconds: float) -> float:
    """Measure the microseconds per step, without the time of a call that takes no steps.

    `multiple` is the number of ticks after which the computation repeats.
    """

    def taken(n: int) -> float:
        began = time.perf_counter()
        jax.block_until_ready(call(n))
        return time.perf_counter() - began

    end = time.perf_counter() + seconds
    n = 2 * multiple  # noise is drawn for pairs of ticks
    taken(n)
    none = min(taken(0) for _ in range(REPEATS))
    # one call may take long because another process interrupted it, so several must
    while n < 2**28 and any(taken(n) < none + SHORTEST for _ in range(REPEATS)):
        n *= 2
    best, repeats = math.inf, 0
    while repeats < REPEATS or time.perf_counter() < end:
        none, best, repeats = min(none, taken(0)), min(best, taken(n)), repeats + 1
    return max(0.0, 1e6 * (best - none) / n)
