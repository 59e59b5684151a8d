"""Scenes keep their ranges, have matches and others, and those of tests are other than those of tuning."""

from __future__ import annotations

import colorsys

import pytest

from deodar_papers.pointing import scenes
from deodar_papers.pointing.scenes import BAND, BEYOND, SERVED, TEST, TUNING, Range, equal_pair, scene


@pytest.mark.parametrize(("first", "served"), [(TUNING, SERVED), (TEST, SERVED), (BAND, BEYOND)])
def test_objects_keep_the_ranges_and_distances(first: int, served: Range):
    for seed in range(first, first + 60):
        drawn = scene(seed, served=served)
        assert scenes.FEWEST <= len(drawn) <= scenes.MOST
        assert len({d.name for d in drawn}) == len(drawn)
        if len(drawn) >= 4:
            assert len({d.colour for d in drawn}) >= 4
        for k, d in enumerate(drawn):
            assert served.radius[0] <= d.radius <= served.radius[1]
            assert served.saturation[0] <= d.saturation <= served.saturation[1]
            assert served.midline[0] <= abs(d.x) <= served.midline[1] and 0.06 <= d.y <= 0.54
            assert abs((d.hue - scenes.HUES[d.colour] + 180) % 360 - 180) <= scenes.SPREAD
            assert d.side == ("left" if d.x < 0 else "right")
            assert colorsys.rgb_to_hsv(*d.rgb)[1] == pytest.approx(d.saturation)
            for other in drawn[:k]:
                assert d.distance(other.x, other.y) > d.radius + other.radius + 0.05


def test_a_seed_is_one_scene_and_no_test_scene_is_a_tuning_scene():
    assert scene(3) == scene(3) != scene(4)
    tuned = {tuple(scene(seed)) for seed in range(TUNING, TUNING + 200)}
    tested = {tuple(scene(seed)) for seed in range(TEST, TEST + 200)}
    assert len(tuned) == len(tested) == 200 and not tuned & tested


def test_wanted_objects_are_the_first_and_alone_of_their_kind():
    for seed in range(40):
        first, *others = scene(seed, [("green", "left")], 4, alone=True)
        assert (first.colour, first.side) == ("green", "left")
        assert all((d.colour, d.side) != ("green", "left") for d in others)
        a, b, *_ = equal_pair(seed, "red", "right")
        assert (a.hue, a.radius, a.saturation, a.value) == (b.hue, b.radius, 0.99, b.value)
        assert a.side == b.side == "right" and a.distance(b.x, b.y) > 2 * a.radius + 0.05
