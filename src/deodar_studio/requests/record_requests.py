"""Handlers of requests about records: writing, comparing and continuing them, and figures."""

from __future__ import annotations

import asyncio

from deodar.errors import DocumentError, ModelError
from deodar.model import find
from deodar.model.paths import quote
from deodar.recording import places
from deodar.session.recorder import compile_records
from deodar_studio.files import figure_file
from deodar_studio.files.file_thread import in_file_thread
from deodar_studio.messages import to_server
from deodar_studio.messages.to_page import Answer
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.handlers import handles


@handles(to_server.OpenRecordModel)
async def _open_record_model(hub: Hub, page: Page, m: to_server.OpenRecordModel) -> None:
    await hub.project.open_record_model(m.discard)


@handles(to_server.CompareRecord)
async def _compare_record(hub: Hub, page: Page, m: to_server.CompareRecord) -> None:
    await hub.project.record.compare(hub.workspace.inside(m.path), hub.from_thread)


@handles(to_server.EndComparison)
async def _end_comparison(hub: Hub, page: Page, m: to_server.EndComparison) -> None:
    hub.project.record.end_comparison()


@handles(to_server.ChooseCopy)
async def _choose_copy(hub: Hub, page: Page, m: to_server.ChooseCopy) -> None:
    hub.source(page)
    record = hub.project.record.reader
    if page.frames is None or record is None or m.dimension not in record.copies:
        raise DocumentError("the open record has no such dimension", where=m.dimension)
    page.frames.choose({m.dimension: m.index})
    others = hub.other_source(page)
    if others is not None:
        others.choose({m.dimension: m.index})
    page.wake()


@handles(to_server.StartRecord)
async def _start_record(hub: Hub, page: Page, m: to_server.StartRecord) -> None:
    hub.project.require_run()
    session = hub.engine.session
    if session is None:
        raise ModelError("no model runs yet", fix="Wait until it is compiled")
    by = session.document.by_id()
    ports = [(p.element, p.port) for p in m.ports if p.element in by]
    if not ports:
        ports = [(e.id, "activation") for e in by.values() if "activation" in find.outputs(e)]
    if not ports:
        raise DocumentError("the model has no field to record", fix="Open the plot of an element first")
    ports = list(dict.fromkeys(ports))
    out = places.free(hub.workspace.root, session.document.name)
    # compiled here, so that the run does not wait for it
    await asyncio.to_thread(compile_records, session.program, ports)
    paths = [f"{by[ident].path}.{quote(port)}" for ident, port in ports]
    await hub.in_engine(lambda: hub.engine.record(out, paths, m.every))


@handles(to_server.StopRecord)
async def _stop_record(hub: Hub, page: Page, m: to_server.StopRecord) -> None:
    await hub.in_engine(hub.engine.stop_record)


@handles(to_server.SaveFigure)
async def _save_figure(hub: Hub, page: Page, m: to_server.SaveFigure) -> Answer:
    engine, opened = hub.engine, hub.project.record.reader
    session = engine.session
    if opened is not None:
        record, document = opened.path, opened.document
    elif session is not None:
        recorder = session.recorder
        record, document = None if recorder is None else recorder.path, session.document
    else:
        raise ModelError("no model runs yet", fix="Wait until it is compiled")
    time = engine.published.time if page.moment is None else page.moment.time
    root = hub.workspace.root
    path = await in_file_thread(lambda: figure_file.save(m, document, record, time, root), str(root))
    return Answer(request=m.request, file=hub.workspace.shown(path))


@handles(to_server.RunRecordFrom)
async def _run_record_from(hub: Hub, page: Page, m: to_server.RunRecordFrom) -> None:
    await hub.project.run_record_from(m.time)
    page.seek(None)
