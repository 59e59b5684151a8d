"""The content of a file of NIR, read with every size checked before it is used.

A file is a group `node` of the type NIRGraph with groups for its nodes and a list of edges. HDF5 may describe
arrays of any size in a few bytes, groups that contain themselves, and links to other files. The reader checks
types and shapes first and reads arrays last; links to other files are refused. Some damaged files make the
HDF5 library itself run without end or crash, so `nir_file.py` runs this reader in a process of its own.
"""

from __future__ import annotations

import contextlib
import io
import math
from collections.abc import Generator, Mapping, Sequence
from typing import Any

import numpy as np

from deodar import codec
from deodar.errors import DeodarError, GraphError, MissingExtra, first_line, show
from deodar_spikes.graph import (
    INPUT,
    NEURON_FIELDS,
    OUTPUT,
    AffineNode,
    EndNode,
    GraphNode,
    InputRange,
    NeuronNode,
    NirGraph,
    OutputRange,
    Singles,
)

MOST_BYTES = 2**30
"""Largest file, and all its arrays together."""

MOST_NODES, MOST_EDGES, MOST_TEXT = 10_000, 100_000, 1_000_000

READABLE = ("Input", "Output", "Affine", "Linear", "CubaLIF")


@contextlib.contextmanager
def needed(package: str) -> Generator[None]:
    """Raise MissingExtra if the import of a package of the extra `neuromorphic` fails inside."""
    try:
        yield
    except ImportError:
        raise MissingExtra(package, "neuromorphic", "a file of NIR") from None


def hdf5() -> Any:
    """Return the package h5py, or raise MissingExtra."""
    with needed("h5py"):
        # an extra
        import h5py
    return h5py


def parse_nir(content: bytes, name: str = "") -> NirGraph:
    """Return the graph of a file, in this process; arguments and errors are those of `nir_file.read_nir`."""
    h5py = hdf5()
    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            return _NirReader(h5py, name).graph(file)
    except DeodarError:
        raise
    except Exception as error:  # h5py raises OSError, KeyError, RuntimeError, ValueError, TypeError
        raise GraphError(
            f"the file is damaged: {first_line(error)}", where=name, fix="Write it again"
        ) from None


