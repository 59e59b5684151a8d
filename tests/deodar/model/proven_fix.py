"""Whether the fix of a problem solves it: the finding is gone, no other one is there, the signal arrives."""

from __future__ import annotations

import re

import numpy as np

import deodar as dd
from deodar.errors import Problem
from deodar.model import edit, find
from deodar.model.check import check
from deodar.model.document import Connection, Document, Entry
from deodar.model.proposed import apply

RANK = {"warning": 0, "problem": 1}

ARRIVES = 1e-3
"""Least change of an output, at any time and position, when what it reads is muted."""

STEPS = 1000
"""Most steps of a run."""


def finding(problem: Problem) -> tuple[str, str]:
    """Return where a problem is and what it is, without its numbers."""
    return problem.where, re.sub(r"[-+]?\d[-+\w.]*", "#", problem.what)


def faults(doc: Document, problem: Problem, labelled: bool = True) -> list[str]:
    """Return what is wrong with the fix of a problem of a document; empty if it is proven.

    Args:
        doc: the document.
        problem: one of its problems.
        labelled: whether this is its only mistake. A path that another mistake breaks stays broken.
    """
    fixed = apply(doc, problem.edits)
    before, after = {finding(p) for p in check(doc)}, check(fixed)
    wrong = [f"still there: {p}" for p in after if finding(p) == finding(problem)]
    wrong += [
        f"new: {p}" for p in after if finding(p) not in before and RANK[p.severity] >= RANK[problem.severity]
    ]
    if not wrong and problem.where in [e.path for e in fixed.entries]:
        lost = muted(fixed, problem)
        if lost and not labelled:
            lost = [end for end in lost if end not in muted(doc, problem)]
        wrong += [f"muted: {path} gives the same without {end}" for path, end in lost]
    return wrong


def muted(doc: Document, problem: Problem) -> list[tuple[str, str]]:
    """Return the ends of broken paths through the element of a problem, in a run.

    The element has to change when all that it reads is muted, and each element that reads it when its own
    outputs are. An element that has no inputs has no first path, one that nothing reads no second.
    """
    entry = next(e for e in doc.entries if e.path == problem.where)
    ends = [c for c in doc.connections if entry.id in (c.source, c.target) and not _in_loop(doc, c)]
    if not ends:
        return []
    for number, c in enumerate(ends):
        doc, gain = edit.add(doc, dd.Gain(1.0, name=f"mute{number}"))
        doc = edit.disconnect(doc, *c.ends)
        doc = edit.connect(doc, _entry(doc, c.source), c.source_port, gain, "", c.reads)
        doc = edit.connect(doc, gain, "", _entry(doc, c.target), c.target_port)
    loud = {f"mute{number}.factor": 1.0 for number in range(len(ends))}
    no_input = {f"mute{k}.factor": 0.0 for k, c in enumerate(ends) if c.target == entry.id}
    no_output = {f"mute{k}.factor": 0.0 for k, c in enumerate(ends) if c.source == entry.id}
    readers = {c.target for c in ends if c.source == entry.id} - {entry.id}
    paths = {entry.path: f"{entry.path}.{find.outputs(entry)[0]}"} | {
        e.path: "{}.{}".format(*(e.path, find.shown(doc, e.path)[1])) for e in doc.entries if e.id in readers
    }
    dt = doc.step
    if not paths or not (no_input or no_output):
        return []
    record = dd.simulate(
        dd.Model(document=doc),
        STEPS * dt if dt < 1 else max(1.0, 1000 // dt) * dt,
        record=list(paths.values()),
        sweep=[loud, loud | no_input, loud | no_output],
        every=10 * dt if dt < 1 else dt,
    )
    values = {path: record[name].values for path, name in paths.items()}

    def changes(path: str, point: int) -> bool:
        return bool(np.abs(values[path][point] - values[path][0]).max() > ARRIVES)

    broken = [(entry.path, "its input")] if no_input and not changes(entry.path, 1) else []
    return broken + [(e.path, entry.path) for e in doc.entries if e.id in readers and not changes(e.path, 2)]


def _entry(doc: Document, ident: str) -> Entry:
    return doc.by_id()[ident]


def _in_loop(doc: Document, c: Connection) -> bool:
    """Return whether a connection closes a loop in which no element states its axes."""
    ahead, last = {c.target}, -1
    while last != len(ahead):
        last = len(ahead)
        ahead |= {d.target for d in doc.connections if d.source in ahead}
    return c.source in ahead and getattr(_entry(doc, c.target).element, "axes", None) is None
