"""Prints how far thresholds of a field on a coarse grid are from those on a fine one: `python
benchmarks/grids.py [--dimensions 1|2] [--sigmoid NAME] [--quadrature NAME]`. Ends with 1 if one exceeds its
limit.

Thresholds are folds, which `dd.continuation` computes in double precision: detection and reverse detection of
a localised input, and forgetting by a homogeneous boost. Inputs lie on a sample, 0.3 of a sample beside one,
and between two. The reference is the rule `cell` on a grid of 10 samples a kernel width (6 over two axes).
Axes are periodic, and the kernel has width 5. Limits are required of `cell` alone.
"""

from __future__ import annotations

import argparse
import functools
import math
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import deodar as dd
from deodar.analysis.continuation.branch import SteadyBranch
from deodar.elements.stimuli import Boost
from deodar.numerics.sigmoids import Absolute, SigmoidFunction

SIGMA = 5.0
LENGTH = {1: 100.0, 2: 60.0}
FINE = {1: 10.0, 2: 6.0}
DRIVEN, HELD = {1: 12.0, 2: 14.0}, {1: 18.0, 2: 22.0}
"""Integrals of kernels: a peak needs its input, and a peak outlives it."""
INHIBITION = {1: 0.3, 2: 0.01}
SIGMOIDS: dict[str, SigmoidFunction] = {
    "logistic 4": dd.Logistic(4.0),
    "logistic 10": dd.Logistic(10.0),
    "logistic 100": dd.Logistic(100.0),
    "absolute 100": Absolute(100.0),
}
PLACES = {1: ((0.0,), (0.3,), (0.5,)), 2: ((0.0, 0.0), (0.5, 0.5), (0.5, 0.0), (0.3, 0.15))}


@dataclass(frozen=True)
class Task:
    """One field on one grid.

    Attributes:
        dimensions: number of its axes.
        width: samples a kernel width.
        sigmoid: its output function.
        quadrature: its rule.
        offset: distance of the input from a sample, in samples of the coarse grid, along each axis.
        step: distance of the samples of the coarse grid.
    """

    dimensions: int
    width: float
    sigmoid: SigmoidFunction
    quadrature: str
    offset: tuple[float, ...]
    step: float

    def axes(self, *, odd: bool = False) -> list[dd.Axis]:
        """Return the axes; `odd`: with one step of the coarse grid more, so that their middle is on a sample
        of it, not between two.
        """
        length = LENGTH[self.dimensions] + odd * self.step
        samples = round(length / SIGMA * self.width)
        return [dd.Axis(n, 0, length, samples, periodic=True) for n in "xy"[: self.dimensions]]

    def beside(self) -> list[float]:
        """Return the position `offset` from the sample in the middle of the coarse grid."""
        middle = round(LENGTH[self.dimensions] / 2 / self.step) * self.step
        return [middle + a * self.step for a in self.offset]

    def model(self, axes: list[dd.Axis], center: list[float], excitation: float) -> dd.Model:
        """Return a field with an input and a boost, both of amplitude 0."""
        model = dd.Model("grid")
        kernel = [dd.Gaussian(excitation, SIGMA, normalized=True)]
        u = model.add(
            dd.Field(
                "u",
                axes,
                sigmoid=self.sigmoid,
                kernel=kernel,
                global_inhibition=INHIBITION[self.dimensions],
                quadrature=self.quadrature,
            )
        )
        model.add(dd.GaussianStimulus("input", axes, center=center, sigma=SIGMA, amplitude=0)) >> u
        model.add(Boost("boost", axes, amplitude=0.0)) >> u
        return model


def _fold(branch: SteadyBranch, instability: str) -> float:
    """Return the parameter of the fold of this name; of several, the last that the branch meets."""
    values = [b.value for b in branch.bifurcations if b.instability == instability]
    return values[-1] if values else math.nan


@functools.cache
def detections(task: Task) -> tuple[float, float]:
    """Return the detection and the reverse detection threshold of a field without self-sustained peaks."""
    model = task.model(task.axes(), task.beside(), DRIVEN[task.dimensions])
    branch = dd.continuation(model, "input.amplitude", (0, 8), finer=False)
    return _fold(branch, "detection"), _fold(branch, "reverse detection")


def forgetting(task: Task) -> float:
    """Return the boost at which a peak without input vanishes, on a sample or between two along all axes."""
    axes = task.axes(odd=not any(task.offset))
    # states that are even about the middle of the axes, which is no sample of the fine grid
    model = task.model(axes, [float(a.points.mean()) for a in axes], HELD[task.dimensions])
    even = list("xy"[: task.dimensions])
    branch = dd.continuation(
        model, "boost.amplitude", (0, -3), induced_by={"input.amplitude": 8}, even=even, finer=False
    )
    return _fold(branch, "forgetting")


THRESHOLDS: dict[str, Callable[[Task], float]] = {
    "detection": lambda task: detections(task)[0],
    "reverse detection": lambda task: detections(task)[1],
    "forgetting": forgetting,
}


def limit(dimensions: int, width: float, sigmoid: str, threshold: str) -> float | None:
    """Return the largest error in percent that is required of `cell`; None: it is only printed."""
    if dimensions == 1:
        if sigmoid == "logistic 4":
            return 0.2
        return 0.4 if threshold == "detection" else 1.2
    if sigmoid != "logistic 4":
        return None
    return 0.3 if width < 3 else 0.2


def rows(dimensions: int, sigmoids: list[str], quadratures: list[str]) -> Iterator[tuple[str, bool]]:
    """Yield a line for each sigmoid, threshold, grid and rule, and whether it keeps its limit."""
    for name in sigmoids:
        for threshold, measure in THRESHOLDS.items():
            for width in (2.5,) if dimensions == 1 else (2.5, 3.0):
                for rule in quadratures:
                    step = SIGMA / width
                    places = [
                        p for p in PLACES[dimensions] if threshold != "forgetting" or set(p) in ({0.0}, {0.5})
                    ]
                    errors = []
                    for offset in places:
                        values = [
                            measure(Task(dimensions, w, SIGMOIDS[name], q, offset, step))
                            for w, q in ((width, rule), (FINE[dimensions], "cell"))
                        ]
                        errors.append(100 * (values[0] / values[1] - 1))
                    most = limit(dimensions, width, name, threshold) if rule == "cell" else None
                    within = most is None or all(abs(e) <= most for e in errors)
                    listed = " / ".join(f"{e:.2f}" for e in errors)
                    verdict = "" if most is None else f"  limit {most:g}: {'kept' if within else 'EXCEEDED'}"
                    yield (
                        f"{dimensions}-D  {name:14}{threshold:19}{width:4g}  {rule:9}{listed:>32} %{verdict}",
                        within,
                    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--dimensions", type=int, choices=(1, 2), action="append", help="one of them alone")
    parser.add_argument("--sigmoid", choices=tuple(SIGMOIDS), action="append", help="this one alone")
    parser.add_argument(
        "--quadrature", choices=("cell", "point", "cell-0.1"), action="append", help="this one (default: all)"
    )
    options = parser.parse_args()
    began, exceeded = time.process_time(), 0
    for dimensions in options.dimensions or (1, 2):
        for line, within in rows(
            dimensions,
            options.sigmoid or list(SIGMOIDS),
            options.quadrature or ["cell", "point", "cell-0.1"],
        ):
            exceeded += not within
            print(line, flush=True)
    print(f"{exceeded} limits exceeded; {time.process_time() - began:.0f} s of CPU; deodar {dd.__version__}")
    return 1 if exceeded else 0


if __name__ == "__main__":
    sys.exit(main())
