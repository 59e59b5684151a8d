"""The figure of looking: names of curves that end at the same height do not cover each other."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np

from deodar_papers.figures.looking import Course, LearnedMap, LearningCurve, looking_figure


def test_names_of_curves_that_end_together_are_apart() -> None:
    curves = [
        LearningCurve(name, (10, 20), (0.0, end), ((0.0, 0.1), (0.0, 0.1)))
        for name, end in (("no reward", 0.04), ("no memory", 0.03), ("paper", 0.5))
    ]
    course = Course("gazes", 0.01, np.zeros((5, 6)))
    learned = LearnedMap(np.zeros((25, 32)), np.zeros((25, 32)), np.zeros((32, 32, 2)))
    figure = looking_figure(curves, (course, course), learned)
    heights = {text.get_text(): text.xy[1] for text in figure.findobj(plt.Annotation)}
    assert heights["no reward"] - heights["no memory"] >= 0.07
    assert (heights["no memory"], heights["paper"]) == (0.03, 0.5), "the lowest one and free ones stay"
