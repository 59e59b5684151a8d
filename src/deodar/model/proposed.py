"""The edits that the fix of a problem proposes: bound to a document, and made in it."""

from __future__ import annotations

import dataclasses as dc
import functools
from collections.abc import Collection, Iterable, Iterator, Sequence

from deodar.errors import (
    ConnectionFix,
    DeodarError,
    EditFix,
    Fix,
    ParameterError,
    Problem,
    UnknownName,
    did_you_mean,
    worded,
)
from deodar.model import building, document_files, edit, find
from deodar.model.document import Document, Leaf
from deodar.model.document_graph import graph
from deodar.model.resolve import reach
from deodar.numerics.axes import Axis
from deodar.parameters import show
from deodar.proposed_edit import (
    Disconnect,
    InsertCoupling,
    ProposedEdit,
    SetAxis,
    SetReads,
    SetSourcePort,
    SetStep,
    SetValues,
)

MOST_TRIED = 20
"""Most edits for structural problems that are tried in one document; each one is resolved as a whole."""


class CheckedDocument:
    """A document whose problems get their edits: what all of them look up, computed once.

    Args:
        doc: a document without structural problems.
    """

    def __init__(self, doc: Document) -> None:
        self.doc = doc

    @functools.cached_property
    def ids(self) -> dict[str, str]:
        """The id of each element by its path."""
        return {e.path: e.id for e in self.doc.entries}

    @functools.cached_property
    def links(self) -> dict[Leaf, str]:
        """The name of the document parameter that drives each linked parameter."""
        return self.doc.links()

    @functools.cached_property
    def axes(self) -> dict[str, Axis]:
        """The axes by their keys."""
        return document_files.axes(self.doc)

    @functools.cached_property
    def _neighbours(self) -> dict[str, set[str]]:
        neighbours: dict[str, set[str]] = {e.id: set() for e in self.doc.entries}
        for c in self.doc.connections:
            neighbours[c.source].add(c.target)
            neighbours[c.target].add(c.source)
        return neighbours

    @functools.cached_property
    def _by_axis_name(self) -> dict[str, set[str]]:
        having: dict[str, set[str]] = {}
        for e in self.doc.entries:
            for axis in e.axes:
                having.setdefault(axis.name, set()).add(e.id)
        return having

    def concerned(self, edits: Sequence[ProposedEdit]) -> Document:
        """Return the part of the document that edits concern, in which they do what they do in the whole.

        Values concern their elements. Axes concern all elements that have an axis of these names, since keys
        number them, and all that connections join with these elements.
        """
        values = [e.element or "" for e in edits if isinstance(e, SetValues)]
        keys = [e.axis for e in edits if isinstance(e, SetAxis)]
        if len(values) == len(edits) and all(path in self.ids for path in values):
            return self._part({self.ids[path] for path in values}, False)
        if len(keys) < len(edits) or any(key not in self.axes for key in keys):
            return self.doc
        having = [self._by_axis_name[self.axes[key].name] for key in keys]
        part = self._part(reach(set[str]().union(*having), self._neighbours.__getitem__), True)
        numbered = document_files.axes(part)
        return part if all(numbered.get(key) == self.axes[key] for key in keys) else self.doc

    def _part(self, ids: Collection[str], connected: bool) -> Document:
        driving = (p for p in self.doc.parameters if any(ident in ids for ident, _ in p.links))
        return dc.replace(
            self.doc,
            entries=tuple(e for e in self.doc.entries if e.id in ids),
            connections=tuple(c for c in self.doc.connections if c.source in ids) if connected else (),
            parameters=() if connected else tuple(driving),
            groups=(),
            uses=(),
        )


def bound(checked: CheckedDocument, problem: Problem) -> Problem:
    """Return a problem whose edits name the element that has it.

    An edit of a parameter that a document parameter drives becomes one of the document parameter. An edit
    that would change something else too, or that the document cannot have, becomes text, with the reason.
    """
    if not isinstance(problem.fix, EditFix):
        return problem
    inside = [e.inside(problem.where) if isinstance(e, SetValues) else e for e in problem.fix.edits]
    if shared := _also_driven(checked, inside):
        text = _text(problem.fix.with_edits(inside)).then(f"First {shared}")
        return dc.replace(problem, fix=text.then(_last_resort(problem.where)))
    edits = [new for e in inside for new in _bound(checked, e)]
    fix = problem.fix.with_edits(edits)
    doc = checked.concerned(edits)
    if not _in_order(doc, edits):  # the lines of its text would change other axes than the edit
        return _advice(problem)
    refused = _refused(doc, edits)
    if refused:
        text = _text(fix).then(f"First change {refused[0]}")
        return dc.replace(problem, fix=text.then(_last_resort(problem.where)))
    return dc.replace(problem, fix=fix)


