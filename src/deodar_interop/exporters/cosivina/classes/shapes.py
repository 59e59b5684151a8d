"""Changes of dimension: sums over dimensions, expansions, transposition, diagonals."""

from __future__ import annotations

from deodar.couplings.arithmetic import Gain
from deodar.couplings.projections import DiagonalExpansion, DiagonalSum, Project, Resample
from deodar.model.document import Entry
from deodar_interop.exporters.cosivina.conversion import ConversionStep, NoConversion, conversion
from deodar_interop.exporters.cosivina.draft import Given, Unwritable
from deodar_interop.exporters.cosivina.layout import is_row, layout, size
from deodar_interop.importers._piece import Dims


def project(b: Given, element: Project) -> None:
    """Write what a projection does: sums over dimensions, then an expansion or a transposition."""
    came, dims = b.dims("input"), b.dims()
    if b.draft.passes_on(b.id):
        part = b.sized("FastFourierTransform", {})
    elif not element.axes and element.reduce == "sum" and len(came) == 2:
        part = b.sized("SumAllDimensions", {}, came)
        for component in ("horizontalSum", "verticalSum"):
            for e in b.draft.followers(b.id, component):
                b.claim([e])
                b.show(part, "output", component, of=e.id)
        b.take(part)
        b.show(part, "output", "fullSum")
        return
    else:
        _through(b, came, dims, dict(element.rename), element.reduce, element.interpolation)
        return
    b.carry(part)


def resample(b: Given, element: Resample) -> None:
    """Write the change of the grid of a row."""
    _through(b, b.dims("input"), b.dims(), {}, "integral", element.interpolation)


def sum_dimension(b: Given, before: Entry, amplitude: float) -> None:
    """Write SumDimension for a projection that sums, and the gain behind it."""
    element = before.element
    assert isinstance(element, Project)
    node = b.draft.nodes[before.id]
    came, dims = layout(node.ins["input"]), layout(tuple(element.axes))
    rename = dict(element.rename)
    here = [a.name for a in element.axes]
    names = {a.name: rename.get(a.name, a.name) for a in came if a is not None}
    lost = [d + 1 for d, a in enumerate(came) if a is not None and names[a.name] not in here]
    if not lost:
        lost = [next((d + 1 for d, a in enumerate(came) if a is None), len(came) + 1)]
    b.claim([before])
    values = {"sumDimensions": lost, "size": size(dims), "amplitude": amplitude}
    kept = [names[a.name] for a in came if a is not None and names[a.name] in here]
    there = [a.name for a in dims if a is not None]
    if kept != there:
        values["dimensionOrder"] = [kept.index(name) + 1 for name in there]
    part = b.part("SumDimension", values)
    b.take(part, of=before.id)
    b.show(part)


def diagonal_sum(b: Given, before: Entry, amplitude: float) -> None:
    """Write DiagonalSum for a sum along diagonals, and the gain behind it."""
    came = layout(b.draft.nodes[before.id].ins["input"])
    b.claim([before])
    part = b.part("DiagonalSum", {"inputSize": size(came), "amplitude": amplitude})
    b.take(part, of=before.id)
    b.show(part)


def diagonals(b: Given, element: DiagonalSum) -> None:
    """Write DiagonalSum with an amplitude of 1."""
    came = b.dims("input")
    if len(came) != 2 or size(came)[0] != size(came)[1]:
        raise Unwritable("cosivina sums along the diagonals of a square alone")
    b.carry(b.part("DiagonalSum", {"inputSize": size(came), "amplitude": 1}))


def diagonal_expansion(b: Given, element: DiagonalExpansion) -> None:
    """Write DiagonalExpansion; an importer puts its amplitude in front of it."""
    dims = b.dims()
    if len(dims) != 2 or size(dims)[0] != size(dims)[1]:
        raise Unwritable("cosivina expands to a square alone")
    amplitude, taken = 1.0, b.id
    sources = [c.source for c in b.draft.wires.into.get((b.id, "input"), [])]
    for e in b.draft.followers(b.id, "scaled"):
        if isinstance(e.element, Gain) and sources == [e.id] and b.draft.readers(e.id) == 1:
            amplitude, taken = e.element.factor, e.id
            b.claim([e])
            break
    if amplitude != 1:
        b.approximate("cosivina does not apply the amplitude of a DiagonalExpansion")
    came = layout(b.draft.nodes[taken].ins["input"])
    if not is_row(came):
        raise Unwritable("cosivina expands a row alone")
    part = b.part("DiagonalExpansion", {"inputSize": size(came), "amplitude": amplitude})
    b.take(part, of=taken)
    b.show(part)


def _through(
    b: Given, came: Dims, dims: Dims, rename: dict[str, str], reduce: str, interpolation: str
) -> None:
    """Add the elements of a conversion; the last one has the label of the entry."""
    try:
        steps = conversion(came, dims, rename, reduce, whole=True, interpolation=interpolation)
    except NoConversion as error:
        raise Unwritable(str(error)) from None
    if not steps:
        steps = [_unchanged(came)]
    last = None
    for k, (kind, values, there) in enumerate(steps):
        final = k == len(steps) - 1
        part = b.part(kind, values, label="" if final else f"{b.label} sum")
        if last is None:
            b.take(part, dims=came)
        else:
            b.inner(part, last[0], dims=last[1])
        last = part, there
        if final:
            b.show(part, dims=dims)


def _unchanged(dims: Dims) -> ConversionStep:
    """Return an element that passes a row or an array of more dimensions on."""
    if is_row(dims):
        return "ExpandDimension2D", {"expandDimension": 1, "size": size(dims)}, dims
    values = {
        "inputSize": size(dims),
        "outputSize": size(dims),
        "dimensionMapping": list(range(1, len(dims) + 1)),
    }
    return "ExpandDimension", values, dims


KINDS = {
    Project: project,
    Resample: resample,
    DiagonalSum: diagonals,
    DiagonalExpansion: diagonal_expansion,
}
