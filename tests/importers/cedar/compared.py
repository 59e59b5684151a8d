"""Runs of imported files, by cedar's names of slots and cedar's counting of iterations."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.elements.field import Field
from deodar.importers.cedar import file, translate
from deodar.importers.cedar.stored import StoredValues
from deodar.model import edit
from deodar.model.paths import display


def silent(doc):
    """Return a document without the noise of its fields."""
    for entry in doc.entries:
        if getattr(entry.element, "noise", 0.0):
            doc = edit.put(doc, entry.id, "noise", 0.0)
    return doc


def translated(content, name="file.json"):
    """Return the translation of a file and its model without noise."""
    parts = translate.StepTranslation(file.parse(content), False, StoredValues(name, lambda _: None))
    model = translate.read(content, name).model
    model.history.commit(silent(model.document))
    return parts, model


def ports(parts):
    """Return for each slot of cedar the port that shows it, and by how many iterations it is ahead.

    What cedar gives in iteration n is at the end of step n if it is a state after the update, or never
    changes, and at its beginning if it follows from the state before.
    """
    found = {}
    for path, piece in parts.pieces.items():
        label, group = ".".join(path), path[:-1]
        for slot, outlet in piece.outlets.items():
            port = f"{display((*group, outlet.name))}.{outlet.port}"
            found[f"{label}.{slot}"] = (port, int(path in parts.wiring.place and not outlet.state))
        if isinstance(piece.elements[0], Field):
            found[f"{label}.activation"] = (f"{display(path)}.activation", 0)
    return found


def run(content, steps, dt, slots=None):
    """Return the values of slots in iterations 0 to `steps`; NaN where deodar does not give them."""
    parts, model = translated(content)
    known = {slot: at for slot, at in ports(parts).items() if slots is None or slot in slots}
    record = sorted({port for port, _ in known.values()})
    data = dd.simulate(model, steps * dt, dt=dt, record=record, every=dt, precision="float64", seed=0)
    out = {}
    for slot, (port, behind) in known.items():
        values = data[port].values
        if behind:
            values = np.concatenate([np.full_like(values[:1], np.nan), values[:-1]])
        out[slot] = values
    return out
