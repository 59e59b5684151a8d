"""A number becomes a peak at its position."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.positions import SpaceCode
from deodar.element import Element
from deodar.elements.stimuli import Boost, Pattern
from tests.deodar.errors.refused import refused

X, Y = dd.Axis("x", 0, 10, 21, unit="cm"), dd.Axis("y", -4, 4, 9, unit="cm")
RING = dd.Axis("heading", -180, 180, 36, periodic=True, unit="deg")


def coded(source: Element, code: SpaceCode) -> np.ndarray:
    model = dd.Model("code")
    model.add(source) >> model.add(code)
    return dd.simulate(model, 1, record=f"{code.name}.output")[f"{code.name}.output"].values[-1]


def test_a_position_in_the_plane_becomes_a_gaussian() -> None:
    pattern = Pattern("place", [dd.Axis("of", 0, 1, 2)], np.array([3.0, 1.0]))  # type: ignore[arg-type]
    y = coded(pattern, SpaceCode([X, Y], (2.0, 1.0), 4.0, gain=(1.0, 2.0), offset=(0.5, -3.0), name="code"))
    plain = 4 * np.exp(-0.5 * ((X.points[:, None] - 3.5) / 2) ** 2 - 0.5 * (Y.points[None, :] + 1.0) ** 2)
    np.testing.assert_allclose(y, plain, atol=1e-6)


@pytest.mark.parametrize("turns", [0, 3, -2])
def test_an_angle_wraps_after_any_number_of_turns(turns: int) -> None:
    angle = np.deg2rad(170) + 2 * np.pi * turns
    y = coded(Boost("angle", [], angle), SpaceCode([RING], 20.0, gain=180 / np.pi, offset=20.0, name="code"))
    distance = (RING.points + 170 + 180) % 360 - 180
    np.testing.assert_allclose(y, np.exp(-0.5 * (distance / 20) ** 2), atol=1e-4)


def test_a_space_code_reads_one_number_for_each_axis() -> None:
    model = dd.Model("misfit")
    model.add(Boost("one", [], 1.0)) >> model.add(SpaceCode([X, Y], name="code"))
    refused(model.require, dd.errors.ModelError, "one axis with 2 samples", "Connect an input of that shape")
    refused(lambda: SpaceCode([], name="nowhere"), dd.errors.ParameterError, "a peak needs at least one axis")


@pytest.mark.parametrize("boundary", [None, ["periodic"], ["zero"]])
def test_a_space_code_has_the_stated_integral_and_boundary(boundary: list[str] | None) -> None:
    code = SpaceCode([RING], 25.0, 3.0, normalized=True, boundary=boundary, name="code")  # type: ignore[arg-type]
    y = coded(Boost("place", (), 171.0), code)
    distance = RING.points - 171.0
    if boundary != ["zero"]:
        distance = distance - 360 * np.round(distance / 360)
    plain = np.exp(-0.5 * (distance / 25) ** 2)
    np.testing.assert_allclose(y, 3 * plain / (plain.sum() * 10), atol=1e-6)
    assert y.sum() * 10 == pytest.approx(3, rel=1e-5) and (y[0] > 1e-3) == (boundary != ["zero"])


def test_too_many_boundaries_are_a_problem() -> None:
    model = dd.Model("ends")
    model.add(Boost("place", (), 1.0)) >> model.add(SpaceCode([X], boundary=["zero", "zero"], name="code"))
    assert any("boundary has 2 entries for 1 axes" in p.what for p in model.check())
