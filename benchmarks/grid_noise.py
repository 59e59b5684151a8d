"""Prints how far reaction times and drift on a coarse grid are from those on a fine one, with the same noise
on both: `python benchmarks/grid_noise.py [--dimensions 1] [--quadrature NAME]`. Ends with 1 if an error
exceeds its limit.

The noise of a field is drawn for each sample, so that two grids draw different noise. Here it is the input
from a source of independent modes, sines and cosines that the coarsest grid resolves, with the variances of a
Gaussian correlation. One seed gives each grid the same noise, and differences between trials are the grid's.

The reaction time is the time from the onset of an input, which is a little stronger than the detection
threshold, until the activation is above 0 somewhere. Drift is the variance of the distance that a memory
without input moves in 3,000 ms. Pinning is how far from its input a memory comes to lie without noise. Fields
are the first ones of `benchmarks/grids.py`, with logistic functions of steepness 4; the reference is the rule
`cell` on its fine grids. Limits are required of `cell` over one axis.
"""

from __future__ import annotations

import argparse
import functools
import math
import sys
import time
from dataclasses import dataclass

import numpy as np

import deodar as dd
import grids
import resolution

NOISE, CORRELATION = 1.0, 4.0
"""Standard deviation at a point, and correlation length."""
MODES = {1: 24, 2: 14}
"""Largest number of waves along an axis."""
ONSET, OBSERVED, STRENGTH = 100.0, 1000.0, 4.6
"""When the input of a reaction begins and when the run ends, in ms; its amplitude."""
MADE, SETTLED, HELD = 400.0, 800.0, 3800.0
"""When the input of a memory ends, and between which times its drift is measured, in ms."""
LIMITS = {"reaction time": 0.5, "drift": 1.0}
"""Largest errors in percent."""


@dataclass(frozen=True)
class Grid:
    """A field on one grid.

    Attributes:
        dimensions: number of its axes.
        width: samples a kernel width.
        quadrature: its rule.
    """

    dimensions: int
    width: float
    quadrature: str

    @property
    def parameters(self) -> grids.Parameters:
        return grids.PARAMETERS[self.dimensions]["first"]

    def axes(self) -> list[dd.Axis]:
        p = self.parameters
        samples = round(p.length / p.kernel * self.width)
        return [dd.Axis(n, 0, p.length, samples, periodic=True) for n in "xy"[: self.dimensions]]

    def model(self, excitation: float, strength: float, window: dd.Window) -> dd.Model:
        """Return a field with an input in its middle while a window lasts, and noise."""
        p, axes, model = self.parameters, self.axes(), dd.Model("noise", dt=1.0)
        u = model.add(
            dd.Field(
                "u",
                axes,
                sigmoid=dd.Logistic(4.0),
                resting_level=p.resting_level,
                kernel=[dd.Gaussian(excitation, p.kernel, normalized=True)],
                global_inhibition=p.inhibition,
                quadrature=self.quadrature,
            )
        )
        middle = p.length / 2
        stimulus = dd.GaussianStimulus(
            "input", axes, center=middle, sigma=p.input, amplitude=strength, windows=[window]
        )
        model.add(stimulus) >> u
        count = 2 * MODES[self.dimensions] + 1
        numbers = [dd.Axis(f"mode_{a.name}", 0, count, count, periodic=True) for a in axes]
        waves = model.add(dd.Noise("modes", numbers, amplitude=NOISE))
        for axis, number in zip(axes, numbers, strict=True):
            weights = dd.AxisWeights(modes(axis, MODES[self.dimensions]), axis, number.name)
            waves = waves >> model.add(weights)
        waves >> u
        u["activation"] >> model.add(dd.Project([], reduce="max", name="top"))
        return model


def modes(axis: dd.Axis, most: int) -> np.ndarray:
    """Return a constant, cosines and sines of up to `most` waves at each sample, scaled to the variances of
    noise of variance 1 with the correlation exp(-d^2 / (2 CORRELATION^2)).
    """
    k = 2 * np.pi * np.arange(most + 1) / axis.range
    scale = np.exp(-((k * CORRELATION) ** 2) / 4)
    scale /= math.sqrt(scale[0] ** 2 + 2 * np.sum(scale[1:] ** 2))
    turns = k[1:] * axis.points[:, None]
    wave = math.sqrt(2) * scale[1:]
    return np.column_stack([np.full(axis.samples, scale[0]), np.cos(turns) * wave, np.sin(turns) * wave])


@functools.cache
def reactions(grid: Grid, trials: int) -> np.ndarray:
    """Return the reaction time of each trial; nan where there is none."""
    model = grid.model(grid.parameters.driven, STRENGTH, dd.Window(ONSET, OBSERVED))
    run = dd.simulate(model, OBSERVED, trials=trials, record=["top.output"], on=dd.Resources(progress=False))[
        "top.output"
    ]
    above = run.transpose("trial", "time").values > 0
    times = run["time"].values[above.argmax(axis=1)] - ONSET
    return np.where(above.any(axis=1) & (times > 0), times, np.nan)


