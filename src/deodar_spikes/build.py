"""The graph of NIR of a network: Input, Affine, CubaLIF, Output, and an Affine among the neurons.

All populations are in one CubaLIF, whose parameters differ between neurons. So each spike arrives one step
later, whatever the order in which a reader computes nodes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from deodar_spikes.graph import (
    INPUT,
    OUTPUT,
    AffineNode,
    EndNode,
    GraphNode,
    InputRange,
    NeuronNode,
    NirGraph,
    OutputRange,
    Singles,
)
from deodar_spikes.linear_maps import WeightMatrix, require_size
from deodar_spikes.network import Population, SpikingNetwork

POISSON = 1000.0
"""Rate of each train of Poisson spikes, in 1/s."""

DRIVE, NEURONS, SYNAPSES = "drive", "neurons", "synapses"
"""Names of the other nodes."""


def build(network: SpikingNetwork) -> NirGraph:
    """Return the graph of a network.

    Analog inputs are the activation that reaches a cell from outside, for each cell of each population with
    an input. A population with noise also has two trains of Poisson spikes for each deviate, one excitatory
    and one inhibitory. Constant currents are biases of the Affine of the input; v_leak and v_reset are 0,
    because not all readers use them. The Output has the spikes of all neurons.

    Raises:
        TooLarge: the network has too many weights between neurons.
    """
    inputs, outputs = _inputs(network.populations), _outputs(network.populations)
    width, size = inputs[-1].stop, network.neurons
    require_size(size * max(size, width), f"a network of {size:,} neurons and {width:,} inputs")
    nodes: dict[str, GraphNode] = {  # in the order of a file, by name
        DRIVE: _drive(network, inputs, width),
        INPUT: EndNode(width),
        NEURONS: _neurons(network),
        OUTPUT: EndNode(size),
        SYNAPSES: _synapses(network, outputs),
    }
    edges = [(INPUT, DRIVE), (DRIVE, NEURONS), (NEURONS, SYNAPSES), (SYNAPSES, NEURONS), (NEURONS, OUTPUT)]
    return NirGraph(nodes, edges, network.step, inputs, outputs, network.settling)


def _inputs(populations: Sequence[Population]) -> list[InputRange]:
    """Return the ranges of the input."""
    out: list[InputRange] = []
    at = 0
    for p in populations:
        if p.port == "output":
            out.append(InputRange(p.label, "analog", at, at + p.cells))
            at += p.cells
    for p in populations:
        if p.noise is not None:
            size = 2 * p.noise.shape[1]
            out.append(InputRange(p.label, "poisson", at, at + size, POISSON))
            at += size
    return out


def _outputs(populations: Sequence[Population]) -> list[OutputRange]:
    """Return the ranges of the output."""
    out: list[OutputRange] = []
    at = 0
    for p in populations:
        shape = tuple(a.samples for a in p.axes)
        out.append(
            OutputRange(p.label, at, at + p.neurons, len(p.code.offsets), p.code.unit, shape, p.probed)
        )
        at += p.neurons
    return out


def _drive(network: SpikingNetwork, inputs: Sequence[InputRange], width: int) -> AffineNode:
    """Return the weights of the input, and the constant currents of all neurons."""
    weights: list[WeightMatrix] = []
    biases: list[WeightMatrix] = []
    for p in network.populations:
        cells = np.zeros((p.cells, width))
        for r in inputs:
            if r.label == p.label and r.kind == "analog":
                cells[:, r.start : r.stop] = np.eye(p.cells)
            elif r.label == p.label and p.noise is not None:
                spike = p.noise / (network.step * math.sqrt(2 * r.rate))
                cells[:, r.start : r.stop] = np.concatenate([spike, -spike], axis=1)
        weights.append(p.code.gain * np.repeat(cells, len(p.code.offsets), axis=0))
        biases.append(np.tile(p.code.gain * p.resting + p.code.offsets, p.cells))
    return AffineNode(np.concatenate(weights).astype(np.float32), np.concatenate(biases).astype(np.float32))


def _neurons(network: SpikingNetwork) -> NeuronNode:
    """Return the parameters of all neurons."""

    def full(value: float) -> Singles:
        return np.full(network.neurons, value, np.float32)

    def each(values: Sequence[float]) -> Singles:
        sizes = [p.neurons for p in network.populations]
        return np.repeat(np.asarray(values, np.float32), sizes)

    synapse = each([p.synapse for p in network.populations])
    membrane = each([p.code.membrane for p in network.populations])
    return NeuronNode(synapse, membrane, full(1), full(0), full(1), full(0), full(1))


def _synapses(network: SpikingNetwork, outputs: Sequence[OutputRange]) -> AffineNode:
    """Return the weights between all neurons."""
    weight = np.zeros((network.neurons, network.neurons), np.float32)
    for projection in network.projections:
        source, target = (network.populations[i] for i in (projection.source, projection.target))
        columns, rows = outputs[projection.source], outputs[projection.target]
        scale = target.code.gain * source.code.unit / columns.neurons
        block = np.kron(projection.weights * scale, np.ones((rows.neurons, columns.neurons)))
        weight[rows.start : rows.stop, columns.start : columns.stop] += block
    return AffineNode(weight, np.zeros(len(weight), np.float32))
