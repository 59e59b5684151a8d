"""A bifurcation in two parameters: the line that it draws in their plane."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from deodar import codec
from deodar.analysis.continuation.bifurcation import Bifurcation
from deodar.analysis.continuation.line import DENSE, ParameterLine
from deodar.analysis.continuation.locus_plane import FoldPlane, HopfPlane, LocusPoint
from deodar.analysis.saved import SavedAnalysis
from deodar.codec import JsonObject
from deodar.errors import AnalysisError, ParameterError
from deodar.parameters import show
from deodar.summary import Summarised, Summary

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, repr=False)
class Locus(Summarised, SavedAnalysis):
    """Where a bifurcation lies in the plane of two parameters.

    Attributes:
        of: kind and name of the bifurcation.
        parameters: paths of both.
        values: points of the line, one row each.
        points: cusps and Bogdanov-Takens points on it, in their order.
        line: the model along the parameter in which the bifurcation was found.
        frequencies: angular frequency at each point of the line of a Hopf point, per document time; empty for
            other bifurcations.
    """

    KIND = "locus"
    PHRASE = "a locus"

    of: str
    parameters: tuple[str, str]
    values: np.ndarray
    points: tuple[LocusPoint, ...] = ()
    line: ParameterLine | None = field(default=None, repr=False, compare=False)
    frequencies: np.ndarray = field(default_factory=lambda: np.zeros(0), repr=False)

    def _summary(self) -> Summary:
        points = [(p.kind, *(f"{number:.6g}" for number in p.values)) for p in self.points]
        return Summary(f"{self.of} over {' and '.join(self.parameters)}, {len(self.values)} points", points)

    def over(self, first: str, second: str) -> Locus:
        """Return the same line with its parameters in this order.

        Raises:
            ParameterError: they are others.
        """
        if (first, second) == self.parameters:
            return self
        if (second, first) != self.parameters:
            raise ParameterError(
                f"the locus is over {' and '.join(self.parameters)}, not over {first} and {second}"
            )
        points = tuple(dc.replace(p, values=p.values[::-1]) for p in self.points)
        return dc.replace(self, parameters=(first, second), values=self.values[:, ::-1], points=points)

    def distance(self, at: Sequence[float], unit: Sequence[float] | None = None) -> float:
        r"""Return how much both parameters may change before the line is reached.

        With the distance 0.05 and no unit, each of them may change by any share up to 5 % of its value, both
        at once. Between two points the line is straight.

        Equation:
            d = \min_{(p, q)} \max\left(\frac{|p - p_0|}{p_u}, \frac{|q - q_0|}{q_u}\right)

        Args:
            at: values p0 and q0 of both parameters, in the order of `parameters`.
            unit: changes of both that count as 1; None: the absolute values of `at`.

        Raises:
            ParameterError: `at` or `unit` are not two numbers, or a unit is not above 0.
        """
        return self._nearest(at, unit)[0]

    def nearest(self, at: Sequence[float], unit: Sequence[float] | None = None) -> tuple[float, float]:
        """Return the values of both parameters on the line that are nearest, in the sense of `distance`.

        Args:
            at: values of both parameters.
            unit: changes of both that count as 1; None: the absolute values of `at`.

        Raises:
            ParameterError: as of `distance`.
        """
        first, second = self._nearest(at, unit)[1]
        return float(first), float(second)

    def _nearest(self, at: Sequence[float], unit: Sequence[float] | None) -> tuple[float, np.ndarray]:
        place = _pair("at", at)
        scale = np.abs(place) if unit is None else _pair("unit", unit)
        for path, size in zip(self.parameters, scale, strict=True):
            if not size > 0:
                raise ParameterError(
                    f"a change of {path} is relative to {size:g}; expected a number above 0",
                    fix="Give the changes that count as 1: unit=(1, 1)",
                )
        distance, nearest_point = nearest(self.values / scale, place / scale)
        return distance, nearest_point * scale

    def dataset(self) -> xarray.Dataset:
        """Return the locus as a Dataset: `first` and `second` over its points, `frequency` of Hopf points."""
        # start-up time: these bring xarray
        import xarray

        from deodar.analysis.continuation import line_file
        from deodar.recording.provenance import KEY

        description = {key: v for key, v in self.data().items() if key not in ("values", "frequencies")}
        values = self.values.reshape(-1, 2)
        variables: dict[str, Any] = {
            name: ("point", values[:, k], {"long_name": self.parameters[k]})
            for k, name in enumerate(("first", "second"))
        }
        if frequencies := self.frequencies.tolist():
            variables["frequency"] = ("point", frequencies, {"long_name": "angular frequency"})
        made_by = codec.line({**line_file.made(self.line), self.KIND: description})
        return xarray.Dataset(variables, attrs={KEY: made_by})

    @classmethod
    def of_record(cls, record: xarray.Dataset, provenance: Mapping[str, Any]) -> Locus:
        # start-up time: this brings xarray
        from deodar.analysis.continuation import line_file

        description = provenance[cls.KIND]
        first, second = description["parameters"]
        return cls(
            description["of"],
            (first, second),
            np.column_stack([record["first"].values, record["second"].values]),
            tuple(LocusPoint(p["kind"], (p["values"][0], p["values"][1])) for p in description["points"]),
            line_file.line_of(provenance),
            record["frequency"].values if "frequency" in record else np.zeros(0),
        )

    def data(self) -> JsonObject:
        """Return the line as plain data."""
        return {
            "of": self.of,
            "parameters": list(self.parameters),
            "values": self.values.tolist(),
            "points": [{"kind": p.kind, "values": list(p.values)} for p in self.points],
            "frequencies": self.frequencies.tolist(),
        }


def locus(
    of: Bifurcation,
    parameter: str,
    span: tuple[float, float],
    within: tuple[float, float] | None = None,
) -> Locus:
    r"""Follow a fold, a branch point or a Hopf point as a second parameter changes.

    The line of a fold or branch point is that of minimally augmented equations: F = 0, and the last component
    of the solution of a bordered system is 0, which is where the derivative of F in the state is singular. A
    Hopf point is followed by such a system with two borders, of the square of the growth rates plus that of
    the frequency. Its line ends in Bogdanov-Takens points, where the frequency is 0.

    Equation:
        F(x, p, q) = 0,\quad g(x, p, q) = 0,\quad
        \begin{pmatrix} F_x & b \\ c^T & 0 \end{pmatrix}
        \begin{pmatrix} v \\ g \end{pmatrix} = \begin{pmatrix} 0 \\ 1 \end{pmatrix}

    Args:
        of: a bifurcation of a branch.
        parameter: path of the second parameter.
        span: lowest and highest value of it.
        within: lowest and highest value of the first one; None: ten times its distance from 0, at least 10.

    Raises:
        AnalysisError: the model has more states than are kept as matrices.
        ParameterError: a path is unknown, or a span is not an interval.

    Reference:
        Govaerts (2000), Numerical methods for bifurcations of dynamical equilibria, chapter 3 (minimally
        augmented systems). Kuznetsov (2004), Elements of applied bifurcation theory, section 10.3.1 (Hopf
        points in two parameters).
    """
    line = of.line
    if line.right_hand_side.size > DENSE:
        raise AnalysisError(
            f"the model has {line.right_hand_side.size} states, and a locus is followed with at most {DENSE}",
            fix="Use a coarser grid, or even=[...]",
        )
    first = line.right_hand_side.parameters[line.index]
    if parameter == first:
        raise ParameterError("is the first parameter", where=parameter, fix="Name another one")
    reach = 10 * max(1.0, abs(of.value))
    box = np.array([_interval(within or (-reach, reach)), _interval(span)])
    plane = (HopfPlane if of.kind == "Hopf" else FoldPlane)(of, parameter, box)
    walked = plane.both(of)
    values = np.array([plane.values(z) for z in walked])
    name = f"{of.kind} ({of.instability})" if of.instability else of.kind
    turning = [plane.frequency(z) for z in walked] if isinstance(plane, HopfPlane) else []
    return Locus(name, (first, parameter), values, tuple(plane.points(walked)), line, np.array(turning))


def _interval(span: tuple[float, float]) -> tuple[float, float]:
    try:
        low, high = sorted(float(value) for value in span)
    except (TypeError, ValueError):
        raise ParameterError(f"the span is {show(span)}; expected two numbers") from None
    if not (math.isfinite(low) and math.isfinite(high)) or low == high:
        raise ParameterError(f"the span is {show(span)}; expected two different, finite numbers")
    return low, high


def _pair(name: str, pair: Sequence[float]) -> np.ndarray:
    try:
        numbers = np.asarray(pair, float)
    except (TypeError, ValueError):
        numbers = np.zeros(0)
    if numbers.shape != (2,) or not np.isfinite(numbers).all():
        raise ParameterError(f"{name} is {show(pair)}; expected two numbers, one for each parameter")
    return numbers


def nearest(line: np.ndarray, at: np.ndarray) -> tuple[float, np.ndarray]:
    """Return the distance of a point to a line of straight pieces, and the nearest point of the line.

    The distance of two points is the larger of the absolute differences of both coordinates.

    Args:
        line: its points, one row each.
        at: the point.
    """
    begin = line[:-1] - at if len(line) > 1 else line - at
    chord = np.diff(line, axis=0) if len(line) > 1 else np.zeros((1, 2))
    # the larger coordinate is convex along a piece: its least is at an end, a zero, or where both are equal
    (a, b), (da, db) = begin.T, chord.T
    above = np.stack([np.zeros_like(a), -np.ones_like(a), -a, -b, b - a, -b - a])
    below = np.stack([np.ones_like(a), -np.ones_like(a), da, db, da - db, da + db])
    shares = np.divide(above, below, out=np.zeros_like(above), where=below != 0).clip(0, 1)
    places = begin + shares[..., None] * chord
    distances = np.abs(places).max(-1)
    best = np.unravel_index(int(distances.argmin()), distances.shape)
    return float(distances[best]), places[best] + at
