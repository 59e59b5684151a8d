"""Handlers of requests about files: documents are opened, saved and recovered, and snapshots and presets."""

from __future__ import annotations

from pathlib import Path

from deodar.model import document_files
from deodar_studio.catalogue import gallery
from deodar_studio.files import content
from deodar_studio.files.file_thread import in_file_thread
from deodar_studio.messages import to_server
from deodar_studio.messages.to_page import Answer, Folder
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.handlers import handles


@handles(to_server.OpenFile)
async def _open_file(hub: Hub, page: Page, m: to_server.OpenFile) -> Answer:
    place = hub.workspace.inside(m.path)
    if await in_file_thread(lambda: content.is_experiment(hub.workspace, place), m.path):
        await hub.experiment.open(place, m.discard, m.discard_experiment)
        await hub.experiment.check()
        return Answer(request=m.request)
    imported = await hub.project.open_file(place, m.discard)
    return Answer(request=m.request, imported=imported)


@handles(to_server.OpenExample)
async def _open_example(hub: Hub, page: Page, m: to_server.OpenExample) -> None:
    path = gallery.example_file(m.name)
    await hub.project.open_copy(lambda: document_files.load(path), m.name, m.discard)


@handles(to_server.OpenPackage)
async def _open_package(hub: Hub, page: Page, m: to_server.OpenPackage) -> None:
    await hub.project.open_copy(lambda: content.read_package(m.content, m.name), m.name, m.discard)


@handles(to_server.OpenText)
async def _open_text(hub: Hub, page: Page, m: to_server.OpenText) -> Answer:
    imported = await hub.project.open_text(m.text, m.name, m.discard)
    return Answer(request=m.request, imported=imported)


@handles(to_server.Recover)
async def _recover(hub: Hub, page: Page, m: to_server.Recover) -> None:
    stored = await in_file_thread(lambda: hub.store.experiment(m.name), m.name)
    if stored is None:
        await hub.project.recover(m.name, m.discard)
    else:
        await hub.experiment.recover(m.name, m.discard, m.discard_experiment)
        await hub.experiment.check()


@handles(to_server.Forget)
async def _forget(hub: Hub, page: Page, m: to_server.Forget) -> None:
    await in_file_thread(lambda: hub.store.forget(m.name), m.name)
    hub.project.history.touch()


@handles(to_server.Close)
async def _close(hub: Hub, page: Page, m: to_server.Close) -> None:
    await hub.project.close(m.discard)


@handles(to_server.Save)
async def _save(hub: Hub, page: Page, m: to_server.Save) -> Answer:
    path: Path = await hub.project.save(m.path, m.replace)
    return Answer(request=m.request, file=hub.workspace.shown(path))


@handles(to_server.ListFolder)
async def _list_folder(hub: Hub, page: Page, m: to_server.ListFolder) -> Folder:
    return await in_file_thread(lambda: hub.workspace.listed(m.request, m.path), m.path)


@handles(to_server.ListSaved)
async def _list_saved(hub: Hub, page: Page, m: to_server.ListSaved) -> None:
    await hub.project.list_saved()


@handles(to_server.SaveSnapshot)
async def _save_snapshot(hub: Hub, page: Page, m: to_server.SaveSnapshot) -> Answer:
    path = await hub.project.save_snapshot(m.name)
    return Answer(request=m.request, file=hub.workspace.shown(path))


@handles(to_server.ReturnTo)
async def _return_to(hub: Hub, page: Page, m: to_server.ReturnTo) -> None:
    await hub.project.return_to(m.name)
    page.seek(None)


@handles(to_server.SavePreset)
async def _save_preset(hub: Hub, page: Page, m: to_server.SavePreset) -> Answer:
    doc = hub.project.history.require_edited().document
    path = await hub.project.file.save_preset(doc, m.name)
    return Answer(request=m.request, file=hub.workspace.shown(path))


@handles(to_server.RemoveSaved)
async def _remove_saved(hub: Hub, page: Page, m: to_server.RemoveSaved) -> None:
    title = hub.project.history.require_edited().name
    await hub.project.file.remove_saved(title, m.sort, m.name)
