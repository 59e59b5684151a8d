"""A vehicle that is carried: it is at its new place after the next period, and drives on from there."""

from __future__ import annotations

import math

import numpy as np
import pytest

import deodar as dd
from deodar.errors import WorldError
from tests.deodar.experiments.calls import run_alone, run_together


def model() -> dd.Model:
    m = dd.Model("wheels", dt=20)
    for side in ("left", "right"):
        m.add(dd.Boost(f"speed {side}", [], 600.0)) >> m.add(dd.Motor(side, motor=side))
    m.add(dd.Sensor("pose", [dd.Axis("of", 0, 2, 3)], sensor="pose"))
    return m


def arena(**options: object) -> dd.Arena:
    layout = {
        "unit": "mm",
        "arena": {"x": [-500, 500], "y": [-500, 500]},
        "blocks": [{"name": "block", "center": [300, 300], "size": [50, 50]}],
    }
    return dd.Arena(
        layout, (0, 0, 0), unit="mm", vehicle="khepera", physics=dd.ArenaPhysics(period=20), **options
    )  # type: ignore[arg-type]


CARRIED = [dd.Move(200.0, "khepera", (-100.0, 50.0, math.pi / 2)), dd.Move(400.0, "khepera", (0.0, 0.0))]


def test_it_is_there_after_the_next_period_with_its_new_heading() -> None:
    trial = run_alone(model(), 600.0, arena(), watch=["pose.output"], actions=CARRIED)
    pose = trial.values["pose.output"]
    assert pose[10] == pytest.approx([9 * 1.0, 0, 0], abs=1.5)  # 600 pulses a second are 50 mm/s
    assert pose[11] == pytest.approx([-100, 50, math.pi / 2], abs=1e-3)
    assert pose[20] == pytest.approx([-100, 59, math.pi / 2], abs=0.1)
    assert pose[21] == pytest.approx([0, 0, math.pi / 2], abs=1e-3)  # two numbers keep the heading
    assert pose[-1, 1] == pytest.approx(9.0, abs=0.1)


def test_a_batch_carries_the_vehicle_of_each_trial() -> None:
    trials = run_together(model(), 600.0, [0, 1], ["pose.output"], world=arena(), actions=CARRIED)
    alone = run_alone(model(), 600.0, arena(), watch=["pose.output"], actions=CARRIED)
    for trial in trials:
        np.testing.assert_allclose(trial.values["pose.output"], alone.values["pose.output"], atol=1e-3)


def test_a_second_trial_starts_at_the_start() -> None:
    world = arena()
    first = run_alone(model(), 600.0, world, watch=["pose.output"], actions=CARRIED)
    trial = run_alone(model(), 600.0, world, watch=["pose.output"], actions=CARRIED)
    np.testing.assert_array_equal(first.values["pose.output"], trial.values["pose.output"])


@pytest.mark.parametrize(("place", "why"), [((300.0, 300.0), "inside 'block'"), ((499.0, 0.0), "outside")])
def test_a_place_where_it_does_not_fit_is_an_error(place: tuple[float, float], why: str) -> None:
    with pytest.raises(WorldError, match=why):
        arena().carry(place)
