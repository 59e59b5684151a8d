"""Axes whose boundaries, samples and units do not agree."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from deodar.errors import EditFix, Problem
from deodar.model import document_files
from deodar.model.resolve import Node
from deodar.model.wiring import Wiring, warning
from deodar.numerics.axes import Axis
from deodar.proposed_edit import EditValue, SetAxis

DEGREES, RADIANS = ("deg", "degree", "degrees", "°"), ("rad", "radian", "radians")
CIRCLES = tuple((k * math.pi, k * 180.0) for k in (1, 2))
"""Half a turn and a full turn, in radians and degrees."""


def check(wiring: Wiring) -> Iterator[Problem]:
    """Yield one warning per axis, at the first element that has it."""
    seen: set[Axis] = set()
    keys = document_files.axes(wiring.doc)
    for n in wiring.declared:
        axes: Any = getattr(n.element, "axes", ())
        for axis in (*axes, *(a for a in (getattr(n.element, "axis", None),) if isinstance(a, Axis))):
            if axis not in seen:
                seen.add(axis)
                yield from _axis(
                    n, axis, {key: a for key, a in keys.items() if a.name == axis.name and axis.fits(a)}
                )


def _axis(n: Node, a: Axis, matched: Mapping[str, Axis]) -> Iterator[Problem]:
    if a.periodic and a.samples > 2 and _round(a.range / (a.samples - 1)) and not _round(a.range / a.samples):
        sentence = (
            f"the periodic axis {a.name!r} counts its end twice: {a.lower:g} and {a.upper:g} are one place,"
            f" so {a.samples} samples lie {a.range / a.samples:g} apart, not {a.range / (a.samples - 1):g}"
        )
        yield warning(
            n,
            sentence,
            _change("Leave the second end out", {k: b for k, b in matched.items() if b == a}, fewer=1),
        )
    unit = a.unit.lower()
    whole, other_unit = (
        (360.0, "rad") if unit in DEGREES else (2 * math.pi, "deg") if unit in RADIANS else (0.0, "")
    )
    turns = (
        {t for radians, degrees in CIRCLES for t in ((radians,) if unit in DEGREES else (degrees,))}
        if whole
        else set[float]()
    )
    if any(math.isclose(a.range, t, rel_tol=1e-3) for t in turns):
        sentence = (
            f"the axis {a.name!r} is {a.range:g} long, a turn or half of one in {other_unit}, but its unit is"
            f" {a.unit}"
        )
        yield warning(
            n,
            sentence,
            _change("Name the other unit", matched, f"Or write the bounds in {a.unit}", unit=other_unit),
        )
    elif whole and not a.periodic and math.isclose(a.range, whole, rel_tol=1e-4):
        sentence = (
            f"the axis {a.name!r} is a whole circle ({a.range:g} {a.unit}), but its ends do not meet: kernels"
            " treat its ends as far apart"
        )
        yield warning(n, sentence, _change("Join the ends", matched, fewer=1, periodic=True))


def _change(
    advice: str, matched: Mapping[str, Axis], otherwise: str = "", fewer: int = 0, **values: EditValue
) -> EditFix:
    """Return the fix that changes all axes that connections match, and leaves some samples of each out.

    The last one is changed first: an axis that becomes equal to another one takes its key, and later axes of
    the name get other keys.
    """
    edits = [
        SetAxis(key, (*values.items(), *((("samples", a.samples - fewer),) if fewer else ())))
        for key, a in reversed(list(matched.items()))
    ]
    return EditFix(advice, edits, otherwise)


def _round(step: float) -> bool:
    """Return whether a step is a number that a person would choose: a whole number, or a few halves, fifths
    or tenths.
    """
    scaled = step / 10 ** math.floor(math.log10(step))
    return any(math.isclose(scaled, k, rel_tol=1e-9) for k in (1, 1.5, 2, 2.5, 3, 4, 5, 6, 7.5, 8, 9))
