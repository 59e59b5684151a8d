"""Prints what a field's behaviour owes to its grid, with `quadrature="point"` and `"cell"`: `python
benchmarks/resolution.py [--quick]`.

`python benchmarks/resolution.py cost` prints how much longer a step takes with `cell`. `python
benchmarks/resolution.py edges` prints the error of the boost that erases a memory over the steepness of the
peak's edge: the table `src/deodar/model/checks/grid_errors.csv`, with which `deodar check` compares a field.

`python benchmarks/resolution.py peaks` prints the error of the output of a peak with input, also for two
kernels, a sigmoid that is linear above its threshold, and three axes.

A field with a memory over 100 degrees (kernel of width 5, integral 18) and one over a torus of 60 x 60
(integral 22), on grids of 2.5 samples a kernel width and more. Three things are measured: the boost at which
a memory is forgotten, how far memories drift under white noise, and how far from their inputs they come to
lie without any. For the step function on a line the boost is known (Amari 1977). Nothing is asserted.
"""

from __future__ import annotations

import argparse
import functools
import math
import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

os.environ.setdefault("NPROC", "1")

import numpy as np

import deodar as dd
from deodar.elements.stimuli import Boost
from deodar.model.checks.resolution import steepness
from deodar.numerics.sigmoids import SemiLinear, SigmoidFunction, Step

MADE, HELD = 400, 3000
"""Times in ms: how long the input is there, and how long a memory is then held."""
SIGMOIDS: dict[str, SigmoidFunction] = {"logistic, beta 4": dd.Logistic(4.0), "step": Step()}
LENGTH, NOISE = {1: 100.0, 2: 60.0}, {1: 0.5, 2: 1.0}
STEEPNESSES = (2.0, 4.0, 8.0, 20.0, 100.0)
WIDTHS = {1: (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.0, 10.0), 2: (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0)}
REFERENCE, FINE = {1: 10.0, 2: 6.0}, 5e-4
"""Of the errors over the steepness of an edge: beta, samples a kernel width, those of the reference, and how
exactly a boost is found.
"""
GRIDS = {1: (51, 101, 201, 501), 2: (31, 61, 121)}


def memory(
    dimensions: int,
    samples: int,
    g: SigmoidFunction,
    quadrature: str,
    noise: float = 0.0,
    dt: float = 1.0,
    center: float | None = None,
) -> dd.Model:
    """A field with an input that makes a memory, and a boost that follows."""
    periodic = dimensions == 2
    axes = [
        dd.Axis(n, 0, LENGTH[dimensions], samples=samples - periodic, periodic=periodic, unit="deg")
        for n in "xy"[:dimensions]
    ]
    kernel, inhibition = (
        [dd.Gaussian(18 if dimensions == 1 else 22, 5, normalized=True)],
        0.3 if dimensions == 1 else 0.01,
    )
    model = dd.Model("memory", dt=dt)
    u = model.add(
        dd.Field(
            "u",
            axes,
            tau=20,
            sigmoid=g,
            kernel=kernel,
            global_inhibition=inhibition,
            noise=noise,
            quadrature=quadrature,
        )
    )
    middle = [LENGTH[dimensions] / 2 if center is None else center] * dimensions
    (
        model.add(
            dd.GaussianStimulus("input", axes, center=middle, sigma=5, amplitude=8, windows=[(0, MADE)])
        )
        >> u
    )
    model.add(Boost("boost", axes, amplitude=0.0, windows=[(2 * MADE, 1e6)])) >> u
    return model


def forgetting(
    dimensions: int,
    samples: int,
    g: SigmoidFunction,
    quadrature: str,
    precise: float = 1e-3,
    lasting: float = 6000.0,
    center: float | None = None,
) -> float:
    """The boost below which a memory is lost, to `precise`; Euler steps of a fifth of the time constant."""
    model = memory(dimensions, samples, g, quadrature, dt=4.0, center=center)
    model["u"]["activation"] >> model.add(dd.Project([], reduce="max", name="top"))
    low, high = -2.5, 0.0
    while high - low > precise:
        tried = np.linspace(low, high, 9)
        data = dd.simulate(
            model,
            2 * MADE + lasting,
            record=["top.output"],
            every=2 * MADE + lasting,
            sweep={"boost.amplitude": tried[1:-1]},
            on=dd.Resources(progress=False),
        )
        held = [False, *(data["top.output"].values[:, -1] > 0), True]
        k = int(np.argmax(held))
        low, high = float(tried[k - 1]), float(tried[k])
    return (low + high) / 2


