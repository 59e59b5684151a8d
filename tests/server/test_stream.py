"""What a stream shows of an array: planes and pictures are sent as they are, more axes are folded."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.server import stream
from deodar.worlds.picture import Picture

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
def test_axes_beyond_the_second_are_folded_except_the_channels_of_a_picture(
    axes: tuple[dd.Axis, ...], picture: bool
) -> None:
    array = np.random.default_rng(0).normal(size=tuple(a.samples for a in axes))
    assert stream.is_picture(axes) == picture
    shown = stream.fold(array, axes)
    if picture or len(axes) <= 2:
        assert shown is array
    else:
        assert np.array_equal(shown, array.reshape(*array.shape[:2], -1).max(axis=-1))


@pytest.mark.parametrize(("most", "expected"), [(0, 9), (1, 2), (2, 2), (5, 5), (9, 9), (20, 9)])
def test_a_thinned_array_keeps_both_ends_and_every_channel(most: int, expected: int) -> None:
    array = np.add.outer(np.arange(9) * 10.0, np.arange(3.0))
    thin = stream.thin(array, most, channels=True)
    assert thin.shape == (expected, 3)
    assert np.array_equal(thin[[0, -1]], array[[0, -1]])
    steps = np.diff(thin[:, 0])
    assert steps.min() > 0 and steps.max() - steps.min() <= 10
