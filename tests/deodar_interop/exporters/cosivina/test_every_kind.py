"""Every registered kind of element is written, or reported as left out; no kind ends in another error."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar import registry
from deodar.model.check import problems
from deodar.model.document_graph import graph
from deodar_interop.exporters.cosivina import write
from deodar_interop.importers.cosivina import read

KINDS = sorted(
    name
    for room in ("elements", "couplings")
    for name, cls in registry.kinds(room).items()
    if cls.__module__.startswith("deodar.")
)
AXES = (
    (),
    (dd.Axis("x", 0, 20, samples=21),),
    (dd.Axis("x", 0, 20, samples=21), dd.Axis("y", 0, 20, samples=21)),
    (dd.Axis("x", 0, 14, samples=15), dd.Axis("y", 0, 14, samples=15)),
    (dd.Axis("x", 0, 4, samples=3), dd.Axis("y", 0, 4, samples=3), dd.Axis("channel", 0, 2, samples=3)),
)


def around(kind: str) -> dd.Model:
    """Return a model in which an example of a kind reads fields and is read."""
    example = registry.kind(kind).example()
    for axes in AXES:
        m = dd.Model("m")
        it = m.add(example)
        for port in example.ports():
            own = example.input_axes(port, axes)
            m.add(dd.Field(f"to {port}", list(axes if own is None else own))) >> it[port]
        if problems(m.document):
            continue
        (node,) = (n for n in graph(m.document).nodes if n.id == it.id)
        if "output" in node.outs:
            it >> m.add(dd.Field("reader", list(node.outs["output"])))
        if not problems(m.document):
            return m
    raise AssertionError(f"no axes fit {kind}")


@pytest.mark.parametrize("kind", KINDS)
def test_a_kind_is_written_or_left_out(kind: str) -> None:
    exported = write(around(kind), "file.json")
    (line,) = (line for line in exported.report.lines if (line.where, line.part) == ("example", "element"))
    assert line.what == kind and (line.verdict == "carried" or line.why)
    reading = read(exported.content, "file.json")
    assert problems(reading.model.document) == []
    labels = {e.path for e in reading.model.document.entries}
    assert ("example" in labels) == (line.verdict != "dropped")
    fields = {line.where for line in reading.report.losses if line.what == "NeuralField"}
    assert not fields