def proven(doc: Document, structural: Sequence[Problem], most: int = MOST_TRIED) -> list[Problem]:
    """Return the structural problems of a document; edits that do not solve theirs, or that bring another
    one, are left out, and those beyond the first `most` become text.
    """
    tried = [p for p in structural if isinstance(p.fix, EditFix)][:most]

    def fixed(problem: Problem) -> Problem:
        if problem in tried:
            return problem if _solves(doc, problem, structural) else _untried(doc, problem, _advice(problem))
        fix = problem.fix
        if not isinstance(fix, EditFix):
            return problem
        return _untried(doc, problem, dc.replace(problem, fix=_text(fix)))

    return list(map(fixed, structural))


def _solves(doc: Document, problem: Problem, before: Sequence[Problem]) -> bool:
    try:
        after = graph(apply(doc, problem.edits)).problems
    except DeodarError:
        return False
    return problem not in after and set(after) <= set(before)


def _advice(problem: Problem) -> Problem:
    """Return a problem whose fix is the advice alone: its edit is not right here."""
    fix = problem.fix
    if not isinstance(fix, EditFix):
        return problem
    return dc.replace(problem, fix=Fix(fix.advice).then(fix.otherwise))


def _untried(doc: Document, problem: Problem, text: Problem) -> Problem:
    """Return a problem as text, in place of an edit that is not made; of a connection it keeps the ends, so
    that the page can remove the connection and not an element.
    """
    ends = next((ends for e in problem.edits if (ends := _paths(doc, e))), None)
    if ends is None:
        return dc.replace(text, fix=worded(text.fix).then(_last_resort(problem.where)))
    fix = worded(text.fix).then(_last_resort("the connection"))
    return dc.replace(text, fix=ConnectionFix(fix, fix.page, ends, fix.shell))


def _paths(doc: Document, proposed: ProposedEdit) -> tuple[str, str, str, str] | None:
    """Return the ends of the connection that an edit is about, by paths; None if it is about none."""
    if isinstance(proposed, InsertCoupling):
        return proposed.ends
    if not isinstance(proposed, (Disconnect, SetReads, SetSourcePort)):
        return None
    source, source_port, target, target_port = _ends(doc, proposed)
    by = doc.by_id()
    return by[source].path, source_port, by[target].path, target_port


def _last_resort(path: str) -> Fix:
    """Return the words for what the button of the page does where no edit is made: it removes something."""
    return Fix("", page=f"Or remove {path}")


def _text(fix: EditFix) -> Fix:
    """Return the text of a fix, without its edits."""
    return Fix(fix, fix.shell, fix.page)


def _also_driven(checked: CheckedDocument, edits: Sequence[ProposedEdit]) -> str:
    """Return what separates an edit from a document parameter that drives more than the edit sets; "" if none
    does.
    """
    doc = checked.doc
    new = {
        (checked.ids.get(e.element or "", ""), path): setting
        for e in edits
        if isinstance(e, SetValues)
        for path, setting in e.values
    }
    for parameter in doc.parameters:
        changed = [leaf for leaf in parameter.links if leaf in new]
        others = [leaf for leaf in parameter.links if changed and new.get(leaf) != new[changed[0]]]
        if others:
            paths = [f"{doc.by_id()[ident].path}.{path}" for ident, path in (changed[0], others[0])]
            return f"unlink {paths[0]} from {parameter.name!r}, which also drives {paths[1]}"
    return ""


def _in_order(doc: Document, edits: Sequence[ProposedEdit]) -> bool:
    """Return whether edits of axes, made one after the other by their keys, are those made together."""
    axes = [e for e in edits if isinstance(e, SetAxis)]
    if len(axes) < 2:
        return True
    try:
        together, in_turn = apply(doc, axes), doc
        for e in axes:
            in_turn = change_axis(in_turn, e.axis, dict(e.values))
    except UnknownName:
        return False
    except DeodarError:  # an element refuses an axis, which the fix states
        return True
    return [e.element for e in in_turn.entries] == [e.element for e in together.entries]


