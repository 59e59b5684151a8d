"""Every coupling against the plain reference: over 200 steps a field drives it, and it drives another
field.
"""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import deodar as dd
from deodar.couplings.arithmetic import Product, Sigmoid, Sum, Threshold
from deodar.couplings.convolutions import Convolve, Shift
from deodar.couplings.delays import Delay
from deodar.couplings.pictures import ColorSpace
from deodar.couplings.positions import PeakPosition
from deodar.couplings.projections import Resample
from deodar.couplings.weights import Weighting, Weights
from deodar.numerics.kernels.separable import Box
from deodar.numerics.sigmoids import Absolute
from tests.oracle import couplings as plain
from tests.oracle import fields
from tests.oracle.kernels import dense

STEPS, EVERY = 200, 20
X = dd.Axis("x", 0, 15, 16)
PHI = dd.Axis("phi", 0, 360, 9, periodic=True, unit="deg")
RANDOM = np.random.default_rng(3)
DENSE, MASK = 0.01 * RANDOM.normal(size=(7, 5, 16, 9)), RANDOM.normal(size=(16, 9))
COARSE, FINE = dd.Axis("x", 0, 15, 7), dd.Axis("x", 0, 15, 31)
PART = dd.Axis("x", 3.3, 17.2, 12)
PHI_FINE = dd.Axis("phi", 0, 360, 25, periodic=True, unit="deg")
Z = dd.Axis("z", -1, 1, 4)
PAN = dd.Axis("pan", 0, 15, 16, unit="deg")
PANORAMA = dd.Axis("pan", 0, 15, 11, unit="deg")

CASES = {
    "gain": (dd.Gain(-1.7), lambda y: -1.7 * y),
    "weighting": (Weighting(MASK, (X, PHI)), lambda y: MASK * y),
    "convolve": (
        Convolve([dd.Gaussian(0.4, [1.2, 50]), Box(0.01, [4, 100], boundary=["reflect", "periodic"])]),
        lambda y: (KERNEL @ y.ravel()).reshape(y.shape),
    ),
    "shift": (Shift([2.0, 80.0]), lambda y: plain.shift(y, [X, PHI], (2.0, 80.0))),
    "shift by parts of a cell": (Shift([-1.3, 415.0]), lambda y: plain.shift(y, [X, PHI], (-1.3, 415.0))),
    "weights": (
        Weights(DENSE, [dd.Axis("a", 0, 1, 7), dd.Axis("b", 0, 1, 5)]),
        lambda y: plain.weights(y, [X, PHI], [X7, X5], DENSE),
    ),
    "weights to a number": (Weights(MASK / 40, []), lambda y: plain.weights(y, [X, PHI], [], MASK / 40)),
    "sigmoid": (Sigmoid(Absolute(5.0, 0.4)), lambda y: fields.sigmoid(Absolute(5.0, 0.4), y)),
    "threshold": (Threshold(0.3), lambda y: plain.threshold(y, 0.3)),
    "sum": (Sum(), lambda y: y),
    "resample coarse": (Resample([COARSE, PHI]), lambda y: plain.resample(y, [X, PHI], [COARSE, PHI])),
    "resample fine": (Resample([FINE, PHI_FINE]), lambda y: plain.resample(y, [X, PHI], [FINE, PHI_FINE])),
    "resample another part": (Resample([PART, PHI]), lambda y: plain.resample(y, [X, PHI], [PART, PHI])),
    "resample nearest": (
        Resample([PART, PHI_FINE], "nearest"),
        lambda y: plain.resample(y, [X, PHI], [PART, PHI_FINE], "nearest"),
    ),
    **{
        f"project {reduction} to {target}": (
            p := dd.Project(axes, reduction),
            lambda y, p=p: plain.project(y, [X, PHI], p),
        )
        for reduction in ("integral", "sum", "mean", "max", "min")
        for target, axes in {"x": [X], "phi": [PHI], "a number": [], "phi and z": [PHI, Z]}.items()
    },
    "project expand and reorder": (
        p := dd.Project([Z, PHI, X]),
        lambda y, p=p: plain.project(y, [X, PHI], p),
    ),
    "project rename": (
        p := dd.Project([PHI, PAN], rename={"x": "pan"}),
        lambda y, p=p: plain.project(y, [X, PHI], p),
    ),
    "project rename and resample": (
        p := dd.Project([PANORAMA], "mean", {"x": "pan"}, "nearest"),
        lambda y, p=p: plain.project(y, [X, PHI], p),
    ),
    "project resample": (p := dd.Project([PHI_FINE, COARSE]), lambda y, p=p: plain.project(y, [X, PHI], p)),
}
X7, X5 = dd.Axis("a", 0, 1, 7), dd.Axis("b", 0, 1, 5)
KERNEL = dense(CASES["convolve"][0].kernel, (X, PHI), many=3)


