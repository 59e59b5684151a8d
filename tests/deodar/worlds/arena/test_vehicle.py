"""The vehicle: its wheels, its sensors and its noise."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
import pytest

from deodar.worlds.arena.epuck import EPUCK
from deodar.worlds.arena.infrared import distances, readings
from deodar.worlds.arena.khepera import KHEPERA
from deodar.worlds.arena.vehicle import ahead, drive, limited, wrapped

NOTHING = jnp.zeros((1, 4)), jnp.zeros(1, bool)


def test_a_full_turn_of_both_wheels_covers_their_circumference() -> None:
    distance, turn = drive(EPUCK, jnp.asarray(0.0), jnp.asarray([1000.0, 1000.0]))
    np.testing.assert_allclose(distance, [2 * np.pi * 0.0205, 0], rtol=1e-6, atol=1e-9)
    assert turn == 0


@pytest.mark.parametrize("steps", [(100.0, 300.0), (-500.0, 500.0), (0.0, 4000.0), (300.0, 299.0)])
def test_constant_wheel_speeds_give_a_circle(steps: tuple[float, float]) -> None:
    """Compare with the circle in double precision: radius axle/2 (r + l) / (r - l), from any heading."""
    heading = 0.7
    left, right = (s * EPUCK.step_length for s in steps)
    radius, angle = EPUCK.axle / 2 * (right + left) / (right - left), (right - left) / EPUCK.axle
    expected = radius * np.array(
        [np.sin(heading + angle) - np.sin(heading), np.cos(heading) - np.cos(heading + angle)]
    )
    distance, turn = drive(EPUCK, jnp.asarray(heading), jnp.asarray(steps))
    np.testing.assert_allclose(distance, expected, atol=2e-7)
    np.testing.assert_allclose(turn, angle, rtol=1e-5)


def test_many_short_periods_end_at_the_pose_of_one_long_period() -> None:
    place, heading = np.zeros(2), 0.3
    for _ in range(50):
        distance, turn = drive(EPUCK, jnp.asarray(heading), jnp.asarray([4.0, 6.0]))
        place, heading = place + np.asarray(distance), heading + float(turn)
    distance, turn = drive(EPUCK, jnp.asarray(0.3), jnp.asarray([200.0, 300.0]))
    np.testing.assert_allclose(place, distance, atol=1e-6)
    np.testing.assert_allclose(heading, 0.3 + float(turn), rtol=1e-6)


def test_the_speed_of_each_wheel_is_limited() -> None:
    assert limited(EPUCK, jnp.asarray(5000.0), jnp.asarray(-1e9)).tolist() == [1000, -1000]
    assert limited(EPUCK, jnp.asarray(-3.0), jnp.asarray(250.0)).tolist() == [-3, 250]


def test_headings_are_wrapped_after_any_number_of_turns() -> None:
    angles = np.asarray([0.1, np.pi + 0.1, -7.0, 100.0])
    small = np.asarray(wrapped(jnp.asarray(angles, jnp.float32)))
    assert (np.abs(small) <= np.pi + 1e-6).all()
    np.testing.assert_allclose(np.exp(1j * small), np.exp(1j * angles), atol=1e-5)


def test_sensors_point_outwards_and_the_first_one_to_the_right_of_the_front() -> None:
    s = EPUCK.infrared
    looks = np.asarray(ahead(jnp.asarray(s.angles))).T
    stands = np.stack([s.forward, s.left], -1)
    # the directions of those at the back differ from it by 30 degrees
    assert (np.sum(looks * stands, 1) / np.linalg.norm(stands, axis=1) > 0.7).all()
    assert s.left[0] < 0 < s.left[-1] and looks[0, 0] > 0.9 and looks[0, 1] < 0
    assert (np.linalg.norm(stands, axis=1) < EPUCK.radius).all(), (
        "they lie inside the body, so that a wall is never behind them"
    )


def test_front_sensors_measure_the_distance_of_a_wall_divided_by_reflection() -> None:
    wall = jnp.asarray([(0.10, -1.0, 0.2, 1.0)]), jnp.ones(1, bool)
    seen = np.asarray(distances(EPUCK.infrared, jnp.zeros(2), jnp.asarray(0.0), *wall, jnp.asarray(0.5)))
    by_hand = (0.10 - 0.030) / np.cos(EPUCK.infrared.angles[0]) / 0.5
    np.testing.assert_allclose(seen[[0, 7]], by_hand, rtol=5e-3)
    assert (seen[[2, 3, 4, 5]] > 10 * 0.07).all()
    turned = np.asarray(
        distances(EPUCK.infrared, jnp.zeros(2), jnp.asarray(np.pi / 2), *wall, jnp.asarray(0.5))
    )
    assert turned.argmin() == 2, "turned to the left it has the wall on its right"


def test_readings_follow_the_table_with_noise_that_grows_with_distance() -> None:
    s = EPUCK.infrared
    at = jnp.asarray(s.distances)
    np.testing.assert_allclose(readings(s, at, jnp.zeros(len(at))), s.readings, rtol=1e-6)
    np.testing.assert_allclose(readings(s, jnp.asarray([0.015]), jnp.zeros(1)), [(2211 + 676) / 2], rtol=1e-6)
    np.testing.assert_allclose(readings(s, jnp.asarray([1.0]), jnp.zeros(1)), [34], rtol=1e-6)
    np.testing.assert_allclose(
        readings(s, at, jnp.ones(len(at))), np.asarray(s.readings) * (1 + np.asarray(s.noise)), rtol=1e-6
    )
    assert (np.asarray(readings(s, at, jnp.full(len(at), -9.0))) >= 0).all()


def test_without_obstacles_every_sensor_reads_the_last_entry_of_the_table() -> None:
    seen = distances(EPUCK.infrared, jnp.zeros(2), jnp.asarray(0.4), *NOTHING, jnp.asarray(0.6))
    np.testing.assert_allclose(readings(EPUCK.infrared, seen, jnp.zeros(8)), 34, rtol=1e-6)


def test_the_khepera_has_the_published_wheels() -> None:
    distance, _ = drive(KHEPERA, jnp.asarray(0.0), jnp.asarray([1200.0, 1200.0]))
    np.testing.assert_allclose(distance, [0.1, 0], atol=1e-6)
    _, turn = drive(KHEPERA, jnp.asarray(0.0), jnp.asarray([-12.0, 12.0]))
    np.testing.assert_allclose(turn, 2 / 53, rtol=1e-5)


def test_infrared_sensors_of_the_khepera_state_distances_up_to_their_range() -> None:
    s = KHEPERA.infrared
    at = jnp.asarray([0.0, 0.0123, 0.05, 0.0999, 0.1001, 0.3])
    np.testing.assert_allclose(
        readings(s, at, jnp.zeros(6)), [0, 12.3, 50, 99.9, 10_000, 10_000], rtol=1e-4, atol=1e-4
    )
    noisy = readings(s, jnp.full(20_000, 0.06), jnp.asarray(np.random.default_rng(1).normal(size=20_000)))
    np.testing.assert_allclose([np.mean(noisy), np.std(noisy)], [60, 3], rtol=0.02)
    assert (readings(s, jnp.full(5, 0.2), jnp.full(5, -3.0)) == 10_000).all(), "no noise where nothing is"


@pytest.mark.parametrize(("sensor", "degrees"), [*enumerate([-90, -45, -9, 11, 45, 90])])
def test_each_infrared_sensor_of_the_khepera_looks_where_the_paper_says(sensor: int, degrees: float) -> None:
    """A small block stands 4 cm from the rim, at an angle that is positive to the right."""
    angle = np.radians(0.7 - degrees)  # the robot faces 0.7 degrees to the left of x
    x, y = (0.0275 + 0.04 + 0.002) * np.cos(angle), (0.0275 + 0.04 + 0.002) * np.sin(angle)
    box = jnp.asarray([[x - 0.002, y - 0.002, x + 0.002, y + 0.002]])
    seen = readings(
        KHEPERA.infrared,
        distances(
            KHEPERA.infrared,
            jnp.zeros(2),
            jnp.asarray(np.radians(0.7)),
            box,
            jnp.ones(1, bool),
            jnp.asarray(0.6),
        ),
        jnp.zeros(6),
    )
    assert seen[sensor] == pytest.approx(40, abs=1.0)
    assert (np.delete(np.asarray(seen), sensor) == 10_000).all()
