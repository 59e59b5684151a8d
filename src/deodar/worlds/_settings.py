"""Checks of the settings of worlds."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from deodar.errors import WorldError
from deodar.parameters import real, show


def periods(name: str, given: Any) -> int:
    """Return a whole number of periods, or raise WorldError."""
    if isinstance(given, bool) or not isinstance(given, (int, np.integer)) or given < 1:
        raise WorldError(f"{name} is {show(given)}; expected a whole number of periods, at least 1")
    return int(given)


def number(name: str, given: Any, above: float | None = None) -> float:
    """Return a finite number of 0 or more, or above a value, or raise WorldError."""
    value = real(given)
    if value is None or not math.isfinite(value) or value < 0 or (above is not None and value <= above):
        raise WorldError(
            f"{name} is {show(given)}; expected a finite number,"
            f" {'above 0' if above is not None else '0 or above'}"
        )
    return float(value)
