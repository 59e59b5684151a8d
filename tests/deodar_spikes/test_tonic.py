"""Tonic neurons: the same resting level for neurons that differ, so that detection stays where it is."""

from __future__ import annotations

import numpy as np
import pytest

from deodar_spikes.build import build
from deodar_spikes.chip_limits import chip_limits
from deodar_spikes.fitting import fit
from deodar_spikes.graph import NirGraph
from deodar_spikes.mismatch import differing
from deodar_spikes.running import rates
from deodar_spikes.simulator import SpikingSimulator
from deodar_spikes.translate import translate
from tests.deodar_spikes.scenes import DETECTOR, bistable, pairs, winner_take_all

DETECTION = 4.27
"""Input from which on the rate model has a peak (evidence/neuromorphic)."""


def network(tonic: bool) -> NirGraph:
    return build(translate(bistable(DETECTOR, np.zeros((1, 31))), tonic=tonic).network)


def active(graph: NirGraph, strength: float, fields: tuple[str, ...] = ("v_threshold", "bias")) -> np.ndarray:
    """Whether each of 20 chips with a mismatch of 20 % has a peak after 1 s of a localised input."""
    chips = differing(graph, dict.fromkeys(fields, 0.2), 20, seed=3)
    simulator = SpikingSimulator(graph, copies=20, differing=chips)
    cells = strength * np.exp(-((np.arange(31) - 15) ** 2) / 8)
    inputs = np.repeat(cells[None].astype(np.float32), 2000, 0)
    inputs[: round(graph.settling / graph.step)] = 0
    sums, _ = simulator.run(simulator.start(), inputs, 20)
    return rates(graph, sums[-5:], 20)["u"].mean(0).max(-1) > 0.5


@pytest.mark.parametrize("fields", [("v_threshold", "bias"), ("v_threshold", "bias", "w_in")])
def test_detection_is_within_5_percent_of_the_rate_model(fields: tuple[str, ...]) -> None:
    graph = network(True)
    assert not active(graph, 0.95 * DETECTION, fields).any()
    assert active(graph, 1.05 * DETECTION, fields).all()


def test_with_constant_currents_detection_is_not() -> None:
    assert active(network(False), 0.95 * DETECTION).all()


def test_a_winner_take_all_gives_its_thresholds_to_them_too() -> None:
    trials = pairs(5)
    translated = translate(winner_take_all(trials.inputs[0]), neurons=10, tonic=True)
    report = {line.what: line.why for line in translated.report.lines if line.where == "pool"}
    for name in ("threshold", "threshold_inhibition"):
        assert report[name] == "synaptic weights from tonic neurons"
    assert all(p.resting == 0 for p in translated.network.populations)
    graph = build(translated.network)
    chips = differing(graph, {"v_threshold": 0.2, "bias": 0.2}, 5, seed=3)
    simulator = SpikingSimulator(graph, copies=5, differing=chips)
    inputs = np.broadcast_to(trials.inputs, (800, *trials.inputs.shape)).copy()
    sums, _ = simulator.run(simulator.start(), inputs, 400)
    tonic = graph.outputs[-1]
    assert (sums[1][:, tonic.start : tonic.stop] == 400).all(), "they spike in each step"
    assert (abs(rates(graph, sums, 400)["pool"][1].argmax(-1) - trials.places) <= 2).all()


def test_weights_of_8_bits_keep_a_resting_level() -> None:
    fitted = fit(network(True), chip_limits("digital-8-bit")).graph
    part = fitted.outputs[-1]
    weights = [g.nodes["synapses"].weight[: part.start, part.start :] for g in (network(True), fitted)]
    assert np.allclose(weights[1], weights[0], rtol=1e-5) and weights[0].max() < 0
