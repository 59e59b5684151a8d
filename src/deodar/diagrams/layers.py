"""Layers: the direction of edges, the column of each node, and order and positions inside columns.

The steps of Sugiyama, Tagawa & Toda (1981), IEEE Trans. Syst. Man Cybern. 11, 109-125: break cycles, rank,
order by barycentres.
"""

from __future__ import annotations

import bisect
import itertools
from collections.abc import Mapping, Sequence

SWEEPS = 10
"""Number of sweeps of the ordering; more have little effect (a guess, from the examples)."""


def forward(nodes: Sequence[str], edges: Sequence[tuple[str, str]]) -> dict[str, int]:
    """Return a position for each node such that few edges run backwards.

    Reference:
        Eades, Lin & Smyth (1993), Inf. Process. Lett. 47, 319-323: sources first, sinks last, else the node
        with the most edges out.
    """
    outs: dict[str, dict[str, int]] = {n: {} for n in nodes}
    ins: dict[str, dict[str, int]] = {n: {} for n in nodes}
    for a, b in edges:
        if a != b:
            outs[a][b] = outs[a].get(b, 0) + 1
            ins[b][a] = ins[b].get(a, 0) + 1
    left, head, tail = dict.fromkeys(nodes), list[str](), list[str]()
    while left:
        sink = next((n for n in reversed(left) if not outs[n] and ins[n]), None)
        source = next((n for n in left if not ins[n]), None)
        if source is not None:
            n = source
            head.append(n)
        elif sink is not None:
            n = sink
            tail.append(n)
        else:
            n = max(left, key=lambda n: sum(outs[n].values()) - sum(ins[n].values()))
            head.append(n)
        del left[n]
        for m in outs.pop(n):
            ins[m].pop(n, None)
        for m in ins.pop(n):
            outs[m].pop(n, None)
    return {n: k for k, n in enumerate([*head, *reversed(tail)])}


def ranks(nodes: Sequence[str], edges: Sequence[tuple[str, str]]) -> dict[str, int]:
    """Return the column of each node: after all nodes that it reads, and as near as possible to its readers.

    Edges run forwards.
    """
    ins: dict[str, list[str]] = {n: [] for n in nodes}
    outs: dict[str, list[str]] = {n: [] for n in nodes}
    for a, b in edges:
        ins[b].append(a)
        outs[a].append(b)
    waits = {n: len(found) for n, found in ins.items()}
    order = [n for n in nodes if not waits[n]]
    for n in order:  # grows during the iteration
        for m in outs[n]:
            waits[m] -= 1
            if not waits[m]:
                order.append(m)
    rank: dict[str, int] = {}
    for n in order:
        rank[n] = max((rank[m] + 1 for m in ins[n]), default=0)
    for n in reversed(order):
        if outs[n] and len(outs[n]) >= len(ins[n]):
            rank[n] = min(rank[m] for m in outs[n]) - 1
    return rank


def order(
    columns: list[list[str]], after: Mapping[str, Sequence[str]], before: Mapping[str, Sequence[str]]
) -> list[list[str]]:
    """Return the nodes of each column in an order with few crossings; edges join neighbouring columns."""
    best, least = columns, crossings(columns, after)
    now = [list(column) for column in columns]
    for sweep in range(SWEEPS):
        if not least:
            break
        down = sweep % 2 == 0
        sides = range(1, len(now)) if down else range(len(now) - 2, -1, -1)
        for c in sides:
            near = {n: k for k, n in enumerate(now[c - 1 if down else c + 1])}
            links = before if down else after
            here = {n: float(k) for k, n in enumerate(now[c])}
            request = {
                n: (sum(near[m] for m in links[n]) / len(links[n]) if links[n] else here[n]) for n in now[c]
            }
            now[c] = sorted(now[c], key=lambda n, request=request, here=here: (request[n], here[n]))
        count = crossings(now, after)
        if count < least:
            best, least = [list(column) for column in now], count
    return best


def crossings(columns: Sequence[Sequence[str]], after: Mapping[str, Sequence[str]]) -> int:
    """Return the number of pairs of edges that cross."""
    total = 0
    for left, right in itertools.pairwise(columns):
        at = {n: k for k, n in enumerate(right)}
        seen: list[int] = []
        for n in left:
            ends = sorted(at[m] for m in after[n])
            total += sum(len(seen) - bisect.bisect_right(seen, e) for e in ends)
            for e in ends:
                bisect.insort(seen, e)
    return total


def settle(requests: Sequence[float], weights: Sequence[float], gaps: Sequence[float]) -> list[float]:
    """Return the positions nearest to the requested ones, by weighted least squares, at least `gaps` apart.

    Args:
        requests: requested position of each item.
        weights: weight of each request.
        gaps: smallest distance between each item and the next; one entry fewer than items.

    Reference:
        Isotonic regression by pooling adjacent violators: Ayer et al. (1955), Ann. Math. Stat. 26, 641-647.
    """
    shift = [0.0]
    for gap in gaps:
        shift.append(shift[-1] + gap)
    blocks: list[tuple[float, float, int]] = []  # mean, weight, number of items
    for request, weight, by in zip(requests, weights, shift, strict=False):
        blocks.append((request - by, weight, 1))
        while len(blocks) > 1 and blocks[-2][0] > blocks[-1][0]:
            (m1, w1, n1), (m2, w2, n2) = blocks[-2], blocks[-1]
            blocks[-2:] = [((m1 * w1 + m2 * w2) / (w1 + w2), w1 + w2, n1 + n2)]
    flat = [mean for mean, _, n in blocks for _ in range(n)]
    return [y + by for y, by in zip(flat, shift, strict=False)]
