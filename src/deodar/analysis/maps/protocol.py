"""The protocol of a map: stages of input for each cell, in one compiled function that returns labels."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.analysis.isolated import WHOLE
from deodar.analysis.maps.labels import RegimeLabel
from deodar.analysis.maps.patterns import count, widest
from deodar.analysis.maps.request import MapRequest
from deodar.analysis.selection import HEAD_START
from deodar.analysis.settling_copies import INPUTS, LEAST_BLOCKS, SettlingLanes
from deodar.compiler.arguments import ProgramState
from deodar.compiler.functions import Constants

REST, ONE, NONE, AHEAD, EQUAL = range(5)
"""The stages: no input, one input, none again; two inputs, one of them ahead; two equal inputs."""

MOST_LANES = 64
"""Cells that are computed at once."""

BLOCKS = 400
"""Blocks of steps in one call, between which progress is shown."""

FAR = 1e4
"""Activation, relative to inputs and resting level, beyond which it grows without limit."""


class Lanes(NamedTuple):
    """The cells that are computed at once; a JAX PyTree.

    Attributes:
        cell: number of the cell of each lane; -1: idle.
        stage: stage of each lane.
        blocks: blocks of steps that it has taken in this stage.
        kept: whether a peak outlived its input.
        state: state of each copy.
        constants: constants of the copies.
        taken: how many cells of the queue have begun.
        labels: label of every cell of the grid, and of a last one that idle lanes write.
    """

    cell: Array
    stage: Array
    blocks: Array
    kept: Array
    state: ProgramState
    constants: list[Constants]
    taken: Array
    labels: Array


class RegimeProtocol(SettlingLanes[MapRequest]):
    """The stages of a map, for any of its cells.

    A lane takes the next cell of the queue when it has finished one, so that cells that settle late delay no
    others.

    Args:
        request: what is measured.
    """

    def __init__(self, request: MapRequest) -> None:
        super().__init__(request, INPUTS, MOST_LANES)
        self._columns = len(request.values[1])
        self._cells = math.prod(len(values) for values in request.values)

    def run(self, labels: np.ndarray, cells: np.ndarray, progress: Callable[[int], None]) -> np.ndarray:
        """Return the labels of a grid with those of some cells computed.

        Args:
            labels: labels so far, of all cells in one row.
            cells: numbers of the cells that are computed.
            progress: called with the number of cells that are done.
        """
        queue = np.zeros(self._cells, np.int32)
        queue[: len(cells)] = cells
        lanes = self.call(self._begin, np.append(labels, 0).astype(np.uint8))
        while True:
            lanes = self.call(self._blocks, lanes, queue, np.int32(len(cells)))
            going = int((np.asarray(lanes.cell) >= 0).sum())
            done = int(lanes.taken) - going
            progress(done)
            if done == len(cells):
                return np.asarray(lanes.labels)[:-1]

    # ----------------------------------------------------------------------------------------------- compiled

    def _begin(self, labels: Array) -> Lanes:
        """Return idle lanes."""
        none = jnp.full(self.lanes, -1, jnp.int32)
        zero = jnp.zeros(self.lanes, jnp.int32)
        parameters = self._parameters(none, zero)
        return Lanes(
            none,
            zero,
            zero,
            zero > 0,
            self.copies.start(parameters),
            self.copies.constants(parameters),
            jnp.int32(0),
            labels,
        )

    def _blocks(self, lanes: Lanes, queue: Array, total: Array) -> Lanes:
        """Return the lanes after `BLOCKS` blocks, or when all cells are done."""

        def going(carry: tuple[Array, Lanes]) -> Array:
            number, lanes = carry
            return (number < BLOCKS) & ((lanes.taken < total) | (lanes.cell >= 0).any())

        def block(carry: tuple[Array, Lanes]) -> tuple[Array, Lanes]:
            number, lanes = carry
            return number + 1, self._block(self._filled(lanes, queue, total))

        return jax.lax.while_loop(going, block, (jnp.int32(0), lanes))[1]

    def _filled(self, lanes: Lanes, queue: Array, total: Array) -> Lanes:
        """Give the next cells of the queue to idle lanes; where constants are rebuilt, to several at once."""
        idle = lanes.cell < 0
        least = self.lanes // 8 if self.copies.rebuilt else 1
        ready = (lanes.taken < total) & (idle.sum() >= jnp.minimum(least, total - lanes.taken))

        def fill(lanes: Lanes) -> Lanes:
            place = lanes.taken + jnp.cumsum(idle, dtype=jnp.int32) - 1
            begins = idle & (place < total)
            cell = jnp.where(begins, queue[jnp.clip(place, 0, self._cells - 1)], lanes.cell)
            parameters = self._parameters(cell, lanes.stage)
            return lanes._replace(
                cell=cell,
                stage=jnp.where(begins, REST, lanes.stage),
                blocks=jnp.where(begins, 0, lanes.blocks),
                kept=lanes.kept & ~begins,
                state=_where(begins, self.copies.start(parameters), lanes.state),
                constants=self.copies.constants(parameters) if self.copies.rebuilt else lanes.constants,
                taken=lanes.taken + begins.sum(dtype=jnp.int32),
            )

        return jax.lax.cond(ready, fill, lambda lanes: lanes, lanes)

    def _block(self, lanes: Lanes) -> Lanes:
        """Advance all lanes by a block of steps, and those that have settled to their next stage."""
        parameters = self._parameters(lanes.cell, lanes.stage)
        begin = self.activation(lanes.state)
        before, state = self.copies.run(parameters, lanes.constants, lanes.state, self.steps)
        last, activation = self.activation(before), self.activation(state)
        settled, far = self._judged(begin, last, activation)
        settled &= lanes.blocks + 1 >= LEAST_BLOCKS
        late = ~settled & (lanes.blocks + 1 >= self.longest)
        above = activation - self.threshold(parameters)[:, None]
        peaks = count(above if self.axes else above[:, 0], self.axes)
        covers = jnp.zeros_like(settled)
        if self.axes:
            covers = widest(above, self.axes[0]) >= WHOLE * self.axes[0].range
        label, stage, outlasts = self._decided(lanes, peaks, covers, self._joined(above))
        label = jnp.where(settled, label, -1)
        label = jnp.where(late, RegimeLabel.RESTLESS, label)
        label = jnp.where(far, RegimeLabel.UNBOUNDED, label)
        active = lanes.cell >= 0
        done, next_stage = active & (label >= 0), settled & (label < 0)
        labels = lanes.labels.at[jnp.where(done, lanes.cell, self._cells)].set(label.astype(jnp.uint8))
        restarts = next_stage & (stage == AHEAD)
        return lanes._replace(
            cell=jnp.where(done, -1, lanes.cell),
            stage=jnp.where(next_stage, stage, lanes.stage),
            blocks=jnp.where(next_stage, 0, lanes.blocks + 1),
            kept=jnp.where(next_stage, outlasts, lanes.kept),
            # an idle lane may hold values that are not finite
            state=_where(restarts | done, self.copies.start(parameters), state),
            labels=labels,
        )

    def _joined(self, above: Array) -> Array:
        """Return whether both places of the two inputs are active."""
        if not self.axes:
            return jnp.zeros(self.lanes, bool)
        return (above[:, np.array(self.request.samples)] > 0).all(-1)

    def _decided(
        self, lanes: Lanes, peaks: Array, covers: Array, joined: Array
    ) -> tuple[Array, Array, Array]:
        """Return what follows where a stage has settled: the label, or -1 and the next stage; and whether a
        peak outlived its input.
        """
        stage, some = lanes.stage, peaks > 0
        outlasts = jnp.where(stage == NONE, some, lanes.kept)
        label = jnp.full(self.lanes, -1, jnp.int32)
        label = jnp.where((stage == REST) & some, RegimeLabel.ACTIVE, label)
        label = jnp.where((stage == ONE) & ~some, RegimeLabel.SILENT, label)
        label = jnp.where(((stage == ONE) | (stage == NONE)) & covers, RegimeLabel.UNBOUNDED, label)
        alone = jnp.where(outlasts, RegimeLabel.SUSTAINED, RegimeLabel.DRIVEN)
        if not self.axes:
            return jnp.where(stage == NONE, alone, label), stage + 1, outlasts
        chosen = jnp.where(outlasts, RegimeLabel.SUSTAINED_SELECTIVE, RegimeLabel.SELECTIVE)
        # two peaks that have grown together are no selection
        won = (peaks == 1) & ~joined
        return jnp.where(stage == EQUAL, jnp.where(won, chosen, alone), label), stage + 1, outlasts

    def _judged(self, begin: Array, last: Array, activation: Array) -> tuple[Array, Array]:
        """Return whether each lane has settled, over the block and in its last step, and whether its
        activation is far beyond what inputs and resting level explain.
        """
        most = jnp.abs(activation).max(-1)
        far = ~(most < FAR * (self.request.isolated.scale + self.request.strength))
        return self.change(begin, last, activation) <= self.request.tolerance, far

    def _parameters(self, cell: Array, stage: Array) -> Array:
        """Return both parameters and the strengths of the inputs, (lanes, parameters)."""
        one, two = stage == ONE, stage >= AHEAD
        dtype = self.copies.dtype
        strength = jnp.asarray(self.request.strength, dtype)
        first = two * strength * jnp.where(stage == AHEAD, 1 + HEAD_START, 1.0)
        cell = jnp.maximum(cell, 0)
        places = (cell // self._columns, cell % self._columns)
        values = [jnp.asarray(v, dtype)[k] for v, k in zip(self.request.values, places, strict=True)]
        return jnp.stack([*values, one * strength, first, two * strength], axis=1).astype(dtype)


def _where(chosen: Array, new: Any, old: Any) -> Any:
    """Return the lanes of `new` where `chosen`, else those of `old`."""

    def pick(a: Array, b: Array) -> Array:
        return jnp.where(chosen.reshape(-1, *(1,) * (a.ndim - 1)), a, b)

    return jax.tree.map(pick, new, old)
