"""Files of NIR: what is written is read, and hostile files are refused with one clear error."""

from __future__ import annotations

import dataclasses as dc
import io
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import h5py
import nir
import numpy as np
import pytest

import deodar as dd
from deodar.errors import GraphError, MissingExtra, TimeError
from deodar_spikes import nir_file, nir_reader
from deodar_spikes.build import build
from deodar_spikes.graph import EndNode, NirGraph
from deodar_spikes.nir_file import read_nir, write_nir
from deodar_spikes.nir_reader import parse_nir
from deodar_spikes.simulator import SpikingSimulator
from deodar_spikes.translate import translate
from tests.deodar_spikes.scenes import pairs, winner_take_all
from tests.house.source import ROOT


def small() -> NirGraph:
    """The graph of a field of four samples."""
    model = dd.Model("small", dt=0.5)
    model.add(dd.Field("u", [dd.Axis("x", 0, 3, samples=4)], noise=1.0))
    return build(translate(model, neurons=2).network)


@pytest.fixture(scope="module")
def content() -> bytes:
    return write_nir(small())


def changed(content: bytes, change: Callable[[h5py.File], None]) -> bytes:
    """The file after a change of its groups and arrays."""
    buffer = io.BytesIO(content)
    with h5py.File(buffer, "r+") as file:
        change(file)
    return buffer.getvalue()


def put(file: h5py.File, path: str, **how: object) -> None:
    """Replace an array."""
    del file[path]
    file.create_dataset(path, **how)


def equal(a: NirGraph, b: NirGraph) -> bool:
    """Whether all nodes, edges and metadata are equal."""
    return (
        list(a.nodes) == list(b.nodes)
        and list(a.edges) == list(b.edges)
        and (a.step, a.inputs, a.outputs, a.settling) == (b.step, b.inputs, b.outputs, b.settling)
        and all(
            np.array_equal(getattr(a.nodes[k], f.name), getattr(b.nodes[k], f.name))
            for k in a.nodes
            for f in dc.fields(a.nodes[k])
        )
    )


def test_a_graph_that_is_written_is_read(content: bytes) -> None:
    assert equal(read_nir(content), small())
    graph = build(translate(winner_take_all(pairs(1).inputs[0])).network)
    assert equal(parse_nir(write_nir(graph)), graph)


