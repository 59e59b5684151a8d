"""Requests that change values, the layout and the history of the document."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from deodar.errors import ParameterError
from deodar.importers import presets
from deodar.importers.report import Line
from deodar.model import building, edit, find
from deodar.model.document import Document
from deodar.model.kept_presets import kept_preset
from deodar.model.usual_pins import with_usual_pins
from deodar_studio.files import content
from deodar_studio.files.file_thread import in_file_thread
from deodar_studio.messages.message import Id
from deodar_studio.messages.to_page import Answer
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.request import Count, Text, answer, changes, edits


@changes(tag="set")
async def set_parameter(
    hub: Hub, page: Page, *, element: Id, parameter: Text, value: Any, gesture: Count = 0
) -> Answer:
    """Change a parameter of an element (`kernel.0.sigma`), or the document parameter if `element` is empty.

    `value` has the format of documents: numbers, text, parts with their kind, axes by their key. Changes with
    the same `gesture` (not 0) are one step of undo, such as the drag of a slider.
    """
    drag = (page.number, gesture) if gesture else None
    return answer(cost=await hub.project.history.set(element, parameter, value, drag))


@changes()
async def describe(
    hub: Hub,
    page: Page,
    *,
    name: Text | None = None,
    notes: str | None = None,
    dt: float | None = None,
    time_unit: Text | None = None,
) -> None:
    """Change general properties of the document; None leaves a property unchanged."""
    properties = {"name": name, "notes": notes, "dt": dt, "time_unit": time_unit}
    await hub.project.history.describe({key: value for key, value in properties.items() if value is not None})


@changes()
async def repair(hub: Hub, page: Page, *, where: Text, what: Text) -> Answer:
    """Do what the `repair` of a listed problem says, as one step of undo."""
    return answer(cost=await hub.project.history.repair(where, what))


@edits()
def open_without_functions(doc: Document) -> Document:
    """Remove the elements that run functions which the file names, as one step of undo."""
    return building.remove(doc, [e.id for e in doc.entries if e.element.external_code()])


@edits()
def add_document_parameter(doc: Document, *, name: Text, element: Id, parameter: Text) -> Document:
    """Add a document parameter with the value of the first parameter that it sets."""
    if name in [k.name for k in doc.parameters]:
        raise ParameterError("there is already a document parameter of that name", where=name)
    added = edit.document_parameter(doc, name, find.number(doc, element, parameter))
    return edit.link(added, element, parameter, name)


@edits()
def link(doc: Document, *, name: Text, element: Id, parameter: Text) -> Document:
    """Link a parameter of an element to a document parameter."""
    return edit.link(doc, element, parameter, name)


@edits()
def unlink(doc: Document, *, element: Id, parameter: Text) -> Document:
    """Unlink a parameter of an element from its document parameter."""
    return edit.unlink(doc, element, parameter)


@edits()
def remove_document_parameter(doc: Document, *, name: Text) -> Document:
    """Remove a document parameter; the parameters that it set keep their values."""
    return edit.remove_document_parameter(doc, name)


@changes()
async def arrange(hub: Hub, page: Page, *, layout: dict[str, Any], undoable: bool = True) -> None:
    """Change parts of the layout: each key replaces that key of `LayoutView`, None removes it.

    What later versions and other programs store beside it stays in the document.
    """
    await hub.project.history.arrange(layout, undoable)


@edits()
def pin_usual(doc: Document) -> Document:
    """Pin up to five parameters that are tuned most, chosen by what they are for."""
    return with_usual_pins(doc)


@changes()
async def apply_preset(hub: Hub, page: Page, *, path: Text) -> Answer:
    """Apply the values of another file below the root, by names and kinds, as one step of undo.

    Connections stay. The answer lists the values that did not match.
    """
    place = hub.workspace.inside(path)
    preset = await in_file_thread(lambda: content.load(hub.workspace, place), path)
    return await _take_over(hub, lambda doc: presets.applied(doc, preset))


@changes()
async def apply_kept_preset(hub: Hub, page: Page, *, name: Text) -> Answer:
    """Apply a preset that the document keeps in its layout, as one step of undo.

    The answer lists the values that could not be applied.
    """
    return await _take_over(hub, lambda doc: presets.kept(doc, kept_preset(doc, name)))


@changes()
async def apply_preset_text(hub: Hub, page: Page, *, name: Text, text: str) -> Answer:
    """Apply the values of a file as `apply_preset` does, given its text."""
    preset = await asyncio.to_thread(content.read, text, name)
    return await _take_over(hub, lambda doc: presets.applied(doc, preset))


async def _take_over(hub: Hub, take: Callable[[Document], tuple[Document, list[Line]]]) -> Answer:
    """Apply the values of a preset to the open document."""
    lines: list[Line] = []

    def change(doc: Document) -> Document:
        new, unfit = take(doc)
        lines.extend(unfit)
        return new

    cost = await hub.project.history.change(change)
    unmatched = [str(line) for line in lines if line.verdict == "dropped"]
    return answer(cost=cost, carried=len(lines) - len(unmatched), unmatched=unmatched)


@changes()
async def undo(hub: Hub, page: Page) -> None:
    """Undo the last change."""
    await hub.project.history.undo()


@changes()
async def redo(hub: Hub, page: Page) -> None:
    """Redo the change that was undone last."""
    await hub.project.history.redo()
