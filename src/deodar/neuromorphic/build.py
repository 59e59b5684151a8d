"""The graph of NIR of a network: a CubaLIF for each population, an Affine for each projection and input."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np

from deodar.neuromorphic.graph import (
    INPUT,
    OUTPUT,
    AffineNode,
    EndNode,
    GraphNode,
    InputRange,
    NeuronNode,
    NirGraph,
    Numbers,
    OutputRange,
)
from deodar.neuromorphic.linear_maps import require_size
from deodar.neuromorphic.network import Population, SpikingNetwork

POISSON = 1000.0
"""Rate of each train of Poisson spikes, in 1/s."""


def build(network: SpikingNetwork) -> NirGraph:
    """Return the graph of a network.

    Analog inputs are the activation that reaches a cell from outside, for each cell of each population. A
    population with noise also has two trains of Poisson spikes for each deviate, one excitatory and one
    inhibitory. All biases are in the Affine of the input. v_leak and v_reset are 0, because not all readers
    use them.
    """
    names = _names(network.populations)
    inputs = _inputs(network.populations)
    width = inputs[-1].stop
    nodes: dict[str, GraphNode] = {INPUT: EndNode(width)}
    edges: list[tuple[str, str]] = []
    for p, name in zip(network.populations, names, strict=True):
        drive, neurons = f"input_to_{name}", f"neurons_{name}"
        nodes[drive] = _drive(p, [r for r in inputs if r.label == p.label], width, network.step)
        nodes[neurons] = _neurons(p, network.membrane)
        edges += [(INPUT, drive), (drive, neurons)]
    for projection in network.projections:
        source, target = (network.populations[i] for i in (projection.source, projection.target))
        require_size(source.neurons * target.neurons, f"the projection from {source.label} to {target.label}")
        n, m = len(source.code.offsets), len(target.code.offsets)
        weight = np.kron(projection.weights, np.ones((m, n))) * (target.code.gain * source.code.unit / n)
        name = f"synapses_{names[projection.source]}_{names[projection.target]}"
        nodes[name] = AffineNode(_single(weight), np.zeros(len(weight), np.float32))
        edges += [
            (f"neurons_{names[projection.source]}", name),
            (name, f"neurons_{names[projection.target]}"),
        ]
    outputs = _outputs(network.populations)
    probed = [k for k, p in enumerate(network.populations) if p.probed]
    nodes[OUTPUT] = EndNode(outputs[-1].stop)
    if len(probed) == 1:
        edges.append((f"neurons_{names[probed[0]]}", OUTPUT))
    else:
        for k, part in zip(probed, outputs, strict=True):
            size = part.stop - part.start
            require_size(outputs[-1].stop * size, "the output")
            weight = np.zeros((outputs[-1].stop, size), np.float32)
            weight[part.start : part.stop] = np.eye(size)
            nodes[f"output_from_{names[k]}"] = AffineNode(weight, np.zeros(len(weight), np.float32))
            edges += [(f"neurons_{names[k]}", f"output_from_{names[k]}"), (f"output_from_{names[k]}", OUTPUT)]
    ordered = {name: nodes[name] for name in sorted(nodes)}
    return NirGraph(ordered, edges, network.step, inputs, outputs, network.settling)


def _inputs(populations: Sequence[Population]) -> list[InputRange]:
    """Return the ranges of the input."""
    out: list[InputRange] = []
    at = 0
    for p in populations:
        if p.probed or p.port == "output":
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
        if p.probed:
            shape = tuple(a.samples for a in p.axes)
            out.append(OutputRange(p.label, at, at + p.neurons, len(p.code.offsets), p.code.unit, shape))
            at += p.neurons
    return out


def _drive(p: Population, ranges: Sequence[InputRange], width: int, step: float) -> AffineNode:
    """Return the weights of the input of a population, and the constant currents of its neurons."""
    n = len(p.code.offsets)
    require_size(p.neurons * width, f"the input of {p.label}")
    cells = np.zeros((p.cells, width))
    for r in ranges:
        if r.kind == "analog":
            cells[:, r.start : r.stop] = np.eye(p.cells)
        else:
            assert p.noise is not None
            spike = p.noise / (step * math.sqrt(2 * r.rate))
            cells[:, r.start : r.stop] = np.concatenate([spike, -spike], axis=1)
    bias = np.tile(p.code.gain * p.resting + p.code.offsets, p.cells)
    return AffineNode(_single(p.code.gain * np.repeat(cells, n, axis=0)), _single(bias))


def _neurons(p: Population, membrane: float) -> NeuronNode:
    def full(value: float) -> Numbers:
        return np.full(p.neurons, value, np.float32)

    return NeuronNode(full(p.synapse), full(membrane), full(1), full(0), full(1), full(0), full(1))


def _single(values: np.ndarray) -> Numbers:
    return np.asarray(values, np.float32)


def _names(populations: Sequence[Population]) -> list[str]:
    """Return names of letters, digits and underscores, which all readers accept."""
    out: list[str] = []
    for k, p in enumerate(populations):
        name = re.sub(r"\W+", "_", p.label, flags=re.ASCII).strip("_").lower() or "population"
        out.append(name if name not in out else f"{name}_{k}")
    return out
