"""The order of evaluation in a step, and the loops that have no order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from deodar.errors import EditFix, Problem
from deodar.model.paths import quote
from deodar.model.resolve import Instant, Node
from deodar.proposed_edit import SetReads

NodeRole = Literal["output", "advance"]
Act = tuple[str, NodeRole, Instant]
"""Element id, role, and instant: outputs at t (0) or t + dt (1), an advance at t."""


def order(nodes: Sequence[Node]) -> tuple[list[Act], dict[str, tuple[int, ...]], list[Problem]]:
    """Return all evaluations of a step in topological order, the level of each node, and loops.

    A read of `current` orders the advance of its source before it. Nodes of equal level can be evaluated
    together.
    """
    walk = _Walk(nodes)
    for n in nodes:
        walk.visit(n, "output", 0)
        if n.element.stateful:
            walk.visit(n, "advance", 0)
        if n.id in walk.ahead:
            walk.visit(n, "output", 1)
    last = max(walk.depth.values(), default=0) + 1
    for act in walk.acts:
        if act[1] == "advance" and act[0] not in walk.ahead:
            walk.depth[act] = last  # no element reads its new state: all such elements advance together
    roles: tuple[tuple[NodeRole, Instant], ...] = (("output", 0), ("advance", 0), ("output", 1))
    levels = {n.id: tuple(walk.depth.get((n.id, role, at), -1) for role, at in roles) for n in nodes}
    place = {n.id: k for k, n in enumerate(sorted(nodes, key=lambda n: n.id))}
    return sorted(walk.acts, key=lambda act: (walk.depth[act], place[act[0]])), levels, walk.problems


class _Walk:
    def __init__(self, nodes: Sequence[Node]) -> None:
        self.by = {n.id: n for n in nodes}
        self.depth: dict[Act, int] = {}
        self.acts: list[Act] = []
        self.problems: list[Problem] = []
        self.path: list[Act] = []
        self.ahead = {i for n in nodes for slots in n.reads.values() for i, _, instant in slots if instant}

    def visit(self, n: Node, role: NodeRole, instant: Instant) -> int:
        act: Act = (n.id, role, instant)
        if act in self.depth:
            if act in self.path:
                loop = [self.by[a[0]].path for a in self.path[self.path.index(act) :]]
                names = " -> ".join([n.path, *reversed(list(dict.fromkeys(loop)))])
                current = any(a[2] or a[1] == "advance" for a in self.path[self.path.index(act) :])
                loop_kind = (
                    "a loop of connections that read 'current'" if current else "a loop without a state in it"
                )
                problem = Problem(
                    n.path, f"{loop_kind}: {names}", self._fix(self.path[self.path.index(act) :])
                )
                if problem not in self.problems:
                    self.problems.append(problem)
            return self.depth[act]
        self.depth[act] = 0
        self.path.append(act)
        depth = 0
        for port in self._needs(n, role):
            for source, _, when in n.reads.get(port, []):
                depth = max(depth, 1 + self.visit(self.by[source], "output", when))
        if role == "output" and instant == 1:
            depth = max(depth, 1 + self.visit(n, "advance", 0))
        self.path.pop()
        self.depth[act] = depth
        self.acts.append(act)
        return depth

    def _fix(self, loop: Sequence[Act]) -> str:
        """Return the fix of a loop of evaluations, each of which needs the next one: another instant for a
        connection of the document that reads the new state.
        """
        for (ident, _, _), (needed, _, instant) in zip(loop, [*loop[1:], loop[0]], strict=True):
            target, source = self.by[ident], self.by[needed]
            reads = [(port, slot) for port, slots in target.reads.items() for slot in slots]
            ports = [(port, out) for port, (i, out, when) in reads if i == needed and when]
            if instant and ports and target.declared and source.declared:
                edits = [
                    SetReads(f"{source.path}.{quote(out)}", f"{target.path}.{quote(port)}", "previous")
                    for port, out in ports
                ]
                return EditFix("Let one of them read 'previous'", edits, "Or let it read 'delayed'")
        return "Let one of them read 'previous', or 'delayed'"

    def _needs(self, n: Node, role: NodeRole) -> list[str]:
        if role == "advance":
            return list(n.reads)
        return [p for p in n.reads if any(p in n.passes(out) for out in n.outs)]
