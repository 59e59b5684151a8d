"""The measure `place`: the position of the highest peak, the same inside the compiled step and in
`analysis.peaks`.
"""

from __future__ import annotations

import math

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.analysis.peaks import peaks
from deodar.errors import ParameterError
from deodar.experiments.actions import Set
from deodar.experiments.experiment import Experiment
from deodar.experiments.measures import Measure
from deodar.experiments.observable import Observable, mask
from deodar.experiments.trial import TrialPlan
from deodar.numerics.peak import position
from deodar.numerics.sigmoids import Step
from tests.deodar.experiments.calls import changed

LINE, RING, TURN = (
    dd.Axis("x", -10, 30, 41),
    dd.Axis("phi", -180, 180, 36, periodic=True),
    dd.Axis("psi", 0, 1, 24, periodic=True),
)
HEIGHT = dd.Axis("y", 0, 5, 21)


def smooth(rng, axes):
    """Return a random activation with several peaks, some of them across the border."""
    values = rng.normal(size=tuple(a.samples for a in axes))
    for d, axis in enumerate(axes):
        k = np.exp(-0.5 * (np.arange(-6, 7) / 1.6) ** 2)
        padded = (
            np.concatenate([np.take(values, range(-6, 0), d), values, np.take(values, range(6), d)], d)
            if axis.periodic
            else values
        )
        values = np.apply_along_axis(
            np.convolve, d, padded, k / k.sum(), "valid" if axis.periodic else "same"
        )
    return values * 2 / values.max()


@pytest.mark.parametrize(
    "axes", [(LINE,), (RING,), (HEIGHT, RING), (RING, TURN)], ids=["line", "ring", "plane", "torus"]
)
@pytest.mark.parametrize("threshold", [0.0, 1.0])
def test_the_compiled_position_is_that_of_the_highest_peak(axes, threshold):
    rng = np.random.default_rng(4)
    compiled = jax.jit(lambda u: position(u, axes, threshold))
    with jax.enable_x64(True):
        for _ in range(12):
            u = smooth(rng, axes)
            expected = peaks(u, axes, threshold)[0].position
            np.testing.assert_allclose(compiled(jax.numpy.asarray(u))[0], expected, atol=1e-9)


@pytest.mark.parametrize("axes", [(LINE,), (RING,), (HEIGHT, RING)], ids=["line", "ring", "plane"])
def test_only_samples_near_the_given_position_belong_to_the_peak(axes):
    center = tuple(0.6 * a.lower + 0.4 * a.upper for a in axes)
    radius = 0.22 * max(a.range for a in axes)
    inside = mask(axes, center, radius)
    with jax.enable_x64(True):
        for k in range(6):
            u = smooth(np.random.default_rng(k), axes)
            expected = peaks(np.where(inside, u, -1e9), axes)[0].position
            np.testing.assert_allclose(
                position(jax.numpy.asarray(u), axes, 0.0, inside)[0], expected, atol=1e-9
            )
            view = Observable("u.activation", "place", center, radius)
            np.testing.assert_allclose(
                view.seen(u[None, None], axes, 2)[0, 0], expected if len(axes) > 1 else expected[0], atol=1e-9
            )


def test_a_ring_above_the_threshold_everywhere_gives_its_highest_sample():
    with jax.enable_x64(True):
        flat = np.ones(36)
        flat[7] = 1.0 + 1e-13
        assert (
            position(jax.numpy.asarray(flat), (RING,), 0.0)[0][0]
            == pytest.approx(RING.points[7])
            == peaks(flat, (RING,))[0].position[0]
        )


def test_the_position_in_single_precision_is_exact_to_a_fraction_of_a_sample():
    u = smooth(np.random.default_rng(1), (LINE,))
    assert position(jax.numpy.asarray(u, np.float32), (LINE,), 0.0)[0][0] == pytest.approx(
        peaks(u, (LINE,))[0].position[0], abs=1e-4
    )


def test_without_a_peak_there_is_no_position():
    assert not position(jax.numpy.full(41, -1.0), (LINE,), 0.0)[1]
    assert math.isnan(Observable("u.activation", "place").seen(np.full((1, 1, 41), -1.0), (LINE,), 2)[0, 0])


def experiment(**changes):
    """Return an experiment with a peak between two samples, on a line or a ring, or without a peak if the
    input is weak.
    """
    model = dd.Model("between samples")
    u = model.add(dd.Field("u", [LINE, RING], tau=10, resting_level=-5, noise=0.5))
    model.add(dd.GaussianStimulus("s", [LINE, RING], center=(9.3, 178.0), sigma=(3, 30), amplitude=12)) >> u
    plan = TrialPlan(60, measures=[Measure("place", "u.activation", "place")])
    return changed(Experiment("place", model, plan, 3, precision="float64"), **changes)


def test_a_batch_and_single_trials_measure_equal_positions_across_the_ends():
    together = experiment().run()["place"].values
    # the action changes nothing, but prevents a batch
    single = experiment(actions=[Set(60, "u.quadrature", "point")]).run()["place"].values
    np.testing.assert_allclose(together, single, atol=1e-9)
    assert (
        np.abs(together[:, 0] - 9.3).max() < 1 and np.abs((together[:, 1] - 178 + 180) % 360 - 180).max() < 10
    )
    assert len(set(together[:, 0].tolist()) - set(LINE.points.tolist())) == 3


def test_a_trial_without_a_peak_has_no_position():
    for actions in ([], [Set(60, "u.quadrature", "point")]):
        table = experiment(
            actions=actions, trials=2, measures=[Measure("place", "u.activation", "place", threshold=50.0)]
        ).run()
        assert np.isnan(table["place"].values).all()


def test_the_threshold_of_an_output_has_to_be_given():
    with pytest.raises(ParameterError, match=r"u.output is above 0 everywhere.*threshold=0.5"):
        experiment(measures=[Measure("place", "u.output", "place")]).run()
    assert not experiment(measures=[Measure("place", "u.output", "place", threshold=0.5)]).check()
    heaviside = experiment()
    heaviside.model.set({"u.sigmoid": Step()})
    assert not changed(heaviside, measures=[Measure("place", "u.output", "place")]).check()


def test_a_threshold_is_accepted_only_for_the_position_of_a_peak():
    with pytest.raises(ParameterError, match="threshold: is 1, and only reduce='place' has a threshold"):
        Measure("highest", "u.activation", "max", threshold=1.0)
