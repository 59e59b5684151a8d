"""The input of a network over time: what deodar computes, and Poisson spikes."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from deodar.batch.simulate import simulate
from deodar.errors import TimeError
from deodar.model.model import Model
from deodar.resources import Resources
from deodar.worlds._base import World
from deodar_spikes.graph import INPUT, NirGraph
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
