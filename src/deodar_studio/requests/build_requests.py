"""Handlers of requests that build a document: new elements, connections, groups, copies."""

from __future__ import annotations

import asyncio
import dataclasses as dc
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from deodar.errors import DeodarError, DocumentError, UnknownName, did_you_mean
from deodar.importers import stored_report
from deodar.model import building, clipboard, document_files, edit, fits, plain_values, script
from deodar.model.building import Around, BoxPosition, EndPorts
from deodar.model.document import Document
from deodar.model.paths import PathNames
from deodar_studio.catalogue import templates
from deodar_studio.messages import to_server
from deodar_studio.messages.to_page import Answer, Fits
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.handlers import handles
from deodar_studio.views import view

T = TypeVar("T")


def _ends(given: to_server.Ends | to_server.Connect | to_server.Disconnect) -> EndPorts:
    return (given.source, given.source_port, given.target, given.target_port)


def _port(given: to_server.PortEnd | None) -> building.ElementPort | None:
    return None if given is None else (given.element, given.port)


def _groups(given: list[list[str]]) -> list[PathNames]:
    return [tuple(g) for g in given]


async def _changed(hub: Hub, how: Callable[[Document], tuple[Document, T]]) -> T:
    """Change the document by a function that also returns a result, and return the result."""
    found: list[T] = []

    def change(doc: Document) -> Document:
        new, result = how(doc)
        found.append(result)
        return new

    await hub.project.history.change(change)
    return found[0]


@handles(to_server.NewDocument)
async def _new(hub: Hub, page: Page, m: to_server.NewDocument) -> None:
    await hub.project.open_copy(lambda: Document("untitled"), "untitled", m.discard)


@handles(to_server.AddElement)
async def _add_element(hub: Hub, page: Page, m: to_server.AddElement) -> Answer:
    wire, replaces = (None if ends is None else _ends(ends) for ends in (m.wire, m.replaces))
    around = Around(_port(m.source), _port(m.target), wire, replaces)
    values = hub.embodiment.starting_values(m.kind, m.values)
    made = await _changed(
        hub, lambda doc: building.add(doc, m.kind, values, m.name, tuple(m.group), m.at, around)
    )
    return Answer(request=m.request, made=made)


@handles(to_server.InsertElement)
async def _insert(hub: Hub, page: Page, m: to_server.InsertElement) -> None:
    def change(doc: Document) -> Document:
        return building.placed(building.insert_element(doc, m.element, _ends(m.wire)), _of(doc, m.positions))

    await hub.project.history.change(change)


@handles(to_server.Connect)
async def _connect(hub: Hub, page: Page, m: to_server.Connect) -> None:
    await hub.project.history.change(lambda doc: building.connect(doc, _ends(m), m.reads))


@handles(to_server.Disconnect)
async def _disconnect(hub: Hub, page: Page, m: to_server.Disconnect) -> None:
    await hub.project.history.change(lambda doc: building.disconnect(doc, [_ends(m)]))


@handles(to_server.Reconnect)
async def _reconnect(hub: Hub, page: Page, m: to_server.Reconnect) -> None:
    await hub.project.history.change(lambda doc: building.reconnect(doc, _ends(m.old), _ends(m.new)))


@handles(to_server.RemoveElements)
async def _remove(hub: Hub, page: Page, m: to_server.RemoveElements) -> None:
    wires = [_ends(c) for c in m.connections]
    await hub.project.history.change(lambda doc: building.remove(doc, m.elements, _groups(m.groups), wires))


@handles(to_server.Rename)
async def _rename(hub: Hub, page: Page, m: to_server.Rename) -> None:
    if m.element:
        await hub.project.history.change(lambda doc: building.rename(doc, m.element, m.name))
    else:
        await hub.project.history.change(lambda doc: building.rename_group(doc, tuple(m.group), m.name))


@handles(to_server.MoveInto)
async def _move_into(hub: Hub, page: Page, m: to_server.MoveInto) -> None:
    def change(doc: Document) -> Document:
        moved = building.move_into(doc, m.elements, _groups(m.groups), tuple(m.group))
        return building.placed(moved, _of(doc, m.positions))

    await hub.project.history.change(change)


@handles(to_server.MakeGroup)
async def _group(hub: Hub, page: Page, m: to_server.MakeGroup) -> Answer:
    path = await _changed(hub, lambda doc: building.group(doc, m.elements, _groups(m.groups), m.name, m.at))
    return Answer(request=m.request, group=list(path))


