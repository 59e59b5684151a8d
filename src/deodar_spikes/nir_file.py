"""Files of NIR (HDF5), written through the package nir."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from deodar import codec
from deodar.errors import MissingExtra
from deodar_spikes.graph import (
    INPUT,
    NEURON_FIELDS,
    AffineNode,
    GraphNode,
    InputRange,
    NeuronNode,
    NirGraph,
    OutputRange,
)

CONVENTION = (
    "a spike is 1 for one step; I += dt/tau_syn (-I + w_in x), then v += dt/tau_mem (v_leak - v + r I),"
    " then a spike if v > v_threshold; spikes arrive one step later"
)
"""What the metadata of a file state about spikes."""


def write_nir(graph: NirGraph) -> bytes:
    """Return the content of a file.

    Raises:
        MissingExtra: the package nir is not installed.
    """
    nir = _nir()
    about = {
        "inputs": [_plain(r) for r in graph.inputs],
        "outputs": [_plain(r) for r in graph.outputs],
        "settling": graph.settling,
    }
    metadata = {
        "dt": float(graph.step),
        "spikes": CONVENTION,
        "made_by": "deodar",
        "deodar": codec.text(about),
    }
    nodes = {name: _nir_node(nir, node, name) for name, node in graph.nodes.items()}
    written = nir.NIRGraph(nodes, list(graph.edges), metadata=metadata)
    buffer = io.BytesIO()
    nir.write(buffer, written)
    return buffer.getvalue()


def _plain(part: InputRange | OutputRange) -> dict[str, Any]:
    return {k: [*v] if isinstance(v, tuple) else v for k, v in vars(part).items()}


def _nir() -> Any:
    try:
        # an extra
        import nir
    except ImportError:
        raise MissingExtra("nir", "neuromorphic", "a file of NIR") from None
    return nir


def _nir_node(nir: Any, node: GraphNode, name: str) -> Any:
    if isinstance(node, AffineNode):
        return nir.Affine(node.weight, node.bias)
    if isinstance(node, NeuronNode):
        return nir.CubaLIF(**{field: getattr(node, field) for field in NEURON_FIELDS})
    size = np.array([node.size])
    return nir.Input({"input": size}) if name == INPUT else nir.Output({"output": size})
