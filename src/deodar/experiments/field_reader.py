"""The reader: one number computed from a field inside the compiled step, so that sampling many trials copies
no fields.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import jax.numpy as jnp

from deodar import codec
from deodar.element import Arrays, Coupling, PortAxes, Setting
from deodar.experiments.observable import PLACE, REDUCES, Observable, mask
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.numerics.axes import Axis, shape
from deodar.numerics.peak import position
from deodar.parameters import Recompile

ReadPlace = tuple[str, str]
"""An element by its id, and one of its ports."""

_REDUCES = {"max": jnp.max, "min": jnp.min, "sum": jnp.sum}


@dataclass(frozen=True)
class Reader(Coupling):
    """y = max, min, mean or sum of the samples around a position, or the position of their highest peak.

    A position is one number per axis, then 1 if a peak exists and 0 if not: values that are not finite would
    end the run. It is never part of a document that is written: `with_readers` adds
    it to the copy that a batch runs.
    """

    reduce: Annotated[str, Recompile(choices=(*REDUCES, PLACE))] = "max"
    near: str = ""
    threshold: Annotated[float, Recompile("input")] = 0.0

    def outputs(self, ins: PortAxes) -> PortAxes:
        count = len(ins["input"])
        return {"output": (Axis("of", 0.0, float(count), count + 1),) if self.reduce == PLACE else ()}

    def output(self, at: Setting) -> Arrays:
        axes, y = at.ins["input"], at.inputs["input"]
        inside = mask(axes, *codec.parse(self.near)) if self.near else None
        if self.reduce == PLACE:
            centroid, exists = position(y, axes, self.threshold, inside)
            return {"output": jnp.append(centroid, exists.astype(centroid.dtype))}
        if self.reduce in ("max", "min"):
            y = y if inside is None else jnp.where(inside, y, jnp.inf if self.reduce == "min" else -jnp.inf)
        else:
            y = y if inside is None else jnp.where(inside, y, 0.0)
        if self.reduce == "mean":
            return {"output": jnp.sum(y) / (y.size if inside is None else int(inside.sum()))}
        return {"output": _REDUCES[self.reduce](y)}


def with_readers(doc: Document, views: Sequence[Observable]) -> tuple[Document, dict[Observable, ReadPlace]]:
    """Return the document with a reader for each view of a field that can have one, and the port of each
    reader.

    Views of single numbers, of input ports and of whole arrays are left out: they are read directly.
    """
    nodes = {node.id: node for node in graph(doc).nodes}
    at: dict[Observable, ReadPlace] = {}
    for view in views:
        source, port = view.place(doc)
        axes = nodes[source.id].outs.get(port) if source.id in nodes else None
        if not view.reduce or axes is None or not shape(axes):
            continue
        mask(axes, view.near, view.radius)  # refused here, not inside the step
        place = codec.line([list(view.near), view.radius]) if view.near else ""
        digest = hashlib.blake2b(repr(view).encode(), digest_size=6).hexdigest()
        doc, entry = edit.add(doc, Reader(view.reduce, place, view.threshold, name=f"look {digest}"))
        doc = edit.connect(doc, source, port, entry, "input")
        at[view] = (entry.id, "output")
    return doc, at
