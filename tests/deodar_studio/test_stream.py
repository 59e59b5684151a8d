"""What a stream shows of an array: which arrays are pictures, and how it is thinned."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import deodar as dd
from deodar.worlds.picture import Picture
from deodar_studio.live.published import PublishedState
from deodar_studio.live.section import Section
from deodar_studio.live.trace import Trace, TraceRequest
from deodar_studio.messages.to_page import Announced
from deodar_studio.streams import stream
from tests.deodar_studio.page import unpacked

X, Y, Z, W = (dd.Axis(name, 0, 10, samples=n) for name, n in zip("xyzw", (4, 5, 6, 3), strict=True))
CHANNEL = Picture.example_axes("picture")[2]


@pytest.mark.parametrize(
    ("axes", "picture"),
    [
        ((), False),
        ((X,), False),
        ((X, Y), False),
        ((X, Y, CHANNEL), True),
        ((X, Y, Z), False),
        ((X, Y, W), False),
        ((X, CHANNEL, Y), False),
        ((X, Y, Z, CHANNEL), False),
    ],
)
def test_three_channels_as_the_third_axis_make_a_picture_and_a_section_has_at_most_two_axes(
    axes: tuple[dd.Axis, ...], picture: bool
) -> None:
    array = np.random.default_rng(0).normal(size=tuple(a.samples for a in axes))
    assert stream.is_picture(axes) == picture
    shown = Section().take(array, axes)
    if len(axes) <= 2:
        assert np.array_equal(shown, array)
    else:
        assert np.array_equal(shown, array.reshape(*array.shape[:2], -1).max(axis=-1))


@pytest.mark.parametrize(("most", "expected"), [(0, 9), (1, 2), (2, 2), (5, 5), (9, 9), (20, 9)])
def test_a_picture_is_thinned_to_means_of_its_cells(most: int, expected: int) -> None:
    array = np.add.outer(np.arange(9) * 10.0, np.arange(3.0))
    thin = stream.thin(array, most, channels=True)
    assert thin.shape == (expected, 3)
    starts = np.arange(expected) * 9 // expected
    means = [part.mean(axis=0) for part in np.split(array, starts[1:])]
    assert np.allclose(thin, means)


@pytest.mark.parametrize("most", [1, 2, 3, 64, 999])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_peak_or_trough_of_one_sample_remains_wherever_it_is(most: int, sign: int) -> None:
    resting = np.full(10_000, -5.0)
    for place in (0, 1, 4_999, 5_003, 9_999):
        array = resting.copy()
        array[place] += 8.0 * sign
        thin = stream.thin(array, most, channels=False)
        assert thin.shape == (2 * (max(2, most) // 2),)
        extreme = thin.max() if sign > 0 else thin.min()
        assert extreme == array[place]
        shown = int(np.abs(thin + 5.0).argmax()) / len(thin)
        assert abs(shown - place / 10_000) <= 2 / len(thin)


def test_minimum_and_maximum_of_a_bin_keep_their_order() -> None:
    rising = np.arange(100.0)
    assert np.array_equal(stream.thin(rising, 10, channels=False), [0, 19, 20, 39, 40, 59, 60, 79, 80, 99])
    assert np.array_equal(stream.thin(-rising, 4, channels=False), [0, -49, -50, -99])


@pytest.mark.parametrize("sign", [1, -1])
def test_a_peak_or_trough_of_one_sample_of_a_plane_remains(sign: int) -> None:
    random = np.random.default_rng(0)
    for x, y in [(0, 0), (299, 199), (37, 151)]:
        array = random.normal(-5, 0.1, (300, 200))
        array[x, y] = -5 + 8.0 * sign
        thin = stream.thin(array, 64, channels=False)
        assert thin.shape == (64, 64)
        assert thin[((x + 1) * 64 - 1) // 300, ((y + 1) * 64 - 1) // 200] == array[x, y]
        assert np.abs(thin + 5).max() == 8.0


def test_places_without_a_value_hide_no_others() -> None:
    array = np.full(1000, np.nan)
    array[501] = 1.0
    assert np.nanmax(stream.thin(array, 10, channels=False)) == 1.0
    plane = np.full((100, 100), np.nan)
    plane[50, 50] = 1.0
    thin = stream.thin(plane, 10, channels=False)
    assert thin[5, 5] == 1.0 and np.isnan(thin).sum() == 99


def test_thinned_rows_keep_a_narrow_peak_at_each_time() -> None:
    rows = np.full((3, 100), -5.0)
    for k in range(3):
        rows[k, 10 + 30 * k] = 4
    assert stream.thin_rows(rows, 0) is rows
    thin = stream.thin_rows(rows, 20)
    assert thin.shape == (3, 20)
    assert thin.argmax(axis=1).tolist() == [2, 8, 14] and thin.max(axis=1).tolist() == [4, 4, 4]


@pytest.mark.parametrize(
    ("section", "width"), [(None, 1), (Section(("y",), most=1), 5), (Section(("z",), most=1), 6)]
)
def test_a_time_course_has_a_number_at_each_time_or_those_of_a_section(
    section: Section | None, width: int
) -> None:
    place = ("u", "activation")
    source: Any = SimpleNamespace(ready=True, axes=lambda place: (X, Y, Z))
    form = stream.Stream(1, place, request=TraceRequest(place, section=section)).news(source, None)
    assert isinstance(form, Announced) and form.shape == [1 + width]
    assert [axis.samples for axis in form.axes] == ([] if section is None else [width])


def test_samples_that_a_thread_adds_while_a_frame_is_made_are_in_the_next_one() -> None:
    class Growing(Trace):
        """Takes another sample whenever it is read, as the thread of the engine may."""

        def since(self, count: int, end: int | None = None) -> np.ndarray:
            found = super().since(count, end)
            self.add(float(self.count), 0.5)
            return found

    trace, times = Growing(), list[float]()
    course = stream.Stream(7, ("u", "output"), request=TraceRequest(("u", "output")))
    course._said = Announced(stream=7, shape=[2], axes=[], rest=[], folded=[], channels=False)
    for _ in range(3):
        trace.add(float(trace.count), 0.5)
        frame = course.frame(PublishedState(1, 0.0, 0, {}), trace)
        assert frame is not None
        _, _, start, values = unpacked(frame)
        times += (start + values[::2]).tolist()
    assert times == [0, 1, 2, 3, 4], "each sample once; the last one is in the next frame"
