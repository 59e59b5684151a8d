"""Rates and spikes in the same measures, and what a translation reports."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.errors import ModelError, ParameterError, TimeError, TooLarge
from deodar_spikes.build import build
from deodar_spikes.comparison import compare_spikes, outcomes
from deodar_spikes.norse import norse_version, run_norse
from deodar_spikes.prepare import SpikingOptions
from deodar_spikes.running import SpikingTrials, network_input, simulated
from deodar_spikes.translate import translate
from tests.deodar_spikes.scenes import pairs, winner_take_all

X = dd.Axis("x", 0, 30, samples=31)


def memory(noise: float = 0.0) -> dd.Model:
    """A field that keeps a peak, with an input from 50 to 150 ms."""
    model = dd.Model("memory", dt=0.5)
    kernel = [dd.Gaussian(18, 2, normalized=True), dd.Gaussian(-8, 5, normalized=True)]
    u = model.add(dd.Field("u", [X], 20, -5.0, kernel=kernel, global_inhibition=0.1, noise=noise))
    cue = dd.GaussianStimulus("cue", [X], center=11, sigma=2, amplitude=7, windows=[(50, 150)])
    model.add(cue) >> u
    return model


def test_a_memory_of_spikes_is_that_of_rates() -> None:
    found = compare_spikes(memory(), 600, trials=2, norse=False)
    rates, spikes = (found.estimates["u"][run] for run in ("rates", "spikes"))
    for name in ("winner", "memory"):
        assert rates[name].value == spikes[name].value == 1.0
    assert spikes["peaks"].value == 1 and abs(rates["detection"].value - spikes["detection"].value) <= 5
    assert spikes["difference"].value < 0.05 and spikes["drift"].value < 0.2
    assert spikes["forgetting"].n == 0 and np.isnan(spikes["forgetting"].value)


def test_poisson_spikes_have_the_variance_of_the_noise() -> None:
    """The field without interaction, far below its threshold, read through the current of its neurons."""
    model = dd.Model("noise", dt=0.5)
    model.add(dd.Field("u", [dd.Axis("x", 0, 9, samples=10)], 20, -5.0, noise=2.0))
    translated = translate(model, neurons=1)
    graph = build(translated.network)
    given = network_input(translated, graph, 2000)
    [inputs] = given.pieces(1, 0, len(given.analog))
    drive = graph.nodes["drive"]
    [population] = translated.network.populations
    s = (inputs[:, 0] @ drive.weight.T) / population.code.gain
    assert s.mean() == pytest.approx(0, abs=0.5)
    assert s.var() == pytest.approx(2.0**2 / 0.5, rel=0.05)  # q^2 / (dt x cell)


def test_trials_differ_by_noise_alone_and_repeat() -> None:
    translated = translate(memory(noise=1.0), neurons=5)
    graph = build(translated.network)
    given = network_input(translated, graph, 200)
    three = simulated(graph, given, SpikingTrials(3, 10))["u"]
    two = simulated(graph, given, SpikingTrials(2, 10))["u"]
    assert not np.array_equal(three[:, 0], three[:, 1]) and np.array_equal(three[:, :2], two)


def test_fields_that_are_coupled_become_one_network() -> None:
    model = memory()
    y = dd.Axis("y", 0, 30, samples=16)
    v = model.add(dd.Field("v", [y], 10, -1.0, sigmoid=dd.SemiLinear()))
    model["u"] >> model.add(dd.Project([y], rename={"x": "y"})) >> model.add(dd.Gain(3.0)) >> v
    product = model.add(dd.Product(name="both"))
    model["u"] >> product
    model.connect("cue", "both.factor")
    translated = translate(model, neurons=4)
    report = {(line.where, line.what): line for line in translated.report.lines}
    assert [p.label for p in translated.network.populations] == ["u", "v"]
    assert {(p.source, p.target) for p in translated.network.projections} == {(0, 0), (0, 1)}
    assert report["both", "Product"].verdict == "dropped" and "not linear" in report["both", "Product"].why
    assert report["both", "u"].verdict == "dropped" and report["cue", "GaussianStimulus"].verdict == "carried"
    graph = build(translated.network)
    run = simulated(graph, network_input(translated, graph, 300), SpikingTrials(1, 10))
    expected = dd.simulate(model, 300, record=["v.output"], every=300)["v.output"].values[-1]
    assert run["v"].shape == (60, 1, 16)
    assert np.sqrt(np.mean((run["v"][-10:].mean((0, 1)) - expected) ** 2)) < 0.05 * expected.max()


def test_outcomes_of_a_peak_that_moves_and_goes() -> None:
    axis = dd.Axis("x", 0, 9, samples=10)
    outputs = np.zeros((40, 2, 10), np.float32)
    outputs[12:30, 0, 3] = 1.0  # detected after 2 windows, gone 10 windows after the input
    outputs[11:, 1, 6] = 1.0
    outputs[22:, 1, 6], outputs[22:, 1, 8] = 0.0, 1.0
    on = np.zeros(40, bool)
    on[10:20] = True
    found = outcomes(outputs, (axis,), on, 5.0, 1.0)
    assert found.winner.tolist() == [3, 6] and found.peaks.tolist() == [1, 1]
    assert found.detection.tolist() == [12.5, 7.5]
    assert found.forgetting[0] == 52.5 and np.isnan(found.forgetting[1])
    assert found.memory.tolist() == [0, 1] and found.drift[1] == pytest.approx(2)


def test_a_model_without_neurons_is_refused() -> None:
    model = dd.Model("none")
    model.add(dd.Boost("b"))
    with pytest.raises(ModelError, match=r"nothing in the model 'none' becomes neurons.*Field"):
        translate(model)
    model = dd.Model("linear")
    model.add(dd.Field("u", sigmoid=dd.Linear(-1.0)))
    with pytest.raises(ModelError, match=r"u: its slope is not above 0"):
        translate(model)


def test_a_step_above_a_time_constant_is_refused() -> None:
    model = winner_take_all(pairs(1).inputs[0])
    with pytest.raises(TimeError, match=r"pool: the step 6 ms is not below tau_inhibition = 5 ms.*step=0.5"):
        translate(model, step=6)
    with pytest.raises(TimeError, match=r"the step 20 ms is not below the membrane"):
        translate(model, step=20)


def test_a_network_that_is_too_large_is_refused_before_it_is_made() -> None:
    plane = [dd.Axis("x", 0, 99, samples=60), dd.Axis("y", 0, 99, samples=60)]
    model = dd.Model("plane")
    model.add(dd.Field("u", plane))
    with pytest.raises(TooLarge, match="weights, more than"):
        build(translate(model).network)


def test_wrong_numbers_are_refused() -> None:
    with pytest.raises(ParameterError, match="a mismatch of 3"):
        compare_spikes(memory(), 100, 1, SpikingOptions(mismatch=3.0), norse=False)
    with pytest.raises(ParameterError, match="0 neurons of a cell"):
        translate(memory(), neurons=0)
    with pytest.raises(ParameterError, match="0 trials"):
        compare_spikes(memory(), 100, 0, norse=False)


def test_an_environment_without_norse_is_named() -> None:
    assert norse_version("/nowhere/python") == ""
    with pytest.raises(dd.errors.MissingExtra, match="norse"):
        run_norse(build(translate(memory(), neurons=2).network), np.zeros((2, 1, 31), np.float32), 1, "/no")


def test_correlated_noise_keeps_its_correlation() -> None:
    """Its matrix is computed in double precision, whatever the process computes in."""
    model = dd.Model("noise", dt=0.5)
    axis = dd.Axis("x", 0, 9, samples=10)
    model.add(dd.Field("u", [axis], 20, -5.0, noise=2.0, noise_length=1.5))
    noise = translate(model, neurons=4).network.populations[0].noise
    assert noise is not None
    distance = np.subtract.outer(axis.points, axis.points)
    expected = np.exp(-(distance**2) / (2 * 1.5**2))
    covariance = noise @ noise.T
    np.testing.assert_allclose(covariance / covariance[0, 0], expected, atol=1e-7)