@functools.cache
def moves(grid: Grid, trials: int) -> np.ndarray:
    """Return how far each memory moves, along each axis; nan where it is lost."""
    p = grid.parameters
    assert p.sustained is not None
    run = dd.simulate(
        grid.model(p.sustained, 8.0, dd.Window(0.0, MADE)),
        HELD,
        trials=trials,
        record=["u.output", "top.output"],
        every=SETTLED - MADE,
        on=dd.Resources(progress=False),
    )
    remembered = run["top.output"].sel(time=HELD, method="nearest").values > 0
    places = [_places(run["u.output"].sel(time=t, method="nearest"), p.length) for t in (SETTLED, HELD)]
    moved = (places[1] - places[0] + p.length / 2) % p.length - p.length / 2
    return np.where(remembered[:, None], moved, np.nan)


def _places(output: object, length: float) -> np.ndarray:
    """Return the circular mean of the output along each axis: shape (trials, axes)."""
    values = output.transpose("trial", ...)  # type: ignore[attr-defined]
    angles: list[np.ndarray] = []
    for name in values.dims[1:]:
        marginal = values.sum([d for d in values.dims[1:] if d != name]).values
        turn = np.exp(2j * np.pi * values[name].values / length)
        angles.append(np.angle(marginal @ turn) / (2 * np.pi) * length)
    return np.stack(angles, axis=1)


def row(measure: str, grid: Grid, trials: int) -> tuple[str, bool]:
    """Return the row of a table, and whether it keeps its limit."""
    fine = Grid(grid.dimensions, grids.FINE[grid.dimensions], "cell")
    if measure == "reaction time":
        coarse, reference = reactions(grid, trials), reactions(fine, trials)
        valid = ~np.isnan(coarse) & ~np.isnan(reference)
        exact = reference[valid].mean()
        difference = (coarse - reference)[valid]
        error = 100 * difference.mean() / exact
        spread = f" +- {100 * difference.std() / math.sqrt(valid.sum()) / exact:.2f}"
    else:
        coarse, reference = moves(grid, trials), moves(fine, trials)
        valid = ~np.isnan(coarse).any(axis=1) & ~np.isnan(reference).any(axis=1)
        exact = float(np.var(reference[valid], axis=0).mean())
        error = 100 * (float(np.var(coarse[valid], axis=0).mean()) / exact - 1)
        spread = ""
    most = LIMITS[measure] if grid.dimensions == 1 and grid.quadrature == "cell" else None
    within = most is None or abs(error) <= most
    verdict = "" if most is None else f"{most:g}, {'kept' if within else 'EXCEEDED'}"
    return (
        f"| {measure} | {grid.width:g} | {grid.quadrature} | {exact:.4f} | {error:.2f}{spread} |"
        f" {valid.sum()} | {verdict} |"
    ), within


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--dimensions", type=int, choices=(1, 2), action="append", help="one of them alone")
    parser.add_argument(
        "--quadrature", choices=("cell", "point", "cell-0.1"), action="append", help="this one (default: all)"
    )
    parser.add_argument("--trials", type=int, help="(default: 600 over one axis, 100 over two)")
    options = parser.parse_args()
    began, exceeded = time.process_time(), 0
    for dimensions in options.dimensions or (1, 2):
        trials = options.trials or {1: 600, 2: 100}[dimensions]
        print(f"\n{dimensions}-D\n")
        print("| measure | samples a width | quadrature | fine grid | error, % | trials | limit |")
        print("|---" * 7 + "|", flush=True)
        for measure in ("reaction time", "drift")[dimensions - 1 :]:
            for width in grids.COARSE[dimensions]:
                for rule in options.quadrature or ["cell", "point", "cell-0.1"]:
                    line, within = row(measure, Grid(dimensions, width, rule), trials)
                    exceeded += not within
                    print(line, flush=True)
        for rule in options.quadrature or ["cell", "point", "cell-0.1"]:
            # over one axis a line with open ends, over two a torus
            samples = round(grids.PARAMETERS[dimensions]["first"].length / 2) + 1
            farthest = resolution.motion(dimensions, samples, dd.Logistic(4.0), rule)
            print(f"| pinning, samples | 2.5 | {rule} | 0 | {farthest:.3f} | | |", flush=True)
    print(
        f"\n{exceeded} limits exceeded; {time.process_time() - began:.0f} s of CPU; deodar {dd.__version__}"
    )
    return 1 if exceeded else 0


if __name__ == "__main__":
    sys.exit(main())
