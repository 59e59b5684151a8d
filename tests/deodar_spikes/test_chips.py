"""The limits of chips: rounding, cores, and what does not fit."""

from __future__ import annotations

import numpy as np
import pytest

from deodar.errors import UnknownName
from deodar_spikes.build import build
from deodar_spikes.chip_limits import ChipLimits, chip_limits, chip_names
from deodar_spikes.fitting import fit
from deodar_spikes.graph import AffineNode, NeuronNode
from deodar_spikes.mismatch import chip, differing
from deodar_spikes.translate import translate
from tests.deodar_spikes.scenes import pairs, winner_take_all


def graph():
    return build(translate(winner_take_all(pairs(1).inputs[0])).network)


@pytest.mark.parametrize("name", chip_names())
def test_every_number_of_a_chip_has_a_source(name: str) -> None:
    limits = chip_limits(name)
    stated = {
        k for k, v in vars(limits).items() if v not in (None, {}) and k not in ("name", "meaning", "sources")
    }
    assert set(limits.sources) == stated and all(limits.sources.values()) and limits.meaning


def test_an_unknown_chip_suggests_the_nearest() -> None:
    with pytest.raises(UnknownName, match="Did you mean 'digital-8-bit'"):
        chip_limits("digital-8bit")


def test_the_ideal_chip_changes_nothing() -> None:
    fitted = fit(graph(), chip_limits("ideal"))
    assert fitted.fits and not fitted.lines and fitted.cores == 1
    assert np.array_equal(fitted.graph.nodes["synapses"].weight, graph().nodes["synapses"].weight)


def test_weights_of_8_bits_have_few_values_in_each_block() -> None:
    fitted, whole = fit(graph(), chip_limits("digital-8-bit")), graph()
    new, old = fitted.graph.nodes["synapses"], whole.nodes["synapses"]
    assert isinstance(new, AffineNode) and isinstance(old, AffineNode)
    block = new.weight[:600, :600]
    assert len(np.unique(block)) <= 255 and np.abs(block - old.weight[:600, :600]).max() <= (
        np.abs(block).max() / 127 / 2 * 1.001
    )
    assert fitted.fits and any("8 bits" in line.why for line in fitted.lines)


def test_neurons_are_divided_among_cores_without_gaps() -> None:
    whole = graph()
    for limits in (ChipLimits("small", "", neurons_per_core=100), ChipLimits("w", "", sources_per_core=650)):
        parts = fit(whole, limits).parts
        assert [p.start for p in parts] == [0, *(p.stop for p in parts[:-1])] and parts[-1].stop == 640
    assert fit(whole, ChipLimits("small", "", neurons_per_core=100)).cores == 7
    assert not fit(whole, ChipLimits("tiny", "", neurons_per_core=100, cores=6)).fits
    for bits, cores in ((50_000, 7), (100_000, 4)):  # of 312,600 synapses
        assert fit(whole, ChipLimits("bits", "", synapse_bits_per_core=bits)).cores == cores


def test_neurons_with_too_many_synapses_are_named() -> None:
    fitted = fit(graph(), chip_limits("analog-mismatch"))
    assert not fitted.fits
    assert [line.where for line in fitted.lines if line.verdict == "dropped"] == ["pool", "pool inhibitory"]


def test_chips_differ_and_each_has_the_spread_that_was_asked_for() -> None:
    found = differing(graph(), {"v_threshold": 0.2, "bias": 0.1}, 5)
    thresholds = found["neurons"]["v_threshold"]
    assert thresholds.std(1) == pytest.approx(np.full(5, 0.2), rel=0.15)
    assert not np.array_equal(thresholds[0], thresholds[1])
    one = chip(graph(), {"v_threshold": 0.2, "bias": 0.1}, number=3)
    node = one.nodes["neurons"]
    assert isinstance(node, NeuronNode) and np.array_equal(node.v_threshold, thresholds[3])
    assert not differing(graph(), {"v_threshold": 0.0}, 2)
