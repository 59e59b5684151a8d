"""The ring of published states: what it covers, what it stores, and how it is thinned."""

from __future__ import annotations

import numpy as np
import pytest

from deodar.worlds._scene import Scene, SceneBody, SceneBox
from deodar_studio.live.published import PublishedState
from deodar_studio.live.ring import PAUSE, StateRing

PLACE = ("u", "activation")


def state(tick: int, values: np.ndarray | None = None, **options: object) -> PublishedState:
    array = np.full(100, float(tick)) if values is None else values
    return PublishedState(tick + 1, float(10 * tick), tick, {PLACE: array}, **options)  # type: ignore[arg-type]


def filled(ring: StateRing, states: int, apart: float = 0.02, start: float = 0.0) -> StateRing:
    for k in range(states):
        ring.add(state(k), start + k * apart)
    return ring


def shown(ring: StateRing, time: float, further: int = 0) -> float:
    state_at = ring.at(time, further)
    assert state_at is not None
    return state_at[1].time


def test_an_empty_ring_has_no_moments() -> None:
    ring = StateRing()
    assert ring.span() is None and ring.at(0.0) is None and ring.nbytes == 0


def test_the_moment_up_to_a_time_is_found_with_its_values() -> None:
    ring = filled(StateRing(), 10)
    assert [shown(ring, t) for t in (-5, 0, 9, 10, 55, 1e9, float("inf"))] == [0, 0, 0, 10, 50, 90, 90]
    assert [shown(ring, 50, n) for n in (-9, -1, 1, 2, 99)] == [0, 40, 60, 70, 90]
    number, state_at = ring.at(55) or (-1, state(0))
    assert number == 5 and state_at.tick == 5
    assert np.array_equal(state_at.arrays[PLACE], np.full(100, 5.0))


def test_states_older_than_the_covered_wall_time_are_removed() -> None:
    ring = filled(StateRing(seconds=1.0), 200)
    span = ring.span()
    assert span is not None
    assert (span.first, span.last, span.frames) == (1490, 1990, 51)
    assert span.full_from == span.first, "nothing within the covered time was removed"


def test_a_ring_up_to_a_tick_has_the_earlier_states_only() -> None:
    ring = filled(StateRing(), 10)
    short = ring.until(4)
    span, whole = short.span(), ring.span()
    assert span is not None and whole is not None
    assert (span.last, span.frames, whole.frames) == (40, 5, 10)
    assert 0 < short.nbytes < ring.nbytes and shown(short, 1e9) == 40
    short.add(state(5, np.full(100, 3.0)), 100.0)
    assert shown(ring, 50) == shown(short, 50) == 50
    state_at = ring.at(50)
    assert state_at is not None and state_at[1].arrays[PLACE][0] == 5, "the first ring has not changed"


def test_a_pause_does_not_count_as_running() -> None:
    ring = filled(StateRing(seconds=2.0), 51)
    ring.add(state(51), 3600.0)
    span = ring.span()
    assert span is not None and span.first == 0 and 1.0 + PAUSE < 2.0


def test_a_state_without_a_step_replaces_the_last_one() -> None:
    ring = filled(StateRing(), 3)
    before = ring.nbytes
    ring.add(state(2, np.full(100, 77.0)), 0.05)
    span = ring.span()
    assert span is not None and span.frames == 3 and ring.nbytes == before
    state_at = ring.at(20)
    assert state_at is not None and state_at[1].arrays[PLACE][0] == 77


def test_arrays_are_copied_in_single_precision_and_equal_ones_are_stored_once() -> None:
    ring, values = StateRing(), np.linspace(0, 1, 100)
    for tick in range(5):
        ring.add(state(tick, values), tick * 0.02)
    assert ring.nbytes == 400
    state_at = ring.at(0)
    values[:] = -1
    assert state_at is not None and state_at[1].arrays[PLACE].dtype == np.float32
    assert state_at[1].arrays[PLACE][-1] == 1
    ring.add(state(5, values), 0.1)
    assert ring.nbytes == 800


def test_the_memory_is_bounded_and_older_moments_are_thinned_more() -> None:
    most = 400 * 400
    ring = filled(StateRing(most=most), 2000)
    span = ring.span()
    assert span is not None and ring.nbytes <= most
    assert span.frames == 400, "the memory is used"
    assert (span.first, span.last) == (0, 19990), "the whole time remains covered"
    times = np.array([shown(ring, 0, k) for k in range(400)])
    gaps = np.diff(times)
    assert gaps[-20:].max() == 10, "the newest moments are complete"
    old, middle = gaps[times[1:] < 5000].mean(), gaps[(times[1:] > 12000) & (times[1:] < 17000)].mean()
    assert old > 1.5 * middle > 15
    assert 0 < span.full_from < 19990
    assert gaps[times[1:] > span.full_from].max() == 10 < gaps[times[1:] <= span.full_from].max()


def test_a_state_larger_than_the_limit_is_not_stored() -> None:
    ring = filled(StateRing(most=100), 3)
    assert ring.span() is None and ring.nbytes == 0


@pytest.mark.parametrize("nan", [0.0, np.nan])
def test_removed_states_release_their_memory(nan: float) -> None:
    ring = StateRing(seconds=0.1)
    for k in range(100):
        ring.add(state(k, np.full(100, nan if k % 2 else float(k))), k * 0.02)
    span = ring.span()
    assert span is not None and span.frames == 6 and ring.nbytes == 6 * 400


def test_boxes_that_do_not_move_are_stored_once() -> None:
    def scene(x: float) -> Scene:
        box = SceneBox("wall", (1.0, 1.0), (0.1, 0.1), (0, 0, 0))
        return Scene("m", (0, 0, 3, 2), (box,), (), (SceneBody("robot", (x, 0.0), 0.0, 0.1),))

    ring = StateRing()
    for k in range(2):
        ring.add(state(k, scene=scene(float(k)), passed=k), 0.02 * k)
    first, second = (ring.at(10.0 * k) for k in range(2))
    assert first is not None and second is not None
    assert first[1].scene is not None and second[1].scene is not None
    assert first[1].scene.boxes is second[1].scene.boxes
    assert [state_at[1].scene.bodies[0].center[0] for state_at in (first, second) if state_at[1].scene] == [
        0,
        1,
    ]
