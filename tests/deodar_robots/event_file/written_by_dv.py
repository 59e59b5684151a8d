"""Writes the AEDAT4 files of this folder, with the package `dv-processing`: python written_by_dv.py"""

from __future__ import annotations

from pathlib import Path

import dv_processing as dv
import numpy as np

HERE = Path(__file__).parent
FIRST = 1_700_000_000_000_000
"""Time of the first event, in microseconds."""


def store(begin: int, end: int, columns: int, rows: int) -> dv.EventStore:
    """Return events with the numbers begin to end; see `expected` in test_aedat4.py."""
    events = dv.EventStore()
    for k in range(begin, end):
        events.push_back(FIRST + 250 * k, k % columns, 3 * k % rows, k % 3 == 0)
    return events


def writer(name: str, compression: dv.CompressionType, *streams: str) -> dv.io.MonoCameraWriter:
    """Return the writer of a file with streams of events and of frames."""
    config = dv.io.MonoCameraWriter.Config("DAVIS")
    config.compression = compression
    for stream in streams:
        if stream == "frames":
            config.addFrameStream((64, 48), stream)
        else:
            config.addEventStream((64, 48) if stream == "events" else (32, 24), stream)
    return dv.io.MonoCameraWriter(str(HERE / name), config)


two = writer("two.aedat4", dv.CompressionType.LZ4, "events", "frames", "second")
two.writeEvents(store(0, 60, 64, 48), "events")
two.writeEvents(store(10, 30, 32, 24), "second")
two.writeFrame(dv.Frame(FIRST, np.full((48, 64), 100, np.uint8)), "frames")
two.writeEvents(store(60, 120, 64, 48), "events")
del two

one = writer("one.aedat4", dv.CompressionType.ZSTD, "events")
one.writeEvents(store(0, 60, 64, 48), "events")
one.writeEvents(store(60, 120, 64, 48), "events")
del one

plain = writer("plain.aedat4", dv.CompressionType.NONE, "events")
plain.writeEvents(store(0, 20, 64, 48), "events")
plain.writeEvents(store(20, 40, 64, 48), "events")
del plain

frames = writer("frames.aedat4", dv.CompressionType.LZ4, "frames")
frames.writeFrame(dv.Frame(FIRST, np.full((48, 64), 100, np.uint8)), "frames")
del frames

writer("empty.aedat4", dv.CompressionType.LZ4, "events")
