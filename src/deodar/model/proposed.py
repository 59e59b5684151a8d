"""The edits that the fix of a problem proposes: bound to a document, and made in it."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterable, Iterator, Sequence

from deodar.errors import DeodarError, EditFix, Fix, Problem, UnknownName, did_you_mean, joined
from deodar.model import document_files, edit, find
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.numerics.axes import Axis
from deodar.proposed_edit import Disconnect, ProposedEdit, SetAxis, SetStep, SetValues


def bound(doc: Document, problem: Problem) -> Problem:
    """Return a problem whose edits name the element that has it.

    An edit of a parameter that a document parameter drives becomes one of the document parameter. An edit
    that would change something else too, or that the document cannot have, becomes text, with the reason.
    """
    if not isinstance(problem.fix, EditFix):
        return problem
    inside = [e.inside(problem.where) if isinstance(e, SetValues) else e for e in problem.fix.edits]
    if shared := _also_driven(doc, inside):
        return dc.replace(problem, fix=_text(problem.fix.with_edits(inside), f"First {shared}"))
    edits = [new for e in problem.fix.edits for new in _bound(doc, problem.where, e)]
    fix = problem.fix.with_edits(edits)
    if not _in_order(doc, edits):  # the lines of its text would change other axes than the edit
        return dc.replace(problem, fix=joined(problem.fix.advice, problem.fix.otherwise))
    refused = _refused(doc, edits)
    if refused:
        return dc.replace(problem, fix=_text(fix, f"First change {refused[0]}"))
    return dc.replace(problem, fix=fix)


def _text(fix: EditFix, reason: str) -> Fix:
    """Return the text of a fix, without its edits, and what has to be done before."""
    return Fix(fix, fix.shell, fix.page).then(reason)


def _also_driven(doc: Document, edits: Sequence[ProposedEdit]) -> str:
    """Return what separates an edit from a document parameter that drives more than the edit sets; "" if none
    does.
    """
    idents = {e.path: e.id for e in doc.entries} if doc.parameters else {}
    new = {
        (idents.get(e.element or "", ""), path): setting
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
        together, each = apply(doc, axes), doc
        for e in axes:
            each = change_axis(each, e.axis, dict(e.values))
    except UnknownName:
        return False
    except DeodarError:  # an element refuses an axis, which the fix states
        return True
    return [e.element for e in each.entries] == [e.element for e in together.entries]


def _refused(doc: Document, edits: Sequence[ProposedEdit]) -> Sequence[Problem]:
    """Return why edits cannot be made, or what prevents a run after them."""
    try:
        new = apply(doc, edits)
    except DeodarError as error:
        return error.problems
    # another axis may not fit arrays and connections
    return graph(new).problems if any(isinstance(e, SetAxis) for e in edits) else ()


def _bound(doc: Document, where: str, proposed: ProposedEdit) -> Iterator[ProposedEdit]:
    if not isinstance(proposed, SetValues):
        yield proposed
        return
    proposed = proposed.inside(where)
    idents = [e.id for e in doc.entries if e.path == proposed.element]
    links = {leaf: name for (ident, leaf), name in doc.links().items() if ident in idents}
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
            case SetStep():
                doc = edit.describe(doc, dt=proposed.dt)
            case Disconnect():
                source, source_port = find.port(doc, proposed.source)
                target, target_port = find.port(doc, proposed.target, "")
                target_port = target_port or target.element.ports()[0]
                doc = edit.disconnect(doc, source.id, source_port, target.id, target_port)
            case _:
                raise TypeError(f"{type(proposed).__name__} is no edit of a document")
    return doc


def change_axis(doc: Document, key: str, values: dict[str, object]) -> Document:
    """Return a document in which an axis has other values, in every element that has it.

    Raises:
        UnknownName: the document has no axis of this key.
    """
    return edit.replace_axis(doc, *_new_axis(doc, key, values))


def _new_axis(doc: Document, key: str, values: dict[str, object]) -> tuple[Axis, Axis]:
    """Return the axis of a key, and the same axis with other values."""
    axes = document_files.axes(doc)
    if key not in axes:
        raise UnknownName(f"the document has no axis {key!r}", fix=did_you_mean(key, axes))
    old: Axis = axes[key]
    return old, dc.replace(old, **values)  # type: ignore[arg-type]