def amari() -> float:
    """The same for the step function on a long line: the boost at which the stable and the unstable width of
    a peak meet.
    """
    widths = np.linspace(0.01, 60, 600_000)
    # the kernel's integral over 0..w
    excitation = 9.0 * np.array([math.erf(w / (5 * math.sqrt(2))) for w in widths[::10]])
    return float(5 - np.max(excitation - 0.3 * widths[::10]))


def edges(dimensions: int) -> None:
    """The error of the boost that erases a memory, in percent, over beta times the change of activation from
    sample to sample at its edge, for both quadratures.

    The memory lies on a sample, and between two of them along each axis: the larger error counts. The
    reference is `cell` on a grid of 10 samples a kernel width (6 over two axes).
    """

    def samples(width: float) -> int:
        return round(LENGTH[dimensions] / 5 * width) + 1

    for beta in STEEPNESSES:
        g = dd.Logistic(beta)
        exact = forgetting(dimensions, samples(REFERENCE[dimensions]), g, "cell", FINE)
        for width in WIDTHS[dimensions]:
            u = memory(dimensions, samples(width), g, "point")["u"].element
            assert isinstance(u, dd.Field)
            cells = [f"{dimensions},{beta:g},{width:g},{max(steepness(u)):.2f}"]
            for quadrature in ("point", "cell"):
                errors = [
                    100
                    * abs(
                        forgetting(dimensions, samples(width), g, quadrature, FINE, center=place) / exact - 1
                    )
                    for place in (LENGTH[dimensions] / 2 + share * 5 / width for share in (0.0, 0.5))
                ]
                cells.append(f"{max(0.1, *errors):.1f}")
            print(",".join(cells), flush=True)


@dataclass(frozen=True)
class DrivenField:
    """A field whose peak is held by its input.

    Attributes:
        dimensions: number of axes.
        sigmoid: its output function.
        kernel: integral and width of each Gaussian.
        inhibition: global inhibition.
        fine: samples a kernel width of the reference.
    """

    dimensions: int
    sigmoid: SigmoidFunction
    kernel: tuple[tuple[float, float], ...] = ((12.0, 5.0),)
    inhibition: float = 0.3
    fine: float = 10.0

    def output(self, width: float, quadrature: str, share: float) -> float:
        """Return the integral of the output over the axes; `share` is the distance of the input
        from a sample of a grid of 2.5 samples a kernel width, in samples.
        """
        length = {1: 100.0, 2: 60.0, 3: 40.0}[self.dimensions]
        axes = [
            dd.Axis(n, 0, length, samples=round(length / 5 * width), periodic=True)
            for n in "xyz"[: self.dimensions]
        ]
        u = dd.Field(
            "u",
            axes,
            tau=20,
            sigmoid=self.sigmoid,
            kernel=[dd.Gaussian(a, s, normalized=True) for a, s in self.kernel],
            global_inhibition=self.inhibition,
            quadrature=quadrature,
        )
        model = dd.Model("peak", dt=4.0)
        center = [length / 2 + share * 2.0] * self.dimensions
        model.add(dd.GaussianStimulus("input", axes, center=center, sigma=5, amplitude=9)) >> model.add(u)
        record = dd.simulate(model, 1200, record="u.output", every=1200.0, on=dd.Resources(progress=False))
        return float(record["u.output"].values[-1].sum(dtype=float)) * math.prod(a.step for a in axes)


