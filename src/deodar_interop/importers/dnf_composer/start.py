"""What stimuli show after the initialisation of dnf-composer, which adds their inputs once."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from deodar_interop.importers._foreign import Foreign
from deodar_interop.importers._piece import Unfit
from deodar_interop.importers.dnf_composer.element import StoredElement
from deodar_interop.importers.dnf_composer.sizes import size

ADDING = ("gauss stimulus", "gauss stimulus 2d", "boost stimulus", "boost stimulus 2d")
"""Labels whose inputs are added at the start, and never again."""


def added(elements: Sequence[Foreign], contexts: Mapping[str, StoredElement]) -> dict[str, np.ndarray]:
    """Return for each stimulus with inputs the sum that it adds, one number for each sample.

    All elements are initialised twice, in the order of the file: without inputs, then with them. So a
    stimulus adds the final output of the sources before it, and what those after it show without inputs.
    A sum that exceeds the budget is left out.
    """
    out: dict[str, np.ndarray] = {}
    for e in elements:
        if e.kind not in ADDING or not e.sources:
            continue
        count = math.prod(size(e))
        try:
            contexts[e.label].budget.take(count)
        except Unfit:
            continue
        total = np.zeros(count)
        for s in e.sources:
            b = contexts[s.label]
            level = b.start if s.component == "output" else b.levels.get(s.component, 0.0)
            total += level() if callable(level) else level
            if s.component == "output" and s.label in out:
                total += out[s.label]
        out[e.label] = total
    return out
