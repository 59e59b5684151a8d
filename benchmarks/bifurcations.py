"""What continuation reaches, against closed forms and runs: `python benchmarks/bifurcations.py`.

Each row is an error or the CPU time of one computation, without compiling where the row says so, with its
target. Sums are over samples (`quadrature="point"`); the last table has the same thresholds with
`quadrature="cell"`. Status 1 if a target is missed; times are judged only where the load is at most 1.5 times
the cores.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("NPROC", "1")
import numpy as np

import deodar as dd

MOST_LOAD = 1.5


def node(excitation: float = 6.0) -> dd.Model:
    """Return a node with self-excitation and the input `s`."""
    model = dd.Model("node")
    kernel = [dd.Gaussian(excitation)] if excitation else []
    u = model.add(dd.Field("u", tau=20, resting_level=-5, kernel=kernel))
    model.add(dd.Boost("s", amplitude=0.0)) >> u
    return model


def node_folds(excitation: float = 6.0, beta: float = 4.0) -> tuple[float, float]:
    """Return the inputs of its folds, detection first: where w g'(u) = 1, and s = u - h - w g(u)."""
    root = np.sqrt(1 - 4 / (beta * excitation))
    inputs: list[float] = []
    for output in ((1 - root) / 2, (1 + root) / 2):
        u = np.log(output / (1 - output)) / beta
        inputs.append(float(u + 5 - excitation * output))
    return inputs[0], inputs[1]


def line(
    samples: int = 101, excitation: float = 8.0, inhibition: float = 0.1, quadrature: str = "point"
) -> dd.Model:
    """Return the field of docs/instabilities.md with the inputs `s` (localised) and `boost`."""
    x = dd.Axis("x", 0, 100, samples)
    model = dd.Model("line")
    field = dd.Field(
        "u",
        [x],
        tau=20,
        resting_level=-5,
        kernel=[dd.Gaussian(excitation, 5, normalized=True)],
        global_inhibition=inhibition,
        quadrature=quadrature,
    )
    u = model.add(field)
    model.add(dd.GaussianStimulus("s", [x], center=50, sigma=5, amplitude=0.0)) >> u
    model.add(dd.Boost("boost", [x], amplitude=0.0)) >> u
    return model


def rivals(samples: int = 201, quadrature: str = "point") -> dd.Model:
    """Return a field with two equal inputs, mirror images of each other."""
    x = dd.Axis("x", 0, 100, samples)
    model = dd.Model("rivals")
    kernel = [dd.Gaussian(12, 5, normalized=True)]
    field = dd.Field("u", [x], tau=20, resting_level=-5, kernel=kernel, quadrature=quadrature)
    u = model.add(field)
    model.set("u.global_inhibition", 0.1)
    for name, center in (("left", 30), ("right", 70)):
        model.add(dd.GaussianStimulus(name, [x], center=center, sigma=5, amplitude=6)) >> u
    return model


def oscillator(dt: float = 1.0) -> dd.Model:
    """Return an excitatory and an inhibitory node, which oscillate between two Hopf points."""
    model = dd.Model("oscillator", dt=dt)
    e = model.add(dd.Field("e", tau=20, resting_level=-4.0, kernel=[dd.Gaussian(2.5)]))
    i = model.add(dd.Field("i", tau=40, resting_level=-3.0, sigmoid=dd.Logistic(beta=1)))
    e >> dd.Gain(6.0, name="forth") >> i
    i >> dd.Gain(-6.0, name="back") >> e
    return model


def plane(samples: int = 30, length: float = 30.0) -> dd.Model:
    """Return a field over two axes with a localised input `s`, with more states than have matrices."""
    x, y = (dd.Axis(name, 0, length, samples) for name in "xy")
    model = dd.Model("plane")
    kernel = [dd.Gaussian(14, 3, normalized=True)]
    field = dd.Field("u", [x, y], tau=20, resting_level=-5, kernel=kernel, global_inhibition=0.05)
    u = model.add(field)
    middle = length / 2
    model.add(dd.GaussianStimulus("s", [x, y], center=(middle, middle), sigma=3, amplitude=0.0)) >> u
    return model


Row = tuple[str, float, float, bool]
"""What it is, the value, the target (at most), and whether it is a time."""


def timed(function: Callable[[], object]) -> float:
    """Return the CPU time of a call, s."""
    began = time.process_time()
    function()
    return time.process_time() - began


def bisected(model: dd.Model, low: float, high: float, peak: bool) -> float:
    """Return the input at which a peak appears, to 1e-5, by runs of 3000 time constants; or where it
    vanishes, from `low` on, where there is one.
    """
    d = dd.right_hand_side(model, ["s.amplitude"])
    state = d.settle(d.start, np.array([low]), 3000, least=0.0)
    while abs(high - low) > 1e-5:
        middle = (low + high) / 2
        there = d.settle(state, np.array([middle]), 3000, least=1e-13)
        if bool(there.max() > 0) == peak:
            high = middle
        else:
            low, state = middle, there
    return (low + high) / 2


