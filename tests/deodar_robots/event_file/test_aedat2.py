"""AEDAT2: addresses, times, and what is wrong with a file."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.errors import RunWarning, WorldError
from deodar_robots.event_file import aedat2

HEADER = b"#!AER-DAT2.0\r\n# This is a raw AE data file - do not edit\r\n"


def file(folder: Path, events: list[tuple[int, int]], header: bytes = HEADER, more: bytes = b"") -> Path:
    path = folder / "a.aedat"
    path.write_bytes(header + np.array(events, ">u4").tobytes() + more)
    return path


def address(x: int, y: int, bit: int) -> int:
    return y << 8 | x << 1 | bit


def world(path: Path, **settings) -> dd.EventFile:
    return dd.EventFile(path, **settings)


def at(opened: dd.EventFile, sensor: str = "events", time: float = 10.0) -> list[tuple[int, int]]:
    """Return columns and rows with events in the 10 ms before a time."""
    axes = [dd.Axis(name, 0, n - 1, n) for name, n in zip(("column", "row"), opened.size, strict=True)]
    return [(int(c), int(r)) for c, r in zip(*np.nonzero(opened.sense(sensor, axes, time)), strict=True)]


def test_addresses_are_those_of_a_dvs128_in_jaer_or_plain(tmp_path: Path) -> None:
    path = file(tmp_path, [(address(3, 5, 0), 100), (address(100, 20, 1), 200)])
    seen = world(path)
    assert seen.size == (128, 128) and seen.count == 2
    assert at(seen, "on") == [(124, 122)] and at(seen, "off") == [(27, 107)]
    plain = world(path, jaer=False)
    assert at(plain, "on") == [(100, 20)] and at(plain, "off") == [(3, 5)]


def test_the_time_of_the_first_event_is_0(tmp_path: Path) -> None:
    path = file(tmp_path, [(address(1, 0, 0), 4_000_000_000), (address(2, 0, 0), 4_000_010_000)])
    seen = world(path)
    assert seen.duration == 10.001
    assert at(seen, time=10.0) == [(126, 127)] and at(seen, time=20.0) == [(125, 127)]


def test_times_wrap_at_32_bits(tmp_path: Path) -> None:
    stamps = [2**32 - 8_000, 2**32 - 1, 0, 5_000]
    seen = world(file(tmp_path, [(address(k, 0, 0), t) for k, t in enumerate(stamps)]))
    assert seen.duration == 13.001
    assert len(at(seen, time=10.0)) == 3 and at(seen, time=20.0) == [(124, 127)]


def test_a_recording_of_hours_wraps_several_times(tmp_path: Path) -> None:
    stamps = (np.arange(10) * 1_900_000_000) % 2**32
    seen = world(file(tmp_path, [(address(k, 0, 0), int(t)) for k, t in enumerate(stamps)]))
    assert seen.duration == pytest.approx(9 * 1.9e6, abs=0.01)


def test_events_that_are_not_of_a_pixel_are_left_out(tmp_path: Path) -> None:
    path = file(tmp_path, [(0x8000, 50), (address(3, 5, 0), 100), (0x8000, 150)])
    assert world(path).count == 1
    with pytest.raises(WorldError, match="holds no events"):
        world(file(tmp_path, [(0x8000, 50)]))


def test_an_event_that_is_cut_off_is_left_out(tmp_path: Path) -> None:
    path = file(tmp_path, [(address(3, 5, 0), 100)], more=b"\0\0\1")
    with pytest.warns(RunWarning, match=r"a\.aedat: ends within an event; its last 3 bytes are left out"):
        assert world(path).count == 1


def test_time_that_goes_back_a_little_is_sorted(tmp_path: Path) -> None:
    path = file(tmp_path, [(address(k, 0, 0), t) for k, t in enumerate([0, 30_000, 12_000, 50_000])])
    with pytest.warns(RunWarning, match=r"back by up to 18 ms at 1 of 4 events; sorted them"):
        seen = world(path)
    assert at(seen, time=20.0) == [(125, 127)] and at(seen, time=40.0) == [(126, 127)]


def test_time_that_was_reset_is_refused(tmp_path: Path) -> None:
    path = file(tmp_path, [(address(k, 0, 0), t) for k, t in enumerate([0, 3_000_000, 100])])
    with pytest.raises(WorldError, match=r"back by 3 s at event 2 of 3: it was reset there.*two files"):
        world(path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty"),
        (b"#!AER-DAT2.0", "ends within its header"),
        (HEADER + b"# 12", "ends within its header"),
        (HEADER, "holds no events"),
        (b"#!AER-DAT3.1\r\n" + bytes(80), "is of the version '3.1' of AEDAT; versions 2 and 4 are read"),
        (b"#!AER-DAT1.0\r\n" + bytes(80), "is of the version '1.0'"),
        (b"RIFF" + bytes(80), "is not a recording of events: it does not begin with '#!AER-DAT'"),
        (b"#!AER-DAT2.0\r\n" + b"#" * (2**24 + 1), "has a header of more than 16 MiB"),
        (HEADER + b"# AEChip: eu.seebetter.ini.chips.davis.DAVIS240C\r\n" + bytes(80), "with a 'DAVIS240C'"),
        (HEADER + b"\xff" * 80, "event 0 of 10 has the address 0xffffffff"),
    ],
)
def test_a_file_that_cannot_be_read_is_one_clear_error(content: bytes, message: str, tmp_path: Path) -> None:
    path = tmp_path / "wrong.aedat"
    path.write_bytes(content)
    with pytest.raises(WorldError) as caught:
        world(path)
    assert str(caught.value).startswith(f"{path}: {message}") or f"was recorded {message}" in str(
        caught.value
    )
    assert len(caught.value.problems) == 1 and caught.value.problems[0].fix


def test_a_header_of_many_lines_is_read_at_once(tmp_path: Path) -> None:
    path = file(tmp_path, [(address(3, 5, 0), 100)], header=HEADER + b"#\n" * 1_000_000)
    assert world(path).count == 1


def test_events_beyond_the_stated_sensor_are_refused(tmp_path: Path) -> None:
    path = file(tmp_path, [(address(1, 1, 0), 100), (address(64, 1, 0), 100)])
    with pytest.raises(WorldError, match=r"event 1 of 2 is at column 64, row 1; the sensor has 64 x 128"):
        world(path, size=(64, 128), jaer=False)


def test_what_is_written_is_read(tmp_path: Path) -> None:
    random = np.random.default_rng(3)
    times = 2**32 - 50_000 + np.sort(random.integers(0, 100_000, 5000))
    columns, rows = random.integers(0, 128, (2, 5000))
    on = random.random(5000) < 0.4
    path = tmp_path / "b.aedat"
    path.write_bytes(aedat2.encoded(times, columns, rows, on))
    events = aedat2.read(path, None, jaer=True)
    assert np.array_equal(events.times, times - times[0])
    assert np.array_equal(events.pixels, columns * 128 + rows) and np.array_equal(events.on, on)


def test_rates_of_poisson_events_are_read_back(tmp_path: Path) -> None:
    """Known rates of four quarters of the sensor, for 4 s: means and variances are those of the process."""
    random, seconds, side = np.random.default_rng(5), 4.0, 128
    rates = {True: np.array([[5.0, 20.0], [0.0, 2.0]]), False: np.array([[1.0, 1.0], [8.0, 3.0]])}
    parts = []
    for on, quarters in rates.items():
        mean = quarters.repeat(64, axis=0).repeat(64, axis=1) * seconds
        pixels = np.repeat(np.arange(side**2), random.poisson(mean).ravel())
        parts.append((random.integers(0, int(seconds * 1e6), len(pixels)), pixels, np.full(len(pixels), on)))
    times, pixels, on = (np.concatenate(part) for part in zip(*parts, strict=True))
    order = np.argsort(times)
    path = tmp_path / "poisson.aedat"
    path.write_bytes(aedat2.encoded(times[order], pixels[order] // side, pixels[order] % side, on[order]))
    seen = world(path)
    axes = (dd.Axis("column", 31.5, 95.5, 2), dd.Axis("row", 31.5, 95.5, 2))
    for sensor, expected in (("on", rates[True]), ("off", rates[False]), ("events", sum(rates.values()))):
        read = np.array([seen.sense(sensor, axes, 10.0 * (k + 1)) for k in range(400)])
        # four standard errors of a Poisson count
        assert np.all(
            np.abs(read.mean(axis=0) - expected) <= 4 * np.sqrt(expected / (64 * 64 * seconds)) + 1e-9
        )
        counts = read[:, expected > 0] * (64 * 64 * 0.01)
        fano = counts.var(axis=0, ddof=1) / counts.mean(axis=0)
        assert np.all(np.abs(fano - 1) < 4 * np.sqrt(2 / 399))


def test_24_mb_are_read_within_seconds(tmp_path: Path) -> None:
    count = 3_000_000
    words = np.empty((count, 2), ">u4")
    words[:, 0], words[:, 1] = np.arange(count) % 2**15, np.arange(count) * 2
    path = tmp_path / "large.aedat"
    with path.open("wb") as output:
        output.write(HEADER)
        words.tofile(output)
    begun = time.process_time()
    seen = world(path)
    assert seen.count == count and time.process_time() - begun < 10
