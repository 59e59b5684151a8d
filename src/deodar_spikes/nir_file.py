"""Files of NIR (HDF5): written through the package nir, and read in a process of their own.

Nothing in a file is executed. Some damaged files make the HDF5 library run without end or crash: the process
that reads has a limit of time and memory, so that deodar reports them like any other damaged file.
"""

from __future__ import annotations

import dataclasses as dc
import io
import os
import subprocess
import sys
from typing import Any

import numpy as np

from deodar import codec
from deodar.errors import GraphError
from deodar_spikes.graph import (
    INPUT,
    NEURON_FIELDS,
    AffineNode,
    EndNode,
    GraphNode,
    InputRange,
    NeuronNode,
    NirGraph,
    OutputRange,
)
from deodar_spikes.nir_reader import MOST_BYTES, hdf5, needed, output_range

SECONDS, SECONDS_PER_BYTE = 20.0, 1e-7
"""Limit of the time that reading takes."""

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
    made = nir.NIRGraph(nodes, list(graph.edges), metadata=metadata)
    buffer = io.BytesIO()
    nir.write(buffer, made)
    return buffer.getvalue()


def _plain(part: InputRange | OutputRange) -> dict[str, Any]:
    return {k: [*v] if isinstance(v, tuple) else v for k, v in vars(part).items()}


def _nir() -> Any:
    with needed("nir"):
        # an extra
        import nir
    return nir


def _nir_node(nir: Any, node: GraphNode, name: str) -> Any:
    if isinstance(node, AffineNode):
        return nir.Affine(node.weight, node.bias)
    if isinstance(node, NeuronNode):
        return nir.CubaLIF(**{field: getattr(node, field) for field in NEURON_FIELDS})
    size = np.array([node.size])
    return nir.Input({"input": size}) if name == INPUT else nir.Output({"output": size})


def read_nir(content: bytes, name: str = "") -> NirGraph:
    """Return the graph of a file.

    Args:
        content: the file.
        name: its name, for errors.

    Raises:
        GraphError: it is not a file of NIR, is damaged or too large, or has nodes that deodar does not know.
        MissingExtra: the package h5py is not installed.
    """
    if len(content) > MOST_BYTES:
        raise GraphError(f"the file has {len(content):,} bytes, more than {MOST_BYTES:,}", where=name)
    if not content.startswith(b"\x89HDF\r\n\x1a\n"):
        raise GraphError("it is not an HDF5 file", where=name, fix="Give a file of NIR, which ends in .nir")
    hdf5()  # a missing package is found before a process starts
    seconds = SECONDS + SECONDS_PER_BYTE * len(content)
    try:
        done = subprocess.run(
            [sys.executable, "-m", "deodar_spikes.nir_process", name],
            input=content,
            capture_output=True,
            timeout=seconds,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)},
        )
    except subprocess.TimeoutExpired:
        raise GraphError(
            f"the file is damaged: it was not read in {seconds:.0f} s", where=name, fix="Write it again"
        ) from None
    if done.returncode:
        raise GraphError(
            f"the file is damaged: the HDF5 library crashed (status {done.returncode})",
            where=name,
            fix="Write it again",
        )
    return unpack(done.stdout)


def pack(graph: NirGraph | GraphError) -> bytes:
    """Return a graph, or why there is none, for another process: arrays and JSON, nothing else."""
    about: dict[str, Any]
    arrays: dict[str, np.ndarray] = {}
    if isinstance(graph, NirGraph):
        about = {
            "nodes": [[name, type(node).__name__, node.size] for name, node in graph.nodes.items()],
            "edges": [list(e) for e in graph.edges],
            "step": graph.step,
            "inputs": [_plain(r) for r in graph.inputs],
            "outputs": [_plain(r) for r in graph.outputs],
            "settling": graph.settling,
        }
        for k, node in enumerate(graph.nodes.values()):
            if not isinstance(node, EndNode):
                arrays |= {f"{k}.{f.name}": getattr(node, f.name) for f in dc.fields(node)}
    else:
        [problem] = graph.problems
        about = {"wrong": [problem.what, problem.where, problem.fix]}
    buffer = io.BytesIO()
    np.savez(buffer, about=np.frombuffer(codec.text(about).encode(), np.uint8), **arrays)  # pyright: ignore[reportArgumentType]
    return buffer.getvalue()


def unpack(content: bytes) -> NirGraph:
    """Return the graph that `pack` wrote, or raise its error."""
    with np.load(io.BytesIO(content), allow_pickle=False) as data:
        about: Any = codec.parse(data["about"].tobytes().decode())
        if "wrong" in about:
            raise GraphError(*about["wrong"])
        nodes: dict[str, GraphNode] = {}
        for k, (name, kind, size) in enumerate(about["nodes"]):
            if kind == "EndNode":
                nodes[name] = EndNode(size)
            elif kind == "AffineNode":
                nodes[name] = AffineNode(data[f"{k}.weight"], data[f"{k}.bias"])
            else:
                nodes[name] = NeuronNode(**{f: data[f"{k}.{f}"] for f in NEURON_FIELDS})
    return NirGraph(
        nodes,
        [(a, b) for a, b in about["edges"]],
        about["step"],
        [InputRange(**r) for r in about["inputs"]],
        [output_range(r) for r in about["outputs"]],
        about["settling"],
    )