def thresholds(quadrature: str = "point") -> dict[str, float]:
    """Return the thresholds of the manual's fields."""
    up, down = dd.continuation(line(quadrature=quadrature), "s.amplitude", (0, 8), finer=False).bifurcations
    both = dd.continuation(
        rivals(quadrature=quadrature), "u.global_inhibition", (0.1, 0.5), finer=False
    ).bifurcations
    lost = dd.continuation(
        line(201, 22, 0.4, quadrature),
        "boost.amplitude",
        (0, -4),
        induced_by={"s.amplitude": 8.0},
        even=["x"],
        finer=False,
    ).bifurcations
    return {
        "detection": up.value,
        "reverse detection": down.value,
        "selection, 201 samples": next(b.value for b in both if b.instability == "selection"),
        "forgetting, 201 samples": next(b.value for b in lost if b.instability == "forgetting"),
    }


def measured() -> list[Row]:
    """Return all rows; each is printed when it is there."""
    rows: list[Row] = []

    def add(what: str, value: float, target: float, is_time: bool = False) -> None:
        rows.append((what, value, target, is_time))
        form = f"{value:.2f} s" if is_time else f"{value:.1e}"
        print(f"  {what:64} {form:>9}   at most {target:g}", flush=True)

    folds = [b.value for b in dd.continuation(node(), "s.amplitude", (0, 8)).bifurcations]
    add("node, folds against the closed form", float(np.abs(np.subtract(folds, node_folds())).max()), 1e-9)

    branch = dd.continuation(line(), "s.amplitude", (0, 8), finer=False)
    up, down = branch.bifurcations
    start = branch.line.right_hand_side
    add("1-D, 101 samples: S-curve, folds, spectra; compiled", timed(lambda: again(branch)), 0.5, True)
    high = bisected(line(), 0.0, 8.0, True)
    low = bisected(line(), 6.0, 0.0, False)
    add("the same folds against bisection", max(abs(up.value - high), abs(down.value - low)), 2e-5)
    path, h = "u.global_inhibition", 1e-4
    sides: list[float] = []
    for sign in (1, -1):
        model = line(inhibition=0.1 + sign * h)
        sides.append(dd.continuation(model, "s.amplitude", (0, 6), finer=False).bifurcations[0].value)
    slope = (sides[0] - sides[1]) / (2 * h)
    add("gradient of a fold against central differences", abs(up.sensitivity[path] - slope), 1e-6)
    assert start.size == 101

    large = dd.continuation(plane(100, 50.0), "s.amplitude", (0, 9), finer=False)
    add("2-D, 100 x 100: S-curve, folds, eigenvalues; compiled", timed(lambda: again(large)), 3.0, True)

    known = thresholds()
    add(
        "selection against bisection (0.3235), 201 samples",
        abs(known["selection, 201 samples"] - 0.3235),
        1e-3,
    )
    add("forgetting against bisection (-1.602859)", abs(known["forgetting, 201 samples"] + 1.602859), 1e-4)

    hopf = dd.continuation(oscillator(), "e.resting_level", (-4, 2)).bifurcations[0]
    d = hopf.line.right_hand_side
    jacobian = d.linear(hopf.state, np.array([hopf.value]))[1] / d.time_constants[:, None]
    add("Hopf of two nodes: trace", abs(float(np.trace(jacobian))), 1e-9)

    points = 0

    def follow() -> None:
        nonlocal points
        for b in branch.bifurcations:
            points += len(dd.locus(b, "u.kernel.0.amplitude", (0.5, 20), (-2, 12)).values)

    seconds = timed(follow)
    add(f"locus of both folds with cusps, {points} points, with compiling", seconds, 10.0, True)
    return rows


def again(branch: object) -> None:
    """Follow a branch with the functions that are compiled."""
    from deodar.analysis.continuation.branch import SteadyBranch
    from deodar.analysis.continuation.walk import begun, walk

    assert isinstance(branch, SteadyBranch)
    first = begun(branch.line, branch.states[0], float(branch.values[0]), 1.0)
    assert first is not None
    walk(branch.line, first, (float(branch.values.min()), float(branch.values.max())), 1000)


def main() -> int:
    """Print the tables, and judge."""
    load, cores = os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0, os.cpu_count() or 1
    print(f"{cores} cores, load {load:.1f}")
    rows = measured()
    point, cell = thresholds(), thresholds("cell")
    print("\n  threshold                      point        cell")
    for name, value in point.items():
        print(f"  {name:26} {value:10.6f}  {cell[name]:10.6f}")
    quiet = load <= MOST_LOAD * cores
    missed = [row for row in rows if row[1] > row[2] and (quiet or not row[3])]
    for what, value, target, _ in missed:
        print(f"missed: {what}: {value:g}, at most {target:g}")
    if not quiet:
        print("times are not judged: the load is above 1.5 times the cores")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
