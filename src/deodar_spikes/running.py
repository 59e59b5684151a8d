"""The input of a network over time, and runs of its graph, on several chips and in several trials."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deodar.batch.simulate import simulate
from deodar.errors import TimeError
from deodar.model.model import Model
from deodar.resources import Resources
from deodar.worlds._base import World
from deodar_spikes.graph import INPUT, NirGraph
from deodar_spikes.mismatch import chip, differing
from deodar_spikes.norse import run_norse
from deodar_spikes.simulator import SpikingSimulator
from deodar_spikes.translate import Translated

InputValues = NDArray[np.float32]

MOST_STEPS = 1_000_000


@dc.dataclass(frozen=True)
class NetworkInput:
    """The analog input of a network, and its spike trains as rates.

    Attributes:
        analog: steps x values of the Input, or steps x trials x values; first the steps in which currents
            settle, without input.
        settling: number of these steps.
        step: dt in s.
        expected: spikes per step of each value of the Input that is a spike train; 0 for analog values.
    """

    analog: InputValues
    settling: int
    step: float
    expected: InputValues

    @property
    def on(self) -> NDArray[np.bool_]:
        """Whether an excitatory input is on, for each step after settling."""
        peak_input = self.analog[self.settling :].max(tuple(range(1, self.analog.ndim)), initial=0.0)
        return np.asarray(peak_input > 1e-3 * max(1e-30, float(peak_input.max(initial=0.0))))

    def pieces(self, trials: int, seed: int, size: int) -> Iterator[InputValues]:
        """Yield pieces of `size` steps: steps x values if all trials are equal, else steps x trials x values.

        The spike trains of trial k are the same for any number of trials and any size of pieces.
        """
        sources = [np.random.default_rng([seed, k]) for k in range(trials)]
        places = np.flatnonzero(self.expected)
        for start in range(0, len(self.analog), size):
            part = self.analog[start : start + size]
            if not len(places):
                yield part
                continue
            many = part.copy() if part.ndim == 3 else np.repeat(part[:, None], trials, axis=1)
            for k, source in enumerate(sources):
                many[:, k, places] = source.poisson(self.expected[places], (len(part), len(places)))
            yield many


def network_input(
    translated: Translated,
    graph: NirGraph,
    duration: float,
    world: World | None = None,
    trials: int | None = None,
    seed: int = 0,
) -> NetworkInput:
    """Return the input of a network: that of the model, from its start.

    Args:
        translated: the network and the document of what is computed by deodar.
        graph: the graph of the network.
        duration: document time.
        world: the world that its sensors read.
        trials: number of trials, each with an input of its own, because the world differs between them; none:
            all trials have the same input.
        seed: seed of the world, and of noise outside of the network.

    Raises:
        TimeError: the duration has too many steps.
    """
    doc, step = translated.drive, translated.network.step / translated.network.unit
    steps = round(duration / step)
    settling = round(graph.settling / graph.step)
    if not 1 <= steps <= MOST_STEPS:
        raise TimeError(
            f"{duration:g} are {steps:,} steps of {step:g}",
            fix=f"Give a duration up to {MOST_STEPS * step:g}",
        )
    many = () if trials is None else (trials,)
    analog = np.zeros((settling + steps, *many, graph.nodes[INPUT].size), np.float32)
    fed = {doc.by_id()[c.target].path for c in doc.connections if c.target_port == "input"}
    ranges = [r for r in graph.inputs if r.kind == "analog" and r.label in fed]
    if ranges:
        model = Model(doc.name)
        model.commit(doc)
        ports = {r.label: f"{r.label}.input" for r in ranges}
        record = simulate(
            model,
            steps * step,
            dt=step,
            seed=seed,
            record=list(ports.values()),
            every=step,
            trials=trials,
            world=world,
            on=Resources(progress=False),
        )
        for r in ranges:
            values = record[ports[r.label]].values
            values = values if trials is None else np.moveaxis(values, 0, 1)
            analog[settling:, ..., r.start : r.stop] = values[:steps].reshape(steps, *many, -1)
    expected = np.zeros(graph.nodes[INPUT].size, np.float32)
    for r in graph.inputs:
        expected[r.start : r.stop] = r.rate * graph.step
    return NetworkInput(analog, settling, graph.step, expected)


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
