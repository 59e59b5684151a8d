"""Prints how far thresholds of a field on a coarse grid are from those on a fine one: `python
benchmarks/grids.py [--dimensions 1] [--parameters NAME] [--sigmoid NAME] [--quadrature NAME]`. Ends with 1 if
one exceeds its limit.

Thresholds are folds, which `dd.continuation` computes in double precision. Detection and reverse detection
are those of a localised input, forgetting is that by a homogeneous boost, and selection is the strength at
which a second input takes over from a peak that the first one holds. Inputs lie on a sample, 0.3 of a sample
beside one, and between two; forgetting is that of peaks on a sample and between two, as a peak without input
has no other steady places on a grid. The reference is the rule `cell` on a grid of 10 samples a kernel width
(6 over two axes). Axes are periodic. Limits are required of `cell` alone.

A step function has no derivative, which a continuation needs: the logistic function of steepness 1000 stands
for it.
"""

from __future__ import annotations

import argparse
import dataclasses as dc
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

FINE = {1: 10.0, 2: 6.0}
COARSE = {1: (2.5,), 2: (2.5, 3.0)}
"""Samples a kernel width."""
PLACES: dict[int, tuple[tuple[float, ...], ...]] = {
    1: ((0.0,), (0.3,), (0.5,)),
    2: ((0.0, 0.0), (0.5, 0.5), (0.3, 0.15)),
}
SIGMOIDS: dict[str, SigmoidFunction] = {
    "logistic 4": dd.Logistic(4.0),
    "logistic 10": dd.Logistic(10.0),
    "logistic 100": dd.Logistic(100.0),
    "logistic 1000": dd.Logistic(1000.0),
    "absolute 100": Absolute(100.0),
}


@dataclass(frozen=True)
class Rivalry:
    """A field with two inputs, of which only one has a peak.

    Attributes:
        excitation: integral of the kernel.
        inhibition: global inhibition.
        holding: strength of the first input, which holds the peak.
        distance: distance of the second input, along the first axis.
    """

    excitation: float
    inhibition: float
    holding: float
    distance: float


@dataclass(frozen=True)
class Parameters:
    """The fields of one set of parameters.

    Attributes:
        length: length of each axis.
        kernel: width of the kernel.
        input: width of the inputs.
        resting_level: h.
        driven: integral of the kernel with which a peak needs its input.
        inhibition: global inhibition, with `driven` and `sustained`.
        sustained: integral of the kernel with which a peak outlives its input; None: forgetting is not
            measured.
        rivalry: the field of the selection; None: not measured.
    """

    length: float
    kernel: float
    input: float
    resting_level: float
    driven: float
    inhibition: float
    sustained: float | None = None
    rivalry: Rivalry | None = None


PARAMETERS: dict[int, dict[str, Parameters]] = {
    1: {
        "first": Parameters(100, 5, 5, -5, 12, 0.3, 18, Rivalry(15, 0.8, 6, 30)),
        "second": Parameters(128, 8, 10, -4, 9, 0.15, 14, Rivalry(12, 0.4, 5, 48)),
    },
    2: {
        "first": Parameters(60, 5, 5, -5, 12, 0.01, 22, Rivalry(16, 0.03, 7, 24)),
        "second": Parameters(48, 4, 5, -4, 10, 0.02, 20, Rivalry(13, 0.05, 6, 20)),
    },
}
"""Sets of parameters by the number of axes. The rule was chosen on thresholds of the first ones."""


