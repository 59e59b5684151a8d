"""Fit a graph to a chip: round its weights, divide its neurons among cores, and list what does not fit."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence

import numpy as np

from deodar.importers.report import Line
from deodar_spikes.chip_limits import ChipLimits
from deodar_spikes.graph import INPUT, OUTPUT, AffineNode, GraphNode, NeuronNode, NirGraph, Singles


@dc.dataclass(frozen=True)
class CorePart:
    """Neurons of a node that lie in one core: from `start` to before `stop`."""

    core: int
    node: str
    start: int
    stop: int


@dc.dataclass(frozen=True)
class Fitted:
    """A graph for a chip.

    Attributes:
        graph: the graph with rounded weights and constant currents.
        parts: the neurons of each core, in order.
        lines: what was rounded (`approximated`) and what does not fit (`dropped`: the file has it, the chip
            has no place for it).
    """

    graph: NirGraph
    parts: Sequence[CorePart]
    lines: Sequence[Line]

    @property
    def cores(self) -> int:
        """Number of cores."""
        return 1 + max((p.core for p in self.parts), default=-1)

    @property
    def fits(self) -> bool:
        """Whether the chip has a place for everything."""
        return not any(line.verdict == "dropped" for line in self.lines)


def fit(graph: NirGraph, limits: ChipLimits) -> Fitted:
    """Return a graph for a chip, without its mismatch (see `mismatch.py`)."""
    lines: list[Line] = []
    nodes = {name: _rounded(graph, name, limits, lines) for name in graph.nodes}
    copied = dc.replace(graph, nodes=nodes)
    parts = _divide(copied, limits, lines)
    cores = 1 + max((p.core for p in parts), default=-1)
    if limits.cores is not None and cores > limits.cores:
        lines.append(
            Line("", "file", "cores", "dropped", f"it needs {cores} cores, and the chip has {limits.cores}")
        )
    return Fitted(copied, parts, lines)


def _rounded(graph: NirGraph, name: str, limits: ChipLimits, lines: list[Line]) -> GraphNode:
    """Round the numbers of an Affine: in each block, from one population or input to another population, to
    the steps that its largest number allows.
    """
    node = graph.nodes[name]
    if not isinstance(node, AffineNode):
        return node
    rows, columns = _ranges(graph, node.size), _ranges(graph, node.takes)
    weight, bias = node.weight.copy(), node.bias.copy()
    for label, row in rows:
        for source, column in columns:
            place = (row, column)
            rounded = _round(weight, place, limits.weight_bits)
            if rounded:
                lines.append(Line(label, "connection", source, "approximated", f"weights of {rounded}"))
        rounded = _round(bias, (row,), limits.bias_bits)
        if rounded:
            lines.append(Line(label, "parameter", "bias", "approximated", rounded))
    return AffineNode(weight, bias)


def _round(values: Singles, place: tuple[slice, ...], bits: int | None) -> str:
    """Round a part of an array in its place; return what that changed, "" if nothing."""
    part = values[place]
    if bits is None or not np.any(part):
        return ""
    largest = np.abs(part).max()
    step = largest / (2 ** (bits - 1) - 1)
    new = (np.round(part / step) * step).astype(np.float32)
    error = float(np.sqrt(np.mean((new - part)[part != 0] ** 2)) / largest)
    lost = int(np.count_nonzero(part) - np.count_nonzero(new))
    values[place] = new
    return f"{bits} bits: error {error:.2%} rms of the largest{f'; {lost:,} became 0' if lost else ''}"


def _ranges(graph: NirGraph, size: int) -> list[tuple[str, slice]]:
    """Return the populations or inputs among the rows or columns of a matrix, by its size."""
    neurons = [n.size for n in graph.nodes.values() if isinstance(n, NeuronNode)]
    if [size] == neurons and size == graph.nodes[OUTPUT].size and graph.outputs:
        return [(r.label, slice(r.start, r.stop)) for r in graph.outputs]
    if size == graph.nodes[INPUT].size and graph.inputs:
        return [(f"input {r.label}", slice(r.start, r.stop)) for r in graph.inputs]
    return [("all", slice(0, size))]


def _divide(graph: NirGraph, limits: ChipLimits, lines: list[Line]) -> list[CorePart]:
    """Divide neurons among cores, one after another, and report what is too large for any."""
    into = _connected(graph)
    parts: list[CorePart] = []
    core, used, bits, sources = 0, 0, 0, set[int]()
    weight_bits = limits.weight_bits or 1
    for name, node in graph.nodes.items():
        if not isinstance(node, NeuronNode):
            continue
        connected = into[name]
        counts = connected.sum(1)
        for label, part in _ranges(graph, node.size):
            lines += _too_many(label, counts[part], limits)
        start = 0
        for k in range(node.size):
            indices = set(np.flatnonzero(connected[k]).tolist())
            needed = int(counts[k]) * weight_bits
            full = (
                (limits.neurons_per_core is not None and used + 1 > limits.neurons_per_core)
                or (limits.sources_per_core is not None and len(sources | indices) > limits.sources_per_core)
                or (limits.synapse_bits_per_core is not None and bits + needed > limits.synapse_bits_per_core)
            )
            if full and used:
                if k > start:
                    parts.append(CorePart(core, name, start, k))
                core, used, bits, sources, start = core + 1, 0, 0, set(), k
            used, bits, sources = used + 1, bits + needed, sources | indices
        if node.size > start:
            parts.append(CorePart(core, name, start, node.size))
    return parts


def _too_many(label: str, counts: np.ndarray, limits: ChipLimits) -> list[Line]:
    """Report neurons with more synapses than a neuron or a core may have."""
    most = int(counts.max(initial=0))
    allowed = {
        "a neuron has": limits.fan_in,
        "a core receives": limits.sources_per_core,
        "a core stores": None
        if limits.synapse_bits_per_core is None
        else limits.synapse_bits_per_core // (limits.weight_bits or 1),
    }
    return [
        Line(
            label,
            "element",
            "synapses",
            "dropped",
            f"{int((counts > limit).sum())} of {len(counts)} neurons have up to {most}, and {what} {limit}",
        )
        for what, limit in allowed.items()
        if limit is not None and most > limit
    ]


def _connected(graph: NirGraph) -> Mapping[str, np.ndarray]:
    """Return, for each node of neurons, which sources reach each neuron: all neurons and inputs in order."""
    first: dict[str, int] = {}
    at = 0
    for name, node in graph.nodes.items():
        if isinstance(node, NeuronNode) or name == INPUT:
            first[name] = at
            at += node.size
    out = {n: np.zeros((v.size, at), bool) for n, v in graph.nodes.items() if isinstance(v, NeuronNode)}
    for a, b in graph.edges:
        if b not in out:
            continue
        node = graph.nodes[a]
        if isinstance(node, AffineNode):
            for source in (s for s, t in graph.edges if t == a and s in first):
                columns = slice(first[source], first[source] + graph.nodes[source].size)
                out[b][:, columns] |= node.weight != 0
        elif a in first:
            out[b][np.arange(node.size), first[a] + np.arange(node.size)] = True
    return out
