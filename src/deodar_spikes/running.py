"""Runs of a graph, on several chips and in several trials, as outputs of the elements of the model."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deodar_spikes.drive import NetworkInput
from deodar_spikes.graph import NirGraph
from deodar_spikes.mismatch import chip, differing
from deodar_spikes.norse import run_norse
from deodar_spikes.simulator import SpikingSimulator

Rates = Mapping[str, NDArray[np.float32]]
"""For each probed element: windows x trials x cells."""

PIECE = 40
"""Windows that are computed at once."""


@dc.dataclass(frozen=True)
class SpikingTrials:
    """The trials of a graph.

    Attributes:
        number: number of trials; trial k runs on chip k modulo `chips`.
        every: steps of a window.
        spread: relative standard deviation between neurons, by parameter.
        chips: number of chips.
        seed: seed of mismatch and spike trains.
    """

    number: int
    every: int
    spread: Mapping[str, float] = dc.field(default_factory=dict[str, float])
    chips: int = 1
    seed: int = 0


def simulated(graph: NirGraph, inputs: NetworkInput, trials: SpikingTrials) -> Rates:
    """Run a graph in the simulator of deodar.

    Args:
        graph: the graph.
        inputs: its input.
        trials: number of trials, windows and chips.
    """
    number, every, chips, seed = trials.number, trials.every, trials.chips, trials.seed
    on = np.arange(number) % chips
    parameters = {
        node: {field: values[on] for field, values in fields.items()}
        for node, fields in differing(graph, trials.spread, min(chips, number), seed).items()
    }
    simulator = SpikingSimulator(graph, copies=number, differing=parameters)
    state, found = simulator.start(), list[NDArray[np.float32]]()
    whole = _whole(inputs, every)
    for piece in whole.pieces(number, seed, PIECE * every):
        sums, state = simulator.run(state, piece, every)
        found.append(sums)
    return rates(graph, np.concatenate(found)[whole.settling // every :], every)


def in_norse(
    graph: NirGraph,
    given: NetworkInput,
    trials: SpikingTrials,
    python: str | Path | None = None,
) -> Rates:
    """Run a graph in norse: a file for each chip; see `simulated`."""
    number, every, chips, seed = trials.number, trials.every, trials.chips, trials.seed
    whole = _whole(given, every)
    steps = len(whole.analog)
    [inputs] = whole.pieces(number, seed, steps)
    if inputs.ndim == 2:
        inputs = np.repeat(inputs[:, None], number, axis=1)
    parts = [np.arange(k, number, chips) for k in range(min(chips, number))]
    spikes = [
        run_norse(chip(graph, trials.spread, seed, k), inputs[:, part], every, python)
        for k, part in enumerate(parts)
    ]
    sums = np.empty((steps // every, number, spikes[0].shape[-1]), np.float32)
    for part, values in zip(parts, spikes, strict=True):
        sums[:, part] = values
    return rates(graph, sums[whole.settling // every :], every)


def rates(graph: NirGraph, sums: NDArray[np.float32], every: int) -> Rates:
    """Return the outputs of elements from sums of spikes in windows."""
    return {
        r.label: sums[..., r.start : r.stop].reshape(*sums.shape[:-1], -1, r.neurons).sum(-1)
        * np.float32(r.unit / r.neurons / every)
        for r in graph.outputs
        if r.probed
    }


def _whole(inputs: NetworkInput, every: int) -> NetworkInput:
    """Return the input with a number of settling steps and steps that are multiples of a window."""
    settling = -(-inputs.settling // every) * every
    steps = (len(inputs.analog) - inputs.settling) // every * every
    before = np.zeros((settling - inputs.settling, *inputs.analog.shape[1:]), np.float32)
    analog = np.concatenate([before, inputs.analog[: inputs.settling + steps]])
    return NetworkInput(analog, settling, inputs.step, inputs.expected)
