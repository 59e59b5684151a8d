"""The velocity of a body towards a peak: against the sum over samples, its limit, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.elements.variables import Integrator
from deodar.errors import DeodarError

X, Y, HUE = dd.Axis("x", 0, 20, 21), dd.Axis("y", 0, 8, 17), dd.Axis("hue", 0, 360, 12, periodic=True)
OF = [dd.Axis("of", 0, 1, 2)]


def velocity(over: list[dd.Axis], position: list[float], **given: object) -> tuple[np.ndarray, np.ndarray]:
    model = dd.Model("reaching")
    at = [a.lower + 0.6 * a.range for a in over]
    source = model.add(dd.GaussianStimulus("s", over, center=at, sigma=[a.range / 10 for a in over]))
    pattern = model.add(dd.Pattern("here", OF, np.array(position)))
    toward = model.add(dd.AttractorVelocity(name="toward", **given))  # type: ignore[arg-type]
    source >> toward
    pattern >> toward["position"]
    record = ["toward", "s"]
    recorded = dd.simulate(model, 1, dt=1.0, record=record, precision="float64")
    return recorded["toward.output"].values[-1], recorded["s.output"].values[-1]


def test_it_is_the_sum_over_samples_of_the_distance_times_the_input():
    for axes, given in (([X, Y], {}), ([X, Y, HUE], {"axes": [X, Y]})):
        v, f = velocity(axes, [3.0, 7.0], tau=50.0, **given)
        f = f * X.step * Y.step * (HUE.step if len(axes) == 3 else 1.0)
        f = f.reshape(21, 17, -1).sum(axis=2)
        expected = [((X.points[:, None] - 3.0) * f).sum(), ((Y.points[None] - 7.0) * f).sum()]
        np.testing.assert_allclose(v, np.array(expected) / 50.0, rtol=1e-10)


def test_the_limit_shortens_the_vector_and_keeps_its_direction():
    free, _ = velocity([X, Y], [3.0, 7.0])
    slow, _ = velocity([X, Y], [3.0, 7.0], fastest=0.1)
    assert np.hypot(*slow) == pytest.approx(0.1) and np.hypot(*free) > 0.1
    np.testing.assert_allclose(slow / np.hypot(*slow), free / np.hypot(*free))
    fast, _ = velocity([X, Y], [3.0, 7.0], fastest=1e6)
    np.testing.assert_allclose(fast, free)


@pytest.mark.parametrize(
    ("axes", "position", "says"),
    [
        ([X, Y, HUE], [0.0, 0.0], "takes one axis with 3 samples at its port 'position'"),
        ([X], [0.0, 0.0], "takes one number at its port 'position'"),
    ],
)
def test_axes_that_have_no_position_are_refused(axes, position, says):
    with pytest.raises(DeodarError, match=says):
        velocity(axes, position)


@pytest.mark.parametrize(
    ("heading", "goal", "end"), [(20.0, 350.0, -10.0), (350.0, 20.0, 380.0), (90, 60, 60)]
)
def test_a_heading_field_turns_a_heading_the_shorter_way(heading, goal, end):
    ring = dd.Axis("heading", 0, 360, 36, periodic=True, unit="deg")
    model = dd.Model("turning")
    model.add(dd.GaussianStimulus("goal", [ring], center=goal, sigma=20, amplitude=10)) >> model.add(
        dd.Field("u", [ring])
    )
    turn = model.add(dd.AttractorVelocity(tau=2000.0, name="turn"))
    body = model.add(Integrator("body", rate=1.0, initial=heading))
    model["u"] >> turn >> body
    body >> turn["position"]
    assert not model.check()
    s = dd.Session(model, precision="float64")
    s.step(2000)
    assert float(s.read("body")) == pytest.approx(end, abs=1e-3)


def test_on_a_periodic_axis_it_is_the_sum_of_sines():
    v, f = velocity([X, HUE], [3.0, 300.0], tau=50.0)
    hue = 360 / (2 * np.pi) * np.sin(2 * np.pi * (HUE.points - 300.0) / 360)
    f = f * X.step * HUE.step
    np.testing.assert_allclose(v[1], (hue[None] * f).sum() / 50.0, rtol=1e-10)
    np.testing.assert_allclose(v[0], ((X.points[:, None] - 3.0) * f).sum() / 50.0, rtol=1e-10)
