"""Runs of the planner through a maze of the user."""

from __future__ import annotations

import pytest

from deodar.architectures.spa import maze
from deodar.errors import WorldError
from deodar_papers.spa.narrative import drive


def test_a_maze_without_a_goal_is_refused_with_what_to_type() -> None:
    arena = maze("large")
    arena.goals = None
    with pytest.raises(WorldError, match="the maze has no goal") as refused:
        drive(arena)
    [problem] = refused.value.problems
    assert problem.fix.at("shell") == "Give one, in cm: --goal X Y"
    assert problem.fix.at("script") == "Give one, in cm: goal=(X, Y)"
