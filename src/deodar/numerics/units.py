"""Units of length and angle, as the axes of documents and the signals of worlds state them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class MetricUnit:
    """A unit of length or angle.

    Attributes:
        quantity: `length` or `angle`.
        symbol: its usual name.
        size: its size in metres or radians.
    """

    quantity: str
    symbol: str
    size: float


UNITS: Mapping[MetricUnit, tuple[str, ...]] = {
    MetricUnit("length", "km", 1e3): ("kilometre", "kilometer"),
    MetricUnit("length", "m", 1.0): ("metre", "meter"),
    MetricUnit("length", "dm", 0.1): ("decimetre", "decimeter"),
    MetricUnit("length", "cm", 0.01): ("centimetre", "centimeter"),
    MetricUnit("length", "mm", 1e-3): ("millimetre", "millimeter"),
    MetricUnit("length", "um", 1e-6): (
        "\N{MICRO SIGN}m",
        "\N{GREEK SMALL LETTER MU}m",
        "micrometre",
        "micrometer",
    ),
    MetricUnit("angle", "rad", 1.0): ("radian",),
    MetricUnit("angle", "deg", math.pi / 180): ("\N{DEGREE SIGN}", "degree"),
}
"""The units, and other names of each; a name written in full may end in s."""

_KNOWN = {name: unit for unit, others in UNITS.items() for name in (unit.symbol, *others)}


def parse(text: str) -> MetricUnit | None:
    """Return the unit that a text names; None if it names no unit of length or angle."""
    name = text.strip()
    return _KNOWN.get(name) or (_KNOWN.get(name[:-1]) if name.endswith("s") and len(name) > 4 else None)


def of_size(quantity: str, size: float) -> MetricUnit | None:
    """Return the unit of a quantity that has a size in metres or radians, to 1e-6; None if none has."""
    return next(
        (u for u in UNITS if u.quantity == quantity and math.isclose(u.size, size, rel_tol=1e-6)), None
    )