@handles(to_server.Ungroup)
async def _ungroup(hub: Hub, page: Page, m: to_server.Ungroup) -> None:
    await hub.project.history.change(lambda doc: building.ungroup(doc, tuple(m.group)))


@handles(to_server.CopyElements)
async def _copy(hub: Hub, page: Page, m: to_server.CopyElements) -> Answer:
    doc = hub.project.history.document()
    text = await asyncio.to_thread(
        lambda: clipboard.text(building.excerpt(doc, m.elements, _groups(m.groups)))
    )
    return Answer(request=m.request, text=text)


@handles(to_server.ExportScript)
async def _export_script(hub: Hub, page: Page, m: to_server.ExportScript) -> Answer:
    # a script says how the model is built, not what was imported
    doc, path = stored_report.without_report(hub.project.history.document()), hub.project.file.path
    written = await asyncio.to_thread(script.script, doc, "" if path is None else path.name)
    return Answer(request=m.request, text=written)


@handles(to_server.Paste)
async def _paste(hub: Hub, page: Page, m: to_server.Paste) -> Answer:
    try:
        read = await asyncio.to_thread(clipboard.read, m.text)
    except DeodarError as error:
        first, *more = error.problems
        what = f"the clipboard holds no elements that can be pasted: {first.what}"
        raise DocumentError(
            what + (f" (and {len(more)} more problems)" if more else ""), first.where, first.fix
        ) from None
    # functions that the text names run only where the studio was started with trust, as those of a file
    template = dc.replace(read, foreign=not hub.project.trust)
    made = await _changed(hub, lambda doc: building.paste(doc, template, tuple(m.group), m.at))
    return Answer(request=m.request, made=made)


@handles(to_server.SetMany)
async def _set_many(hub: Hub, page: Page, m: to_server.SetMany) -> Answer:
    ids = list(dict.fromkeys(m.elements))
    gesture = (page.number, m.gesture) if m.gesture else None
    cost = await hub.project.history.change(
        lambda doc: plain_values.put(doc, ids, m.parameter, m.value), gesture
    )
    return Answer(request=m.request, cost=cost)


@handles(to_server.ChangeAxis)
async def _change_axis(hub: Hub, page: Page, m: to_server.ChangeAxis) -> Answer:
    def change(doc: Document) -> Document:
        known = document_files.axes(doc)
        if m.key not in known:
            raise UnknownName(f"the document has no axis {m.key!r}", fix=did_you_mean(m.key, known))
        return edit.replace_axis(doc, known[m.key], plain_values.axis(m.axis))

    return Answer(request=m.request, cost=await hub.project.history.change(change))


@handles(to_server.AddTemplate)
async def _add_template(hub: Hub, page: Page, m: to_server.AddTemplate) -> Answer:
    template = await asyncio.to_thread(templates.document, m.name)
    group: list[str] = []

    def insert(doc: Document) -> tuple[Document, list[str]]:
        new, ids, path = building.insert(doc, template, m.name, tuple(m.group), m.at)
        group.extend(path)
        return new, ids

    made = await _changed(hub, insert)
    return Answer(request=m.request, made=made, group=group)


@handles(to_server.Comment)
async def _comment(hub: Hub, page: Page, m: to_server.Comment) -> Answer:
    values: dict[str, Any] = {} if m.text is None else {"text": m.text}
    values |= {} if m.at is None else {"x": m.at[0], "y": m.at[1]}
    values |= {} if m.size is None else {"width": m.size[0], "height": m.size[1]}
    found: list[str] = []

    def change(doc: Document) -> Document:
        new, ident = building.comment(doc, m.comment, None if m.remove else values)
        found.append(ident)
        return new

    await hub.project.history.lay_out(change)
    return Answer(request=m.request, made=[] if m.comment else found)


@handles(to_server.FindFits)
async def _find_fits(hub: Hub, page: Page, m: to_server.FindFits) -> Fits:
    doc = hub.project.history.document()
    ports, kinds = await asyncio.to_thread(fits.fits, doc, m.element, m.port)
    return view.fits(m, ports, kinds)


@handles(to_server.PlaceBoxes)
async def _place(hub: Hub, page: Page, m: to_server.PlaceBoxes) -> None:
    await hub.project.history.lay_out(lambda doc: building.placed(doc, _of(doc, m.positions)))


def _of(doc: Document, positions: Mapping[str, BoxPosition]) -> dict[str, BoxPosition]:
    """Return the positions of elements that exist: another page may have removed the others."""
    return {i: at for i, at in positions.items() if i in doc.by_id()}