def drive():
    """Return a field whose output moves over time, and that output at each step."""
    field = dd.Field(
        "u",
        [X, PHI],
        tau=10,
        resting_level=-2,
        kernel=[dd.Gaussian(0.004, [2, 60])],
        sigmoid=dd.Logistic(1.5),
    )
    stimuli = [
        dd.GaussianStimulus(
            "early", [X, PHI], center=[4, 30], sigma=[2, 40], amplitude=6, windows=[(10, 90)]
        ),
        dd.GaussianStimulus(
            "late", [X, PHI], center=[11, 250], sigma=[2, 40], amplitude=6, windows=[(70, 300)]
        ),
    ]
    maps = [fields.stimulus(s, s.windows[0].start) for s in stimuli]

    def arriving(k):
        return sum(
            m for m, s in zip(maps, stimuli, strict=True) if s.windows[0].start <= k < s.windows[0].stop
        )

    u = fields.run(field, arriving, STEPS, 1.0, many=3)
    model = dd.Model("couplings")
    handle = model.add(field)
    for s in stimuli:
        model.connect(model.add(s), handle)
    return model, handle, fields.sigmoid(field.sigmoid, u)


def close(values, reference, name):
    scale = abs(reference).max()
    assert scale > 1e-3, f"{name}: nothing arrives"
    return (
        []
        if abs(values - reference).max() <= 1e-9 * scale
        else [f"{name}: off by {abs(values - reference).max() / scale:.1e}"]
    )


@pytest.fixture(scope="module")
def run():
    """Run one model with every coupling between `u` and a field of its own."""
    model, u, g = drive()
    expected = {}
    for name, (coupling, formula) in CASES.items():
        c = model.add(dataclasses.replace(coupling, name=name))
        model.connect(u, c)
        axes = coupling.outputs({"input": (X, PHI)})["output"]
        v = dd.Field(f"v {name}", axes, tau=7, resting_level=-1)
        model.connect(c, model.add(v))
        expected[name] = v, np.array([formula(y) for y in g])
    record = [f"{dd.quote(name)}.output" for name in expected] + [
        f"{dd.quote(v.name)}.activation" for v, _ in expected.values()
    ]
    return dd.simulate(model, STEPS, record=record, every=EVERY, precision="float64"), expected


@pytest.mark.parametrize("name", CASES)
def test_every_coupling_agrees_with_the_oracle(run, name):
    record, expected = run
    v, reference = expected[name]
    wrong = close(record[f"{name}.output"].values, reference[::EVERY], name)
    target = fields.run(v, lambda k: reference[k], STEPS, 1.0)[::EVERY]
    wrong += close(record[f"{v.name}.activation"].values, target, v.name)
    assert not wrong


def test_couplings_with_two_inputs_or_memory_agree_with_the_oracle():
    model, u, g = drive()
    f = dd.GaussianStimulus("f", [X], center=8, sigma=3, amplitude=1.3)
    plane = dd.GaussianStimulus("plane", [X, PHI], center=[8, 90], sigma=[3, 60], amplitude=1.3)
    factor, other, number = model.add(f), model.add(plane), model.add(dd.Field("n", [], resting_level=0.4))
    product, gated, held_at_zero = (
        model.add(Product(name="product")),
        model.add(Product(name="gated")),
        model.add(Delay([X, PHI], 0.7, name="held")),
    )
    total = model.add(Sum(name="both"))
    for target in (product, gated, held_at_zero, total):
        model.connect(u, target)
    model.connect(factor, product["factor"])
    model.connect(number, gated["factor"])
    model.connect(other, total)
    record = dd.simulate(model, STEPS, record=["product", "gated", "held", "both"], precision="float64")
    pattern = fields.stimulus(f, 0)[:, None]
    level = 1 / (1 + np.exp(-4 * 0.4))
    wrong = close(record["product.output"].values, g * pattern, "product")
    wrong += close(record["gated.output"].values, g * level, "gated")
    wrong += close(record["both.output"].values, g + fields.stimulus(plane, 0), "both")
    wrong += close(record["held.output"].values, np.concatenate([np.full((1, 16, 9), 0.7), g[:-1]]), "held")
    assert not wrong