DRIVEN_FIELDS = {
    "logistic of beta 4": DrivenField(1, dd.Logistic(4.0)),
    "two kernels": DrivenField(1, dd.Logistic(4.0), ((34.0, 5.0), (-20.0, 9.0)), 0.05),
    "SemiLinear": DrivenField(1, SemiLinear(slope=0.2), ((4.0, 5.0),)),
    "step": DrivenField(1, Step()),
    "step, two axes": DrivenField(2, Step(), inhibition=0.01, fine=6.0),
    "logistic of beta 4, three axes": DrivenField(3, dd.Logistic(4.0), inhibition=0.0005, fine=6.0),
    "step, three axes": DrivenField(3, Step(), inhibition=0.0005, fine=6.0),
}


def peaks() -> None:
    """The error, in percent, of the integral of the output of a peak on 2.5 samples a kernel width, for an
    input on a sample and one between two along each axis.
    """
    print("| field | point | cell |\n|---|---|---|")
    for name, field in DRIVEN_FIELDS.items():
        exact = field.output(field.fine, "cell", 0.0)
        errors = [
            ", ".join(f"{100 * (field.output(2.5, rule, share) / exact - 1):.2f}" for share in (0.0, 0.5))
            for rule in ("point", "cell")
        ]
        print(f"| {name} | {' | '.join(errors)} |", flush=True)


def cost(rounds: int, seconds: float) -> None:
    """How much longer a step takes with `cell`: pairs of runs in turn, CPU time on one core, the median of
    their ratios and its quartiles.
    """
    sys.path.insert(0, str(Path(__file__).parent))
    import workloads

    print(f"{'workload':10}{'point, us a step':>18}{'cell more':>12}{'quartiles':>20}")
    for name in ("W1_100", "W1_200", "W5", "W2_50", "W2_100"):
        work = workloads.WORKLOADS[name]
        models = [work.model() for _ in range(2)]
        models[1].set("u.quadrature", "cell")

        def timed(model: dd.Model, steps: int, trials: int | None = work.trials or None) -> float:
            began = time.process_time()
            dd.simulate(model, steps, trials=trials, on=dd.Resources(progress=False))
            return time.process_time() - began

        n = 100
        for model in models:
            timed(model, n)
        while (taken := timed(models[0], n)) < seconds:
            n = 2 * n if taken < seconds / 4 else math.ceil(1.2 * n * seconds / taken)
        pairs = [[timed(model, 2 * n) - timed(model, n) for model in models] for _ in range(rounds)]
        ratios = [b / a - 1 for a, b in pairs]
        low, middle, high = np.quantile(ratios, [0.25, 0.5, 0.75])
        step = 1e6 * float(np.median([a for a, _ in pairs])) / n
        spread = f"{low:.0%} to {high:.0%}"
        print(f"{name:10}{step:18.2f}{middle:12.0%}{spread:>20}", flush=True)


def places(model: dd.Model, dimensions: int, until: float, **how: object) -> np.ndarray:
    """Where the memory is at 800 ms and at the end: shape (runs, 2, dimensions)."""
    data = dd.simulate(
        model, 2 * MADE + until, record=["u.output"], every=400.0, on=dd.Resources(progress=False), **how
    )["u.output"]  # type: ignore[arg-type]
    g = data.isel(time=[2, -1]).values.astype(float)
    g = np.moveaxis(g, data.dims.index("time"), -dimensions - 1).reshape(-1, 2, *g.shape[-dimensions:])
    x = data["x"].values
    total = g.sum(tuple(range(2, g.ndim)))
    return np.stack(
        [np.moveaxis(g, 2 + d, -1).sum(tuple(range(2, g.ndim - 1))) @ x / total for d in range(dimensions)],
        -1,
    )


def drift(dimensions: int, samples: int, g: SigmoidFunction, quadrature: str, trials: int) -> float:
    """Variance of the place of a memory (mean over axes) that 3,000 ms of noise add, in squared degrees."""
    positions = places(
        memory(dimensions, samples, g, quadrature, NOISE[dimensions]), dimensions, HELD, trials=trials
    )
    return float(np.mean(np.var(positions[:, 1] - positions[:, 0], axis=0)))


