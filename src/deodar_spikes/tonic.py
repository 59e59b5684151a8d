"""Resting levels from neurons that spike in every step, in place of constant currents.

The constant current that holds a field at rest is the largest one, and neurons that differ in it differ in
their thresholds. Tonic neurons give all neurons of a network the same resting level: they are driven so
strongly that they spike in each step, however much they differ. Of the constant currents only the spread of
the thresholds remains, which follows the output function.
"""

from __future__ import annotations

import dataclasses as dc

import numpy as np

from deodar_spikes.network import Population, Projection, SpikingNetwork
from deodar_spikes.spike_code import QUICK, SpikeCode

LABEL = "tonic neurons"

DRIVE = 10.0 * QUICK
"""Constant current of a tonic neuron: ten times the one from which on it spikes in each step."""


def with_tonic_neurons(network: SpikingNetwork, neurons: int) -> SpikingNetwork:
    """Return a network whose resting levels are synapses from tonic neurons.

    Args:
        network: the network.
        neurons: number of tonic neurons; each gives an equal part of every resting level.
    """
    quick = QUICK * network.step
    code = SpikeCode(1.0, np.full(neurons, DRIVE), 1.0, quick, 0.0, 0.0, 1.0, 0.0, 0.0)
    tonic = Population(LABEL, "", "tonic", (), code, 0.0, quick, probed=False)
    source = len(network.populations)
    resting = [
        Projection(source, target, np.full((p.cells, 1), p.resting))
        for target, p in enumerate(network.populations)
        if p.resting
    ]
    populations = [*(dc.replace(p, resting=0.0) for p in network.populations), tonic]
    return dc.replace(network, populations=populations, projections=[*network.projections, *resting])
