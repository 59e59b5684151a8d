"""Runs and courses that are constructed, so that what they show is known."""

from __future__ import annotations

import numpy as np

from deodar_papers.saliency.scenes import Cue, Outcome
from deodar_papers.story.field_moments import FieldThresholds
from deodar_papers.story.one_field import FieldRun
from deodar_papers.story.photograph import CueCourse

THRESHOLDS = FieldThresholds((4.092, 0.012), (-0.826, 0.003))

COUNT, AGAIN, GO, GONE, FALLS = 100, 40, 60, 70, 80


def field_run(*peaks: tuple[int, int, int]) -> FieldRun:
    """Return a run of 100 samples: one input at samples 10 to 38, two at 42 to 59, a lowered field from 80.

    Args:
        peaks: position, first sample and sample after the last one.
    """
    activation = np.full((COUNT, 101), -5.0)
    for place, begin, end in peaks:
        activation[begin:end, place - 3 : place + 4] = 6.0
    inputs = np.zeros((COUNT, 101))
    inputs[10:39, 50] = 4.6
    inputs[42:GO, [28, 72]] = 5.0
    inputs[GO:GONE, [28, 72]] = np.linspace(4.9, 0.1, GONE - GO)[:, None]
    lowered = np.zeros(COUNT)
    lowered[FALLS:95] = -1.5
    return FieldRun(activation, inputs, lowered, AGAIN)


def course(
    name: str, target: str, *peaks: tuple[float, float], right: bool, arrives: bool = True
) -> CueCourse:
    """Return a course of 71 samples with peaks that appear at sample 33 and stay.

    Args:
        name: the colour, and
        target: what has it; "" for nothing.
        peaks: positions of the spatial field in units of the scene.
        right: whether the marks are met.
        arrives: whether the motor variable ends at the peak, or stays without one.
    """
    outline = ((0.0, 0.0), (1e3, 0.0), (1e3, 1e3), (0.0, 1e3))
    cue = Cue(5.0, name, "present" if target else "absent", target, (outline,) if right else ())
    gap = None if not peaks else 0.1 if arrives else 9.0
    moved = 20.0 if peaks or not arrives else 0.0
    outcome = Outcome(cue, peaks, peaks, peaks, (40.0, 40.0), gap, moved)
    spatial, colour = np.full((71, 40, 40), -5.0), np.full((71, 30), -3.0)
    motor = np.full((71, 2), 40.0)
    colour[12:, 3:6] = 5.0
    for x, y in peaks:
        spatial[33:, round(x / 2) - 2 : round(x / 2) + 2, round(y / 2) - 2 : round(y / 2) + 2] = 6.0
        motor[35:] = x, y
    appears, turns = (33, 35) if peaks else (None, None)
    return CueCourse(name, target, outcome, 10, appears, turns, 40, spatial, colour, motor)
