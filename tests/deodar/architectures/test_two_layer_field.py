"""The two-layer field: its equations, and the one-layer field and the pool to which it converges with
faster inhibition.
"""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.architectures.two_layer_field import Layer, two_layer_field
from deodar.elements.populations import SoftWinnerTakeAll
from deodar.numerics.sigmoids import Linear

X, RING = dd.Axis("x", 0, 100, 51), dd.Axis("x", 0, 100, 50, periodic=True)
TAU, H = 20.0, -5.0


def test_the_steps_are_those_of_the_equations():
    model = dd.Model("steps", dt=0.5)
    kernels = (
        [dd.Gaussian(10, 4, normalized=True)],
        [dd.Gaussian(-6, 9, normalized=True)],
        [dd.Gaussian(8, 3, normalized=True)],
    )
    model.insert(
        two_layer_field(
            [RING],
            kernels[0],
            kernels[1],
            0.2,
            kernels[2],
            Layer(12.0, -3.0, dd.Logistic(3)),
            Layer(7.0, -6.0, dd.Logistic(1)),
        ),
        "two",
    )
    model.add(dd.GaussianStimulus("s", [RING], center=30, sigma=6, amplitude=5)) >> model["two.excitatory"]
    record = dd.simulate(
        model, 60, record=["two.excitatory.activation", "two.inhibitory.activation"], precision="float64"
    )

    def ring(kernel):
        d = RING.points[:, None] - RING.points
        images = sum(np.exp(-0.5 * ((d + 100 * k) / kernel.sigma) ** 2) for k in range(-4, 5))
        return kernel.amplitude * RING.step * images / (kernel.sigma * np.sqrt(2 * np.pi))

    excites, inhibits, drives = (ring(k[0]) for k in kernels)
    d = RING.points - 30
    s = 5 * np.exp(-0.5 * ((d - 100 * np.round(d / 100)) / 6) ** 2)
    u, v = np.full(50, -3.0), np.full(50, -6.0)
    for k in range(121):
        np.testing.assert_allclose(record["two.excitatory.activation"].values[k], u, atol=1e-6)
        np.testing.assert_allclose(record["two.inhibitory.activation"].values[k], v, atol=1e-6)
        g, g_v = 1 / (1 + np.exp(-3 * u)), 1 / (1 + np.exp(-v))
        u, v = (
            u + 0.5 / 12 * (-u - 3 + s + excites @ g + inhibits @ g_v - 0.2 * RING.step * g_v.sum()),
            v + 0.5 / 7 * (-v - 6 + drives @ g),
        )
    assert u.max() > 0 and v.max() > 0


def selection(axis, inhibition, global_inhibition, pool):
    """Return one layer, two layers and, if asked for, the pool behind a low-pass filter, with the same
    parameters and two inputs.
    """
    kernel = [dd.Gaussian(12, 5, normalized=True)]
    model = dd.Model("three", dt=0.5)
    model.add(
        dd.Field("one", [axis], TAU, H, kernel=[*kernel, *inhibition], global_inhibition=global_inhibition)
    )
    layers = two_layer_field(
        [axis],
        kernel,
        inhibition,
        global_inhibition,
        excitatory=Layer(TAU, H),
        inhibitory=Layer(10, 0, Linear()),
    )
    model.insert(layers, "two")
    targets = [model["one"], model["two.excitatory"]]
    model.parameter("tau_v", 1.0)
    model.link("two.inhibitory.tau", "tau_v")
    if pool:
        units = SoftWinnerTakeAll(
            "pool", [axis], TAU, 1.0, 0.0, kernel, global_inhibition, 1.0, -H, sigmoid=dd.Logistic()
        )
        slow = model.add(dd.Field("slow", [axis], TAU, 0.0, Linear()))
        slow >> model.add(units)
        model.link("pool.tau_inhibition", "tau_v")
        targets.append(slow)
    for name, place, strength in (("left", 30, 7.0), ("right", 70, 6.0)):
        stimulus = model.add(
            dd.GaussianStimulus(name, [axis], center=place, sigma=5, amplitude=strength, windows=[(20, 250)])
        )
        for target in targets:
            stimulus >> target
    return model


RATIOS = np.array([1, 1 / 2, 1 / 4, 1 / 8, 1 / 16, 1 / 32])


def falls_in_proportion(distance):
    """Return whether the distance falls monotonically, and in the end in proportion to the ratio: halved
    with it to 10 %.
    """
    assert (np.diff(distance) < 0).all()
    np.testing.assert_allclose(distance[-3:-1] / distance[-2:], 2, rtol=0.1)
    assert distance[-1] < 0.2


def test_the_three_forms_converge_as_inhibition_becomes_faster():
    model = selection(X, (), 0.6, pool=True)
    record = ["one.activation", "two.excitatory.activation", "pool.interaction", "slow.activation"]
    recorded = dd.simulate(
        model, 300, record=record, sweep={"tau_v": list(TAU * RATIOS)}, every=1, precision="float64"
    )
    one, two = recorded["one.activation"].values, recorded["two.excitatory.activation"].values
    pool = (recorded["pool.interaction"] + recorded["slow.activation"] + H).values
    left, right = one[0, 240, 15], one[0, 240, 35]
    assert left > 0 > right, "the one-layer field selects the stronger input"
    for other in (two, pool):
        falls_in_proportion(np.abs(other - one).max((1, 2)))
    np.testing.assert_allclose(pool, two, atol=1e-10)


def test_two_layers_with_local_inhibition_converge_to_one_layer():
    """Mexican-hat interaction: the inhibitory layer's kernel is the negative part of the one-layer
    field's.
    """
    model = selection(RING, (dd.Gaussian(-9, 12, normalized=True),), 0.2, pool=False)
    record = ["one.activation", "two.excitatory.activation"]
    recorded = dd.simulate(
        model, 300, record=record, sweep={"tau_v": list(TAU * RATIOS)}, every=1, precision="float64"
    )
    falls_in_proportion(
        np.abs(recorded["two.excitatory.activation"] - recorded["one.activation"]).max(("time", "x")).values
    )


def test_slow_inhibition_overshoots_and_ends_the_peak():
    """Inhibition that is far slower than excitation overshoots: the peak decays while its input stays."""
    model = selection(X, (), 0.6, pool=False)
    model.set("tau_v", 4 * TAU)
    u = dd.simulate(model, 250, record=["one.activation", "two.excitatory.activation"], every=1)
    assert float(u["two.excitatory.activation"].sel(x=30, time=slice(80, 100)).min()) > 0
    assert (
        float(u["two.excitatory.activation"].sel(time=slice(200, 240)).max("x").min())
        < 0
        < float(u["one.activation"].sel(x=30, time=220))
    )


@pytest.mark.parametrize("drive", [(), (dd.Gaussian(1, 3, normalized=True),)])
def test_a_two_layer_field_is_saved_and_loaded(tmp_path, drive):
    model = dd.Model("two")
    for name in ("perceptual", "memory"):
        model.insert(two_layer_field([X], [dd.Gaussian(15, 5)], [dd.Gaussian(-5, 10)], drive=drive), name)
    model["perceptual.excitatory"] >> model["memory.inhibitory"]
    assert not model.check()
    dd.save(model, tmp_path / "two.json")
    assert dd.load(tmp_path / "two.json").document == model.document
