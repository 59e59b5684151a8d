"""What a map of regimes measures: one field alone, two of its parameters, and the inputs of the protocol."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from deodar.analysis.isolated import Isolated, Isolation, isolate
from deodar.analysis.selection import DISTANCE, places
from deodar.compiler.driven import driven
from deodar.elements.field import Field
from deodar.elements.stimuli import GaussianStimulus
from deodar.errors import AnalysisError, ParameterError
from deodar.model import edit, find
from deodar.model.document import Document, Leaf
from deodar.model.model import Model
from deodar.parameters import real, show

STRONG = 1.2
"""Default input relative to the distance between resting level and threshold: it makes a peak without
interaction.
"""

TOLERANCE = 2e-4
"""Change of activation per time constant that counts as settled, relative to the same distance."""

LIMIT = 500.0
"""Longest stage, in time constants. Beside a fold the passage takes at most about 100, as slower changes
count as settled; an edge of a peak that hardly moves takes longer.
"""

INPUTS = ("middle", "first", "second")
"""The inputs of the protocol: one alone, and two at equal distances from it."""


class MapOptions(Isolation, total=False):
    """Keyword arguments of `regime_map`: those of `isolate`, and the longest stage in time constants."""

    limit: float


@dataclass(frozen=True)
class MapRequest:
    """One field alone, with the inputs of the protocol, and the parameters over which it is mapped.

    Attributes:
        isolated: the field, as other measurements see it.
        model: the same field with the inputs `middle`, `first` and `second`.
        paths: paths of both parameters in the original model.
        values: values of each.
        leaves: numbers of `model` that each drives.
        strength: amplitude of each input.
        limit: longest stage, in time constants.
        precision: float32 or float64.
    """

    isolated: Isolated
    model: Model
    paths: tuple[str, str]
    values: tuple[np.ndarray, np.ndarray]
    leaves: tuple[tuple[Leaf, ...], tuple[Leaf, ...]]
    strength: float
    limit: float
    precision: str

    @property
    def places(self) -> tuple[tuple[float, ...], ...]:
        """The positions of the two inputs; none on a node."""
        return places(self.isolated, DISTANCE) if self.isolated.axes else ()

    @property
    def tolerance(self) -> float:
        """The largest change of activation per time constant that counts as settled."""
        return TOLERANCE * self.isolated.scale

    @property
    def threshold_of(self) -> int | None:
        """Which parameter is the threshold above which a peak exists; None if it is the same in all cells."""
        ident = find.element(self.model.document, "field").id
        return next((k for k, leafs in enumerate(self.leaves) if (ident, "sigmoid.threshold") in leafs), None)


def requested(
    model: Model,
    over: Mapping[str, Any],
    field: str,
    strength: float | None,
    options: MapOptions,
) -> MapRequest:
    """Return what a map measures.

    Raises:
        AnalysisError: the element is not a field with one axis or none, or a parameter changes no label.
        ParameterError: a path is unknown, changing the parameter needs another program, or its values are
            not those of an axis of a map.
    """
    isolation, limit = _divided(**options)
    doc = model.document
    path = field or only_field(doc)
    if len(over) != 2:
        raise ParameterError(
            f"a map has two parameters, not {len(over)}",
            fix="Name both: {'u.resting_level': (-8, -2, 50), 'u.global_inhibition': (0, 1, 50)}",
        )
    values = {name: _values(doc, name, points) for name, points in over.items()}
    isolated = isolate(model, path, **isolation)
    if len(isolated.axes) > 1:
        raise AnalysisError(
            f"has {len(isolated.axes)} axes; a map counts peaks on one axis, or measures a node",
            where=isolated.path,
            fix="Measure one cell with dd.regimes, or map the same field over one axis",
        )
    amplitude = STRONG * isolated.scale if strength is None else positive("strength", strength)
    small = with_inputs(isolated, model.trusted)
    leaves = {name: driven_alone(doc, small.document, isolated, name) for name in values}
    first, second = values
    return MapRequest(
        isolated,
        small,
        (first, second),
        (values[first], values[second]),
        (leaves[first], leaves[second]),
        amplitude,
        positive("limit", limit),
        isolated.session.precision,
    )


def _divided(
    *,
    sigma: float | Sequence[float] | None = None,
    center: Sequence[float] | None = None,
    precision: str = "float32",
    dt: float | None = None,
    inputs: Sequence[str] = (),
    limit: float = LIMIT,
) -> tuple[Isolation, float]:
    """Return the arguments of `isolate`, and the longest stage."""
    return {"sigma": sigma, "center": center, "precision": precision, "dt": dt, "inputs": inputs}, limit


def only_field(doc: Document) -> str:
    """Return the path of the only field of a document.

    Raises:
        AnalysisError: the document has none, or several.
    """
    fields = [e.path for e in doc.entries if isinstance(e.element, Field)]
    if len(fields) != 1:
        raise AnalysisError(
            f"the model has {len(fields)} fields" if fields else "the model has no field",
            fix=f"Name one: field={fields[0]!r}" if fields else "",
        )
    return fields[0]


def positive(name: str, value: Any) -> float:
    """Return a finite number above 0.

    Raises:
        ParameterError: the value is none.
    """
    number = real(value)
    if number is None or not 0 < number < float("inf"):
        raise ParameterError(f"{name} is {show(value)}; expected a number above 0")
    return number


def _values(doc: Document, path: str, points: Any) -> np.ndarray:
    """Return the values of one parameter, in growing order: given as such, or as (low, high, n)."""
    driven(doc, path)
    try:
        numbers = np.asarray(points, float)
    except (TypeError, ValueError):
        numbers = np.zeros((0, 0))
    if numbers.ndim != 1:
        raise ParameterError(
            f"the values are {show(points)}; expected numbers, or (low, high, n)", where=path
        )
    if isinstance(points, tuple) and len(numbers) == 3:
        low, high, n = (float(number) for number in numbers)
        if not float(n).is_integer() or n < 2:
            raise ParameterError(f"n is {n:g}; a map needs 2 or more values of each parameter", where=path)
        numbers = np.linspace(low, high, int(n))
    if not np.isfinite(numbers).all():
        raise ParameterError(f"the values {show(points)} are not all finite numbers", where=path)
    if len(numbers) < 2:
        raise ParameterError(
            f"has {len(numbers)} values; a map needs 2 or more of each parameter", where=path
        )
    if not (np.diff(numbers) > 0).all():
        raise ParameterError(f"the values {show(points)} do not grow from each to the next", where=path)
    for number in (numbers[0], numbers[-1]):
        edit.change(doc, path, float(number))
    return numbers


def with_inputs(isolated: Isolated, trusted: bool) -> Model:
    """Return the isolated field with the inputs of the protocol."""
    small = Model(document=isolated.session.document, trusted=trusted)
    for name in ("input", "second", "boost"):
        small.remove(name)
    axes = isolated.axes
    where = dict.fromkeys(INPUTS, isolated.center)
    if axes:
        where["first"], where["second"] = places(isolated, DISTANCE)
    for name in INPUTS:
        stimulus = GaussianStimulus(
            name, axes, center=where[name] or 0.0, sigma=isolated.sigma or 1.0, amplitude=0.0
        )
        small.add(stimulus) >> small["field"]
    return small


def driven_alone(doc: Document, small: Document, isolated: Isolated, path: str) -> tuple[Leaf, ...]:
    """Return the numbers of the isolated field that a parameter of the model drives."""
    ids = {find.element(doc, isolated.path).id: find.element(small, "field").id}
    for path_of_input in isolated.background:
        ids[find.element(doc, path_of_input).id] = find.element(small, f"background.{path_of_input}").id
    leaves = driven(doc, path)
    driven_leaves = tuple((ids[ident], leaf) for ident, leaf in leaves if ident in ids)
    if not driven_leaves:
        raise AnalysisError(
            f"does not belong to {isolated.path}, which is measured alone",
            where=path,
            fix="Name parameters of the field, or keep the stimulus as constant input: inputs=[PATH]",
        )
    field_id = find.element(small, "field").id
    for ident, leaf in driven_leaves:
        name = leaf.split(".")[0]
        if ident == field_id and name in ("noise", "noise_length"):
            raise AnalysisError("changes no regime: noise is off in the measurement", where=path)
        if ident == field_id and name == "tau":
            raise AnalysisError(
                "changes no regime: the steady states of a field do not depend on it", where=path
            )
    return driven_leaves
