"""Many steps of a model as one pure function, with memory for its gradient that grows with the square root of
their number.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array, lax

from deodar.compiler.arguments import ProgramState
from deodar.compiler.dynamics import ByPath, Dynamics, PreparedStep, TrialKey
from deodar.errors import ParameterError, TimeError, instance_of
from deodar.model import find
from deodar.session.run import require_sampled, whole

RolloutCarry = tuple[Array, ProgramState]
"""Tick and state."""


class Rollout(NamedTuple):
    """The result of `rollout`; a JAX PyTree.

    Attributes:
        records: values of the recorded ports by path, samples first.
        state: the state after the last step.
    """

    records: dict[str, Array]
    state: ProgramState


class RolloutStart(NamedTuple):
    """Where a rollout begins; a JAX PyTree.

    Attributes:
        state: the state.
        tick: number of steps before it.
    """

    state: ProgramState
    tick: Any = 0


def rollout(
    dynamics: Dynamics,
    n: int,
    parameters: ByPath | None = None,
    inputs: ByPath | None = None,
    key: TrialKey | None = None,
    record: Sequence[str] = (),
    every: float | None = None,
    start: RolloutStart | None = None,
) -> Rollout:
    """Take `n` steps, and return what was recorded: a pure function, to be compiled by `jax.jit`.

    It computes what `simulate` computes for the same seed and trial, with noise, time, windows and parts of
    several ticks; in double precision to 1e-12. Gradients store about 2 sqrt(n) states and compute each step
    twice (`jax.checkpoint`).

    Args:
        dynamics: what `dd.dynamics` returned.
        n: number of steps.
        parameters: values by path; those that are left out keep their present values.
        inputs: by path, the reading of a sensor or what is added to the input of a field or node; over its
            axes, or with one more axis in front, over the steps. The reading of a sensor at the end is that
            of the last step.
        key: `dynamics.key(seed, trial)`; none: seed 0 and trial 0.
        record: paths of ports; the path of a field alone means its activation.
        every: sampling interval in document time, a whole number of steps; none: dt. The first sample is the
            state at the start.
        start: a state from which to begin, and its tick; none: the beginning.

    Returns:
        Arrays by path, samples first, and the state at the end.
    """
    gap = 1 if every is None else whole(every, dynamics.dt, "every")
    if n < 0 or gap < 1:
        raise TimeError(f"{n} steps, a sample after each {gap}: expected at least 0 steps, and 1")
    require_sampled(every, gap, n, dynamics.dt)
    if start is not None:
        instance_of(RolloutStart, start, "start")
    prepared = dynamics.prepare(parameters)
    trial_key = dynamics.key() if key is None else key
    begin = RolloutStart(dynamics.init(parameters, trial_key)) if start is None else start
    with dynamics.context():
        first = jnp.asarray(begin.tick, jnp.uint32)
        state = jax.tree.map(jnp.asarray, begin.state)
    run = _Steps(dynamics, prepared, trial_key, *_by_step(dynamics, inputs or {}, n), first)
    return run.recorded(n, (first, state), tuple(record), gap)


def _by_step(dynamics: Dynamics, inputs: ByPath, n: int) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return the inputs that are constant, and those that have an axis of steps."""
    still, moving = dict[str, Array](), dict[str, Array]()
    for path, value in inputs.items():
        array = jnp.asarray(value)
        entry = find.element(dynamics.doc, path)
        g, _ = dynamics.executable.plan.row[entry.id]
        node = dynamics.executable.plan.groups[g].like
        axes = len(node.outs["output"])
        if array.ndim <= axes:
            still[path] = array
        elif array.ndim == axes + 1 and len(array) == n:
            moving[path] = array
        else:
            raise ParameterError(
                f"has the shape {list(array.shape)}; expected {axes} axes, or one more with {n} steps",
                where=path,
            )
    return still, moving


class _Steps:
    """Steps with parameters, key and inputs."""

    def __init__(
        self,
        dynamics: Dynamics,
        prepared: PreparedStep,
        key: TrialKey,
        still: Mapping[str, Array],
        moving: Mapping[str, Array],
        first: Array,
    ) -> None:
        self._dynamics, self._prepared, self._key = dynamics, prepared, key
        self._still, self._moving, self._first = still, moving, first

    def _inputs(self, tick: Array) -> dict[str, Array]:
        """Return the inputs of a step; after the last one those of the last step."""
        passed = (tick - self._first).astype(jnp.int32)
        moving = {path: a[jnp.minimum(passed, len(a) - 1)] for path, a in self._moving.items()}
        return {**self._still, **moving}

    def _one_step(self, carry: RolloutCarry) -> RolloutCarry:
        tick, state = carry
        new = self._dynamics.step(self._prepared, state, self._inputs(tick), tick, self._key)
        return tick + jnp.uint32(1), new

    def _some(self, carry: RolloutCarry, n: int) -> RolloutCarry:
        """Take `n` steps, in segments whose inside is computed again for the gradient."""
        return _segmented(carry, n, lambda carry: (self._one_step(carry), None), math.isqrt(n))[0]

    def recorded(self, n: int, carry: RolloutCarry, ports: Sequence[str], every: int) -> Rollout:
        """Take `n` steps and observe ports in between."""

        def seen(carry: RolloutCarry) -> dict[str, Array]:
            tick, state = carry
            inputs = self._inputs(tick) if self._sensors else {}
            return self._dynamics.observe(self._prepared, state, inputs, tick, self._key, ports)

        def interval(carry: RolloutCarry) -> tuple[RolloutCarry, dict[str, Array]]:
            carry = self._one_step(carry) if every == 1 else self._some(carry, every)
            return carry, seen(carry)

        if not ports:
            return Rollout({}, self._some(carry, n)[1])
        records = n // every
        begun = seen(carry)
        carry, later = _segmented(carry, records, interval, max(1, math.isqrt(n) // every))
        joined = jax.tree.map(lambda a, b: jnp.concatenate([a[None], b]), begun, later)
        return Rollout(joined, self._some(carry, n - records * every)[1])

    @property
    def _sensors(self) -> bool:
        return any(find.element(self._dynamics.doc, p).id in self._plan_sensors for p in self._paths)

    @property
    def _paths(self) -> list[str]:
        return [*self._still, *self._moving]

    @property
    def _plan_sensors(self) -> Mapping[str, int]:
        return self._dynamics.executable.plan.sensors


def _segmented(
    carry: RolloutCarry, n: int, interval: Callable[[RolloutCarry], tuple[RolloutCarry, Any]], size: int
) -> tuple[RolloutCarry, Any]:
    """Apply a function `n` times, in segments of `size` whose inside is computed again for the gradient;
    return the last value and what it gave beside, stacked.
    """

    def inner(carry: RolloutCarry, length: int) -> tuple[RolloutCarry, Any]:
        return lax.scan(lambda carry, _: interval(carry), carry, length=length)

    whole, remainder = divmod(n, max(1, size))
    segment = jax.checkpoint(lambda carry: inner(carry, max(1, size)))  # type: ignore[no-untyped-call]
    carry, records = lax.scan(lambda carry, _: segment(carry), carry, length=whole)
    records = jax.tree.map(lambda a: a.reshape(-1, *a.shape[2:]), records)
    carry, last = jax.checkpoint(lambda carry: inner(carry, remainder))(carry)
    return carry, jax.tree.map(lambda a, b: jnp.concatenate([a, b]), records, last)
