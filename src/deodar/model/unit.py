"""Units of document time in seconds of wall time."""

from __future__ import annotations

SECONDS = {"us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "abstract": 1e-3}


def unit_seconds(time_unit: str) -> float:
    """Return the seconds in one unit of document time; abstract time counts as milliseconds."""
    if time_unit in SECONDS:
        return SECONDS[time_unit]
    _, _, number, unit = time_unit.split()  # "1 = 64 ms"
    return float(number) * SECONDS[unit]
