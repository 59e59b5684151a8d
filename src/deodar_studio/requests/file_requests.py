"""Requests about files: documents are opened, saved and recovered, and snapshots and presets."""

from __future__ import annotations

import asyncio
from typing import Literal

from deodar.cli import doctor
from deodar.model import document_files
from deodar.model.document import Document
from deodar_studio.catalogue import gallery
from deodar_studio.files.content import read_package
from deodar_studio.files.file_thread import in_file_thread
from deodar_studio.files.unpacked import unpacked
from deodar_studio.messages.to_page import Answer, Folder
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.project.open_project import UNTITLED
from deodar_studio.requests.request import Text, answer, asks, changes, opens


@opens()
async def open_file(
    hub: Hub, page: Page, *, path: Text, discard: bool = False, discard_experiment: bool = False
) -> Answer:
    """Open a document, a record, an experiment or a package below the root.

    `discard` allows unsaved edits of the document to be lost, `discard_experiment` those of the experiment.
    The `text` of the answer is a sentence on the package that was opened.
    """
    place = hub.workspace.inside(path)
    inner, sentence = await in_file_thread(lambda: unpacked(place, hub.project.trust), path)
    return answer(imported=await hub.open(inner, discard, discard_experiment), text=sentence)


@opens(tag="new")
async def new_document(hub: Hub, page: Page, *, discard: bool = False) -> None:
    """Open an empty document without a file."""
    await hub.project.open_copy(lambda: Document(UNTITLED), UNTITLED, discard)


@opens()
async def open_example(hub: Hub, page: Page, *, name: Text, discard: bool = False) -> None:
    """Open an example, as a document without a file."""
    path = gallery.example_file(name)
    await hub.project.open_copy(lambda: document_files.load(path), name, discard)


@opens()
async def open_package(hub: Hub, page: Page, *, name: Text, content: str, discard: bool = False) -> None:
    """Open a package (`NAME.deodar`) that was dropped on the page, as a document without a file.

    `content` is base64.
    """
    await hub.project.open_copy(lambda: read_package(content, name), name, discard)


@opens()
async def open_text(hub: Hub, page: Page, *, name: Text, text: str, discard: bool = False) -> Answer:
    """Open the text of a file that was dropped on the page, as a document without a file."""
    return answer(imported=await hub.project.open_text(text, name, discard))


@opens()
async def recover(
    hub: Hub, page: Page, *, name: Text, discard: bool = False, discard_experiment: bool = False
) -> None:
    """Open stored unsaved edits of a document, or of an experiment with its model.

    `discard` allows unsaved edits of the document to be lost, `discard_experiment` those of the experiment.
    """
    if await in_file_thread(lambda: hub.store.experiment(name), name) is None:
        await hub.project.recover(name, discard)
    else:
        await hub.experiment.recover(name, discard, discard_experiment)
        await hub.experiment.check()


@asks()
async def forget(hub: Hub, page: Page, *, name: Text) -> None:
    """Delete stored unsaved edits."""
    await in_file_thread(lambda: hub.store.forget(name), name)
    hub.project.history.touch()


@changes()
async def close(hub: Hub, page: Page, *, discard: bool = False) -> None:
    """Close the document and show the gallery."""
    await hub.project.close(discard)


@changes()
async def save(hub: Hub, page: Page, *, path: Text = "", replace: bool = False) -> Answer:
    """Write the document to `path`, or to its own file if `path` is empty.

    `replace` allows another file, or a file that changed on disk since it was read, to be overwritten.
    """
    return answer(file=hub.workspace.shown(await hub.project.save(path, replace)))


@asks()
async def list_folder(hub: Hub, page: Page, *, path: Text = "") -> Folder:
    """List the documents and folders in a folder below the root; a `folder` message follows."""
    return await in_file_thread(lambda: hub.workspace.listed(path), path)


@asks()
async def fault_report(hub: Hub, page: Page) -> Answer:
    """Return the text of `deodar doctor --report` as the `text` of the answer."""
    return answer(text=await asyncio.to_thread(doctor.report))


@asks()
async def list_saved(hub: Hub, page: Page) -> None:
    """List snapshots and presets again; a `saved_files` message follows if the list changed."""
    await hub.project.list_saved()


@changes()
async def save_snapshot(hub: Hub, page: Page, *, name: Text) -> Answer:
    """Save the present state of the run as a snapshot under a new name."""
    return answer(file=hub.workspace.shown(await hub.project.save_snapshot(name)))


@changes()
async def return_to(hub: Hub, page: Page, *, name: Text) -> None:
    """Return to a snapshot: states, time, noise, world and parameters; the run pauses."""
    await hub.project.return_to(name)
    page.seek(None)


@changes()
async def save_preset(hub: Hub, page: Page, *, name: Text) -> Answer:
    """Save the present values of the parameters as a preset under a new name."""
    doc = hub.project.history.require_edited().document
    return answer(file=hub.workspace.shown(await hub.project.file.save_preset(doc, name)))


@changes()
async def remove_saved(hub: Hub, page: Page, *, sort: Literal["snapshot", "preset"], name: Text) -> None:
    """Delete a snapshot or a preset."""
    title = hub.project.history.require_edited().name
    await hub.project.file.remove_saved(title, sort, name)