def _refused(doc: Document, edits: Sequence[ProposedEdit]) -> Sequence[Problem]:
    """Return why edits cannot be made, or what prevents a run after them."""
    try:
        new = apply(doc, edits)
    except DeodarError as error:
        return error.problems
    # another axis may not fit arrays and connections
    return graph(new).problems if any(isinstance(e, SetAxis) for e in edits) else ()


def _bound(checked: CheckedDocument, proposed: ProposedEdit) -> Iterator[ProposedEdit]:
    if not isinstance(proposed, SetValues):
        yield proposed
        return
    ident = checked.ids.get(proposed.element or "", "")
    links = {path: name for path, _ in proposed.values if (name := checked.links.get((ident, path)))}
    shared = tuple((links[path], setting) for path, setting in proposed.values if path in links)
    alone = tuple((path, setting) for path, setting in proposed.values if path not in links)
    if alone:
        yield dc.replace(proposed, values=alone)
    if shared:
        yield SetValues(shared, "")


def apply(doc: Document, edits: Iterable[ProposedEdit]) -> Document:
    """Return a document in which edits of a problem are made.

    Raises:
        DeodarError: the document does not have what an edit changes.
    """
    edits = list(edits)
    axes = [e for e in edits if isinstance(e, SetAxis)]
    if axes:  # keys belong to the document as it is: an edit may number the keys of a name again
        doc = edit.replace_axes(doc, dict(_new_axis(doc, e.axis, dict(e.values)) for e in axes))
    for proposed in edits:
        match proposed:
            case SetValues():
                doc = edit.change_all(doc, proposed.paths())
            case SetAxis():
                pass
            case InsertCoupling(ends=(source, out, target, port)):
                first, last = find.element(doc, source), find.element(doc, target)
                around = building.Around(wire=(first.id, out, last.id, port))
                doc, _ = building.add(doc, proposed.kind, proposed.values(), around=around)
            case SetStep():
                doc = edit.describe(doc, dt=proposed.dt)
            case Disconnect():
                doc = edit.disconnect(doc, *_ends(doc, proposed))
            case SetReads():
                doc = edit.set_reads(doc, _ends(doc, proposed), proposed.reads)
            case SetSourcePort():
                _, port = find.port(doc, proposed.port)
                doc = edit.set_source_port(doc, _ends(doc, proposed), port)
            case _:
                raise TypeError(f"{type(proposed).__name__} is no edit of a document")
    return doc


def _ends(doc: Document, proposed: Disconnect | SetReads | SetSourcePort) -> tuple[str, str, str, str]:
    """Return the ends of the connection that an edit is about."""
    source, source_port = find.port(doc, proposed.source)
    target, target_port = find.port(doc, proposed.target, "")
    return source.id, source_port, target.id, target_port or target.element.ports()[0]


def change_axis(doc: Document, key: str, values: dict[str, object]) -> Document:
    """Return a document in which an axis has other values, in every element that has it.

    Raises:
        UnknownName: the document has no axis of this key.
    """
    return edit.replace_axis(doc, *_new_axis(doc, key, values))


def remove_axis(doc: Document, key: Axis | str) -> Document:
    """Return a document without an axis, given by its key or itself.

    Raises:
        UnknownName: the document has no axis of this key.
        ParameterError: an element needs the axis, such as one whose array has a dimension for it.
    """
    axis = _axis(doc, key)
    new = edit.remove_axis(doc, axis)
    places = {p.where for p in graph(doc).problems}
    if needing := [p for p in graph(new).problems if p.where not in places]:
        fix = "Change this first, or remove the element"
        raise ParameterError(
            [Problem(p.where, f"needs the axis {axis.name}; without it: {p.what}", fix) for p in needing]
        )
    return new


def _axis(doc: Document, key: Axis | str) -> Axis:
    axes = document_files.axes(doc)
    if isinstance(key, Axis):
        if key in axes.values():
            return key
        raise UnknownName(f"the document has no axis {key}", fix=f"Its axes: {', '.join(axes) or 'none'}")
    if not isinstance(key, str):
        raise ParameterError(f"expected an Axis or its name, got {show(key)}")
    if key not in axes:
        raise UnknownName(f"the document has no axis {key!r}", fix=did_you_mean(key, axes))
    return axes[key]


def _new_axis(doc: Document, key: str, values: dict[str, object]) -> tuple[Axis, Axis]:
    """Return the axis of a key, and the same axis with other values."""
    old = _axis(doc, key)
    return old, dc.replace(old, **values)  # type: ignore[arg-type]
