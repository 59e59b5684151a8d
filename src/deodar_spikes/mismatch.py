"""Neurons that differ from each other, as on an analog chip."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping

import numpy as np

from deodar_spikes.graph import AffineNode, NeuronNode, NirGraph, Singles
from deodar_spikes.simulator import Copies

LEAST = 0.05
"""Smallest factor: a threshold or time constant is never negative."""

FIELDS = ("v_threshold", "bias", "w_in", "tau_mem", "tau_syn")
"""What may differ: parameters of neurons, and the constant current."""


def differing(graph: NirGraph, spread: Mapping[str, float], copies: int, seed: int = 0) -> Copies:
    """Return the parameters of several chips: each value times 1 + spread times a normal deviate.

    Args:
        graph: the graph.
        spread: relative standard deviation by parameter, of `FIELDS`.
        copies: number of chips.
        seed: seed of all deviates; chip k has the same ones for any number of chips.
    """
    out: dict[str, dict[str, Singles]] = {}
    for number, (name, node) in enumerate(graph.nodes.items()):
        for place, field in enumerate(FIELDS):
            fits = field == "bias" if isinstance(node, AffineNode) else isinstance(node, NeuronNode)
            if not spread.get(field) or not fits or not hasattr(node, field):
                continue
            value = getattr(node, field)
            if field == "bias" and not np.any(value):
                continue
            factors = [
                np.maximum(1 + spread[field] * _deviates(seed, k, number, place, value.size), LEAST)
                for k in range(copies)
            ]
            out.setdefault(name, {})[field] = (value * np.stack(factors)).astype(np.float32)
    return out


def chip(graph: NirGraph, spread: Mapping[str, float], seed: int = 0, number: int = 0) -> NirGraph:
    """Return the graph of one chip."""
    found = differing(graph, spread, number + 1, seed)
    nodes = {
        name: dc.replace(node, **{k: v[number] for k, v in found.get(name, {}).items()})
        for name, node in graph.nodes.items()
    }
    return dc.replace(graph, nodes=nodes)


def _deviates(seed: int, copy: int, node: int, field: int, size: int) -> np.ndarray:
    return np.random.default_rng([seed, copy, node, field]).standard_normal(size)
