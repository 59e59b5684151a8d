"""The rate of a neuron, and populations whose rate follows an output function."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar_spikes.graph import EndNode, NeuronNode, NirGraph
from deodar_spikes.simulator import SpikingSimulator
from deodar_spikes.spike_code import NoSpikeCode, spike_code, steady_rate

STEP = 5e-4
CURRENTS = np.array([0.5, 1.0, 1.05, 1.3, 2.0, 3.7, 6.0, 12.0])


def counts(step: float, duration: float) -> np.ndarray:
    """Spikes of neurons with constant currents, after the current has settled."""

    def full(value: float) -> np.ndarray:
        return np.full(len(CURRENTS), value, np.float32)

    neurons = NeuronNode(full(1e-3), full(20e-3), full(1), full(0), full(1), full(0), full(1))
    nodes = {"input": EndNode(len(CURRENTS)), "neurons": neurons, "output": EndNode(len(CURRENTS))}
    simulator = SpikingSimulator(NirGraph(nodes, [("input", "neurons"), ("neurons", "output")], step))
    inputs = CURRENTS.astype(np.float32)[None].repeat(round(duration / step), 0)
    _, state = simulator.run(simulator.start(), inputs[: round(0.1 / step)], every=1)
    return simulator.run(state, inputs, every=len(inputs))[0][0, 0]


def test_the_rate_of_a_neuron_is_the_analytic_one_within_1_percent() -> None:
    duration, membrane = 4.0, 20e-3
    with np.errstate(divide="ignore", invalid="ignore"):
        analytic = np.where(CURRENTS > 1, 1 / (membrane * np.log(CURRENTS / (CURRENTS - 1))), 0)
    measured = counts(1e-5, duration) / duration
    assert measured == pytest.approx(analytic, rel=0.01)
    # and of one spike in k steps where steps are long
    assert counts(5e-4, duration) == pytest.approx(
        steady_rate(CURRENTS, 5e-4 / membrane) * duration / 5e-4, abs=1
    )


@pytest.mark.parametrize("neurons", [10, 20, 50])
@pytest.mark.parametrize(
    "sigmoid",
    [
        dd.Logistic(beta=4, threshold=0.5),
        dd.Logistic(beta=0.7),
        dd.Step(1.0),
        dd.SemiLinear(2.0, 0.5),
        dd.Absolute(50),
    ],
)
def test_the_mean_rate_follows_the_output_function(sigmoid, neurons: int) -> None:
    code = spike_code(sigmoid, neurons, STEP, 20e-3)
    u = np.linspace(code.low, code.high, 1001)
    difference = (code.output(u, STEP) - np.asarray(sigmoid(u))) / code.peak
    if not isinstance(sigmoid, dd.Step):
        assert np.sqrt(np.mean(difference**2)) == pytest.approx(code.rms, rel=0.1)
        assert code.rms < 0.35 / neurons + 0.01 and code.worst < 0.6 / neurons + 0.02
    else:
        assert np.sqrt(np.mean(difference**2)) < 0.05


def test_the_error_falls_with_the_number_of_neurons() -> None:
    errors = [spike_code(dd.Logistic(4), n, STEP, 20e-3).rms for n in (5, 10, 20, 40)]
    assert errors == sorted(errors, reverse=True) and errors[-1] < 0.3 * errors[0]


def test_a_semi_linear_output_needs_a_lift_of_a_half_on_average() -> None:
    assert spike_code(dd.SemiLinear(), 20, STEP, 20e-3).offsets.mean() == pytest.approx(0.5)


@pytest.mark.parametrize("sigmoid", [dd.SemiLinear(0.0), dd.Linear(-1.0)])
def test_a_function_without_a_rising_rate_is_refused(sigmoid) -> None:
    with pytest.raises(NoSpikeCode):
        spike_code(sigmoid, 20, STEP, 20e-3)
