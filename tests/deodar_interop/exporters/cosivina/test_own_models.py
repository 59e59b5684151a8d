"""Models that were built in deodar: the exported file, run by the plain simulator, gives their trajectory."""

from __future__ import annotations

import json

import numpy as np
import pytest

import deodar as dd
from deodar_interop.exporters.cosivina import write
from deodar_interop.importers.cosivina import read
from tests.deodar_interop.exporters.cosivina.files import elements, largest_difference
from tests.deodar_interop.importers.cosivina.oracle import Sim

LINE = dd.Axis("position", -30, 30, samples=121)
RING = dd.Axis("x", 0, 100, samples=100, periodic=True)
SPACE = dd.Axis("space", 0, 20, samples=21)
COLOR = dd.Axis("color", 0, 360, samples=36, periodic=True)


def selection():
    m = dd.Model("selection")
    kernel = [dd.Gaussian(15, 4, normalized=True)]
    u = m.add(dd.Field("u", [LINE], kernel=kernel, global_inhibition=0.6, sigmoid=dd.Logistic(2)))
    m.add(dd.GaussianStimulus("left", [LINE], center=-12, sigma=3, amplitude=6)) >> u
    windows = [(5, 60), (70.4, 1e31)]
    m.add(dd.GaussianStimulus("right", [LINE], center=10.3, sigma=3, amplitude=6.2, windows=windows)) >> u
    return m, ["u"]


def memory():
    m = dd.Model("memory")
    kernel = [dd.MexicanHat(20, 3, 15, 6, normalized=True)]
    u = m.add(dd.Field("u", [RING], kernel=kernel, sigmoid=dd.Logistic(4)))
    m.add(dd.GaussianStimulus("cue", [RING], center=25, sigma=5, amplitude=8, windows=[(10, 60)])) >> u
    trace = m.add(dd.MemoryTrace("trace", [RING], tau_build=50, tau_decay=300))
    u >> trace >> dd.Gain(2) >> u
    return m, ["u"]


def broad():
    """A kernel so wide that its images on the ring count; in cosivina it is a matrix."""
    m = dd.Model("broad")
    u = m.add(dd.Field("u", [RING], kernel=[dd.Gaussian(20, 5, True), dd.Gaussian(-15, 25, True)]))
    m.add(dd.GaussianStimulus("cue", [RING], center=25, sigma=5, amplitude=8)) >> u
    return m, ["u"]


def coupled():
    m = dd.Model("coupled")
    u = m.add(
        dd.Field("u", [LINE], tau=10, kernel=[dd.Gaussian(8, 2), dd.Gaussian(-4, 5), dd.Gaussian(1, 1)])
    )
    v = m.add(dd.Field("v", [LINE], tau=5, resting_level=-2))
    m.add(dd.GaussianStimulus("s", [LINE], center=-7, sigma=2, amplitude=7)) >> u
    u >> v
    v >> u
    v >> dd.Gain(-3) >> u
    u >> dd.Convolve([dd.Gaussian(3, 2, normalized=True)]) >> v
    return m, ["u", "v"]


def node():
    m = dd.Model("node")
    u = m.add(dd.Field("u", [RING], kernel=[dd.Gaussian(2, 3)]))
    n = m.add(dd.Field("n", kernel=[dd.Gaussian(4)], global_inhibition=1))
    r = m.add(dd.RateNode("r", self_excitation=2, resting_level=-1))
    m.add(dd.GaussianStimulus("s", [RING], center=20, sigma=4, amplitude=9)) >> u
    u >> dd.Project([]) >> dd.Gain(0.6) >> n
    n >> u
    n >> r
    return m, ["u", "n", "r"]


def planes():
    """A plane and its two margins; in cosivina the rows are turned, expanded and summed over."""
    m = dd.Model("planes")
    p = m.add(dd.Field("p", [SPACE, COLOR], kernel=[dd.Gaussian(0.1, [2, 20])], global_inhibition=0.0001))
    f = m.add(dd.Field("f", [COLOR], kernel=[dd.Gaussian(3, 20, normalized=True)]))
    s = m.add(dd.Field("s", [SPACE], resting_level=-1))
    p >> dd.Project([COLOR]) >> dd.Gain(0.5) >> f
    p >> dd.Project([SPACE], "mean") >> s
    f >> p
    s >> p
    m.add(dd.GaussianStimulus("i", [SPACE, COLOR], center=[5, 90], sigma=[2, 30], amplitude=6)) >> p
    m.add(dd.GaussianStimulus("j", [COLOR], center=200, sigma=30, amplitude=6)) >> f
    m.add(dd.Boost("b", [SPACE], 2.0)) >> s
    m.add(dd.BoxStimulus("box", [SPACE], center=12, width=3, amplitude=4, windows=[(20, 40)])) >> s
    return m, ["p", "f", "s"]


