"""The reader: one number made of a field inside the compiled step, so that a look at many trials copies no fields."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import jax.numpy as jnp

from deodar.element import Arrays, Coupling, Setting, Time
from deodar.experiments.view import PLACE, REDUCES, View, mask, places
from deodar.model import edit
from deodar.model.document import Document
from deodar.model.resolve import resolve
from deodar.numerics.axes import Axes, Axis, shape
from deodar.parameters import Recompile

Place = tuple[str, str]
"""An element by its id, and one of its ports."""

_REDUCES = {"max": jnp.max, "min": jnp.min, "sum": jnp.sum}


@dataclass(frozen=True)
class Reader(Coupling):
    """y = max, min, mean or sum of the samples around a place, or where the largest of them stands.

    It is never part of a document that is written: `with_readers` adds it to the copy that a batch runs.
    """

    reduce: Annotated[str, Recompile(choices=(*REDUCES, PLACE), meaning="what is made of the samples")] = "max"
    near: Annotated[str, Recompile(meaning="the place and the radius around it, as JSON; empty: all samples")] = ""

    def outputs(self, ins: Mapping[str, Axes]) -> Mapping[str, Axes]:
        count = len(ins["input"])
        return {"output": (Axis("of", 0.0, float(count - 1), count),) if self.reduce == PLACE and count > 1 else ()}

    def output(self, at: Setting, state: Arrays, inputs: Arrays, constants: Any, time: Time, noise: Any) -> Arrays:
        axes, y = at.ins["input"], inputs["input"].ravel()
        near, radius = json.loads(self.near) if self.near else ((), 0.0)
        inside, points = mask(axes, near, radius), places(axes)
        inside = None if inside is None else inside.ravel()
        if self.reduce in ("max", "min", PLACE):
            y = y if inside is None else jnp.where(inside, y, jnp.inf if self.reduce == "min" else -jnp.inf)
        else:
            y = y if inside is None else jnp.where(inside, y, 0.0)
        if self.reduce == "mean":
            return {"output": jnp.sum(y) / (y.size if inside is None else int(inside.sum()))}
        if self.reduce != PLACE:
            return {"output": _REDUCES[self.reduce](y)}
        # the first of the largest by two reductions, which vector instructions do; argmax takes four times as long as a step of the field
        first = jnp.min(jnp.where(y == jnp.max(y), jnp.arange(y.size, dtype=jnp.int32), y.size - 1))
        found = jnp.asarray(points, at.dtype)[first]
        return {"output": found[0] if len(axes) == 1 else found}


def with_readers(doc: Document, views: Sequence[View]) -> tuple[Document, dict[View, Place]]:
    """The document with a reader for each view of a field that can have one, and where each of these is read.

    Views of single numbers, of input ports and of whole arrays are left out: they are read as they are.
    """
    nodes = {node.id: node for node in resolve(doc)[0]}
    at: dict[View, Place] = {}
    for view in views:
        source, port = view.place(doc)
        axes = nodes[source.id].outs.get(port) if source.id in nodes else None
        if not view.reduce or axes is None or not shape(axes):
            continue
        mask(axes, view.near, view.radius)  # refused here, not inside the step
        near = json.dumps([list(view.near), view.radius]) if view.near else ""
        digest = hashlib.blake2b(repr(view).encode(), digest_size=6).hexdigest()
        doc, entry = edit.add(doc, Reader(view.reduce, near, name=f"look {digest}"))
        doc = edit.connect(doc, source, port, entry, "input")
        at[view] = (entry.id, "output")
    return doc, at
