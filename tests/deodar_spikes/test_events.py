"""A field in front of the event camera selects the same of two blinking targets as rates and as spikes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar_spikes.build import build
from deodar_spikes.comparison import SpikingComparison, compare_spikes
from deodar_spikes.prepare import SpikingOptions
from deodar_spikes.running import network_input
from deodar_spikes.translate import translate
from tests.deodar_spikes.scenes import Targets, chosen, targets

RECORDING = Path(__file__).parents[1] / "deodar_robots" / "event_file" / "one.aedat4"

TRIALS = 8
MODEL = dd.architectures.event_selection()


def compared(model: dd.Model, given: Targets, duration: float = 600) -> SpikingComparison:
    options = SpikingOptions(neurons=3, mismatch=0.1)
    return compare_spikes(model, duration, TRIALS, options, given.world, norse=False)


def last(comparison: SpikingComparison, run: str) -> np.ndarray:
    """The mean output in the last 100 ms, trials x cells."""
    return comparison.runs[run]["perceptual"][-20:].mean(0)


@pytest.fixture(scope="module")
def given() -> Targets:
    return targets(TRIALS, 0.8)


@pytest.fixture(scope="module")
def comparison(given: Targets) -> SpikingComparison:
    return compared(MODEL, given)


def test_rates_and_spikes_select_the_target_with_more_contrast(
    comparison: SpikingComparison, given: Targets
) -> None:
    for run in ("rates", "spikes"):
        target, other = chosen(last(comparison, run), given)
        assert target.all() and not other.any(), run
    # the places differ, so that each trial must be compared with itself
    assert len(np.unique(last(comparison, "rates").argmax(-1))) > 4
    same = comparison.estimates["perceptual"]["spikes"]["winner"]
    assert same.value == 1.0 and same.n == TRIALS
    assert comparison.estimates["perceptual"]["spikes"]["difference"].value < 0.05


def test_without_inhibition_they_select_neither(given: Targets) -> None:
    comparison = compared(dd.architectures.event_selection(inhibition=0.0), given, 400)
    for run in ("rates", "spikes"):
        target, other = chosen(last(comparison, run), given)
        assert target.all() and other.all(), run


def test_both_read_the_same_events_and_each_trial_its_own(
    comparison: SpikingComparison, given: Targets
) -> None:
    spikes = comparison.given.analog[comparison.given.settling :]
    record = dd.simulate(MODEL, 100, record="perceptual.input", every=1, trials=TRIALS, world=given.world)
    rates = np.moveaxis(record["perceptual.input"].values, 0, 1)[:100].reshape(100, TRIALS, -1)
    assert np.array_equal(spikes[:100], rates)
    assert np.ptp(spikes[:100], axis=1).max() > 1


def test_a_recording_is_the_input_of_all_trials() -> None:
    translated = translate(MODEL, neurons=1)
    graph = build(translated.network)
    world = dd.EventFile(RECORDING, period=10.0)
    network = network_input(translated, graph, 60, world, 2)
    given = network.analog[network.settling :]
    assert given.max() > 0 and np.array_equal(given[:, 0], given[:, 1])
    record = dd.simulate(MODEL, 60, record="perceptual.input", every=1, world=world)
    assert np.array_equal(given[:, 0].reshape(60, 16, 16), record["perceptual.input"].values[:60])
