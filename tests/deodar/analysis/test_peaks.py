"""Peaks: count, position, width and amplitude, on lines and rings, in any dimension."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.analysis.peaks import peaks

x = dd.Axis("x", 0, 100, samples=101)
ring = dd.Axis("phi", 0, 360, samples=72, periodic=True, unit="deg")


def bump(
    axis: dd.Axis, center: float, sigma: float = 6.0, height: float = 3.0, resting: float = -1.0
) -> np.ndarray:
    d = axis.points - center
    if axis.periodic:
        d = d - axis.range * np.round(d / axis.range)
    return resting + (height - resting) * np.exp(-(d**2) / (2 * sigma**2))


@pytest.mark.parametrize("center", [30.0, 30.3, 47.77, 62.5])
def test_position_and_width_are_interpolated_between_samples(center: float) -> None:
    (peak,) = peaks(bump(x, center), [x])
    assert peak.position[0] == pytest.approx(center, abs=0.05)
    assert peak.width[0] == pytest.approx(2 * 6.0 * np.sqrt(2 * np.log(4.0)), abs=0.1)
    assert peak.amplitude == pytest.approx(3.0, abs=0.05)


@pytest.mark.parametrize("center", [0.0, 2.4, 357.9, 359.99, 180.0])
def test_a_peak_across_the_ends_of_a_periodic_axis_is_one_peak(center: float) -> None:
    measured = peaks(bump(ring, center, sigma=20), [ring])
    assert len(measured) == 1
    off = (measured[0].position[0] - center + 180) % 360 - 180
    assert abs(off) < 0.3 and 0 <= measured[0].position[0] < 360
    assert measured[0].width[0] == pytest.approx(2 * 20 * np.sqrt(2 * np.log(4.0)), abs=1.0)


def test_activation_at_both_ends_of_a_line_is_two_peaks() -> None:
    assert len(peaks(np.maximum(bump(x, 0), bump(x, 100)), [x])) == 2


def test_peaks_are_sorted_by_height_and_counted_above_the_threshold() -> None:
    u = np.maximum(bump(x, 20, height=2.0), bump(x, 70, height=3.0))
    measured = peaks(u, [x])
    assert [round(p.position[0]) for p in measured] == [70, 20]
    assert len(peaks(u, [x], threshold=2.5)) == 1 and len(peaks(u, [x], threshold=3.5)) == 0


def test_a_peak_across_the_ends_of_two_periodic_axes_is_one_peak() -> None:
    a, b = dd.Axis("a", 0, 10, samples=40, periodic=True), dd.Axis("b", 0, 10, samples=40, periodic=True)
    u = -1 + 4 * np.multiply.outer(bump(a, 0.1, 1.0, 1, 0), bump(b, 9.8, 1.0, 1, 0))
    (peak,) = peaks(u, [a, b])
    assert np.allclose(((np.array(peak.position) - [0.1, 9.8]) + 5) % 10 - 5, 0, atol=0.05)
    assert peak.size == pytest.approx(np.pi * 2 * np.log(4.0), rel=0.1)


def test_a_node_above_the_threshold_is_one_peak() -> None:
    assert len(peaks(np.array(0.5), [])) == 1 and len(peaks(np.array(-0.5), [])) == 0


def test_the_axes_of_a_recorded_variable_are_taken_from_the_record() -> None:
    model = dd.Model("record")
    model.add(dd.Field("u", [ring], resting_level=-2)) and None
    model.add(dd.GaussianStimulus("s", [ring], center=355, sigma=20, amplitude=6)) >> model["u"]
    record = dd.simulate(model, 200)
    (peak,) = peaks(record["u.activation"].isel(time=-1))
    assert abs((peak.position[0] - 355 + 180) % 360 - 180) < 0.5
    assert "355" in repr(peak) or "354" in repr(peak)
    assert "<table>" in peaks(record["u.activation"].isel(time=-1))._repr_html_()


def test_activation_of_another_shape_or_with_nan_is_refused() -> None:
    with pytest.raises(dd.errors.AnalysisError, match="shape"):
        peaks(np.zeros(5), [x])
    with pytest.raises(dd.errors.AnalysisError, match="finite"):
        peaks(np.full(101, np.nan), [x])


@pytest.mark.parametrize("axis", [x, dd.Axis("phi", 0, 100, samples=101, periodic=True)])
def test_each_of_two_peaks_has_a_width_of_its_own(axis: dd.Axis) -> None:
    narrow, broad = bump(axis, 20, sigma=3, height=3.0), bump(axis, 70, sigma=8, height=2.0)
    measured = peaks(np.maximum(narrow, broad), [axis])
    assert [p.width[0] for p in measured] == pytest.approx(
        [2 * 3 * np.sqrt(2 * np.log(4.0)), 2 * 8 * np.sqrt(2 * np.log(3.0))], abs=0.2
    )
    assert [p.size for p in measured] == pytest.approx([p.width[0] for p in measured])


def test_the_width_is_measured_within_the_region_of_the_peak() -> None:
    u = -np.ones((5, 7))
    u[0, 1:6], u[0:4, 1], u[0:4, 5] = 1, 1, 1  # a bow: the row of its highest sample meets both legs
    u[2, 1] = 2
    a, b = dd.Axis("a", 0, 4, samples=5), dd.Axis("b", 0, 6, samples=7)
    (peak,) = peaks(u, [a, b])
    assert peak.samples == 11 and peak.width[1] == pytest.approx(2 / 3 + 2 / 3)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("flipped", [False, True])
def test_a_region_that_touches_two_others_across_the_ends_joins_them(turned: bool, flipped: bool) -> None:
    u = -np.ones((6, 9))
    u[0, 1:8], u[-1, 1:3], u[-1, 6:8] = 1, 1, 1
    axes = [dd.Axis("a", 0, 6, samples=6, periodic=True), dd.Axis("b", 0, 8, samples=9)]
    u = u[::-1] if flipped else u
    (peak,) = peaks(u.T, axes[::-1]) if turned else peaks(u, axes)
    assert peak.samples == 11