@dataclass(frozen=True)
class Task:
    """One field on one grid.

    Attributes:
        parameters: its parameters.
        width: samples a kernel width.
        sigmoid: its output function.
        quadrature: its rule.
        offset: distance of the input from a sample, in samples of the coarse grid, along each axis.
        step: distance of the samples of the coarse grid.
    """

    parameters: Parameters
    width: float
    sigmoid: SigmoidFunction
    quadrature: str
    offset: tuple[float, ...]
    step: float

    def axes(self, *, centred: bool = False) -> list[dd.Axis]:
        """Return the axes; `centred`: an axis along which the offset is 0 has one step of the coarse grid
        more, so that its middle is on a sample of the coarse grid, not between two.
        """
        axes: list[dd.Axis] = []
        for name, offset in zip("xy", self.offset, strict=False):
            length = self.parameters.length + (centred and not offset) * self.step
            samples = round(length / self.parameters.kernel * self.width)
            axes.append(dd.Axis(name, 0, length, samples, periodic=True))
        return axes

    def beside(self) -> list[float]:
        """Return the position `offset` from the sample in the middle of the coarse grid."""
        middle = round(self.parameters.length / 2 / self.step) * self.step
        return [middle + a * self.step for a in self.offset]

    def model(
        self, axes: list[dd.Axis], center: list[float], excitation: float, inhibition: float
    ) -> dd.Model:
        """Return a field with an input at a position, another beside it, and a boost, all of amplitude 0."""
        p, model = self.parameters, dd.Model("grid")
        kernel = [dd.Gaussian(excitation, p.kernel, normalized=True)]
        u = model.add(
            dd.Field(
                "u",
                axes,
                sigmoid=self.sigmoid,
                resting_level=p.resting_level,
                kernel=kernel,
                global_inhibition=inhibition,
                quadrature=self.quadrature,
            )
        )
        beside = [center[0] + (p.rivalry.distance if p.rivalry else 0.0), *center[1:]]
        for name, place in (("input", center), ("second", beside)):
            model.add(dd.GaussianStimulus(name, axes, center=place, sigma=p.input, amplitude=0)) >> u
        model.add(Boost("boost", axes, amplitude=0.0)) >> u
        return model


def _folds(branch: SteadyBranch) -> list[float]:
    """Return the parameter at each fold, in the order of the branch; not a number where there is none."""
    return [b.value for b in branch.bifurcations if b.kind == "fold"] or [math.nan]


@functools.cache
def detections(task: Task) -> tuple[float, float]:
    """Return the detection and the reverse detection threshold of a field without self-sustained peaks: the
    first and the last fold of the branch.
    """
    p = task.parameters
    model = task.model(task.axes(), task.beside(), p.driven, p.inhibition)
    branch = dd.continuation(model, "input.amplitude", (0, 8), finer=False)
    first, *others = _folds(branch)
    return first, [math.nan, *others][-1]


@functools.cache
def forgetting(task: Task) -> float:
    """Return the boost at which a peak without input vanishes, on a sample or between two along each axis."""
    axes, p = task.axes(centred=True), task.parameters
    if p.sustained is None:
        return math.nan
    # states that are even about the middle of the axes, which is no sample of the fine grid
    model = task.model(axes, [float(a.points.mean()) for a in axes], p.sustained, p.inhibition)
    branch = dd.continuation(
        model,
        "boost.amplitude",
        (0, -4),
        induced_by={"input.amplitude": 8},
        even=[a.name for a in axes],
        finer=False,
    )
    # of several, the last that the branch meets; others are of the grid
    return [math.nan, *(b.value for b in branch.bifurcations if b.instability == "forgetting")][-1]


@functools.cache
def selection(task: Task) -> float:
    """Return the strength of a second input at which the peak of the first one vanishes and another one
    appears: the first fold of the branch.
    """
    rivalry = task.parameters.rivalry
    if rivalry is None:
        return math.nan
    model = task.model(task.axes(), task.beside(), rivalry.excitation, rivalry.inhibition)
    model.set("input.amplitude", rivalry.holding)
    branch = dd.continuation(model, "second.amplitude", (0, 3 * rivalry.holding), finer=False)
    return _folds(branch)[0]


THRESHOLDS: dict[str, Callable[[Task], float]] = {
    "detection": lambda task: detections(task)[0],
    "reverse detection": lambda task: detections(task)[1],
    "forgetting": forgetting,
    "selection": selection,
}


def limit(dimensions: int, width: float, sigmoid: str, threshold: str) -> float | None:
    """Return the largest error in percent that is required of `cell`; None: it is only printed."""
    if dimensions == 1:
        if sigmoid == "logistic 4":
            return 0.2
        return 0.4 if threshold in ("detection", "selection") else 1.2
    if sigmoid != "logistic 4":
        return None
    return 0.3 if width < 3 else 0.2


