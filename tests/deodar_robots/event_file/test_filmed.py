"""A video before an event camera: where and when it causes events."""

from __future__ import annotations

import pickle
from pathlib import Path

import cv2
import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError
from deodar.worlds import _capture
from deodar_robots.event_file.filmed import DARK
from deodar_robots.eye.event_camera import EventCamera
from tests.deodar.worlds.test_camera_files import long_video, require_no_reader_once_closed

QUIET = EventCamera(spread=0.0, leak=0.0, shot=0.0)
WHOLE = (dd.Axis("column", 0, 63, 64), dd.Axis("row", 0, 47, 48))
AXES = (dd.Axis("column", 3.5, 59.5, 8), dd.Axis("row", 3.5, 43.5, 6))


@pytest.fixture(scope="module")
def square() -> Path:
    return _capture.example()


def film(path: Path, lumas: list[int]) -> Path:
    """Write a video of grey pictures, 10 a second, without loss."""
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"FFV1"), 10, (64, 48))
    for luma in lumas:
        writer.write(np.full((48, 64, 3), luma, np.uint8))
    writer.release()
    return path


def world(path: Path, **settings) -> dd.EventFile:
    opened = dd.EventFile(path, **{"size": (64, 48), "camera": QUIET, **settings})
    opened.reset(1)
    return opened


def counts(opened: dd.EventFile, sensor: str, periods: int) -> list[float]:
    """Return the mean number of events of a pixel in each period."""
    seen = (opened.sense(sensor, WHOLE, opened.period * (k + 1)) for k in range(periods))
    return [float(reading.mean()) * opened.period / 1000 for reading in seen]


def test_events_count_the_thresholds_in_the_change_of_log_luminance(tmp_path: Path) -> None:
    path = film(tmp_path / "step.avi", [40, 160, 160, 30, 30])
    change = np.log((160 + DARK) / (40 + DARK))
    on, off = (counts(world(path), sensor, 50) for sensor in ("on", "off"))
    assert sum(on) == np.floor(change / 0.2) == 6
    # from the luminance of the last event on
    assert sum(off) == np.floor((1.2 + np.log((40 + DARK) / (30 + DARK))) / 0.2)
    # the change lasts from one picture to the next: linear in 100 ms
    assert sum(on[:5]) == np.floor(change / 2 / 0.2) and sum(on[:10]) == sum(on)
    assert sum(off[:20]) == 0 and sum(off[:30]) == sum(off)


def test_a_constant_video_causes_no_events(tmp_path: Path) -> None:
    assert counts(world(film(tmp_path / "still.avi", [90] * 5)), "events", 60) == [0.0] * 60


def test_a_moving_square_causes_events_at_its_edges(square: Path) -> None:
    opened = world(square, period=40.0)
    for tick in (3, 9, 15):
        on, off = (opened.sense(sensor, AXES, 40.0 * tick) for sensor in ("on", "off"))
        # red is darker than the ground: its leading edge turns pixels off
        left = 2 * tick
        assert abs(8 * int(off.sum(axis=1).argmax()) + 3.5 - (left + 15)) <= 8
        assert abs(8 * int(on.sum(axis=1).argmax()) + 3.5 - left) <= 8
        assert set(np.flatnonzero(off.sum(axis=0))) <= {2, 3}


def test_after_the_end_there_are_no_events(square: Path) -> None:
    opened = world(square, camera=EventCamera())
    # 25 pictures of 40 ms
    assert opened.sense("events", AXES, 1000.0).sum() > 0
    assert opened.sense("events", AXES, 1010.0).sum() == 0
    assert opened.sense("events", AXES, 5000.0).sum() == 0
    again = world(square, camera=EventCamera(), loop=True)
    assert again.sense("events", AXES, 1010.0).sum() > 0
    assert again.sense("off", AXES, 2200.0).sum() > 0


def test_events_follow_from_seed_and_time(square: Path) -> None:
    opened = world(square, camera=EventCamera(shot=20.0))
    in_turn = [opened.sense("events", WHOLE, 10.0 * k) for k in range(12)]
    opened.reset(1)
    assert np.array_equal(opened.sense("events", WHOLE, 110.0), in_turn[11]), "without the ones before"
    assert np.array_equal(opened.sense("events", WHOLE, 30.0), in_turn[3]), "back in time"
    opened.reset(2)
    assert not np.array_equal(opened.sense("events", WHOLE, 110.0), in_turn[11])
    copied = pickle.loads(pickle.dumps(opened))
    assert np.array_equal(copied.sense("on", WHOLE, 150.0), opened.sense("on", WHOLE, 150.0))


def test_a_kept_state_is_restored(square: Path) -> None:
    opened = world(square, camera=EventCamera(shot=20.0))
    opened.sense("events", WHOLE, 50.0)
    kept = opened.keep()
    later = opened.sense("events", WHOLE, 120.0)
    other = world(square, camera=EventCamera(shot=20.0))
    other.put(kept)
    assert np.array_equal(other.sense("events", WHOLE, 120.0), later)


def test_trials_of_a_batch_see_the_events_of_a_single_run(square: Path) -> None:
    model = dd.Model("watching", dt=10)
    model.add(dd.Sensor("seen", AXES, sensor="events"))
    options = dict(record="seen.output", every=10, seed=4)
    one = dd.simulate(model, 200, world=dd.EventFile(square, size=(64, 48)), **options)
    two = dd.simulate(model, 200, world=dd.EventFile(square, size=(64, 48)), trials=[0, 5], **options)
    assert one["seen.output"].max() > 0
    for trial in range(2):
        assert np.array_equal(two["seen.output"].values[trial], one["seen.output"].values)


def test_the_default_sensor_keeps_the_proportions_of_a_video(square: Path) -> None:
    opened = dd.EventFile(square, camera=QUIET)
    assert opened.size == (128, 128) and opened.duration is None and opened.count is None
    axes = (dd.Axis("column", 3.5, 123.5, 16), dd.Axis("row", 3.5, 123.5, 16))
    seen = opened.sense("events", axes, 400.0)
    # 64 x 48 pixels fill all columns and 96 rows; the square is at rows 16 to 32 of the video
    assert set(np.flatnonzero(seen.sum(axis=0))) <= set(range(6, 11))


def test_a_file_that_is_no_video_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "film.mp4"
    path.write_text("not a video")
    with pytest.raises(WorldError, match=r"film\.mp4: cannot be read as a video"):
        dd.EventFile(path)


def test_a_filmed_video_that_is_closed_has_no_reader_until_the_next_reading(tmp_path: Path) -> None:
    require_no_reader_once_closed(dd.EventFile, "on", AXES, long_video(tmp_path))
