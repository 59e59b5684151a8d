"""The order in which the nodes of a graph are computed in a step.

NIR does not define when, within a step, the output of one node reaches another one. deodar does what nirtorch
2.6 does, on which norse is built: nodes are computed in the order of the file, beginning with the Input. A
node with several inputs that is part of a loop reads what is not computed yet with its value of the step
before, 0 in the first step. Any other node waits until its inputs are computed.
"""

from __future__ import annotations

import dataclasses as dc
from collections import deque
from collections.abc import Mapping, Sequence

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from deodar.errors import GraphError
from deodar.neuromorphic.graph import INPUT, OUTPUT, NirGraph


@dc.dataclass(frozen=True)
class Evaluation:
    """A node, and the nodes that it reads: of this step, and of the step before."""

    name: str
    now: Sequence[str]
    before: Sequence[str]


def order(graph: NirGraph) -> list[Evaluation]:
    """Return all nodes except the Input in the order of their computation.

    Raises:
        GraphError: a loop has no node with a second input, so that no order exists.
    """
    names = list(graph.nodes)
    sources: dict[str, list[str]] = {name: [] for name in names}
    for a, b in graph.edges:
        sources[b].append(a)
    loops = _loops(names, graph.edges)
    start = names.index(INPUT)
    waiting = deque(n for n in [*names[start + 1 :], *names[:start]] if n != OUTPUT)
    waiting.append(OUTPUT)
    done: set[str] = {INPUT}
    out: list[Evaluation] = []
    idle = 0
    while waiting:
        name = waiting.popleft()
        late = [s for s in sources[name] if s not in done]
        looped = len(sources[name]) > 1 and all(loops[s] == loops[name] for s in late)
        if (late and not looped) or (name == OUTPUT and waiting):
            waiting.append(name)
            idle += 1
            if idle > len(waiting):
                raise GraphError(
                    f"the nodes {', '.join(sorted(waiting)[:6])} wait for each other: a loop that no other"
                    " input reaches has no order",
                    fix="Connect the input to a node of each loop",
                )
            continue
        idle = 0
        out.append(Evaluation(name, [s for s in sources[name] if s in done], late))
        done.add(name)
    return out


def _loops(names: Sequence[str], edges: Sequence[tuple[str, str]]) -> Mapping[str, int]:
    """Return a number for each node, equal for nodes that are part of one loop."""
    place = {name: k for k, name in enumerate(names)}
    rows, columns = [place[a] for a, _ in edges], [place[b] for _, b in edges]
    matrix = coo_array((np.ones(len(rows)), (rows, columns)), shape=(len(names),) * 2)
    labels = connected_components(matrix, connection="strong")[1]
    return {name: int(labels[k]) for name, k in place.items()}
