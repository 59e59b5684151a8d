"""The steered shift: it equals the fixed shift by the same amount, for all kinds of steering, and its
inverse restores the input.
"""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.convolutions import Shift, SteeredShift
from deodar.elements.stimuli import Boost, Pattern
from deodar.errors import ModelError, ParameterError

X, RING = dd.Axis("x", -2, 7, 10), dd.Axis("phi", 0, 360, 12, periodic=True, unit="deg")
PAIR = dd.Axis("component", 0, 1, 2)
SCENE = np.random.default_rng(3).normal(size=(10, 12))


def scene() -> tuple[dd.Model, dd.model.model.Handle]:
    model = dd.Model("shift")
    return model, model.add(Pattern("scene", [X, RING], SCENE))


def shifted_twice(amounts, gain=1.0, offset=0.0):
    """Return the outputs of two shifts in series, one shift by a pair, and a fixed shift for the same
    picture.
    """
    model, source = scene()
    behind = source
    for axis, amount in zip((X, RING), amounts, strict=True):
        behind = behind >> model.add(SteeredShift(axis.name, gain, offset, name=f"along {axis.name}"))
        model.connect(model.add(Boost(f"by {axis.name}", [], amount)), behind["by"])
    pair = model.add(SteeredShift(["x", "phi"], gain, offset, name="pair"))
    source >> pair
    model.connect(model.add(Pattern("amounts", [PAIR], amounts)), pair["by"])
    source >> model.add(Shift([gain * a + offset for a in amounts], name="fixed"))
    record = dd.simulate(
        model, 1, dt=1.0, record=["along phi.output", "pair.output", "fixed.output"], precision="float64"
    )
    return [record[name].values[-1] for name in record.data_vars]


@pytest.mark.parametrize("amounts", [(0.0, 0.0), (3.0, 60.0), (-1.3, -400.5), (2.7, 7230.0), (40.0, 0.0)])
def test_a_constant_steering_input_gives_the_fixed_shift(amounts):
    one_by_one, pair, fixed = shifted_twice(amounts)
    np.testing.assert_allclose(pair, fixed, atol=1e-11)
    np.testing.assert_allclose(one_by_one, fixed, atol=1e-11)
    if amounts[0] == 40:
        assert not fixed.any()


def test_gain_and_offset_scale_the_steering_input():
    one_by_one, pair, fixed = shifted_twice((2.0, 31.5), gain=-1.0, offset=1.5)
    np.testing.assert_allclose(pair, fixed, atol=1e-12)
    np.testing.assert_allclose(one_by_one, fixed, atol=1e-12)
    np.testing.assert_allclose(pair[3], 0.5 * (SCENE[3] + SCENE[4])[(np.arange(12) + 1) % 12], atol=1e-12)


def test_a_shift_by_the_gaze_and_its_inverse_restore_the_position():
    """A peak at r on the retina with gaze g is shifted to r + g; a shift by -g restores it."""
    retina = dd.Axis("x", -30, 30, 121)
    model = dd.Model("frames")
    seen = model.add(dd.GaussianStimulus("seen", [retina], center=-5, sigma=2))
    gaze = model.add(Boost("gaze", [], 12.5))
    world, back = model.add(SteeredShift("x", name="world")), model.add(SteeredShift("x", -1.0, name="back"))
    seen >> world >> back
    for shift in (world, back):
        model.connect(gaze, shift["by"])
    record = dd.simulate(
        model, 1, dt=1.0, record=["seen.output", "world.output", "back.output"], precision="float64"
    )
    x = retina.points
    np.testing.assert_allclose(record["world.output"].values[-1], np.exp(-((x - 7.5) ** 2) / 8), atol=1e-12)
    np.testing.assert_allclose(record["back.output"].values[-1], record["seen.output"].values[-1], atol=1e-12)


def test_the_shift_follows_the_steering_input_in_every_step():
    model, source = scene()
    position = model.add(dd.Field("position", [], tau=5, resting_level=0, sigmoid=dd.Logistic(1.0)))
    model.add(Boost("push", [], 3.0)) >> position
    shift = model.add(SteeredShift("x", 4.0, name="shift"))
    source >> shift
    model.connect(position, shift["by"])
    record = dd.simulate(model, 20, dt=1.0, record=["shift.output", "position.output"], precision="float64")
    for g, y in zip(record["position.output"].values, record["shift.output"].values, strict=True):
        places = X.points - 4.0 * g
        expected = [np.interp(places, X.points, column, left=0.0) for column in SCENE.T]
        inside = places >= X.lower  # below the first sample it falls to zero within one cell
        np.testing.assert_allclose(y[inside], np.array(expected).T[inside], atol=1e-12)


def test_wrong_axes_to_shift_along_are_reported():
    with pytest.raises(ParameterError, match="along: is empty"):
        SteeredShift([])
    with pytest.raises(ParameterError, match="contains a name twice"):
        SteeredShift(["x", "x"])
    model, source = scene()
    source >> model.add(SteeredShift("phy", name="shift"))
    with pytest.raises(ModelError, match=r"shifts along 'phy'(.|\n)*Did you mean 'phi'"):
        dd.Session(model)
    model, source = scene()
    pair = model.add(SteeredShift(["x", "phi"], name="pair"))
    source >> pair
    model.connect(model.add(Boost("one", [], 1.0)), pair["by"])
    with pytest.raises(ModelError, match="one axis with 2 samples"):
        dd.Session(model)
