"""Requests about records: writing, comparing and continuing them, and figures."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import msgspec

from deodar.errors import DocumentError, ModelError
from deodar.model import find
from deodar.model.paths import quote
from deodar.recording import places
from deodar.session.recorder import compile_records
from deodar_studio.files.file_thread import in_file_thread
from deodar_studio.messages.message import Data, Id
from deodar_studio.messages.to_page import Answer
from deodar_studio.pages.hub import Hub
from deodar_studio.pages.page import Page
from deodar_studio.requests.request import Count, Text, answer, asks, changes, repeats

FIGURES = {
    "course": "time_course",
    "curve": "snapshot",
    "heat": "snapshot",
    "picture": "snapshot",
    "space_time": "space_time",
}
"""The kind of figure for a kind of plot."""


class RecordedPort(Data, frozen=True):
    """A port to record."""

    element: Id
    port: Text


@changes()
async def open_record_model(hub: Hub, page: Page, *, discard: bool = False) -> None:
    """Open the document of the open record, as a document without a file, which runs."""
    await hub.project.open_record_model(discard)


@changes()
async def compare_record(hub: Hub, page: Page, *, path: Text) -> None:
    """Compare the open record with another one below the root; a `comparison` message follows."""
    await hub.project.record.compare(hub.workspace.inside(path), hub.from_thread)


@changes()
async def end_comparison(hub: Hub, page: Page) -> None:
    """Show the open record alone again."""
    hub.project.record.end_comparison()


@asks()
async def choose_copy(hub: Hub, page: Page, *, dimension: Text, index: Count) -> None:
    """Show another trial or point of a sweep of the open record: the index along one of its dimensions."""
    hub.source(page)
    record = hub.project.record.reader
    if page.frames is None or record is None or dimension not in record.copies:
        raise DocumentError("the open record has no such dimension", where=dimension)
    page.frames.choose({dimension: index})
    others = hub.other_source(page)
    if others is not None:
        others.choose({dimension: index})
    page.wake()


@asks()
async def start_record(
    hub: Hub,
    page: Page,
    *,
    ports: Annotated[Sequence[RecordedPort], msgspec.Meta(max_length=500)] = (),
    every: Annotated[float, msgspec.Meta(gt=0)] | None = None,
) -> None:
    """Record ports of the running model into a new folder below the root; `clock` states its path.

    Without ports: the activation of every field. `every` is the document time between two samples, None every
    step.
    """
    hub.project.require_run()
    session = hub.engine.session
    if session is None:
        raise ModelError("no model runs yet", fix="Wait until it is compiled")
    by = session.document.by_id()
    recorded = [(p.element, p.port) for p in ports if p.element in by]
    if not recorded:
        recorded = [(e.id, "activation") for e in by.values() if "activation" in find.outputs(e)]
    if not recorded:
        raise DocumentError("the model has no field to record", fix="Open the plot of an element first")
    recorded = list(dict.fromkeys(recorded))
    out = places.free(hub.workspace.root, session.document.name)
    # compiled here, so that the run does not wait for it
    await asyncio.to_thread(compile_records, session.program, recorded)
    paths = [f"{by[ident].path}.{quote(port)}" for ident, port in recorded]
    await hub.in_engine(lambda: hub.engine.record(out, paths, every))


@asks()
async def stop_record(hub: Hub, page: Page) -> None:
    """Complete the record that is being written."""
    await hub.in_engine(hub.engine.stop_record)


@asks()
async def save_figure(
    hub: Hub, page: Page, *, element: Id, port: Text, kind: Text, range: tuple[float, float] | None = None
) -> Answer:
    """Save a plot as the file of a figure, which `deodar plot` draws; the answer states its path.

    `kind` is that of the plot, `range` the range of its values; None: it follows the data.
    """
    engine, opened, root = hub.engine, hub.project.record.reader, hub.workspace.root
    session = engine.session
    if opened is not None:
        record, document = opened.path, opened.document
    elif session is not None:
        recorder = session.recorder
        record, document = None if recorder is None else recorder.path, session.document
    else:
        raise ModelError("no model runs yet", fix="Wait until it is compiled")
    time = engine.published.time if page.moment is None else page.moment.time

    def write() -> Path:
        # start-up time: this imports matplotlib
        from deodar.figures import FigureFile, FigurePanel

        entry, name = find.shown(document, f"{find.entry(document, element).path}.{quote(port)}")
        figure = FIGURES.get(kind)
        at = [time] if figure == "snapshot" else None
        panel = FigurePanel(f"{entry.path}.{name}", kind=figure, at=at, value_range=range)
        file = FigureFile([panel], record=None if record is None else str(record), folder=root)
        return file.save(places.free(root, f"{document.name}-figure", ".toml"))

    return answer(file=hub.workspace.shown(await in_file_thread(write, str(root))))


@repeats()
async def run_record_from(hub: Hub, page: Page, *, time: float) -> None:
    """Open a copy of the open record's document, which runs on from the last sample up to a document time.

    The run of the record is repeated up to there, with later requests of the page meanwhile; opening another
    document ends the repetition. The answer follows when the copy runs.
    """
    await hub.project.run_record_from(time)
    page.seek(None)
