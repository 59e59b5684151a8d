"""Bifurcation diagrams: lines by stability, marks by kind."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.errors import FigureError
from tests.deodar.analysis.continuation.models import line, node


def test_stable_parts_are_solid_and_meet_unstable_ones_at_the_folds():
    branch = dd.continuation(node(), "s.amplitude", (0, 8))
    axes = dd.bifurcation_diagram(branch).axes[0]
    lines = [drawn for drawn in axes.lines if len(drawn.get_xdata()) > 1]
    assert [drawn.get_linestyle() for drawn in lines] == ["-", "--", "-"]
    up, down = (b.value for b in branch.bifurcations)
    ends = [float(drawn.get_xdata()[k]) for drawn in lines for k in (0, -1)]
    assert ends == pytest.approx([0, up, up, down, down, 8])
    texts = [text.get_text() for text in axes.texts]
    assert texts == ["detection\n3.966", "reverse detection\n0.03363"]
    assert axes.get_xlabel() == "s.amplitude" and axes.get_ylabel() == "highest u.activation"


def test_what_the_grid_makes_is_small_and_open():
    branch = dd.continuation(
        line(excitation=22, inhibition=0.4),
        "boost.amplitude",
        (0, -4),
        induced_by={"s.amplitude": 8},
        even=["x"],
    )
    axes = dd.bifurcation_diagram(branch).axes[0]
    marks = [drawn for drawn in axes.lines if drawn.get_marker() == "o"]
    assert sorted(drawn.get_markerfacecolor() == "white" for drawn in marks) == [False, *[True] * 4]
    assert len(axes.texts) == 1


def test_branches_of_different_parameters_are_not_drawn_together():
    by_input = dd.continuation(node(), "s.amplitude", (0, 3), finer=False)
    by_level = dd.continuation(node(), "u.resting_level", (-5, -4), finer=False)
    with pytest.raises(FigureError, match="have different parameters"):
        dd.bifurcation_diagram(by_input, by_level)
    with pytest.raises(FigureError, match="no branch"):
        dd.bifurcation_diagram()
    assert np.isfinite(dd.bifurcation_diagram(by_level, shown="u.output").axes[0].lines[0].get_ydata()).all()
