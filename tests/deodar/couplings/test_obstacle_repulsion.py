"""An obstacle turns a vehicle away from it, the more the nearer it is."""

from __future__ import annotations

import math

import numpy as np
import pytest

import deodar as dd

ANGLES = [-90.0, -45.0, -9.0, 11.0, 45.0, 90.0]
FAR = 1e4


def force(distances: list[float], **parameters: float) -> float:
    sensor = dd.Axis("sensor", 0, 5, 6)
    model = dd.Model("repulsion")
    model.add(dd.Pattern("distance", [sensor], distances)) >> model.add(  # type: ignore[arg-type]
        dd.ObstacleRepulsion(ANGLES, **parameters, name="force")  # type: ignore[arg-type]
    )
    return float(dd.simulate(model, 1, record="force", precision="float64")["force.output"][-1])


@pytest.mark.parametrize("k", range(6))
@pytest.mark.parametrize("distance", [0.0, 25.0, 80.0])
def test_one_obstacle_repels_as_the_equation_says(k: int, distance: float) -> None:
    distances = [FAR] * 6
    distances[k] = distance
    wide = math.degrees(math.atan(math.tan(math.radians(22.5)) + 100 / (100 + distance)))
    expected = 15 * math.exp(-distance / 30) * math.exp(-(ANGLES[k] ** 2) / (2 * wide**2))
    assert force(distances) == pytest.approx(-math.copysign(expected, ANGLES[k]), rel=1e-9)


def test_forces_add_up_and_parameters_scale_them() -> None:
    one, other = [20.0, *[FAR] * 5], [*[FAR] * 4, 40.0, FAR]
    two_distances = [20.0, *[FAR] * 3, 40.0, FAR]
    assert force(two_distances) == pytest.approx(force(one) + force(other), rel=1e-9)
    assert force(one, strength=30.0) == pytest.approx(2 * force(one), rel=1e-9)
    assert abs(force(one, reach=10.0)) < abs(force(one)) < abs(force(one, size=1000.0))
    assert abs(force(one, view=90.0)) > abs(force(one))


def test_nothing_in_reach_exerts_no_force() -> None:
    angles = dd.ObstacleRepulsion.example().angles.data  # type: ignore[attr-defined]
    assert np.array_equal(angles, np.arange(-90.0, 91.0, 9.0))
    assert force([FAR] * 6) == pytest.approx(0.0, abs=1e-12)


def test_a_sensor_without_an_angle_is_a_problem() -> None:
    model = dd.Model("repulsion")
    model.add(dd.Pattern("distance", [dd.Axis("sensor", 0, 3, 4)], np.ones(4))) >> model.add(
        dd.ObstacleRepulsion(ANGLES, name="force")  # type: ignore[arg-type]
    )
    [problem] = model.check()
    assert problem.what == "angles has shape [6], the input has [4] samples"
