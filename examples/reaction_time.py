"""Reaction times of a choice between two targets, against their distance, and with one of them expected.

    python examples/reaction_time.py

Two equal inputs come at 100 ms, and a trial ends when a peak has formed. Look at the figure: near targets add
up and are answered soonest, at a place between them; far ones inhibit each other and take longest. A
pre-shape, which is there from the start and too weak for a peak, makes the answer to the expected target come
sooner, and this target is chosen. Without a pre-shape the model is symmetric: the share of peaks left of the
middle is one half. A peak exactly at the middle would count half. Bands are 95 % intervals: of medians by the
binomial law, of shares by Wilson's.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import deodar as dd

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

ONSET, MIDDLE, RESTING = 100.0, 50.0, -5.0
DISTANCES = (4, 8, 12, 16, 20, 28, 36)


def experiment(trials: int = 100) -> dd.Experiment:
    """Return an experiment of `trials` trials for each distance, without and with a pre-shape at the left."""
    x = dd.Axis("x", 0, 100, samples=101, unit="deg")
    model = dd.Model("reaction time")
    kernel = [dd.Gaussian(amplitude=1.2, sigma=5)]
    u = model.add(
        dd.Field("u", [x], tau=20, resting_level=RESTING, kernel=kernel, global_inhibition=0.6, noise=1.0)
    )
    for name in ("left", "right"):
        (
            model.add(
                dd.GaussianStimulus(name, [x], center=MIDDLE, sigma=5, amplitude=5, windows=[(ONSET, 1e9)])
            )
            >> u
        )
    model.add(dd.GaussianStimulus("preshape", [x], center=MIDDLE, sigma=5, amplitude=1)) >> u
    places = {
        d: {"left.center": MIDDLE - d / 2, "right.center": MIDDLE + d / 2, "preshape.center": MIDDLE - d / 2}
        for d in DISTANCES
    }
    return dd.Experiment(
        "reaction time",
        model,
        dd.TrialPlan(
            600,
            events=[dd.Appears("detected", "u")],
            # half the resting level, because at detection only one sample is above 0
            measures=[dd.Measure("place", "u.activation", "place", threshold=RESTING / 2)],
        ),
        trials=trials,
        factors=[
            dd.Factor("distance", {f"{d} deg": p for d, p in places.items()}),
            dd.Factor("preshape", [0.0, 1.0], "preshape.amplitude"),
        ],
    )


def left_of_middle(places: np.ndarray) -> tuple[float, int]:
    """How many peaks are left of the middle, those exactly at the middle counted half, and how many peaks
    there are.
    """
    found = places[~np.isnan(places)]
    return float((found < MIDDLE).sum() + 0.5 * (found == MIDDLE).sum()), len(found)


def reactions(data: xarray.Dataset, preshape: float) -> dict[str, list[tuple[float, tuple[float, float]]]]:
    """For each distance the median time from the onset to a peak, and the share of peaks left of the middle,
    with their intervals.
    """
    out: dict[str, list[tuple[float, tuple[float, float]]]] = {"time": [], "left": []}
    for d in DISTANCES:
        cell = data.isel(trial=((data["distance"] == f"{d} deg") & (data["preshape"] == preshape)).values)
        times = cell["detected"].values - ONSET
        left, n = left_of_middle(cell["place"].values)
        middle = float(cell["detected"].median()) - ONSET
        out["time"].append((middle, dd.median_interval(times) or (middle, middle)))
        out["left"].append((left / n, dd.wilson(left, n) or (0.0, 1.0)))
    return out


def figure(data: xarray.Dataset) -> Figure:
    """Time to detection and choices against the distance of the targets, with 95 % bands."""
    import matplotlib.pyplot as plt

    plt.rcParams.update(dd.figures.RC)
    made, (times, choices) = plt.subplots(1, 2, figsize=(7.2, 2.9), layout="constrained")
    for preshape, label in ((0.0, "no pre-shape"), (1.0, "pre-shape at the left target")):
        found = reactions(data, preshape)
        for axes, name in ((times, "time"), (choices, "left")):
            (line,) = axes.plot(DISTANCES, [v for v, _ in found[name]], marker="o", label=label)
            lows, highs = zip(*(interval for _, interval in found[name]), strict=True)
            axes.fill_between(DISTANCES, lows, highs, color=line.get_color(), alpha=0.25)
            axes.set_xlabel("distance of the targets (deg)")
    choices.axhline(0.5, **dd.figures.THRESHOLD_LINE)
    times.set(ylabel="time to detection (ms)", ylim=(0, None), title="median, 95 % interval")
    choices.set(ylabel="share of peaks left of the middle", ylim=(0, 1.03), title="share, 95 % interval")
    times.legend(loc="lower right")
    return made


if __name__ == "__main__":
    found = experiment().run()
    for preshape in (0.0, 1.0):
        row = reactions(found, preshape)
        told = "   ".join(
            f"{d} deg: {t:3.0f} ms {100 * s:3.0f} %"
            for d, (t, _), (s, _) in zip(DISTANCES, row["time"], row["left"], strict=True)
        )
        print(f"pre-shape {preshape:g}:  {told}")
    figure(found).savefig(Path("reaction_time.png"), dpi=120)
    print("The figure is reaction_time.png")
