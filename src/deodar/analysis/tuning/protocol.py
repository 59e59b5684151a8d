"""Stages of input for a batch of candidates, in one compiled function."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.analysis.maps.patterns import count, widest
from deodar.analysis.settling_copies import LEAST_BLOCKS, SettlingLanes
from deodar.analysis.tuning.request import INPUTS, TuningRequest
from deodar.analysis.tuning.response import FieldInput, FieldResponse, SettledBatch, Stages
from deodar.compiler.arguments import ProgramState
from deodar.compiler.functions import Constants

LANES = 16
"""Candidates that are computed at once, until the last of them has settled."""


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


class TuningProtocol(SettlingLanes[TuningRequest]):
    """The response of any candidates to any stages of input.

    Args:
        request: what is measured.
    """

    def __init__(self, request: TuningRequest) -> None:
        super().__init__(request, INPUTS, LANES)

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
        constants = self.call(self.copies.constants, self._parameters(rounded, FieldInput()))
        states: dict[Stages, ProgramState] = {
            (): self.call(self.copies.start, self._parameters(rounded, FieldInput()))
        }
        settled: dict[Stages, SettledBatch] = {}

        def run(stages: Stages) -> SettledBatch:
            if stages not in settled:
                if stages[:-1] not in states:
                    run(stages[:-1])
                before = states[stages[:-1]]
                state, arrays_of_stage = self.call(
                    self._stage, self._parameters(rounded, stages[-1]), constants, before
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

    # ----------------------------------------------------------------------------------------------- compiled

    def _stage(
        self, parameters: Array, constants: list[Constants], state: ProgramState
    ) -> tuple[ProgramState, tuple[Array, ...]]:
        """Return the states when all candidates have settled, or at the limit, and what they are."""
        threshold = self.threshold(parameters)[:, None]

        def going(carry: StageCarry) -> Array:
            return (carry.blocks < LEAST_BLOCKS) | ((carry.blocks < self.longest) & ~carry.settled.all())

        def block(carry: StageCarry) -> StageCarry:
            begin = self.activation(carry.state)
            before, state = self.copies.run(parameters, constants, carry.state, self.steps)
            last, after = self.activation(before), self.activation(state)
            high, higher = (after - threshold).max(-1), (begin - threshold).max(-1)
            crossing = jnp.where(higher > 0, carry.blocks + self._passed(higher, high), carry.active)
            active = jnp.where(high > 0, carry.blocks + 1.0, crossing).astype(carry.active.dtype)
            # what is not finite does not change any more
            settled = ~(self.change(begin, last, after) > self.request.tolerance)
            return StageCarry(carry.blocks + 1, state, settled, active)

        none = jnp.zeros(self.lanes, parameters.dtype)
        end = jax.lax.while_loop(going, block, StageCarry(jnp.int32(0), state, none > 0, none))
        above = self.activation(end.state) - threshold
        peaks = count(above if self.axes else above[:, 0], self.axes)
        width = widest(above, self.axes[0]) if self.axes else none
        duration = self.steps * self.copies.dynamics.dt / self.request.isolated.field.tau
        return end.state, (above, peaks, width, end.settled, end.active * duration)

    def _passed(self, begin: Array, end: Array) -> Array:
        """Return after which share of a block activation falls below 0, if it relaxes with the time constant
        of the field.
        """
        duration = self.steps * self.copies.dynamics.dt / self.request.isolated.field.tau
        decay = math.exp(-duration)
        to = jnp.minimum((end - decay * begin) / (1 - decay), -1e-30)
        return jnp.clip(jnp.log1p(jnp.maximum(begin, 0.0) / -to) / duration, 0.0, 1.0)
