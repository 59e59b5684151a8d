"""Straight edges: positions along a column with a given order and distances, near requested positions."""

from __future__ import annotations

from collections.abc import Sequence


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