@dataclass(frozen=True)
class Row:
    """The errors of one threshold on one coarse grid.

    Attributes:
        labels: parameters, sigmoid, threshold, samples a kernel width and rule.
        reference: the threshold on the fine grid, with the input on a sample.
        errors: errors in percent of the fine grid, one for each place.
        most: the largest that is allowed; None: any.
    """

    labels: tuple[str, ...]
    reference: float
    errors: tuple[float, ...]
    most: float | None

    @property
    def within(self) -> bool:
        """Whether all errors keep the limit; a threshold that was not found does not."""
        return self.most is None or all(abs(e) <= self.most for e in self.errors)

    def line(self) -> str:
        """Return the row of a table."""
        verdict = "" if self.most is None else f"{self.most:g}, {'kept' if self.within else 'EXCEEDED'}"
        errors = ", ".join(f"{e:.2f}" for e in self.errors)
        return f"| {' | '.join(self.labels)} | {self.reference:.4f} | {errors} | {verdict} |"


HEADER = "| parameters | sigmoid | threshold | samples a width | quadrature | fine grid | error, % | limit |"


def rows(dimensions: int, name: str, sigmoid: str, quadratures: list[str]) -> Iterator[Row]:
    """Yield the rows of one set of parameters and one sigmoid."""
    p = PARAMETERS[dimensions][name]
    measured = {"forgetting": p.sustained is not None, "selection": p.rivalry is not None}
    for threshold, measure in THRESHOLDS.items():
        if not measured.get(threshold, True):
            continue
        for width in COARSE[dimensions]:
            for rule in quadratures:
                coarse = Task(p, width, SIGMOIDS[sigmoid], rule, PLACES[dimensions][0], p.kernel / width)
                reference, errors = compared(measure, coarse, PLACES[dimensions])
                most = limit(dimensions, width, sigmoid, threshold) if rule == "cell" else None
                yield Row((name, sigmoid, threshold, f"{width:g}", rule), reference, errors, most)


def compared(
    measure: Callable[[Task], float], coarse: Task, places: tuple[tuple[float, ...], ...]
) -> tuple[float, tuple[float, ...]]:
    """Return a threshold on the fine grid, and the errors of the coarse one in percent, one for each place.

    The length of an axis may differ with the place of a peak without input, and so may the reference.
    """
    references: list[float] = []
    errors: list[float] = []
    for offset in places:
        if measure is forgetting and not set(offset) <= {0.0, 0.5}:
            continue
        task = dc.replace(coarse, offset=offset)
        same = offset if measure is forgetting else places[0]
        fine = dc.replace(coarse, offset=same, quadrature="cell", width=FINE[len(offset)])
        references.append(measure(fine))
        errors.append(100 * (measure(task) / references[-1] - 1))
    return references[0], tuple(errors)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--dimensions", type=int, choices=(1, 2), action="append", help="one of them alone")
    parser.add_argument("--parameters", action="append", help="this set alone (default: all)")
    parser.add_argument("--sigmoid", choices=tuple(SIGMOIDS), action="append", help="this one alone")
    parser.add_argument(
        "--quadrature", choices=("cell", "point", "cell-0.1"), action="append", help="(default: cell)"
    )
    options = parser.parse_args()
    began, exceeded = time.process_time(), 0
    for dimensions in options.dimensions or (1, 2):
        print(f"\n{dimensions}-D\n\n{HEADER}\n{'|---' * 8}|", flush=True)
        for name in PARAMETERS[dimensions]:
            if name not in (options.parameters or [name]):
                continue
            for sigmoid in options.sigmoid or (SIGMOIDS if name == "first" else ["logistic 4"]):
                for row in rows(dimensions, name, sigmoid, options.quadrature or ["cell"]):
                    exceeded += not row.within
                    print(row.line(), flush=True)
    print(
        f"\n{exceeded} limits exceeded; {time.process_time() - began:.0f} s of CPU; deodar {dd.__version__}"
    )
    return 1 if exceeded else 0


if __name__ == "__main__":
    sys.exit(main())