class _NirReader:
    def __init__(self, h5py: Any, name: str) -> None:
        self.h5py = h5py
        self.name = name
        self.bytes = 0

    def wrong(self, what: str, where: str = "", fix: str = "") -> GraphError:
        return GraphError(what, where=": ".join(p for p in (self.name, where) if p), fix=fix)

    def graph(self, file: Any) -> NirGraph:
        top = self.group(file, "node")
        if self.text(top, "type") != "NIRGraph":
            raise self.wrong("its node is not a NIRGraph")
        inside = self.group(top, "nodes")
        if len(inside) > MOST_NODES:
            raise self.wrong(f"it has {len(inside):,} nodes, more than {MOST_NODES:,}")
        nodes: dict[str, GraphNode] = {}
        ends: dict[str, str] = {}
        for key in inside:
            group = self.group(inside, key)
            kind = self.text(group, "type")
            if kind not in READABLE:
                raise self.wrong(
                    f"the node {show(key)} is a {kind[:40]}, which deodar does not know",
                    fix=f"It reads {', '.join(READABLE)}",
                )
            if kind in ("Input", "Output"):
                ends.setdefault(kind, key)
                if ends[kind] != key:
                    raise self.wrong(f"it has two nodes {kind}: {show(ends[kind])} and {show(key)}")
            nodes[key] = self.node(group, kind, key)
        for kind in ("Input", "Output"):
            if kind not in ends:
                raise self.wrong(f"it has no {kind}")
        names = {ends["Input"]: INPUT, ends["Output"]: OUTPUT}
        if any(k in nodes and k not in names for k in (INPUT, OUTPUT)):
            raise self.wrong("a node that is no Input or Output has the name input or output")
        edges = self.edges(top, nodes)
        self.sizes(nodes, edges)
        step, about = self.metadata(top)
        return NirGraph(
            {names.get(k, k): v for k, v in nodes.items()},
            [(names.get(a, a), names.get(b, b)) for a, b in edges],
            step,
            *self.meaning(about, nodes[ends["Input"]].size, nodes[ends["Output"]].size),
        )

    # ----------------------------------------------------------------------------------------------- parts

    def node(self, group: Any, kind: str, key: str) -> GraphNode:
        """Read one node."""
        if kind in ("Input", "Output"):
            shape = self.array(group, "shape", key, 1)
            size = float(np.prod(shape.astype(np.float64))) if shape.size else 1.0
            if not 1 <= size <= MOST_BYTES / 4 or (shape < 1).any():
                raise self.wrong(f"it has the shape {show(shape.tolist())}", key)
            return EndNode(int(size))
        if kind in ("Affine", "Linear"):
            weight = self.array(group, "weight", key, 2)
            bias = (
                self.array(group, "bias", key, 1) if kind == "Affine" else np.zeros(len(weight), np.float32)
            )
            if bias.size != len(weight):
                raise self.wrong(f"it has {len(weight)} rows and {bias.size} biases", key)
            return AffineNode(weight, bias.reshape(-1))
        return self.neurons(group, key)

    def neurons(self, group: Any, key: str) -> NeuronNode:
        """Read a CubaLIF."""
        threshold = self.array(group, "v_threshold", key, None).reshape(-1)
        values: dict[str, Singles] = {"v_threshold": threshold}
        for field in NEURON_FIELDS:
            if field == "v_threshold":
                continue
            if field in group:
                found = self.array(group, field, key, None).reshape(-1)
            elif field in ("v_reset", "w_in"):
                found = np.full(1, float(field == "w_in"), np.float32)
            else:
                raise self.wrong(f"it has no {field}", key)
            if found.size not in (1, threshold.size):
                raise self.wrong(
                    f"it has {threshold.size} thresholds and {found.size} values of {field}", key
                )
            values[field] = np.broadcast_to(found, threshold.shape).copy()
        for field in ("tau_syn", "tau_mem"):
            if not (values[field] > 0).all():
                raise self.wrong(f"a time constant {field} is not above 0", key)
        return NeuronNode(**values)

    def edges(self, top: Any, nodes: Mapping[str, GraphNode]) -> list[tuple[str, str]]:
        """Read the edges: pairs of names."""
        data = self.dataset(top, "edges", "")
        if len(data.shape) != 2 or data.shape[1] != 2 or data.shape[0] > MOST_EDGES:
            raise self.wrong(f"its edges have the shape {show(data.shape)}")
        self.count(data, 64)
        if self.h5py.check_string_dtype(data.dtype) is None:
            raise self.wrong("its edges are not pairs of names")
        out: list[tuple[str, str]] = []
        for pair in data[()]:
            a, b = (v.decode("utf-8", "replace") if isinstance(v, bytes) else str(v) for v in pair)
            for end in (a, b):
                if end not in nodes:
                    raise self.wrong(f"an edge names the node {show(end)}, which it does not have")
            out.append((a, b))
        return list(dict.fromkeys(out))

    def sizes(self, nodes: Mapping[str, GraphNode], edges: Sequence[tuple[str, str]]) -> None:
        """Refuse edges between nodes that do not fit."""
        for a, b in edges:
            target = nodes[b]
            takes = target.takes if isinstance(target, AffineNode) else target.size
            if nodes[a].size != takes:
                raise self.wrong(
                    f"the node {show(a)} has {nodes[a].size} outputs, and {show(b)} takes {takes} inputs"
                )

    def metadata(self, top: Any) -> tuple[float, dict[str, Any]]:
        """Read the step and what the values of Input and Output are."""
        if "metadata" not in top:
            return 0.0, {}
        group = self.group(top, "metadata")
        step = self.number(group, "dt") if "dt" in group else 0.0
        if not (math.isfinite(step) and step >= 0):
            raise self.wrong(f"the step of its metadata is {step}")
        if "deodar" not in group:
            return step, {}
        about = codec.parse(self.text(group, "deodar"))
        return step, about if isinstance(about, dict) else {}

    def meaning(
        self, about: Mapping[str, Any], inputs: int, outputs: int
    ) -> tuple[list[InputRange], list[OutputRange], float]:
        """Return the ranges of Input and Output that the metadata state."""
        try:
            ins = [InputRange(**part) for part in about.get("inputs", ())]
            outs = [output_range(part) for part in about.get("outputs", ())]
            settling = float(about.get("settling", 0.0))
            good = all(_inside(r.start, r.stop, inputs) for r in ins) and all(
                _inside(r.start, r.stop, outputs)
                and math.prod(r.shape) * r.neurons == r.stop - r.start
                and math.isfinite(r.unit)
                for r in outs
            )
        except (TypeError, ValueError, KeyError, AttributeError) as error:
            raise self.wrong(f"its metadata cannot be read: {first_line(error)}") from None
        if not good or not 0 <= settling < 1e6:
            raise self.wrong("its metadata do not fit its Input and Output")
        return ins, outs, settling

    # ----------------------------------------------------------------------------------------- HDF5, checked

    def member(self, group: Any, key: str) -> Any:
        """Return a member of a group that lies in this file."""
        link = group.get(key, getlink=True)
        if link is None:
            raise self.wrong(f"it has no {key}", group.name if group.name != "/" else "")
        if not isinstance(link, self.h5py.HardLink):
            raise self.wrong(f"{show(key)} is a link, and a file of NIR has none")
        return group[key]

    def group(self, parent: Any, key: str) -> Any:
        found = self.member(parent, key)
        if not isinstance(found, self.h5py.Group):
            raise self.wrong(f"{show(key)} is not a group")
        return found

    def dataset(self, group: Any, key: str, where: str) -> Any:
        found = self.member(group, key)
        if not isinstance(found, self.h5py.Dataset):
            raise self.wrong(f"{show(key)} is not an array", where)
        if found.external or found.is_virtual:
            raise self.wrong(f"{show(key)} lies in another file", where)
        return found

    def count(self, data: Any, item: int) -> None:
        """Refuse arrays that are larger than memory allows, before they are read."""
        self.bytes += math.prod(int(n) for n in data.shape) * item
        if self.bytes > MOST_BYTES:
            raise self.wrong(f"its arrays have more than {MOST_BYTES:,} bytes", data.name)

    def text(self, group: Any, key: str) -> str:
        data = self.dataset(group, key, group.name)
        if data.shape != () or self.h5py.check_string_dtype(data.dtype) is None:
            raise self.wrong(f"{show(key)} is not a text", group.name)
        self.count(data, data.dtype.itemsize)
        value = data[()]
        text = value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)
        if len(text) > MOST_TEXT:
            raise self.wrong(f"{show(key)} has {len(text):,} characters", group.name)
        return text

    def number(self, group: Any, key: str) -> float:
        """Read one number, in all its digits."""
        data = self.dataset(group, key, group.name)
        if data.shape != () or data.dtype.kind not in "fiu":
            raise self.wrong(f"{key} is not a number", group.name)
        return float(data[()])

    def array(self, group: Any, key: str, where: str, axes: int | None) -> Singles:
        """Read an array of finite numbers."""
        data = self.dataset(group, key, where)
        if data.dtype.kind not in "fiub":
            raise self.wrong(f"{key} are not numbers", where)
        if data.shape is None or (axes is not None and len(data.shape) != axes):
            raise self.wrong(f"{key} has the shape {show(data.shape)}", where)
        self.count(data, max(4, data.dtype.itemsize))
        values = np.asarray(data[()])
        if not np.isfinite(values.astype(np.float64)).all():
            raise self.wrong(f"{key} has values that are not finite", where)
        with np.errstate(over="ignore"):
            single = values.astype(np.float32)
        if not np.isfinite(single).all():
            raise self.wrong(f"{key} has values above the largest one of 32 bits", where)
        return single


def output_range(plain: Mapping[str, Any]) -> OutputRange:
    """Return the range of plain data."""
    rest = {k: v for k, v in plain.items() if k != "shape"}
    return OutputRange(**rest, shape=tuple(int(n) for n in plain["shape"]))


def _inside(start: Any, stop: Any, size: int) -> bool:
    return isinstance(start, int) and isinstance(stop, int) and 0 <= start < stop <= size
