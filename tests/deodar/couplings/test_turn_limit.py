"""A turn that is too fast slows both wheels and keeps the radius."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar.couplings.steering import TurnLimit
from deodar.elements.stimuli import Boost


@pytest.mark.parametrize(
    ("left", "right", "share"),
    [(0.5, 0.5, 1.0), (0.9, 0.1, 1.0), (1.2, -0.8, 0.4), (-0.6, 0.6, 2 / 3), (0.0, 0.0, 1.0)],
)
def test_the_speeds_of_both_wheels_have_the_same_factor(left: float, right: float, share: float) -> None:
    model = dd.Model("wheels")
    wheels = model.add(TurnLimit(speed=500.0, limit=400.0, name="wheels"))
    for side, value in (("left", left), ("right", right)):
        model.add(Boost(side, [], value)) >> wheels[side]
    record = dd.simulate(model, 1, record=["wheels.to_left", "wheels.to_right"])
    got = [float(record[f"wheels.to_{side}"][-1]) for side in ("left", "right")]
    assert got == pytest.approx([500 * left * share, 500 * right * share], rel=1e-5)
    assert abs(got[0] - got[1]) <= 400.01
