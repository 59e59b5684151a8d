"""The soft winner-take-all of neurons selects what the rate model selects."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar_spikes.build import build
from deodar_spikes.simulator import SpikingSimulator
from deodar_spikes.translate import translate
from tests.deodar_spikes.scenes import CELLS, pairs, winner_take_all

STEPS = 800


def rates(inputs: np.ndarray, inhibition: float = 1.0) -> np.ndarray:
    """The output of each cell in the second half of 400 ms, by trial."""
    graph = build(translate(winner_take_all(inputs[0], inhibition)).network)
    simulator = SpikingSimulator(graph, copies=len(inputs))
    drive = np.broadcast_to(inputs, (STEPS, *inputs.shape)).copy()
    spikes, _ = simulator.run(simulator.start(), drive, every=STEPS // 2)
    part = graph.outputs[0]
    cells = spikes[1][:, part.start : part.stop].reshape(len(inputs), CELLS, part.neurons).sum(-1)
    return cells * part.unit / part.neurons / (STEPS // 2)


def test_neurons_select_the_stronger_input_as_the_rate_model_does() -> None:
    trials = pairs(20)
    found = rates(trials.inputs)
    expected = np.array(
        [
            dd.simulate(winner_take_all(s), 400, record=["pool.output"], every=400)["pool.output"].values[-1]
            for s in trials.inputs[:5]
        ]
    )
    assert (abs(found.argmax(1) - trials.places) <= 2).all()
    assert np.sqrt(np.mean((found[:5] - expected) ** 2)) <= 0.05 * expected.max()


def test_without_inhibition_they_do_not_select() -> None:
    trials = pairs(20)
    found = rates(trials.inputs, inhibition=0.0)
    assert ((found > 0.3 * found.max(1, keepdims=True)).sum(1) > 12).all()
