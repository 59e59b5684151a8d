"""The head that comes with deodar: a camera on a pan-tilt unit, and a ball that swings around it."""

from __future__ import annotations

import numpy as np
import pytest

from deodar.numerics.axes import Axis
from deodar_robots.robot.robot import Robot

PICTURE = (Axis("column", 0, 31, 32), Axis("row", 0, 15, 16), Axis("channel", 0, 2, 3))
HALF = np.degrees(np.arctan(2 * np.tan(np.radians(15))))


def moved(head: Robot, seconds: float, **speeds: float) -> tuple[float, float, float]:
    """Move the head at some speeds, and return pan, tilt and the bearing of the ball."""
    for k in range(round(50 * seconds)):
        head.act({name: np.full(1, speed, np.float32) for name, speed in speeds.items()}, 20.0 * k)
    return tuple(float(np.ravel(head.sense(name, (), 0.0))[0]) for name in ("pan", "tilt", "ball"))


@pytest.fixture
def head() -> Robot:
    found = Robot("head")
    found.reset(0)
    return found


def test_the_ball_swings_at_its_frequency_and_keeps_its_amplitude(head: Robot):
    bearings = np.array([moved(head, 0.02)[2] for _ in range(50 * 25)])
    crossings = np.flatnonzero(np.diff(np.sign(bearings)))
    assert np.diff(crossings).mean() / 50 == pytest.approx(1 / 0.16, rel=0.01), "half a period of 0.08 Hz"
    assert np.abs(bearings[-700:]).max() == pytest.approx(0.7, rel=0.01)


def test_it_turns_at_the_commanded_speeds_up_to_its_ranges(head: Robot):
    pan, tilt, _ = moved(head, 0.5, pan=-1.0, tilt=0.4)
    assert pan == pytest.approx(0.4 - 0.5, abs=0.06) and tilt == pytest.approx(0.2, abs=0.04)
    pan, tilt, _ = moved(head, 1.5, pan=6.0, tilt=6.0)
    assert pan == pytest.approx(np.radians(86), abs=0.1) and tilt == pytest.approx(np.radians(40), abs=0.1)


def test_its_picture_shows_the_ball_at_its_bearing_and_lower_when_it_looks_up(head: Robot):
    pan, _, ball = moved(head, 1.0)
    red = red_of(head)
    across = np.tan(np.radians(HALF)) * (1 - 2 * (np.nonzero(red)[0].mean() + 0.5) / 32)
    assert np.degrees(np.arctan(across)) == pytest.approx(np.degrees(ball - pan), abs=2.0)
    before = np.nonzero(red)[1].mean()
    moved(head, 0.2, tilt=0.5)
    assert np.nonzero(red_of(head))[1].mean() > before


def red_of(head: Robot) -> np.ndarray:
    """Return which pixels of the picture are red, columns first."""
    picture = np.asarray(head.sense("camera", PICTURE, 0.0)).reshape(32, 16, 3)
    return picture[..., 0] - picture[..., 2] > 0.1
