"""The pixels of the event camera: their statistics are those that the parameters state."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from deodar.numerics.axes import Axis
from deodar_robots.eye.event_camera import EventCamera, rate

SIZE = 128
KEY = jnp.asarray([3, 7], jnp.uint32)
QUIET = EventCamera(spread=0.0, leak=0.0, shot=0.0)


def exposed(camera: EventCamera, pictures, period: float = 10.0):
    """Return the events (on, off) of each picture after the first one, to which the pixels have adapted."""
    pictures = jnp.asarray(pictures, jnp.float32)
    state = camera.start(pictures[0], KEY)
    step = jax.jit(lambda state, picture, tick: camera.expose(state, picture, period, KEY, tick))
    frames = []
    for tick, picture in enumerate(pictures[1:], 2):
        state = step(state, picture, jnp.uint32(tick))
        frames.append((np.asarray(state["on"]), np.asarray(state["off"])))
    return frames


def steps(*levels: float) -> np.ndarray:
    return np.ones((1, SIZE, SIZE)) * np.asarray(levels)[:, None, None]


def test_a_step_of_log_luminance_sends_an_event_for_each_threshold() -> None:
    (up, down), (up_again, down_again) = exposed(QUIET, steps(0.0, 1.05, 0.0))
    assert np.all(up == 5) and not down.any()  # 1.05 / 0.2 = 5.25
    assert not up_again.any() and np.all(down_again == 5)


def test_the_rest_of_a_step_is_remembered() -> None:
    frames = exposed(QUIET, steps(0.0, 0.15, 0.15, 0.25))
    assert [int(on[0, 0]) for on, _ in frames] == [0, 0, 1]


def test_the_refractory_time_limits_the_events_of_a_period_and_delays_the_others() -> None:
    slow = EventCamera(spread=0.0, leak=0.0, shot=0.0, refractory=4.0)
    frames = exposed(slow, steps(0.0, 1.05, 1.05, 1.05, 1.05))
    assert [int(on[0, 0]) for on, _ in frames] == [2, 2, 1, 0]


def test_shot_noise_has_its_rate_in_equal_parts() -> None:
    noisy = EventCamera(spread=0.0, leak=0.0, shot=2.0)
    frames = exposed(noisy, steps(*[0.0] * 101))
    on, off = (np.sum([f[k] for f in frames]) for k in (0, 1))
    seconds = 100 * 0.01 * SIZE * SIZE
    for count in (on, off):
        assert abs(count - seconds) < 4 * np.sqrt(seconds)


def test_the_leak_causes_on_events_at_its_rate() -> None:
    leaking = EventCamera(spread=0.0, leak=1.0, shot=0.0)
    frames = exposed(leaking, steps(*[0.0] * 101))
    on, off = (np.sum([f[k] for f in frames]) for k in (0, 1))
    assert on == pytest.approx(SIZE * SIZE, rel=0.01) and off == 0
    spread = [f[0].sum() for f in frames]
    assert max(spread) < 3 * np.mean(spread), "the pixels do not leak at the same moment"


def test_thresholds_spread_over_the_pixels() -> None:
    spread = EventCamera(spread=0.05, leak=0.0, shot=0.0)
    state = spread.start(jnp.zeros((SIZE, SIZE), jnp.float32), KEY)
    for name in ("on threshold", "off threshold"):
        thresholds = np.asarray(state[name])
        assert thresholds.mean() == pytest.approx(0.2, rel=0.002)
        assert thresholds.std() == pytest.approx(0.05 * 0.2, rel=0.03)
    correlation = np.corrcoef(np.ravel(state["on threshold"]), np.ravel(state["off threshold"]))[0, 1]
    assert abs(correlation) < 0.03


def test_the_reading_is_a_rate_at_every_sampling() -> None:
    events = np.zeros((SIZE, SIZE), np.float32)
    events[40:48, 80:88] = 3
    for samples in (128, 64, 32, 16):
        edge = SIZE / samples / 2 - 0.5
        axes = tuple(Axis(name, edge, SIZE - 1 - edge, samples) for name in ("column", "row"))
        rates = np.asarray(rate(jnp.asarray(events), axes, 10.0))
        assert rates.shape == (samples, samples)
        assert rates.sum() * axes[0].step ** 2 == pytest.approx(64 * 3 / 0.01)
        assert rates[int(44 / 128 * samples), int(84 / 128 * samples)] == pytest.approx(300, rel=1e-5)


def test_cells_beyond_the_sensor_have_no_events() -> None:
    axes = (Axis("column", -40, -10, 4), Axis("row", 0, 127, 4))
    assert not np.asarray(rate(jnp.ones((SIZE, SIZE)), axes, 10.0)).any()
