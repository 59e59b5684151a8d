"""The request of a simulation: its duration, its copies, and how it is computed."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Sequence
from typing import Any

from deodar.resources import Resources
from deodar.sweep import Sweep


@dc.dataclass(frozen=True)
class SimulationRequest:
    """The request of a simulation, as passed to `deodar.simulate`, or of one piece of it.

    Worker processes receive it pickled, so a piece contains plain data: the model and its world are passed
    separately.

    Attributes:
        duration: document time; a whole number of steps.
        dt: Euler step; none: the document's own.
        seed: seed of all noise.
        record: paths of ports, handles or probes; none: all fields and nodes, at the end.
        every: document time between records; none: dt.
        trials: number of trials, or a list of trial numbers; none: one run without a dimension `trial`.
        sweep: for each parameter path its values, or a list of points; none: no sweep.
        precision: float32, float64 or float32-exact.
        on: what the run may use; of a piece its devices.
        width: of a piece, a dimension and its length in the other pieces. The piece is filled up to it with
            copies of its last one, whose results are dropped: the last digits in single precision depend on
            the number of copies that are computed together.
        first: of a piece, the number of its first point of a list.
    """

    duration: float
    dt: float | None = None
    seed: int = 0
    record: Any = None
    every: float | None = None
    trials: int | Sequence[int] | None = None
    sweep: Sweep | None = None
    precision: str = "float32"
    on: Resources = Resources()
    width: tuple[str, int] | None = None
    first: int = 0
