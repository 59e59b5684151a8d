"""A finer grid changes cost, not behaviour: positions, thresholds and switching rates at 1x, 2x and, over one
axis, 4x the samples.
"""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd

FINER = {1: (1, 2, 4), 2: (1, 2)}
"""Samples relative to those of the coarse grid, by dimensions."""
LENGTH = {1: 60.0, 2: 40.0}
COARSE = {1: 61, 2: 29}
PLACE = {1: (27.3,), 2: (17.1, 22.4)}


def axes(dimensions: int, finer: int) -> list[dd.Axis]:
    samples = (COARSE[dimensions] - 1) * finer + 1
    return [dd.Axis(name, 0, LENGTH[dimensions], samples=samples) for name in "xy"[:dimensions]]


def localised(dimensions: int, finer: int, former: float) -> dd.Model:
    """Return a bistable field with a tested input; `former` is the strength of an earlier, temporary input
    that creates a peak.
    """
    over = axes(dimensions, finer)
    model = dd.Model("resolution")
    kernel = [
        dd.Gaussian(11 if dimensions == 1 else 18, 4, normalized=True),
        dd.Gaussian(-6, 9, normalized=True),
    ]
    u = model.add(
        dd.Field(
            "u", over, tau=10, resting_level=-5, sigmoid=dd.Logistic(2), kernel=kernel, global_inhibition=0.01
        )
    )
    for name, amplitude, windows in (("former", former, [(0, 150)]), ("tested", 0.0, None)):
        (
            model.add(
                dd.GaussianStimulus(
                    name, over, center=PLACE[dimensions], sigma=3, amplitude=amplitude, windows=windows
                )
            )
            >> u
        )
    model["u"]["activation"] >> model.add(dd.Project([], reduce="max", name="top"))
    return model


def lowest_with_a_peak(model: dd.Model, low: float, high: float) -> float:
    """Return the smallest tested amplitude, to 1/121 of the range, with a peak at the end, from two sweeps
    of which the second is finer.
    """
    for _ in range(2):
        amplitudes = np.linspace(low, high, 12)
        record = dd.simulate(
            model, 900, record=["top.output"], every=900, sweep={"tested.amplitude": amplitudes}
        )
        peak = record["top.output"].values[:, -1] > 0
        assert peak[-1] and not peak[0], "the threshold lies outside the range that is searched"
        first = int(np.argmax(peak))
        low, high = float(amplitudes[first - 1]), float(amplitudes[first])
    return high


def place(model: dd.Model, dimensions: int) -> np.ndarray:
    model.set("tested.amplitude", 8.0)
    activation = dd.simulate(model, 300)["u.activation"].isel(time=-1)
    weight = np.maximum(activation.values, 0)
    grids = np.meshgrid(*(activation[name].values for name in "xy"[:dimensions]), indexing="ij")
    return np.array([(g * weight).sum() / weight.sum() for g in grids])


@pytest.mark.parametrize("dimensions", [1, 2])
def test_positions_and_thresholds_converge_on_finer_grids(dimensions: int) -> None:
    detection, forgetting, places = [], [], []
    for finer in FINER[dimensions]:
        detection.append(lowest_with_a_peak(localised(dimensions, finer, former=0), 3.5, 6.0))
        forgetting.append(lowest_with_a_peak(localised(dimensions, finer, former=9), 0.5, 4.5))
        places.append(place(localised(dimensions, finer, former=0), dimensions))
    step = LENGTH[dimensions] / (COARSE[dimensions] - 1)
    for finer, position in zip(FINER[dimensions], places, strict=True):
        assert np.abs(position - places[-1]).max() <= step / 2, finer
        assert np.abs(position - PLACE[dimensions]).max() <= step / 2, finer
    assert np.mean(forgetting) < 0.9 * np.mean(detection), (
        "without hysteresis the two thresholds would be one"
    )
    for thresholds in (detection, forgetting):
        assert max(thresholds) / min(thresholds) <= 1.03, thresholds


def noisy(dimensions: int, finer: int) -> dd.Model:
    """Return a field just below detection, driven over it by noise that is correlated over four coarse
    samples.
    """
    samples, length, strength = {1: (26, 50.0, 8.0), 2: (11, 40.0, 14.0)}[dimensions]
    over = [dd.Axis(name, 0, length, samples=(samples - 1) * finer + 1) for name in "xy"[:dimensions]]
    four = 4 * length / (samples - 1)
    model = dd.Model("switching")
    kernel = [dd.Gaussian(strength, 5 if dimensions == 1 else 6, normalized=True)]
    model.add(dd.Field("u", over, tau=10, resting_level=-1.5, kernel=kernel, noise=1.8, noise_length=four))
    model["u"]["activation"] >> model.add(dd.Project([], reduce="max", name="top"))
    return model


@pytest.mark.parametrize(("dimensions", "trials"), [(1, 2000), (2, 1300)])
def test_switching_rate_under_correlated_noise(dimensions: int, trials: int) -> None:
    rates, events = [], []
    for finer in FINER[dimensions]:
        top = dd.simulate(noisy(dimensions, finer), 200, record=["top.output"], every=2, trials=trials)[
            "top.output"
        ].values
        peak = top > 1.0
        waited = np.where(peak.any(1), peak.argmax(1), peak.shape[1]) * 2.0
        events.append(int(peak.any(1).sum()))
        rates.append(events[-1] / waited.sum())
    assert min(events) >= 1000, events
    for a in range(len(rates)):
        for b in range(a):
            interval = 1.96 * np.sqrt(1 / events[a] + 1 / events[b])
            assert abs(np.log(rates[a] / rates[b])) <= max(interval, np.log(1.10)), (rates, events)


def test_white_noise_keeps_its_spatial_integral() -> None:
    spread = []
    for finer in FINER[1]:
        model = dd.Model("white")
        over = [dd.Axis("x", 0, 60, samples=30 * finer, periodic=True)]
        model.add(dd.Field("u", over, tau=10, noise=1.0)) >> model.add(dd.Project([], name="total"))
        model.disconnect("u", "total")
        model.connect(model["u"]["activation"], "total")
        record = dd.simulate(model, 100, record=["total.output"], every=100, trials=1500, precision="float64")
        spread.append(float(record["total.output"].values[:, -1].std()))
    assert max(spread) / min(spread) < 1.10, spread