def motion(dimensions: int, samples: int, g: SigmoidFunction, quadrature: str) -> float:
    """How far from its input a memory lies at most after 3,000 ms without noise, in samples, for inputs on a
    sample and between two.
    """
    step = LENGTH[dimensions] / (samples - 1)
    model, most = memory(dimensions, samples, g, quadrature), 0.0
    for share in (0.0, 0.1, 0.25, 0.4, 0.5):
        center = [LENGTH[dimensions] / 2 + part * share * step for part in (1, 0.6)[:dimensions]]
        model.set("input.center", center)
        most = max(most, float(np.abs(places(model, dimensions, HELD)[:, 1] - center).max()) / step)
    return most


def table(
    title: str,
    dimensions: int,
    grids: tuple[int, ...],
    measure: Callable[..., float],
    form: str,
    sigmoids: dict[str, SigmoidFunction],
) -> None:
    print(f"\n{title}")
    print(
        f"{'samples an axis (a kernel width)':44}"
        + "".join(f"{f'{n} ({5 * (n - 1) / LENGTH[dimensions]:g})':>12}" for n in grids)
    )
    for name, g in sigmoids.items():
        for quadrature in ("point", "cell"):
            print(f"{name + ', ' + quadrature:44}", end="", flush=True)
            for n in grids:
                print(f"{measure(dimensions, n, g, quadrature):{form}}", end="", flush=True)
            print()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "what",
        nargs="?",
        choices=("behaviour", "cost", "edges", "peaks"),
        default="behaviour",
        help="what is measured (default: behaviour)",
    )
    parser.add_argument(
        "--rounds", type=int, default=15, help="pairs of runs that the cost is taken over (default 15)"
    )
    parser.add_argument(
        "--seconds", type=float, default=0.5, help="CPU time of the shorter run of the cost (default 0.5)"
    )
    parser.add_argument("--quick", action="store_true", help="one dimension, three grids, 400 trials")
    parser.add_argument(
        "--trials",
        type=int,
        default=1000,
        help="runs that the variance of drift is taken over (default 1000)",
    )
    parser.add_argument("--dimensions", type=int, choices=(1, 2), help="one of them alone")
    given = parser.parse_args()
    began = time.time()
    if given.what == "edges":
        print("axes,beta,samples_a_width,edge,point,cell")
        for dimensions in (given.dimensions,) if given.dimensions else (1, 2):
            edges(dimensions)
        return 0
    if given.what == "peaks":
        peaks()
        return 0
    if given.what == "cost":
        cost(given.rounds, given.seconds)
        print(f"\n{time.time() - began:.0f} s; deodar {dd.__version__}, single precision")
        return 0
    trials = 400 if given.quick else given.trials
    for dimensions in (given.dimensions,) if given.dimensions else (1,) if given.quick else (1, 2):
        grids = GRIDS[dimensions][:3] if given.quick else GRIDS[dimensions]
        where = "a line" if dimensions == 1 else "a plane"
        theory = f"; Amari's value for the step: {amari():.4f}" if dimensions == 1 else ""
        table(
            f"Boost at which a memory is forgotten, on {where}{theory}",
            dimensions,
            grids,
            forgetting,
            "12.4f",
            SIGMOIDS,
        )
        table(
            f"Farthest from its input after {HELD} ms without noise, in samples, on {where}",
            dimensions,
            grids[:2],
            motion,
            "12.3f",
            SIGMOIDS,
        )
        noisy = functools.partial(drift, trials=trials if dimensions == 1 else min(trials, 400))
        title = (
            f"Variance of the place after {HELD} ms of noise {NOISE[dimensions]:g}, squared degrees,"
            f" {noisy.keywords['trials']} runs, on {where}"
        )
        table(
            title,
            dimensions,
            grids[:3],
            noisy,
            "12.4f",
            SIGMOIDS if not given.quick else dict([*SIGMOIDS.items()][:1]),
        )
    print(f"\n{time.time() - began:.0f} s; deodar {dd.__version__}, single precision")
    return 0


if __name__ == "__main__":
    sys.exit(main())
