"""The open record without a document that is edited, a file or a page."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

import deodar as dd
from deodar.errors import DocumentError
from deodar.model import edit
from deodar.recording import folder
from deodar.recording.replay import RecordReader
from deodar_studio.project import comparison
from deodar_studio.project.file_state import FileState
from deodar_studio.project.record import OpenRecord, SetAside


def record(path: Path, seed: int) -> Path:
    """Write a record of a node with noise."""
    model = dd.Model("m")
    model.add(dd.Noise("n")) >> model.add(dd.RateNode("u"))
    recording = dd.simulate(model, duration=20, record=["u.activation"], seed=seed)
    folder.write(recording, model.document, path, "zarr")
    return path


def opened(news: list[str]) -> OpenRecord:
    return OpenRecord(lambda path: path.name, lambda: news.append("changed"), lambda: news.append("outdated"))


def test_two_records_are_compared_until_one_is_closed(tmp_path: Path) -> None:
    async def scene() -> None:
        news: list[str] = []
        r, recording = opened(news), record(tmp_path / "two", 2)
        with pytest.raises(DocumentError, match="no record is open"):
            await r.compare(recording, lambda: None)
        r.open(RecordReader(record(tmp_path / "one", 1)), (None, ""))
        ended = asyncio.Event()
        loop = asyncio.get_running_loop()
        await r.compare(recording, lambda: (loop.call_soon_threadsafe(ended.set), None)[1])
        while r.compared().progress < 1:
            await asyncio.wait_for(ended.wait(), 60)
            ended.clear()
        assert r.compared().path == "two" and [d.path for d in r.compared().differences] == ["u.activation"]
        assert "changed" in news
        r.close()
        assert r.reader is None and r.compared() == comparison.NO_COMPARISON

    asyncio.run(scene())


def test_a_complete_record_does_not_grow(tmp_path: Path) -> None:
    news: list[str] = []
    r = opened(news)
    assert not asyncio.run(r.refresh())
    r.open(RecordReader(record(tmp_path / "one", 1)), (None, ""))
    assert not asyncio.run(r.refresh()) and news == []


def test_a_document_set_aside_keeps_its_unsaved_edits(tmp_path: Path) -> None:
    model = dd.Model("m")
    saved = FileState(saved=model.document)
    r = opened([])
    r.open(RecordReader(record(tmp_path / "one", 1)), (None, ""), SetAside(model, saved))
    assert r.aside is not None and not r.aside.unsaved
    model.commit(edit.describe(model.document, notes="more"))
    assert r.aside.unsaved
    r.close()
    assert r.aside is None
