"""Sections of arrays against NumPy's indices."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar_studio.live.section import Section
from deodar_studio.live.trace import CAPACITY, Trace, TraceRequest, capacity, extremes, farthest

X, Y, Z = (dd.Axis(name, 0, 10, samples=n) for name, n in zip("xyz", (4, 5, 6), strict=True))
HUE = dd.Axis("hue", 0, 360, samples=8, periodic=True)
AXES = (X, Y, Z, HUE)
ARRAY = np.random.default_rng(0).normal(size=(4, 5, 6, 8))


@pytest.mark.parametrize(
    ("section", "expected"),
    [
        (Section(), ARRAY.max(axis=(2, 3))),
        (Section(("z", "x")), ARRAY.max(axis=(1, 3)).T),
        (Section(("hue",)), ARRAY.max(axis=(0, 1, 2))),
        (Section(("y", "z"), (("x", 10.0), ("hue", 90.0))), ARRAY[3, :, :, 2]),
        (Section((), (("z", 2.1),)), ARRAY[:, :, 1].max(axis=-1)),
        (Section(("x",), (("hue", -500.0),), most=1), ARRAY[..., 0].max(axis=(1, 2))),
    ],
)
def test_a_section_cuts_at_positions_and_takes_the_maximum_over_the_rest(
    section: Section, expected: np.ndarray
) -> None:
    assert np.array_equal(section.take(ARRAY, AXES), expected)
    assert section.take(ARRAY, AXES).shape == tuple(a.samples for a in section.split(AXES)[0])


def test_a_section_names_the_axes_that_are_drawn_and_those_with_a_maximum() -> None:
    section = Section(("z", "x"), (("y", 3.0), ("x", 5.0)))
    assert section.split(AXES) == ((Z, X), (Y, HUE))
    assert section.folded(AXES) == (HUE,)


def test_axes_of_the_same_name_are_drawn_and_cut_apart() -> None:
    weights = ARRAY[:, :4, 0, 0]
    assert [a.name for a in Section().split((X, X))[0]] == ["x", "x 2"]
    assert np.array_equal(Section(("x 2",), (("x", 10.0),)).take(weights, (X, X)), weights[3])
    assert [a.name for a in Section(("x 2",)).folded((X, X))] == ["x"]


def test_a_section_ignores_axes_that_the_array_does_not_have() -> None:
    assert Section(("lost", "y", "y"), (("gone", 1.0),)).split((X, Y)) == ((Y,), (X,))
    assert Section(("lost",)).split((X, Y)) == ((X, Y), ())
    assert Section(("x",)).take(np.array(3.0), ()) == 3.0


def test_a_time_course_of_rows_keeps_the_newest_within_its_memory() -> None:
    request = TraceRequest(("u", "activation"), section=Section(("y",), (("x", 0.0),), most=1))
    trace = Trace()
    for k in range(3):
        number = request.value(np.full((4, 5), float(k)) + np.arange(5), (X, Y))
        trace.add(10.0 * k, number)
    assert trace.width == 5
    assert trace.since(1).tolist() == [[10, 1, 2, 3, 4, 5], [20, 2, 3, 4, 5, 6]]
    assert capacity(1) == capacity(5) == CAPACITY and capacity(10**9) == 2
    assert capacity(4096) * 4096 * 8 == 16 * 2**20


def test_rows_of_another_length_replace_those_before() -> None:
    trace = Trace()
    for k in range(4):
        trace.add(k, np.zeros(5))
    trace.add(4, np.ones(3))
    assert trace.count == 5
    assert trace.since(0).tolist() == [[4, 1, 1, 1]]


def test_a_thinned_time_course_keeps_every_extreme_in_parts_as_in_one_piece() -> None:
    values = np.random.default_rng(1).normal(size=103)
    values[[41, 77]] = 50.0, -50.0
    whole = extremes(values, 0, 10)
    assert {41, 77} <= set(whole.tolist()) and len(whole) <= 2 * 11
    assert sorted(values[whole])[0] == values.min() and sorted(values[whole])[-1] == values.max()
    # parts that begin at multiples of the interval
    parts = [first + extremes(values[first:last], first, 10) for first, last in ((0, 40), (40, 103))]
    assert np.array_equal(np.concatenate(parts), whole)
    # an interval that lies in two parts keeps the extremes of both
    cut = np.concatenate(
        [first + extremes(values[first:last], first, 10) for first, last in ((0, 45), (45, 103))]
    )
    assert set(whole.tolist()) <= set(cut.tolist())
    assert extremes(np.array([0.0, 1.0, 2.0, 9.0]), 8, 10).tolist() == [0, 1, 2, 3], "two intervals"
    assert np.array_equal(extremes(values, 0, 1), np.arange(103)), "a short course is kept whole"
    values[50:60] = np.nan
    values[77] = np.nan
    assert {41, 50} <= set(extremes(values, 0, 10).tolist()) and 77 not in extremes(values, 0, 10)


def test_thinned_rows_keep_a_peak_and_a_trough_of_one_sample_in_parts_as_in_one_piece() -> None:
    rows = np.random.default_rng(1).normal(size=(103, 3))
    rows[41, 0], rows[77, 1], rows[5, 2] = 50.0, -50.0, np.nan
    times = np.arange(103.0)

    def thinned(*cuts: int) -> tuple[list[float], np.ndarray]:
        ends = zip((0, *cuts), (*cuts, 103), strict=True)
        parts = list(farthest(((times[a:b], rows[a:b]) for a, b in ends), 10, 0.0))
        return [t for part, _ in parts for t in part], np.stack([r for _, part in parts for r in part])

    whole_times, whole = thinned()
    assert whole_times == list(range(0, 103, 10))
    assert whole[4, 0] == 50 and whole[7, 1] == -50 and np.isfinite(whole).all()
    distances = [np.nanmax(np.abs(rows[k : k + 10]), axis=0) for k in range(0, 103, 10)]
    assert np.array_equal(np.abs(whole), distances)
    for cuts in ((40,), (45,), (3, 4, 5, 60, 61), tuple(range(1, 103))):
        cut_times, cut = thinned(*cuts)
        assert cut_times == whole_times and np.array_equal(cut, whole)


def test_a_section_of_frames_over_time_is_the_section_of_each() -> None:
    axes = (dd.Axis("x", 0, 1, 3), dd.Axis("y", 0, 1, 4), dd.Axis("z", 0, 1, 5))
    frames = np.random.default_rng(2).normal(size=(6, 3, 4, 5))
    for section in (Section(("y",), most=1), Section(("z", "x")), Section(("y",), (("x", 0.9),), 1)):
        each = np.stack([section.take(frame, axes) for frame in frames])
        assert np.array_equal(section.take(frames, axes), each)
