"""A graph of NIR, the neuromorphic intermediate representation: the four kinds of nodes that deodar uses.

    Affine      y = weight x + bias
    CubaLIF     tau_syn dI/dt = -I + w_in x,  tau_mem dv/dt = v_leak - v + r I;
                a spike if v > v_threshold, and then v = v_reset

Several edges into a node are summed. Times are in s.

NIR does not define when, within a step, the output of one node reaches another one. deodar does what norse
1.1.0 does: nodes are computed depth first from the Input, along the edges in the order of the file. A node
reads the outputs of nodes before it in the same step, and those of nodes after it, in loops, with the values
of the step before.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from deodar.errors import GraphError, show

Singles: TypeAlias = NDArray[np.float32]

INPUT, OUTPUT = "input", "output"
"""Names of the nodes at both ends."""


@dc.dataclass(frozen=True)
class EndNode:
    """An Input or an Output: its number of values."""

    size: int


@dc.dataclass(frozen=True)
class AffineNode:
    """An Affine: weights, rows x columns, and a bias for each row."""

    weight: Singles
    bias: Singles

    @property
    def size(self) -> int:
        """Number of outputs."""
        return int(self.weight.shape[0])

    @property
    def takes(self) -> int:
        """Number of inputs."""
        return int(self.weight.shape[1])


@dc.dataclass(frozen=True)
class NeuronNode:
    """A CubaLIF: parameters of each neuron."""

    tau_syn: Singles
    tau_mem: Singles
    r: Singles
    v_leak: Singles
    v_threshold: Singles
    v_reset: Singles
    w_in: Singles

    @property
    def size(self) -> int:
        """Number of neurons."""
        return int(self.v_threshold.size)


NEURON_FIELDS = tuple(f.name for f in dc.fields(NeuronNode))
"""Parameters of a CubaLIF."""

GraphNode: TypeAlias = EndNode | AffineNode | NeuronNode


@dc.dataclass(frozen=True)
class InputRange:
    """A range of the values of the Input.

    Attributes:
        label: what it is.
        kind: `analog`, or `poisson`: spike trains.
        start, stop: the range.
        rate: of the spike trains, in 1/s.
    """

    label: str
    kind: str
    start: int
    stop: int
    rate: float = 0.0


@dc.dataclass(frozen=True)
class OutputRange:
    """A range of the values of the Output: the spikes of a population.

    Attributes:
        label: path of the element.
        start, stop: the range.
        neurons: neurons of a cell, which are neighbours.
        unit: output of the element that corresponds to a spike of each neuron in each step.
        shape: samples of the axes.
        probed: whether its rates are those of the element's output.
    """

    label: str
    start: int
    stop: int
    neurons: int
    unit: float
    shape: tuple[int, ...]
    probed: bool = True


@dc.dataclass(frozen=True)
class NirGraph:
    """Nodes by name, edges, and what the graph was made for.

    Attributes:
        nodes: nodes by name; the Input is `input` and the Output `output`.
        edges: pairs of names.
        step: dt in s.
        inputs, outputs: meaning of the values of Input and Output.
        settling: time from zero currents to rest, in s.
    """

    nodes: Mapping[str, GraphNode]
    edges: Sequence[tuple[str, str]]
    step: float
    inputs: Sequence[InputRange] = ()
    outputs: Sequence[OutputRange] = ()
    settling: float = 0.0

    @property
    def neurons(self) -> int:
        """Number of neurons."""
        return sum(n.size for n in self.nodes.values() if isinstance(n, NeuronNode))

    @property
    def synapses(self) -> int:
        """Number of weights that are not zero, those of inputs included."""
        return sum(int(np.count_nonzero(n.weight)) for n in self.nodes.values() if isinstance(n, AffineNode))


@dc.dataclass(frozen=True)
class Evaluation:
    """A node, and the nodes that it reads: of this step, and of the step before."""

    name: str
    now: Sequence[str]
    before: Sequence[str]


def order(graph: NirGraph) -> list[Evaluation]:
    """Return all nodes except the Input in the order of their computation.

    Raises:
        GraphError: the Input does not reach a node.
    """
    sources: dict[str, list[str]] = {name: [] for name in graph.nodes}
    targets: dict[str, list[str]] = {name: [] for name in graph.nodes}
    for a, b in graph.edges:
        sources[b].append(a)
        targets[a].append(b)
    place: dict[str, int] = {}
    waiting = [INPUT]
    while waiting:
        name = waiting.pop()
        if name not in place:
            place[name] = len(place)
            waiting += reversed(targets[name])
    lost = sorted(set(graph.nodes) - set(place))
    if lost:
        raise GraphError(
            f"no input reaches {', '.join(show(n) for n in lost[:6])}{', ...' if len(lost) > 6 else ''}",
            fix="Connect the Input to each part of the graph, and a node to the Output",
        )
    names = sorted(place, key=lambda n: (n == OUTPUT, place[n]))
    at = {name: k for k, name in enumerate(names)}
    return [
        Evaluation(
            n,
            [s for s in sources[n] if at[s] < at[n]],
            [s for s in sources[n] if at[s] >= at[n]],
        )
        for n in names
        if n != INPUT
    ]
