"""Models of kinds that read time; the tests of these kinds have functions `timed` and `lasting`, which
`tests/deodar/session/test_long_times.py` runs a month after the start.
"""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.element import Element
from deodar.elements.changing_stimuli import TimeSeries

RISING = np.arange(15.0)


def alone(element: Element, t0: float = 0.0, given: np.ndarray | None = None) -> dd.Model:
    """Return a model with an element called `example`, and a time series from t0 on as its input."""
    model = dd.Model("timed", dt=1.0)
    model.describe(t0=t0)
    model.add(element)
    if given is not None:
        model.add(TimeSeries("s", [], t0 + np.arange(len(given)), given)) >> model["example"]
    return model