def test_peak_position_agrees_with_the_oracle_on_a_line_and_a_ring():
    model, u, g = drive()
    # half of the maximum, so that the homogeneous activity before the first peak, which has no direction, is
    # not read out
    most = g.sum((1, 2)).max() * 40
    ring, line = PeakPosition(PHI, most / 2, -7.0, name="ring"), PeakPosition(X, most / 2, -7.0, name="line")
    for read in (ring, line):
        model.connect(u, model.add(read))
    record = dd.simulate(
        model, STEPS, record=["ring", "ring.strength", "line", "line.strength"], precision="float64"
    )
    for read, sums in ((ring, g.sum(1) * 1.0), (line, g.sum(2) * 40.0)):
        reference = np.array([plain.peak_position(f, read) for f in sums])
        assert (reference[:, 0] == -7.0).any() and (reference[:, 0] != -7.0).any()
        np.testing.assert_allclose(record[f"{read.name}.output"].values, reference[:, 0], rtol=1e-9)
        np.testing.assert_allclose(record[f"{read.name}.strength"].values, reference[:, 1], rtol=1e-9)


def test_the_color_space_of_a_picture_agrees_with_the_oracle():
    from deodar.elements.world_ports import Sensor
    from deodar.worlds._base import Signal, World

    pixels = np.random.default_rng(5).random((12, 10, 3))
    pixels[:3] *= 0.1

    class Still(World):
        sensors = {"picture": Signal("random colours")}

        def sense(self, sensor, axes, time):
            return pixels

    x, y, channel = dd.Axis("x", 0, 11, 12), dd.Axis("y", 0, 9, 10), dd.Axis("channel", 0, 2, 3)
    hue = dd.Axis("hue", 0, 360, 8, periodic=True)
    grids = {
        "fine": [x, y, hue],
        "coarse": [dd.Axis("x", 0, 11, 5), dd.Axis("y", 0, 9, 4), hue],
        "finer than the picture": [dd.Axis("x", 0, 11, 23), y, hue],
    }
    model = dd.Model("colours")
    eye = model.add(Sensor("eye", [x, y, channel]))
    codes = [
        ColorSpace(axes, sigma, name=f"{name}, {sigma}") for name, axes in grids.items() for sigma in (0, 31)
    ]
    for code in codes:
        model.connect(eye, model.add(code))
    record = dd.simulate(
        model, 1, record=[dd.quote(c.name) for c in codes], precision="float64", world=Still()
    )
    for code in codes:
        reference = plain.color_space(pixels, [x, y, channel], code)
        np.testing.assert_allclose(
            record[f"{code.name}.output"].values[0], reference, rtol=1e-9, atol=1e-12, err_msg=code.name
        )


@pytest.mark.parametrize("sigma", [0, 31])
def test_the_integral_of_a_color_space_is_independent_of_the_sampling_of_hue(sigma):
    from deodar.elements.stimuli import Pattern

    pixels = np.random.default_rng(5).random((6, 5, 3))
    x, y, channel = dd.Axis("x", 0, 5, 6), dd.Axis("y", 0, 4, 5), dd.Axis("channel", 0, 2, 3)
    model = dd.Model("colours")
    picture = model.add(Pattern("picture", [x, y, channel], pixels))
    for samples in (12, 24, 48):
        code = model.add(
            ColorSpace([x, y, dd.Axis("hue", 0, 360, samples, periodic=True)], sigma, name=f"code{samples}")
        )
        model.connect(picture, code)
        model.connect(code, model.add(dd.Project([], name=f"total{samples}")))
    record = dd.simulate(model, 1, record=[f"total{n}.output" for n in (12, 24, 48)], precision="float64")
    totals = [float(record[f"total{n}.output"][0]) for n in (12, 24, 48)]
    np.testing.assert_allclose(totals, totals[-1], rtol=2e-3)
