"""Handlers of requests: one function for each message of `to_server`, registered by `handles`.

Those that build a document are in `build_requests`, those about an experiment in `experiment_requests`.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from deodar.credentials import masked
from deodar.errors import DocumentError, ModelError, ParameterError
from deodar.importers import presets
from deodar.importers.report import Line
from deodar.live.engine import Injection
from deodar.live.section import Section
from deodar.live.trace import TraceRequest
from deodar.model import edit, files, find
from deodar.model.kept_presets import kept_preset
from deodar.model.paths import quote
from deodar.numerics.axes import Axes
from deodar.recording import places
from deodar.server.catalogue import gallery
from deodar.server.files import content, figure_file
from deodar.server.files.file_thread import in_file_thread
from deodar.server.messages import to_server
from deodar.server.messages.to_page import Answer, Fits, Folder
from deodar.server.pages.hub import Hub
from deodar.server.pages.page import Page
from deodar.server.requests import build_requests as build_requests  # registers its handlers
from deodar.server.requests import experiment_requests as experiment_requests  # registers its handlers
from deodar.server.requests.handlers import HANDLERS, handles
from deodar.server.streams.kernel_stream import KernelStream
from deodar.server.streams.stream import Stream
from deodar.server.streams.weights_stream import WeightsStream
from deodar.server.world.embodiment import preview
from deodar.server.world.scene import SentBodies
from deodar.session.recorder import compile_records
from deodar.session.session import Session
from deodar.worlds._base import World

MOST_STREAMS = 2000
"""Largest number of streams of one page."""

Answers = list[Answer | Folder | Fits]


async def do(hub: Hub, page: Page, message: to_server.Request) -> Answers:
    """Handle a request, and return its answers; the last one ends the request.

    Requests that change the document are handled one after the other.
    """
    if isinstance(message, to_server.DocumentRequest):
        return await hub.project.queue.run(lambda: _change(hub, page, message), message.session)
    return await _done(hub, page, message)


async def _done(hub: Hub, page: Page, message: to_server.Request) -> Answers:
    done = await HANDLERS[type(message)](hub, page, message)
    if isinstance(done, (Folder, Fits)):
        return [done, Answer(request=message.request)]
    return [done or Answer(request=message.request)]


async def _change(hub: Hub, page: Page, message: to_server.DocumentRequest) -> Answers:
    answers = await _done(hub, page, message)
    version = hub.project.history.version
    return [msgspec.structs.replace(a, version=version) if isinstance(a, Answer) else a for a in answers]


# ------------------------------------------------------------------------------------------------------ files


@handles(to_server.OpenFile)
async def _open_file(hub: Hub, page: Page, m: to_server.OpenFile) -> Answer:
    place = hub.workspace.inside(m.path)
    if await in_file_thread(lambda: content.is_experiment(hub.workspace, place), m.path):
        await hub.experiment.open(place, m.discard, m.discard_experiment)
        await hub.experiment.check()
        return Answer(request=m.request)
    imported = await hub.project.open_file(place, m.discard)
    return Answer(request=m.request, imported=imported)


@handles(to_server.OpenRecordModel)
async def _open_record_model(hub: Hub, page: Page, m: to_server.OpenRecordModel) -> None:
    await hub.project.open_record_model(m.discard)


@handles(to_server.CompareRecord)
async def _compare_record(hub: Hub, page: Page, m: to_server.CompareRecord) -> None:
    await hub.project.record.compare(hub.workspace.inside(m.path), hub.from_thread)


@handles(to_server.EndComparison)
async def _end_comparison(hub: Hub, page: Page, m: to_server.EndComparison) -> None:
    hub.project.record.end_comparison()


@handles(to_server.OpenExample)
async def _open_example(hub: Hub, page: Page, m: to_server.OpenExample) -> None:
    path = gallery.example_file(m.name)
    await hub.project.open_copy(lambda: files.load(path), m.name, m.discard)


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


# ------------------------------------------------------------------------------------------------------ edits


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


# ---------------------------------------------------------------------------------------------------- running


async def _engine(hub: Hub, page: Page, function: Callable[[], Any]) -> None:
    await asyncio.wrap_future(hub.engine.call(function))


@handles(to_server.Play)
async def _play(hub: Hub, page: Page, m: to_server.Play) -> None:
    hub.project.require_run()
    page.seek(None)
    await _engine(hub, page, lambda: hub.engine.play(True))


@handles(to_server.Pause)
async def _pause(hub: Hub, page: Page, m: to_server.Pause) -> None:
    await _engine(hub, page, lambda: hub.engine.play(False))


@handles(to_server.Advance)
async def _step(hub: Hub, page: Page, m: to_server.Advance) -> None:
    hub.project.require_run()
    page.seek(None)
    await _engine(hub, page, lambda: hub.engine.step(m.n))


@handles(to_server.ResetRun)
async def _reset(hub: Hub, page: Page, m: to_server.ResetRun) -> None:
    page.seek(None)
    await _engine(hub, page, lambda: hub.engine.reset(m.seed))


@handles(to_server.Speed)
async def _speed(hub: Hub, page: Page, m: to_server.Speed) -> None:
    await _engine(hub, page, lambda: hub.engine.pace.go(m.factor))


@handles(to_server.Lengthen)
async def _lengthen(hub: Hub, page: Page, m: to_server.Lengthen) -> None:
    hub.project.require_run()
    await _engine(hub, page, lambda: hub.engine.lengthen(m.longest))


@handles(to_server.RunFrom)
async def _run_from(hub: Hub, page: Page, m: to_server.RunFrom) -> None:
    await hub.project.run_from(m.time)
    page.seek(None)


@handles(to_server.RunRecordFrom)
async def _run_record_from(hub: Hub, page: Page, m: to_server.RunRecordFrom) -> None:
    await hub.project.run_record_from(m.time)
    page.seek(None)


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


@handles(to_server.Seek)
async def _seek(hub: Hub, page: Page, m: to_server.Seek) -> None:
    page.seek(m.time)


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


@handles(to_server.SeekFrames)
async def _seek_frames(hub: Hub, page: Page, m: to_server.SeekFrames) -> None:
    page.seek_further(m.frames)


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
    await _engine(hub, page, lambda: hub.engine.record(out, paths, m.every))


@handles(to_server.StopRecord)
async def _stop_record(hub: Hub, page: Page, m: to_server.StopRecord) -> None:
    await _engine(hub, page, hub.engine.stop_record)


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


@handles(to_server.MeasureCosts)
async def _measure_costs(hub: Hub, page: Page, m: to_server.MeasureCosts) -> None:
    hub.project.require_run()
    await _engine(hub, page, hub.engine.measure)


@handles(to_server.MeasureRegime)
async def _measure_regime(hub: Hub, page: Page, m: to_server.MeasureRegime) -> None:
    hub.measure_regime(m.element)


@handles(to_server.StopRegime)
async def _stop_regime(hub: Hub, page: Page, m: to_server.StopRegime) -> None:
    hub.measurement.stop()


@handles(to_server.TuneField)
async def _tune_field(hub: Hub, page: Page, m: to_server.TuneField) -> None:
    hub.tune_field(m.element, m.parameters, m.requirements)


@handles(to_server.StopTuning)
async def _stop_tuning(hub: Hub, page: Page, m: to_server.StopTuning) -> None:
    hub.field_tuning.stop()


@handles(to_server.ApplyTuning)
async def _apply_tuning(hub: Hub, page: Page, m: to_server.ApplyTuning) -> Answer:
    return Answer(request=m.request, cost=await hub.project.history.change(hub.field_tuning.applied))


@handles(to_server.PushInput)
async def _push(hub: Hub, page: Page, m: to_server.PushInput) -> None:
    engine = hub.engine
    session = engine.session
    entry = None if session is None else session.document.by_id().get(m.element)
    if session is None or entry is None:
        raise DocumentError("the running model has no such element", where=m.element)
    session.require_injection(m.element)
    injection = Injection(
        m.element, _blob(session.program.axes(session.program.port(m.element, entry.element.ports()[0])), m)
    )
    page.pushes = True
    await _engine(hub, page, lambda: engine.inject(injection))


@handles(to_server.Release)
async def _release(hub: Hub, page: Page, m: to_server.Release) -> None:
    page.pushes = False
    await _engine(hub, page, lambda: hub.engine.inject(None))


def _blob(axes: Axes, m: to_server.PushInput) -> np.ndarray:
    """Sample the input of a push over axes: a Gaussian, or a constant."""
    if not math.isfinite(m.amplitude):
        raise ParameterError("needs a finite number", where="amplitude")
    out = np.asarray(m.amplitude, float)
    for i, axis in enumerate(axes):
        bump = np.ones(axis.samples)
        if m.center is not None and i < len(m.center):
            sigma = m.sigma[i] if m.sigma is not None and i < len(m.sigma) else 0.05 * axis.range
            distance = axis.points - m.center[i]
            distance = distance - axis.range * np.round(distance / axis.range) if axis.periodic else distance
            bump = np.exp(-0.5 * (distance / max(abs(sigma), 1e-9)) ** 2)
        out = out[..., None] * bump
    return out


@handles(to_server.UseWorld)
async def _use_world(hub: Hub, page: Page, m: to_server.UseWorld) -> None:
    world = await in_file_thread(lambda: _world(hub, m), masked(m.path))
    await hub.project.embody(world, m.kind, m.path)


@handles(to_server.PreviewWorld)
async def _preview_world(hub: Hub, page: Page, m: to_server.PreviewWorld) -> Answer:
    model = hub.project.history.model
    doc = None if model is None else model.document
    shown = await in_file_thread(lambda: preview(_world(hub, m), doc), masked(m.path))
    return Answer(request=m.request, preview=shown)


def _world(hub: Hub, m: to_server.UseWorld | to_server.PreviewWorld) -> World:
    """Open a world with a file below the root, a name that it knows, or another text."""
    cls = hub.embodiment.kind(m.kind)
    if not cls.opens or m.path in cls.names():
        return hub.embodiment.open(m.kind, m.path, m.path, m.settings)
    place = hub.workspace.inside(m.path)
    hub.workspace.require_file(place)
    return hub.embodiment.open(m.kind, str(place), m.path, m.settings)


@handles(to_server.UseWorldContent)
async def _use_world_content(hub: Hub, page: Page, m: to_server.UseWorldContent) -> None:
    world = await asyncio.to_thread(hub.embodiment.open_content, m.kind, m.name, m.content, m.settings)
    await hub.project.embody(world, m.kind, m.name)


@handles(to_server.WatchWorld)
async def _watch_world(hub: Hub, page: Page, m: to_server.WatchWorld) -> None:
    page.sent_bodies = SentBodies(m.solid) if m.on else None


@handles(to_server.MoveObject)
async def _move_object(hub: Hub, page: Page, m: to_server.MoveObject) -> None:
    await _rearrange(hub, page, lambda session: session.move(m.name, (m.x, m.y)))


@handles(to_server.PlaceObject)
async def _place_object(hub: Hub, page: Page, m: to_server.PlaceObject) -> None:
    place = m.name, (m.x, m.y), (m.width, m.height), m.color
    await _rearrange(hub, page, lambda session: session.place(*place))


@handles(to_server.RemoveObject)
async def _remove_object(hub: Hub, page: Page, m: to_server.RemoveObject) -> None:
    await _rearrange(hub, page, lambda session: session.remove(m.name))


@handles(to_server.PushBody)
async def _push_body(hub: Hub, page: Page, m: to_server.PushBody) -> None:
    if any(m.force):
        page.pushed.add(m.body)
    else:
        page.pushed.discard(m.body)
    await _rearrange(hub, page, lambda session: session.push_body(m.body, m.force))


async def _rearrange(hub: Hub, page: Page, how: Callable[[Session], None]) -> None:
    hub.project.require_run()
    await _engine(hub, page, lambda: hub.engine.rearrange(how))


# --------------------------------------------------------------------------------------------------- watching


@handles(to_server.Watch)
async def _watch(hub: Hub, page: Page, m: to_server.Watch) -> None:
    _require_room(hub, page, m.stream)
    section = Section(tuple(m.drawn), tuple(m.at.items()))
    page.streams[m.stream] = Stream(m.stream, (m.element, m.port), m.most, other=m.other, section=section)
    hub.watch()


@handles(to_server.WatchTrace)
async def _trace(hub: Hub, page: Page, m: to_server.WatchTrace) -> None:
    _require_room(hub, page, m.stream)
    place = (m.element, m.port)
    page.streams[m.stream] = Stream(
        m.stream, place, request=TraceRequest(place, m.reduce, tuple(m.at)), other=m.other
    )
    hub.watch()


@handles(to_server.WatchRows)
async def _rows(hub: Hub, page: Page, m: to_server.WatchRows) -> None:
    _require_room(hub, page, m.stream)
    place = (m.element, m.port)
    section = Section((m.drawn,) if m.drawn else (), tuple(m.at.items()), most=1)
    request = TraceRequest(place, section=section)
    page.streams[m.stream] = Stream(m.stream, place, m.most, request, m.other)
    hub.watch()


@handles(to_server.WatchKernel)
async def _kernel(hub: Hub, page: Page, m: to_server.WatchKernel) -> None:
    _require_room(hub, page, m.stream)
    stream, source = KernelStream(m.stream, m.element, m.most, m.other), hub.source(page)
    # the first shape compiles the formula of the kernel, for up to seconds
    await asyncio.to_thread(stream.compute, source)
    page.streams[m.stream] = stream
    hub.watch()


@handles(to_server.WatchWeights)
async def _weights(hub: Hub, page: Page, m: to_server.WatchWeights) -> None:
    _require_room(hub, page, m.stream)
    section = Section(tuple(m.drawn), tuple(m.at.items()))
    page.streams[m.stream] = WeightsStream(m.stream, m.element, m.parameter, section, m.most, m.other)
    hub.watch()


@handles(to_server.Unwatch)
async def _unwatch(hub: Hub, page: Page, m: to_server.Unwatch) -> None:
    if page.streams.pop(m.stream, None) is not None:
        hub.watch()


def _require_room(hub: Hub, page: Page, stream: int) -> None:
    if stream not in page.streams and len(page.streams) >= MOST_STREAMS:
        raise ParameterError(f"a page watches at most {MOST_STREAMS} streams")
