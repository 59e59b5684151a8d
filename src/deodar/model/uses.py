"""Groups that stay linked to a template: `refresh` applies a change of the template to every use."""

from __future__ import annotations

import dataclasses as dc

from deodar.errors import ModelError, Problem, UnknownName, did_you_mean
from deodar.leaves import leaves
from deodar.model import edit, find
from deodar.model.document import Connection, Document, Use
from deodar.model.paths import display


def refresh(doc: Document, template: Document) -> Document:
    """Return a document in which every use of a template of this name has its present content."""
    linked = [u.group for u in doc.uses if u.template == template.name]
    if not linked:
        templates = [u.template for u in doc.uses]
        raise UnknownName(
            f"no group is linked to a template {template.name!r}",
            fix=did_you_mean(template.name, templates) or "Link one: model.insert(template, name, link=True)",
        )
    for group in linked:
        doc = _refreshed(
            doc, next(u for u in doc.uses if u.group == group and u.template == template.name), template
        )
    return dc.replace(doc, foreign=doc.foreign or template.asks())


def _refreshed(doc: Document, use: Use, template: Document) -> Document:
    _require_ends(doc, use, template)
    doc, ids = _with_elements(_emptied(doc, use, template), use, template)
    inside = tuple(dc.replace(c, source=ids[c.source], target=ids[c.target]) for c in template.connections)
    doc = _driven(dc.replace(doc, connections=(*doc.connections, *inside)), template, ids)
    nested = [
        Use(use.group + u.group, u.template, tuple((t, ids[i]) for t, i in u.elements)) for u in template.uses
    ]
    doc = dc.replace(doc, uses=(*doc.uses, *nested, Use(use.group, use.template, tuple(ids.items()))))
    for g in template.groups:
        doc = edit.group(doc, use.group + g)
    return doc


def _emptied(doc: Document, use: Use, template: Document) -> Document:
    """Return a document without the elements of a use that its template lacks, and without the connections,
    links to parameters of the template, and uses among the others.
    """
    mine = {ident for _, ident in use.elements}
    doc = edit.remove(doc, [ident for original, ident in use.elements if original not in template.by_id()])
    driving = {k.name for k in template.parameters}
    return dc.replace(
        doc,
        connections=tuple(c for c in doc.connections if not (c.source in mine and c.target in mine)),
        parameters=tuple(
            dc.replace(k, links=tuple(x for x in k.links if x[0] not in mine)) if k.name in driving else k
            for k in doc.parameters
        ),
        uses=tuple(
            u
            for u in doc.uses
            if u.group[: len(use.group)] != use.group or not mine >= {i for _, i in u.elements}
        ),
    )


def _with_elements(doc: Document, use: Use, template: Document) -> tuple[Document, dict[str, str]]:
    """Return a document in which a use has the elements of its template, and their ids by those of the
    template.
    """
    existing = dict(use.elements)
    # elements renamed in the template move to free names first, so that two names can be exchanged
    names = {existing[e.id]: use.group + e.names for e in template.entries if e.id in existing}
    for k, (ident, place) in enumerate(names.items()):
        if doc.by_id()[ident].names != place:
            doc = edit.move(doc, ident, (*use.group, f"\0{k}"))
    ids: dict[str, str] = {}
    for e in template.entries:
        place = use.group + e.names
        element = dc.replace(e.element, name=place[-1])
        if e.id in existing:
            doc = edit.move(doc, existing[e.id], place)
            entry = dc.replace(doc.by_id()[existing[e.id]], element=element, every=e.every)
            doc = dc.replace(doc, entries=tuple(entry if o.id == entry.id else o for o in doc.entries))
        else:
            doc, entry = edit.add(doc, element, place[:-1], e.every)
        ids[e.id] = entry.id
    return doc, ids


def _driven(doc: Document, template: Document, ids: dict[str, str]) -> Document:
    """Return the template's document parameters with the values of this document, and the other links to
    parameters of the new elements.
    """
    for (i, leaf), name in doc.links().items():
        if i in ids.values():
            if leaf not in [path for path, _, _ in leaves(doc.by_id()[i].element)]:
                doc = edit.unlink(doc, i, leaf)
            else:
                doc = edit.document_parameter(
                    doc, name, next(k.value for k in doc.parameters if k.name == name)
                )
    for k in template.parameters:
        if k.links and k.name not in [j.name for j in doc.parameters]:
            doc = edit.document_parameter(doc, k.name, k.value)
        for i, leaf in k.links:
            if (ids[i], leaf) not in doc.links():
                doc = edit.link(doc, ids[i], leaf, k.name)
    return doc


def _require_ends(doc: Document, use: Use, template: Document) -> None:
    """Refuse a template that lacks an element or port of a connection across the border of the group."""
    originals, by = {here: template.by_id().get(t) for t, here in use.elements}, doc.by_id()
    problems: list[Problem] = []

    def show(c: Connection) -> str:
        return f"{by[c.source].path}.{c.source_port} -> {by[c.target].path}.{c.target_port}"

    for c in doc.connections:
        for end, port, far_end in ((c.source, c.source_port, c.target), (c.target, c.target_port, c.source)):
            if end in originals and far_end not in originals:
                entry = originals[end]
                ports = (
                    () if entry is None else find.outputs(entry) if end == c.source else entry.element.ports()
                )
                if port not in ports:
                    missing = by[end].names[len(use.group) :] if entry is None else (*entry.names, port)
                    problems.append(
                        Problem(
                            show(c),
                            f"the template {use.template!r} no longer has {display(missing)!r}",
                            "Disconnect them first",
                        )
                    )
    if problems:
        raise ModelError(problems)
