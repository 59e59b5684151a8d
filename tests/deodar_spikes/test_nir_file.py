"""Files of NIR: the package nir reads what is written."""

from __future__ import annotations

import sys
from pathlib import Path

import nir
import numpy as np
import pytest

import deodar as dd
from deodar.errors import GraphError, MissingExtra
from deodar_spikes.build import build
from deodar_spikes.graph import NEURON_FIELDS, AffineNode, EndNode, NeuronNode, NirGraph
from deodar_spikes.nir_file import write_nir
from deodar_spikes.simulator import SpikingSimulator
from deodar_spikes.translate import translate
from tests.deodar_spikes.scenes import pairs, winner_take_all


def small() -> NirGraph:
    """The graph of a field of four samples."""
    model = dd.Model("small", dt=0.5)
    model.add(dd.Field("u", [dd.Axis("x", 0, 3, samples=4)], noise=1.0))
    return build(translate(model, neurons=2).network)


def test_the_package_nir_reads_the_same_nodes_and_edges(tmp_path: Path) -> None:
    for graph in (small(), build(translate(winner_take_all(pairs(1).inputs[0])).network)):
        path = tmp_path / "graph.nir"
        path.write_bytes(write_nir(graph))
        read = nir.read(path)
        assert set(read.nodes) == set(graph.nodes) and list(read.edges) == list(graph.edges)
        assert read.metadata["dt"] == graph.step
        for name, node in graph.nodes.items():
            if isinstance(node, AffineNode):
                np.testing.assert_array_equal(read.nodes[name].weight, node.weight)
                np.testing.assert_array_equal(read.nodes[name].bias, node.bias)
            elif isinstance(node, NeuronNode):
                for field in NEURON_FIELDS:
                    np.testing.assert_array_equal(getattr(read.nodes[name], field), getattr(node, field))


def test_a_file_has_four_kinds_of_nodes_and_states_its_convention(tmp_path: Path) -> None:
    (tmp_path / "small.nir").write_bytes(write_nir(small()))
    graph = nir.read(tmp_path / "small.nir")
    assert {type(n).__name__ for n in graph.nodes.values()} == {"Input", "Output", "Affine", "CubaLIF"}
    assert graph.metadata["dt"] == 0.5e-3 and "one step later" in str(graph.metadata["spikes"])


def test_a_missing_package_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "nir", None)
    with pytest.raises(MissingExtra, match=r"the package nir.*deodar\[neuromorphic\]"):
        write_nir(small())


def test_an_end_without_an_order_is_refused() -> None:
    graph = NirGraph({"input": EndNode(1), "output": EndNode(1)}, [], 1e-3)
    with pytest.raises(GraphError, match="no input reaches 'output'"):
        SpikingSimulator(graph)
