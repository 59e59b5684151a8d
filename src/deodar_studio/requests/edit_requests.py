"""Handlers of requests that change values, the layout and the history of the document."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from deodar.errors import ParameterError
from deodar.importers import presets
from deodar.importers.report import Line
from deodar.model import edit, find
from deodar.model.kept_presets import kept_preset
from deodar_studio.files import content
from deodar_studio.files.file_thread import in_file_thread
from deodar_studio.messages import to_server
from deodar_studio.messages.to_page import Answer
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.handlers import handles


@handles(to_server.SetParameter)
async def _set(hub: Hub, page: Page, m: to_server.SetParameter) -> Answer:
    gesture = (page.number, m.gesture) if m.gesture else None
    cost = await hub.project.history.set(m.element, m.parameter, m.value, gesture)
    return Answer(request=m.request, cost=cost)


@handles(to_server.Describe)
async def _describe(hub: Hub, page: Page, m: to_server.Describe) -> None:
    given = {key: value for key in ("name", "notes", "dt") if (value := getattr(m, key)) is not None}
    await hub.project.history.describe(given)


@handles(to_server.AddDocumentParameter)
async def _add_document_parameter(hub: Hub, page: Page, m: to_server.AddDocumentParameter) -> None:
    def change(doc: edit.Document) -> edit.Document:
        if m.name in [k.name for k in doc.parameters]:
            raise ParameterError("there is already a document parameter of that name", where=m.name)
        return edit.link(
            edit.document_parameter(doc, m.name, find.number(doc, m.element, m.parameter)),
            m.element,
            m.parameter,
            m.name,
        )

    await hub.project.history.change(change)


@handles(to_server.Link)
async def _link(hub: Hub, page: Page, m: to_server.Link) -> None:
    await hub.project.history.change(lambda doc: edit.link(doc, m.element, m.parameter, m.name))


@handles(to_server.Unlink)
async def _unlink(hub: Hub, page: Page, m: to_server.Unlink) -> None:
    await hub.project.history.change(lambda doc: edit.unlink(doc, m.element, m.parameter))


@handles(to_server.RemoveDocumentParameter)
async def _remove_document_parameter(hub: Hub, page: Page, m: to_server.RemoveDocumentParameter) -> None:
    await hub.project.history.change(lambda doc: edit.remove_document_parameter(doc, m.name))


@handles(to_server.Arrange)
async def _arrange(hub: Hub, page: Page, m: to_server.Arrange) -> None:
    await hub.project.history.arrange(m.layout, m.undoable)


@handles(to_server.ApplyPreset)
async def _apply_preset(hub: Hub, page: Page, m: to_server.ApplyPreset) -> Answer:
    place = hub.workspace.inside(m.path)
    preset = await in_file_thread(lambda: content.load(hub.workspace, place), m.path)
    return await _take_over(hub, m.request, lambda doc: presets.applied(doc, preset))


@handles(to_server.ApplyKeptPreset)
async def _apply_kept_preset(hub: Hub, page: Page, m: to_server.ApplyKeptPreset) -> Answer:
    return await _take_over(hub, m.request, lambda doc: presets.kept(doc, kept_preset(doc, m.name)))


@handles(to_server.ApplyPresetText)
async def _apply_preset_text(hub: Hub, page: Page, m: to_server.ApplyPresetText) -> Answer:
    preset = await asyncio.to_thread(content.read, m.text, m.name)
    return await _take_over(hub, m.request, lambda doc: presets.applied(doc, preset))


async def _take_over(
    hub: Hub, request: int, take: Callable[[edit.Document], tuple[edit.Document, list[Line]]]
) -> Answer:
    """Apply the values of a preset to the open document."""
    lines: list[Line] = []

    def change(doc: edit.Document) -> edit.Document:
        new, found = take(doc)
        lines.extend(found)
        return new

    cost = await hub.project.history.change(change)
    unmatched = [str(line) for line in lines if line.verdict == "dropped"]
    return Answer(request=request, cost=cost, carried=len(lines) - len(unmatched), unmatched=unmatched)


@handles(to_server.Undo)
async def _undo(hub: Hub, page: Page, m: to_server.Undo) -> None:
    await hub.project.history.undo()


@handles(to_server.Redo)
async def _redo(hub: Hub, page: Page, m: to_server.Redo) -> None:
    await hub.project.history.redo()