def couplings():
    m = dd.Model("couplings")
    x = dd.Axis("x", 0, 10, samples=40, periodic=True)
    y = dd.Axis("x", 0, 10, samples=20, periodic=True)
    u = m.add(dd.Field("u", [x], kernel=[dd.Box(2, 3), dd.Gaussian(1, 0.5)], global_inhibition=0.1))
    w = m.add(dd.Field("w", [x]))
    c = m.add(dd.Field("c", [y], resting_level=-1))
    m.add(dd.Pattern("p", [x], np.linspace(0, 5, 40))) >> u
    u >> dd.Shift(2) >> w
    u >> dd.Sigmoid(dd.Logistic(2, 0.3)) >> w
    u >> dd.Interaction([dd.Gaussian(2, 0.5, normalized=True)], 0.2) >> w
    product = m.add(dd.Product(name="product"))
    u >> product
    u >> product["factor"]
    product >> w
    custom = m.add(dd.Convolve([dd.Custom(np.arange(5.0))], name="custom"))
    u >> custom
    w >> custom
    custom >> w
    u >> dd.Resample([y]) >> c
    c >> dd.Weights(np.eye(40, 20) / 3, [x]) >> w
    return m, ["u", "w", "c"]


def later():
    """What is read one step later, and what was computed in the same step."""
    m = dd.Model("later")
    u = m.add(dd.Field("u", [RING], kernel=[dd.Gaussian(2, 3)]))
    v = m.add(dd.Field("v", [RING]))
    m.add(dd.Field("w", [RING]))
    m.add(dd.GaussianStimulus("s", [RING], center=20, sigma=4, amplitude=9)) >> u
    m.connect("u", "v", reads="current")
    m.connect("v", "w", reads="previous")
    g = m.add(dd.Gain(4.0, name="g"))
    u >> g
    m.connect("g", "w", reads="delayed")
    d = m.add(dd.Delay([RING], name="d"))
    u >> d >> v
    return m, ["u", "v", "w"]


def never_and_always():
    """Stimuli that are never on, a sum of a boost that is always on, and a gate that never opens."""
    m = dd.Model("never")
    u = m.add(dd.Field("u", [LINE]))
    n = m.add(dd.RateNode("n"))
    m.add(dd.GaussianStimulus("lasting", [LINE], center=-9, sigma=3, amplitude=6)) >> u
    m.add(dd.GaussianStimulus("bell", [LINE], center=0, sigma=3, amplitude=9, windows=[])) >> u
    m.add(dd.Pattern("pattern", [LINE], np.linspace(0, 9, 121), windows=[])) >> u
    m.add(dd.Boost("boost", [], 9.0, windows=[])) >> n
    total = m.add(dd.Sum(name="sum"))
    m.add(dd.Boost("sum period", [], 3.0)) >> total >> n
    product = m.add(dd.Product(name="gated"))
    u["activation"] >> product
    m.connect(m.add(dd.Boost("gated on", [], 1.0, windows=[])), product["factor"])
    product >> u
    return m, ["u", "n"]


MODELS = [selection, memory, broad, coupled, node, planes, couplings, later, never_and_always]


@pytest.mark.parametrize("make", MODELS)
def test_the_exported_file_gives_the_trajectory(make):
    model, fields = make()
    exported = write(model, "file.json")
    assert exported.report.faithful and read(exported.content, "file.json").report.faithful
    assert largest_difference(model, fields, 80) < 1e-9


@pytest.mark.parametrize("dt", [0.5, 2.0])
def test_the_step_of_the_document_is_that_of_the_file(dt):
    for make in (selection, memory):
        model, fields = make()
        model.describe(dt=dt)
        content = json.loads(write(model, "file.json").content)
        assert content["simulator"]["deltaT"] == dt
        assert largest_difference(model, fields, 40) < 1e-9


