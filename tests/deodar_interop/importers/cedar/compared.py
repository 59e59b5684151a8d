"""Runs of imported files, by cedar's names of slots and cedar's counting of iterations."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.elements.field import Field
from deodar.model import edit
from deodar.model.paths import display
from deodar_interop.importers.cedar import file, translate
from deodar_interop.importers.cedar.side_file import SideFile


def silent(doc):
    """Return a document without the noise of its fields."""
    for entry in doc.entries:
        if getattr(entry.element, "noise", 0.0):
            doc = edit.put(doc, entry.id, "noise", 0.0)
    return doc


def translated(content, name="file.json"):
    """Return the translation of a file and its model without noise."""
    parts = translate.StepTranslation(file.parse(content), SideFile(name, lambda _: None))
    model = translate.read(content, name).model
    model.history.commit(silent(model.document))
    return parts, model


def ports(parts):
    """Return for each slot of cedar the port that shows it, and by how many iterations it is behind.

    What cedar gives in iteration n is in deodar's record at the end of step n if it is a state after the
    update, or never changes, and at its beginning if it follows from the state before. A step that reads both
    kinds has no time in the record at which it can be compared.
    """
    found = {}
    for path, piece in parts.pieces.items():
        label, group = ".".join(path), path[:-1]
        for slot, outlet in piece.outlets.items():
            port = f"{display((*group, outlet.name))}.{outlet.port}"
            at = 0 if outlet.state else behind(parts, path, outlet.name)
            if at is not None:
                found[f"{label}.{slot}"] = (port, at)
        if isinstance(piece.elements[0], Field):
            found[f"{label}.activation"] = (f"{display(path)}.activation", 0)
    return found


def behind(parts, path, name):
    """Return by how many iterations the record of an element is behind; None if its inputs disagree.

    A state after the update is not behind, and one before it is behind by one iteration.
    """
    if path not in parts.wiring.place:
        return 0
    found = ages(parts, path, name, ())
    return found.pop() if len(found) == 1 else 1 if not found else None


def ages(parts, path, name, seen):
    """Return by how many iterations what an element follows from is behind; nothing for constants."""
    wiring, piece = parts.wiring, parts.pieces[path]
    if path not in wiring.place:
        return set()
    if (path, name) in seen or next(e for e in piece.elements if e.name == name).stateful:
        return {1}
    found, seen = set(), (*seen, (path, name))
    for a, c, *rest in piece.inner:
        if c == name:
            found |= {0} if rest[1:2] == ["current"] else ages(parts, path, a, seen)
    for wire in wiring.into.get(path, ()):
        outlet = parts.pieces[wire.source].outlets.get(wire.source_slot)
        inlets = [i.name for listed in piece.inlets.get(wire.target_slot, []) for i in listed]
        if name in inlets and outlet is not None and wire.source in wiring.place:
            if wiring.lag(wire.source, path):
                found.add(1)
            else:
                found |= {0} if outlet.state else ages(parts, wire.source, outlet.name, seen)
    return found


def run(content, steps, dt, slots=None):
    """Return the values of slots in iterations 0 to `steps`; NaN where deodar does not give them."""
    parts, model = translated(content)
    known = {slot: at for slot, at in ports(parts).items() if slots is None or slot in slots}
    record = sorted({port for port, _ in known.values()})
    recording = dd.simulate(model, steps * dt, dt=dt, record=record, every=dt, precision="float64", seed=0)
    out = {}
    for slot, (port, late) in known.items():
        values = recording[port].values
        if late:
            values = np.concatenate([np.full_like(values[:1], np.nan), values[:-1]])
        out[slot] = values
    return out
