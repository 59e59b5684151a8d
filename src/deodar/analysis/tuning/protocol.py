"""Stages of input for a batch of candidates, in one compiled function."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.analysis.maps.patterns import count, widest
from deodar.analysis.settling_copies import SettlingCopies
from deodar.analysis.tuning.request import INPUTS, TuningRequest
from deodar.analysis.tuning.response import FieldInput, FieldResponse, SettledBatch, Stages
from deodar.compiler.arguments import ProgramState
from deodar.compiler.functions import Constants
from deodar.compiler.program import precision_context
from deodar.model import find
from deodar.numerics.axes import Axes

LANES, LEAST_LANES = 16, 8
"""Candidates that are computed at once, until the last of them has settled."""

LANE_BYTES = 8 * 2**20
"""Largest number of bytes of the matrices of all candidates, if each has its own."""

LEAST_BLOCKS = 2
"""Blocks of steps, each a time constant long, after which a stage may end."""


class StageCarry(NamedTuple):
    """A stage of a batch on its way; a JAX PyTree.

    Attributes:
        blocks: blocks of steps so far.
        state: state of each copy.
        settled: whether each has settled in the last block.
        active: blocks after which activation was last above the threshold.
    """

    blocks: Array
    state: ProgramState
    settled: Array
    active: Array


class TuningProtocol:
    """The response of any candidates to any stages of input.

    Args:
        request: what is measured.
    """

    def __init__(self, request: TuningRequest) -> None:
        self.request = request
        doc, isolated = request.model.document, request.isolated
        entry = find.element(doc, "field")
        inputs = [((find.element(doc, name).id, "amplitude"),) for name in INPUTS]
        dt = isolated.session.dt

        def copies(lanes: int) -> SettlingCopies:
            leaves = [*request.leaves, *inputs]
            return SettlingCopies(request.model, leaves, lanes, isolated.session.precision, dt)

        self.axes: Axes = isolated.axes
        self.copies = copies(LANES)
        matrix = sum(axis.samples**2 for axis in self.axes) * self.copies.dtype.itemsize
        if self.copies.rebuilt and matrix * LANES > LANE_BYTES:
            self.copies = copies(max(LEAST_LANES, LANE_BYTES // matrix))
        self.lanes = self.copies.count
        self._place = self.copies.dynamics.executable.plan.row[entry.id]
        tau = isolated.field.tau
        self._steps = max(2, math.ceil(tau / dt))
        self._longest = max(LEAST_BLOCKS, math.ceil(request.limit * tau / (self._steps * dt)))

    def responses(self, values: np.ndarray) -> Iterator[tuple[FieldResponse, np.ndarray]]:
        """Yield the responses of candidates in batches, with the values of each batch.

        Args:
            values: values of the parameters, (candidates, parameters).
        """
        for k in range(0, len(values), self.lanes):
            batch = values[k : k + self.lanes]
            yield self._response(batch), batch

    def _response(self, values: np.ndarray) -> FieldResponse:
        request, isolated = self.request, self.request.isolated
        # idle lanes repeat the last candidate
        padded = np.concatenate([values, np.repeat(values[-1:], self.lanes - len(values), axis=0)])
        rounded = padded.astype(self.copies.dtype)
        constants = self._call("constants", self._parameters(rounded, FieldInput()))
        states: dict[Stages, ProgramState] = {
            (): self._call("start", self._parameters(rounded, FieldInput()))
        }
        settled: dict[Stages, SettledBatch] = {}

        def run(stages: Stages) -> SettledBatch:
            if stages not in settled:
                if stages[:-1] not in states:
                    run(stages[:-1])
                before = states[stages[:-1]]
                state, arrays_of_stage = self._call(
                    "stage", self._parameters(rounded, stages[-1]), constants, before
                )
                arrays = [np.asarray(array)[: len(values)] for array in arrays_of_stage]
                states[stages], settled[stages] = state, SettledBatch(*arrays)
            return settled[stages]

        number = request.threshold_of
        threshold = np.full(len(values), isolated.threshold) if number is None else values[:, number]
        return FieldResponse(
            run, self.axes, request.strength, isolated.scale, threshold, request.samples, isolated.field.tau
        )

    def _parameters(self, values: np.ndarray, inputs: FieldInput) -> np.ndarray:
        inputs_of_field = np.array([getattr(inputs, name) for name in INPUTS], values.dtype)
        return np.concatenate([values, np.tile(inputs_of_field, (len(values), 1))], axis=1)

    def _call(self, name: str, *args: Any) -> Any:
        with (
            precision_context(self.request.isolated.session.precision),
            jax.default_matmul_precision("highest"),
        ):
            return self._compiled[name](*args)

    @cached_property
    def _compiled(self) -> dict[str, Callable[..., Any]]:
        return {
            "constants": jax.jit(self.copies.constants),
            "start": jax.jit(self.copies.start),
            "stage": jax.jit(self._stage),
        }

    # ----------------------------------------------------------------------------------------------- compiled

    def _stage(
        self, parameters: Array, constants: list[Constants], state: ProgramState
    ) -> tuple[ProgramState, tuple[Array, ...]]:
        """Return the states when all candidates have settled, or at the limit, and what they are."""
        threshold = self._threshold(parameters)[:, None]

        def going(carry: StageCarry) -> Array:
            return (carry.blocks < LEAST_BLOCKS) | ((carry.blocks < self._longest) & ~carry.settled.all())

        def block(carry: StageCarry) -> StageCarry:
            begin = self._activation(carry.state)
            before, state = self.copies.run(parameters, constants, carry.state, self._steps)
            last, after = self._activation(before), self._activation(state)
            high, higher = (after - threshold).max(-1), (begin - threshold).max(-1)
            crossing = jnp.where(higher > 0, carry.blocks + self._passed(higher, high), carry.active)
            active = jnp.where(high > 0, carry.blocks + 1.0, crossing).astype(carry.active.dtype)
            return StageCarry(carry.blocks + 1, state, self._settled(begin, last, after), active)

        none = jnp.zeros(self.lanes, parameters.dtype)
        end = jax.lax.while_loop(going, block, StageCarry(jnp.int32(0), state, none > 0, none))
        above = self._activation(end.state) - threshold
        peaks = count(above if self.axes else above[:, 0], self.axes)
        width = widest(above, self.axes[0]) if self.axes else none
        duration = self._steps * self.copies.dynamics.dt / self.request.isolated.field.tau
        return end.state, (above, peaks, width, end.settled, end.active * duration)

    def _passed(self, begin: Array, end: Array) -> Array:
        """Return after which share of a block activation falls below 0, if it relaxes with the time constant
        of the field.
        """
        duration = self._steps * self.copies.dynamics.dt / self.request.isolated.field.tau
        decay = math.exp(-duration)
        to = jnp.minimum((end - decay * begin) / (1 - decay), -1e-30)
        return jnp.clip(jnp.log1p(jnp.maximum(begin, 0.0) / -to) / duration, 0.0, 1.0)

    def _settled(self, begin: Array, last: Array, after: Array) -> Array:
        """Return whether each candidate has settled: over a block, and in its last step."""
        tau, dt = self.request.isolated.field.tau, self.copies.dynamics.dt
        slow = jnp.abs(after - begin).max(-1) * (tau / (self._steps * dt))
        fast = jnp.abs(after - last).max(-1) * (tau / dt)
        return ~(jnp.maximum(slow, fast) > self.request.tolerance)

    def _threshold(self, parameters: Array) -> Array:
        number = self.request.threshold_of
        if number is not None:
            return parameters[:, number]
        return jnp.full(self.lanes, self.request.isolated.threshold, parameters.dtype)

    def _activation(self, state: ProgramState) -> Array:
        """Return the activation of the field, candidates first; a node has one sample."""
        group, row = self._place
        return state["groups"][group]["activation"][:, row].reshape(self.lanes, -1)