def test_a_threshold_moves_the_resting_level_and_the_output_is_the_same():
    m = dd.Model("threshold")
    u = m.add(dd.Field("u", [RING], sigmoid=dd.Logistic(3, threshold=0.5), kernel=[dd.Gaussian(2, 3)]))
    m.add(dd.GaussianStimulus("s", [RING], center=20, sigma=4, amplitude=9)) >> u
    assert largest_difference(m, ["u"], 60, "output") < 1e-9
    exported = write(m, "file.json")
    (line,) = (line for line in exported.report.lines if line.what == "resting_level")
    assert line.verdict == "carried" and "-5.5" in line.why


def test_a_kernel_of_a_plane_that_is_as_wide_as_its_ring_is_approximated():
    m = dd.Model("wide")
    u = m.add(dd.Field("u", [SPACE, COLOR], kernel=[dd.Gaussian(0.1, [2, 60])], global_inhibition=0.0001))
    m.add(dd.GaussianStimulus("i", [SPACE, COLOR], center=[5, 90], sigma=[2, 30], amplitude=9)) >> u
    report = write(m, "file.json").report
    assert [line.verdict for line in report.losses] == ["approximated"] and "images" in report.losses[0].why
    assert 1e-9 < largest_difference(m, ["u"], 30) < 0.1


@pytest.mark.parametrize("length", [0.0, 5.0])
def test_noise_has_the_same_strength_and_correlation(length):
    """The noise of a field, and a source of noise, in steps of 2 and with samples 0.5 apart."""
    x = dd.Axis("x", 0, 1000, samples=2000, periodic=True)
    m = dd.Model("noise")
    m.describe(dt=2.0)
    m.add(dd.Field("u", [x], tau=10, noise=3, noise_length=length))
    v = m.add(dd.Field("v", [x], tau=10))
    m.add(dd.Noise("n", [x], 3, length)) >> v
    exported = write(m, "file.json")
    assert exported.report.faithful
    plain = Sim(
        [
            (a, "CustomStimulus", _drawn(p), i) if k == "NormalNoise" else (a, k, p, i)
            for a, k, p, i in elements(exported.content)
        ],
        2.0,
    )
    plain.step()
    ours = dd.simulate(m, 2, every=2, record=["n.output"], precision="float64")["n.output"].values[-1]
    strength = 3 / np.sqrt(2.0) / (1 if length else np.sqrt(0.5))
    for noise in (ours, plain.out["noise u"]["output"][0], plain.out["n"]["output"][0]):
        assert noise.std() == pytest.approx(strength, rel=0.2)
        correlation = np.corrcoef(noise[:-4], noise[4:])[0, 1]
        assert correlation == pytest.approx(np.exp(-0.5 * (2 / length) ** 2) if length else 0, abs=0.1)


def _drawn(p):
    """Return the parameters of a pattern that is one sample of noise, in steps of 2."""
    rng = np.random.default_rng(4)
    return {"size": p["size"], "pattern": p["amplitude"] * rng.normal(size=p["size"]) / np.sqrt(2.0)}


@pytest.mark.parametrize(("sigma", "far"), [(6, 1e-9), (10, 1e-4), (20, 1e-9)])
def test_a_gaussian_that_wraps_around_its_ring_is_exact_approximated_or_a_matrix(sigma, far):
    m = dd.Model("ring")
    kernel = [dd.Gaussian(20, 4, normalized=True), dd.Gaussian(-15, sigma, normalized=True)]
    u = m.add(dd.Field("u", [RING], kernel=kernel))
    m.add(dd.GaussianStimulus("cue", [RING], center=25, sigma=5, amplitude=8)) >> u
    exported = write(m, "file.json")
    kinds = [
        kind for _, kind, _, _ in elements(exported.content) if "Neural" not in kind and "Stim" not in kind
    ]
    assert (
        kinds
        == {6: ["MexicanHatKernel1D"], 10: ["MexicanHatKernel1D"], 20: ["GaussKernel1D", "WeightMatrix"]}[
            sigma
        ]
    )
    assert exported.report.faithful == (sigma != 10)
    difference = largest_difference(m, ["u"], 60)
    assert difference < far and (sigma != 10 or difference > 1e-9)
