"""The plan on a line: its wave, its execution, and another plan."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.architectures.corridor_plan import START, corridor, plan
from deodar.elements.stimuli import BoxStimulus

X = corridor().points


def fronts(motivation: np.ndarray) -> np.ndarray:
    """Return for each time the rightmost position at which a motivation is above threshold."""
    return np.array([X[u > 0].max() if (u > 0).any() else np.nan for u in motivation])


def test_a_wave_of_constant_speed_spreads_from_the_goal() -> None:
    record = dd.simulate(
        plan(start=185.0, goals=[(40.0, (0.0, 1e6))]), 180, record="left.motivation.activation"
    )
    front = fronts(record["left.motivation.activation"].values)
    t = np.flatnonzero((front > 55) & (front < 165))
    speed, start = np.polyfit(t, front[t], 1)
    assert len(t) > 100 and 0.6 < speed < 0.85
    assert np.abs(front[t] - (speed * t + start)).max() < 3.0, "a step of the behaviour is 5 cm"


def test_the_walker_starts_when_the_wave_arrives_and_follows_a_new_goal() -> None:
    names = [
        "gone.activation",
        "left.strongest.output",
        "right.strongest.output",
        "left.motivation.activation",
    ]
    record = dd.simulate(plan(), 1200, record=names, trials=[3]).isel(trial=0)
    where, front = (
        START + record["gone.activation"].values,
        fronts(record["left.motivation.activation"].values),
    )
    left, right = (record[f"{side}.strongest.output"].values > 0.5 for side in ("left", "right"))
    began, reached = np.argmax(left & (np.arange(len(left)) > 40)), np.argmax(front >= START)
    assert -10 < began - reached < 25, "neither before the wave is there nor long after it"
    assert where[: began - 5].min() > START - 1
    assert 34 < where[430] < 46 and not left[400:440].any(), "it is at the goal without an intention"
    return_at = 450 + np.argmax(right[450:])
    assert return_at - 450 > (150 - where[450]) / 0.85, "the second wave has to come, too"
    assert where[-1] == pytest.approx(150, abs=7)
    assert left[450:].sum() < 5 and right[:450].sum() < 5


def test_a_wall_stops_the_wave() -> None:
    model = plan(start=150.0, goals=[(40.0, (0.0, 1e6))])
    wall = model.add(BoxStimulus("wall", [corridor()], center=90, width=20, amplitude=-15))
    for side in ("left", "right"):
        wall >> model[f"{side}.motivation"]
    record = dd.simulate(model, 500, record=["left.motivation.activation", "gone.activation"], every=10)
    motivation = record["left.motivation.activation"].values
    assert motivation[:, X > 95].max() < 0 < motivation[-1, X < 80].max()
    assert abs(record["gone.activation"].values).max() < 1