@pytest.mark.parametrize("name", ["nir", "h5py"])
def test_a_missing_package_is_named(name: str, content: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(MissingExtra, match=rf"the package {name}.*deodar\[neuromorphic\]"):
        write_nir(small()) if name == "nir" else read_nir(content)


def test_the_package_nir_reads_the_file_with_four_kinds_of_nodes(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "small.nir").write_bytes(content)
    graph = nir.read(tmp_path / "small.nir")
    assert {type(n).__name__ for n in graph.nodes.values()} == {"Input", "Output", "Affine", "CubaLIF"}
    assert graph.metadata["dt"] == 0.5e-3 and "one step later" in str(graph.metadata["spikes"])


def test_a_file_of_the_package_nir_is_read(tmp_path: Path) -> None:
    ones = np.ones(3, np.float32)
    neurons = nir.CubaLIF(0.01 * ones, 0.02 * ones, ones, 0 * ones, ones)
    nodes = {"in": nir.Input({"input": np.array([2])}), "w": nir.Linear(np.ones((3, 2), np.float32))}
    nodes |= {"lif": neurons, "out": nir.Output({"output": np.array([3])})}
    nir.write(tmp_path / "other.nir", nir.NIRGraph(nodes, [("in", "w"), ("w", "lif"), ("lif", "out")]))
    graph = read_nir((tmp_path / "other.nir").read_bytes())
    with pytest.raises(TimeError, match="does not state its step"):
        SpikingSimulator(graph)
    simulator = SpikingSimulator(graph, step=1e-3)
    spikes, _ = simulator.run(simulator.start(), np.full((200, 2), 1.5, np.float32), every=200)
    assert (spikes > 10).all()


HOSTILE: dict[str, tuple[Callable[[h5py.File], None], str]] = {
    "sizes of 2^60": (
        lambda f: put(f, "node/nodes/drive/weight", shape=(2**30, 2**30), dtype="f4", chunks=(64, 64)),
        "more than 1,073,741,824 bytes",
    ),
    "a group that contains itself": (
        lambda f: f["node/nodes"].__setitem__("again", f["node"]),
        "is a NIRGraph, which deodar does not know",
    ),
    "a node of another kind": (
        lambda f: put(f, "node/nodes/drive/type", data="Conv2d"),
        "is a Conv2d, which deodar does not know. It reads Input, Output, Affine, Linear, CubaLIF",
    ),
    "a link to another file": (
        lambda f: f["node/nodes"].__setitem__("other", h5py.ExternalLink("/etc/passwd", "/")),
        "'other' is a link",
    ),
    "a soft link": (
        lambda f: f["node/nodes"].__setitem__("other", h5py.SoftLink("/node")),
        "'other' is a link",
    ),
    "an array in another file": (
        lambda f: put(f, "node/nodes/drive/bias", shape=(8,), dtype="f4", external=[("/etc/passwd", 0, 32)]),
        "lies in another file",
    ),
    "values that are not finite": (
        lambda f: f["node/nodes/drive/bias"].__setitem__(0, np.nan),
        "not finite",
    ),
    "a time constant of 0": (
        lambda f: f["node/nodes/neurons/tau_mem"].__setitem__(0, 0.0),
        "tau_mem is not above 0",
    ),
    "biases that do not fit": (
        lambda f: put(f, "node/nodes/drive/bias", data=np.zeros(3)),
        "8 rows and 3 biases",
    ),
    "text for numbers": (lambda f: put(f, "node/nodes/drive/bias", data="x"), "bias are not numbers"),
    "a number for a name": (lambda f: put(f, "node/nodes/drive/type", data=3), "'type' is not a text"),
    "numbers for edges": (lambda f: put(f, "node/edges", data=np.zeros((3, 2))), "not pairs of names"),
    "edges that name nothing": (
        lambda f: put(f, "node/edges", data=np.array([["a", "b"]], "S1").astype(h5py.string_dtype())),
        "names the node 'a'",
    ),
    "edges between sizes that differ": (
        lambda f: put(
            f, "node/edges", data=np.array([["drive", "drive"]], object), dtype=h5py.string_dtype()
        ),
        "has 8 outputs, and 'drive' takes",
    ),
    "no output": (lambda f: f["node/nodes"].__delitem__("output"), "it has no Output"),
    "no nodes": (lambda f: f["node"].__delitem__("nodes"), "it has no nodes"),
    "an input of 2^60": (
        lambda f: put(f, "node/nodes/input/shape", data=np.array([2**60])),
        "it has the shape",
    ),
    "a step without a value": (
        lambda f: put(f, "node/metadata/dt", data=np.nan),
        "the step of its metadata is nan",
    ),
    "metadata that do not fit": (
        lambda f: put(f, "node/metadata/deodar", data='{"outputs": [{"label": 3}]}'),
        "metadata cannot be read",
    ),
    "metadata without JSON": (lambda f: put(f, "node/metadata/deodar", data="{"), "the file is damaged"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_is_refused(name: str, content: bytes) -> None:
    change, said = HOSTILE[name]
    began = time.monotonic()
    with pytest.raises(GraphError) as caught:
        parse_nir(changed(content, change), "bad.nir")
    assert said in str(caught.value) and str(caught.value).startswith("bad.nir: ")
    assert time.monotonic() - began < 2


def test_a_million_nodes_are_refused_before_they_are_read(
    content: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    def many(file: h5py.File) -> None:
        for k in range(2000):
            file[f"node/nodes/n{k}"] = file["node/nodes/drive"]

    large = changed(content, many)
    assert nir_reader.MOST_NODES < 10**6
    monkeypatch.setattr(nir_reader, "MOST_NODES", 1000)
    with pytest.raises(GraphError, match="it has 2,005 nodes, more than 1,000"):
        parse_nir(large)


@pytest.mark.parametrize("part", [b"", b"nothing of HDF5", b"PK\x03\x04"])
def test_a_foreign_file_is_refused_without_a_process(part: bytes) -> None:
    with pytest.raises(GraphError, match="it is not an HDF5 file"):
        read_nir(part)


def test_a_truncated_file_is_refused(content: bytes) -> None:
    for length in (9, 500, len(content) // 2, len(content) - 1):
        with pytest.raises(GraphError, match="the file is damaged"):
            parse_nir(content[:length])
    with pytest.raises(GraphError, match=r"cut\.nir: the file is damaged"):
        read_nir(content[:1000], "cut.nir")


def test_a_file_that_takes_too_long_is_refused(content: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(nir_file, "SECONDS", 0.001)
    with pytest.raises(GraphError, match="the file is damaged: it was not read in"):
        read_nir(content)


def test_damaged_files_are_read_or_refused(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "whole.nir").write_bytes(content)
    script = ROOT / "tests" / "deodar_spikes" / "fuzz.py"
    done = subprocess.run(
        [sys.executable, script, tmp_path / "whole.nir", "3", "40"],
        capture_output=True,
        text=True,
        env={"PYTHONPATH": ":".join(sys.path)},
    )
    counts = dict(part.split("=") for part in done.stdout.split())
    assert done.returncode == 0 and "wrong" not in counts, done.stderr
    assert int(counts["refused"]) > 5 and int(counts["read"]) > 5


def test_an_end_without_an_order_is_refused() -> None:
    graph = NirGraph({"input": EndNode(1), "output": EndNode(1)}, [], 1e-3)
    with pytest.raises(GraphError, match="no input reaches 'output'"):
        SpikingSimulator(graph)
