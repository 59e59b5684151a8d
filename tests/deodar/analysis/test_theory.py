"""What is measured against what theory says: Amari (1977), for one dimension, a step output and no noise.

With w(x) = A exp(-x^2 / 2 sigma^2) - c and W(a) = integral_0^a w, a peak of width a is stationary where W(a)
+ h + s0 = 0 (s0: homogeneous input). It is stable where w(a) < 0; none exists below s0 = -h - max W.
"""

from __future__ import annotations

import dataclasses as dc

import numpy as np
import pytest
from scipy import optimize, special

import deodar as dd
from deodar.analysis.isolated import isolate
from deodar.analysis.thresholds import thresholds
from deodar.analysis.working_memory import forgetting, outlives
from deodar.numerics.sigmoids import Step

LENGTH, TAU = 80.0, 10.0
SETS = [  # amplitude, sigma, inhibition, resting level
    (1.0, 5.0, 0.30, -2.0),
    (1.5, 4.0, 0.40, -3.0),
    (0.8, 6.0, 0.20, -1.5),
]


def w(x: float, a: float, sigma: float, c: float) -> float:
    return a * np.exp(-(x**2) / (2 * sigma**2)) - c


def big_w(width: float, a: float, sigma: float, c: float) -> float:
    return a * sigma * np.sqrt(np.pi / 2) * special.erf(width / (sigma * np.sqrt(2))) - c * width


def widest_rise(a: float, sigma: float, c: float) -> float:
    """Where w(a) = 0: W is largest there, and stability changes."""
    return sigma * np.sqrt(2 * np.log(a / c))


def widths(a: float, sigma: float, c: float, level: float) -> tuple[float, float]:
    """The unstable and the stable width at h + s0 = level."""
    top = widest_rise(a, sigma, c)

    def off(width: float) -> float:
        return big_w(width, a, sigma, c) + level

    return optimize.brentq(off, 1e-9, top), optimize.brentq(off, top, LENGTH)


def field(a: float, sigma: float, c: float, h: float, samples: int) -> dd.Field:
    x = dd.Axis("x", 0, LENGTH, samples=samples, periodic=True)
    return dd.Field(
        "u",
        [x],
        tau=TAU,
        resting_level=h,
        sigmoid=Step(),
        kernel=[dd.Gaussian(a, sigma)],
        global_inhibition=c,
    )


@pytest.mark.parametrize("samples", [160, 320])
@pytest.mark.parametrize(("a", "sigma", "c", "h"), SETS)
def test_the_width_of_a_settled_peak_is_that_of_theory(
    a: float, sigma: float, c: float, h: float, samples: int
) -> None:
    _, stable = widths(a, sigma, c, h)
    isolated = isolate(field(a, sigma, c, h, samples), precision="float64")
    memory = outlives(isolated, 1.5 * abs(h))
    assert memory.outlives and memory.settled and len(memory.left) == 1
    assert memory.left[0].width[0] == pytest.approx(stable, abs=LENGTH / samples)
    assert memory.left[0].position[0] == pytest.approx(isolated.center[0], abs=LENGTH / samples)


@pytest.mark.parametrize(("a", "sigma", "c", "h"), SETS)
def test_the_width_between_growth_and_decay_is_that_of_theory(
    a: float, sigma: float, c: float, h: float
) -> None:
    samples = 640
    step = LENGTH / samples
    unstable, stable = widths(a, sigma, c, h)
    assert w(unstable, a, sigma, c) > 0 > w(stable, a, sigma, c)
    for width, grows in ((unstable - 3 * step, False), (unstable + 3 * step, True)):
        isolated = isolate(field(a, sigma, c, h, samples), precision="float64")
        x = np.asarray(isolated.axes[0].points) - LENGTH / 2
        shape = h + sum(
            w(x - y, a, sigma, c) * step for y in np.arange(-width / 2 + step / 2, width / 2, step)
        )
        start = isolated.snapshot()
        ident = isolated.session.document.by_names()[("field",)].id
        row = {"activation": shape}
        isolated.restore(dc.replace(start, states={**start.states, ident: (row, row)}))
        isolated.settle()
        peaks = isolated.peaks()
        assert bool(peaks) == grows, (width, unstable)
        if grows:
            assert peaks[0].width[0] == pytest.approx(stable, abs=step)


@pytest.mark.parametrize(("a", "sigma", "c", "h"), SETS)
def test_the_resting_level_below_which_peaks_vanish_is_that_of_theory(
    a: float, sigma: float, c: float, h: float
) -> None:
    """A step output on a grid sees the edge at its last sample, half a cell inside: an offset of w(0) step /
    2, which two grids remove.
    """
    measured = []
    for samples in (320, 640):
        step = LENGTH / samples
        forgotten = forgetting(
            isolate(field(a, sigma, c, h, samples), precision="float64"), 1.5 * abs(h), accuracy=0.002
        )
        assert forgotten is not None and forgotten.jump
        on_this_grid = -h - np.cumsum(w(np.arange(samples // 2) * step, a, sigma, c) * step).max()
        assert forgotten.value == pytest.approx(on_this_grid, rel=0.01)
        measured.append(forgotten.value)
    lowest = -h - big_w(widest_rise(a, sigma, c), a, sigma, c)
    assert 2 * measured[1] - measured[0] == pytest.approx(lowest, rel=0.01)
    assert abs(measured[1] - lowest) < 0.6 * abs(measured[0] - lowest)


@pytest.mark.parametrize(("a", "sigma", "c", "h"), SETS)
@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_localised_input_is_detected_where_it_reaches_the_threshold(
    a: float, sigma: float, c: float, h: float, precision: str
) -> None:
    """A step output is silent up to the threshold, so that detection is where h + amplitude = 0."""
    detection = thresholds(isolate(field(a, sigma, c, h, 160), precision=precision)).detection
    assert detection is not None and detection.jump and detection.value == pytest.approx(-h, rel=0.01)


def test_a_settled_field_satisfies_its_fixed_point_equation() -> None:
    """The pattern that is left satisfies u = h + w * g(u), recomputed with plain sums."""
    isolated = isolate(
        dc.replace(field(1.0, 5.0, 0.30, -2.0, 160), sigmoid=dd.Logistic(20.0)), precision="float64"
    )
    memory = outlives(isolated, 3.0)
    assert memory.outlives
    u, x, step = memory.activation, isolated.axes[0].points, isolated.axes[0].step
    g = 1 / (1 + np.exp(-20.0 * u))
    lag = x[:, None] - x[None]
    lag = lag - LENGTH * np.round(lag / LENGTH)
    right = -2.0 + step * (w(lag, 1.0, 5.0, 0.30) @ g)
    assert np.abs(u - right).max() < 5e-3
