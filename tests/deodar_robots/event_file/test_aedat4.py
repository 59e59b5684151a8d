"""AEDAT4: streams, sizes and times, damaged files, and what ends the child that reads them.

The files were written by `written_by_dv.py`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.errors import MissingExtra, RunWarning, WorldError
from deodar.guarded import guarded_file
from deodar.guarded.children import Children
from deodar_robots.event_file import aedat4

HERE = Path(__file__).parent


def expected(begin: int, end: int, columns: int, rows: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times, pixels and polarities of the events with the numbers begin to end."""
    k = np.arange(begin, end)
    return 250 * (k - begin), k % columns * rows + 3 * k % rows, k % 3 == 0


@pytest.mark.parametrize(
    ("name", "stream", "size", "numbers"),
    [
        ("one", 0, (64, 48), (0, 120)),
        ("plain", 0, (64, 48), (0, 40)),
        ("two", 0, (64, 48), (0, 120)),
        ("two", 1, (32, 24), (10, 30)),
    ],
)
def test_each_stream_has_its_events_and_size(
    name: str, stream: int, size: tuple[int, int], numbers: tuple[int, int]
) -> None:
    events = aedat4.read(HERE / f"{name}.aedat4", None, stream)
    times, pixels, on = expected(*numbers, *size)
    assert events.size == size
    assert np.array_equal(events.times, times)
    assert np.array_equal(events.pixels, pixels) and np.array_equal(events.on, on)


def test_the_world_has_the_rates_of_a_stream() -> None:
    world = dd.EventFile(HERE / "two.aedat4", stream=1)
    assert world.size == (32, 24) and world.count == 20 and world.duration == 4.751
    axes = (dd.Axis("column", 0, 31, 32), dd.Axis("row", 0, 23, 24))
    # 20 events in 10 ms
    assert world.sense("events", axes, 10.0).sum() == pytest.approx(2000)
    assert world.sense("on", axes, 10.0).sum() == pytest.approx(600)
    assert world.sense("events", axes, 20.0).sum() == 0


@pytest.mark.parametrize(
    ("name", "stream", "message"),
    [
        ("frames", 0, "has no stream 0 with events; its streams: frame"),
        ("two", 2, "has no stream 2 with events; its streams: events 64 x 48, events 32 x 24, frame"),
        ("empty", 0, "holds no events"),
    ],
)
def test_a_file_without_such_events_is_refused(name: str, stream: int, message: str) -> None:
    with pytest.raises(WorldError, match=f"{name}.aedat4: {message}"):
        dd.EventFile(HERE / f"{name}.aedat4", stream=stream)


def test_events_before_the_damage_are_used(tmp_path: Path) -> None:
    content = (HERE / "plain.aedat4").read_bytes()
    path = tmp_path / "cut.aedat4"
    path.write_bytes(content[: content.rindex(b"EVTS") + 100])
    with pytest.warns(RunWarning, match=r"cut\.aedat4: is damaged after 20 events .*; those before are used"):
        assert dd.EventFile(path).count == 20
    first = content.index(b"EVTS", content.index(b"</dv>"))
    for size, message in (
        (40, "cannot be read as AEDAT4"),
        (first + 9, "holds no events before it is damaged"),
    ):
        path.write_bytes(content[:size])
        with pytest.raises(WorldError, match=message):
            dd.EventFile(path)


def test_a_file_with_more_events_than_are_read_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(aedat4, "MOST_EVENTS", 10)
    with pytest.raises(WorldError, match=r"plain\.aedat4: holds more than 10 events"):
        dd.EventFile(HERE / "plain.aedat4")


def test_a_file_that_ends_the_process_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    killer = tmp_path / "aedat.py"
    killer.write_text("import os\n\n\ndef Decoder(path):\n    os.abort()\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(guarded_file, "children", Children)
    with pytest.raises(
        WorldError, match=r"one\.aedat4: cannot be read as AEDAT4 \(its reader ended by SIGABRT\)"
    ):
        dd.EventFile(HERE / "one.aedat4")


def test_a_file_that_is_never_read_to_its_end_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    endless = tmp_path / "aedat.py"
    endless.write_text("def Decoder(path):\n    while True:\n        pass\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(guarded_file, "children", Children)
    monkeypatch.setattr(aedat4, "PATIENCE", 0.5)
    with pytest.raises(WorldError, match=r"AEDAT4 \(it takes longer than 0\.5 s\)"):
        dd.EventFile(HERE / "one.aedat4")


def test_without_the_package_the_error_names_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "aedat", None)
    says = r"reading an AEDAT4 file needs the package aedat.*pip install 'deodar\[events\]'"
    with pytest.raises(MissingExtra, match=says):
        dd.EventFile(HERE / "one.aedat4")


def test_opening_aedat2_needs_no_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "aedat", None)
    monkeypatch.setitem(sys.modules, "cv2", None)
    assert dd.EventFile.example().count == 8192
