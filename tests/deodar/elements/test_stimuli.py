"""Warnings about the place and the width of a stimulus, which lie on the edges of what is useful."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar.elements.stimuli import BoxStimulus

LINE, RING = dd.Axis("x", 0, 40, 21), dd.Axis("phi", 0, 360, 36, periodic=True)


def warned(stimulus: dd.GaussianStimulus | BoxStimulus) -> list[str]:
    model = dd.Model("stimulus")
    model.add(stimulus)
    texts = [problem.what for problem in model.check()]
    words = ("smaller than the step", "larger than the axis", "lies outside the axis")
    return [word for word in words if any(word in text for text in texts)]


@pytest.mark.parametrize(
    ("width", "expected"), [(1.99, ["smaller than the step"]), (2.0, []), (3.0, []), (90.0, [])]
)
def test_a_box_is_at_least_as_wide_as_a_step(width: float, expected: list[str]) -> None:
    assert warned(BoxStimulus("s", [LINE], center=20, width=width)) == expected


@pytest.mark.parametrize(
    ("sigma", "expected"),
    [
        (0.99, ["smaller than the step"]),
        (1.0, []),
        (1.5, []),
        (40.0, []),
        (40.1, ["larger than the axis"]),
    ],
)
def test_sigma_is_at_least_half_a_step_and_at_most_the_axis(sigma: float, expected: list[str]) -> None:
    assert warned(dd.GaussianStimulus("s", [LINE], center=20, sigma=sigma)) == expected


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_center_may_lie_as_far_outside_as_the_stimulus_reaches(mirrored: bool) -> None:
    def at(center: float) -> float:
        return 40 - center if mirrored else center

    for inside, outside, make in (
        (44.9, 45.1, lambda center: BoxStimulus("s", [LINE], center=center, width=8)),
        (46.9, 47.1, lambda center: dd.GaussianStimulus("s", [LINE], center=center, sigma=2)),
    ):
        assert warned(make(at(inside))) == []
        assert warned(make(at(outside))) == ["lies outside the axis"]
    assert warned(dd.GaussianStimulus("s", [RING], center=at(900), sigma=30)) == []
