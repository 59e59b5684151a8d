"""The order in which the nodes of a graph are computed in a step.

NIR does not define when, within a step, the output of one node reaches another one. deodar does what norse
1.1.0 does: nodes are computed depth first from the Input, along the edges in the order of the file. A node
reads the outputs of nodes before it in the same step, and those of nodes after it, in loops, with the values
of the step before.
"""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence

from deodar.errors import GraphError, show
from deodar_spikes.graph import INPUT, OUTPUT, NirGraph


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
