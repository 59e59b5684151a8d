"""A measure: how wide the part of a field above a threshold is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

import deodar as dd


@dataclass(frozen=True)
class Width(dd.BaseMeasure):
    """Extent of the part of a field above a threshold: a length, an area or a volume.

    Attributes:
        name: name of its column in the results.
        of: path of a field.
        when: the event at which it is measured; empty: when the trial ends.
        threshold: samples above it count.
    """

    name: str
    of: str
    when: str = ""
    threshold: Annotated[float, dd.Recompile("activation")] = 0.0

    def value(self, samples: np.ndarray, axes: dd.Axes | None) -> float | None:
        above = int((samples > self.threshold).sum())
        return above * float(np.prod([axis.step for axis in axes or ()])) if above else None
