"""Loci of Hopf points against closed forms of two nodes, growth rates, folds and single branches."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from tests.deodar.analysis.continuation.models import oscillator

SELF, FORTH = 2.5, 6.0
"""Self-excitation of the excitatory node, and its input to the inhibitory one, of `oscillator`."""


def steep(excitation: float) -> float:
    """Return the output of the excitatory node where the trace of the growth rates is 0, below one half.

    The trace is (w g' - 1) / 20 - 1 / 40 with g' = 4 g (1 - g).
    """
    slope = 1.5 / excitation
    return 0.5 - np.sqrt(0.25 - slope / 4)


def closed_form(factor: float, high: bool, excitation: float = SELF) -> tuple[float, float]:
    """Return the resting level of the excitatory node at a Hopf point, and the square of its frequency.

    From the inhibitory node the excitatory one has the input `factor` times its output.
    """
    g = steep(excitation)
    e, i = (1 - g, g)[not high], 1 / (1 + np.exp(-(FORTH * (1 - g if high else g) - 3)))
    u = np.log(e / (1 - e)) / 4
    slope_e, slope_i = 4 * e * (1 - e), i * (1 - i)
    square = (1 - excitation * slope_e - factor * FORTH * slope_e * slope_i) / (20 * 40)
    return float(u - excitation * e - factor * i), float(square)


@pytest.fixture(scope="module")
def hopf() -> list[dd.analysis.Bifurcation]:
    return list(dd.continuation(oscillator(), "e.resting_level", (-4, 6), finer=False).bifurcations)


def test_the_hopf_points_of_two_nodes_are_straight_lines_up_to_bogdanov_takens_points(hopf):
    for high, point in enumerate(hopf):
        curve = dd.locus(point, "back.factor", (-12, 0), (-20, 20))
        assert curve.of == "Hopf"
        for (level, factor), frequency in zip(curve.values, curve.frequencies, strict=True):
            expected, square = closed_form(factor, bool(high))
            assert level == pytest.approx(expected, abs=1e-8)
            assert frequency**2 == pytest.approx(square, abs=1e-9)
        (end,) = curve.points
        assert end.kind == "Bogdanov-Takens"
        # 1 - w g' = -1/2 there
        g = steep(SELF)
        i = 1 / (1 + np.exp(-(FORTH * (1 - g if high else g) - 3)))
        factor = -0.5 / (FORTH * 0.6 * i * (1 - i))
        assert end.values == pytest.approx((closed_form(factor, bool(high))[0], factor), abs=1e-7)
        assert tuple(curve.values[-1]) == end.values and curve.frequencies[-1] == 0
        assert curve.values[0, 1] <= -12, "the other end is that of the span"


def test_a_hopf_line_ends_where_the_fold_has_its_bogdanov_takens_point():
    model = oscillator()
    model.set("e.kernel.0.amplitude", 6.0)
    branch = dd.continuation(model, "e.resting_level", (-4, 6), finer=False)
    fold = next(b for b in branch.bifurcations if b.kind == "fold")
    points = dd.locus(fold, "back.factor", (-12, 0), (-10, 15)).points
    doubles = [point.values for point in points if point.kind == "Bogdanov-Takens"]
    assert len(doubles) == 2
    model.set("back.factor", -9.0)
    bifurcations = dd.continuation(model, "e.resting_level", (-4, 10), finer=False).bifurcations
    lines = [dd.locus(b, "back.factor", (-12, 0), (-10, 15)) for b in bifurcations if b.kind == "Hopf"]
    ends = [p.values for line in lines for p in line.points]
    assert len(ends) == 2
    for end in ends:
        assert min(np.abs(np.subtract(end, double)).max() for double in doubles) < 1e-6


@pytest.mark.parametrize("last", [6, 8, 10, 12])
def test_a_pair_that_is_real_at_the_next_point_crosses_in_a_hopf_point(last):
    """Whatever the steps are: behind the Hopf points the two growing modes soon oscillate no more."""
    model = oscillator()
    model.set({"e.kernel.0.amplitude": 6.0, "back.factor": -9.0})
    bifurcations = dd.continuation(model, "e.resting_level", (-4, last), finer=False).bifurcations
    assert [b.kind for b in bifurcations] == ["Hopf", "Hopf"]
    for b, high in zip(bifurcations, (False, True), strict=True):
        level, square = closed_form(-9.0, high, 6.0)
        assert (b.value, b.frequency**2) == pytest.approx((level, square), abs=1e-7)


def test_the_excitation_bends_the_line(hopf):
    curve = dd.locus(hopf[0], "e.kernel.0.amplitude", (1.6, 5), (-10, 10))
    assert len(curve.values) > 10
    for (level, excitation), frequency in zip(curve.values, curve.frequencies, strict=True):
        expected = [closed_form(-6.0, high, excitation) for high in (False, True)]
        nearest = min(expected, key=lambda pair: abs(pair[0] - level))
        assert level == pytest.approx(nearest[0], abs=1e-7)
        assert frequency**2 == pytest.approx(nearest[1], abs=1e-8)


def fields() -> dd.Model:
    """Return an excitatory and an inhibitory field, which oscillate under a wide input."""
    x = dd.Axis("x", 0, 100, samples=41, unit="deg")
    model = dd.Model("waves", dt=1)
    kernel = [dd.Gaussian(4, 6, normalized=True)]
    e = model.add(dd.Field("e", [x], tau=20, resting_level=-4, kernel=kernel))
    i = model.add(dd.Field("i", [x], tau=40, resting_level=-3, sigmoid=dd.Logistic(beta=1)))
    model.add(dd.GaussianStimulus("s", [x], center=50, sigma=15, amplitude=0)) >> e
    e >> dd.Gain(6.0, name="forth") >> i
    i >> dd.Gain(-6.0, name="back") >> e
    return model


def test_the_fastest_mode_of_two_fields_neither_grows_nor_decays_along_the_line():
    branch = dd.continuation(fields(), "s.amplitude", (0, 8), finer=False)
    first = next(b for b in branch.bifurcations if b.kind == "Hopf")
    curve = dd.locus(first, "back.factor", (-6.5, -5.5), (0, 12))
    assert curve.values[:, 1].min() <= -6.5 and curve.values[:, 1].max() >= -5.5
    amplitude, factor = curve.values[3]
    model = fields()
    model.set("back.factor", float(factor))
    bifurcations = dd.continuation(model, "s.amplitude", (0, 8), finer=False).bifurcations
    nearest = min((b for b in bifurcations if b.kind == "Hopf"), key=lambda b: abs(b.value - amplitude))
    assert nearest.value == pytest.approx(amplitude, abs=1e-6)
    assert nearest.frequency == pytest.approx(curve.frequencies[3], rel=1e-6)


def test_the_line_and_its_frequencies_survive_a_file_and_are_drawn(hopf, tmp_path):
    curve = dd.locus(hopf[0], "back.factor", (-8, 0), (-20, 20))
    loaded = dd.analysis.Locus.load(curve.save(tmp_path / "hopf.nc"))
    assert loaded.data() == curve.data() and np.array_equal(loaded.frequencies, curve.frequencies)
    axes = dd.locus_figure(curve, loaded).axes[0]
    assert [drawn.get_marker() for drawn in axes.lines] == ["None", "*", "None"]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["Hopf"]
