"""What a field did in each trial: winner, peaks, times of detection and forgetting, memory.

All measures read outputs alone, so that rates and spikes are measured alike. A cell is active while its
output is above half of `level`, the largest output of the rate model.
"""

from __future__ import annotations

import dataclasses as dc

import numpy as np
from numpy.typing import NDArray

from deodar.analysis.peaks import peaks
from deodar.numerics.axes import Axes, shape

Each = NDArray[np.float64]


@dc.dataclass(frozen=True)
class FieldOutcomes:
    """Measures of a field, one value for each trial; NaN where there is none.

    Attributes:
        winner: index of the cell with the largest output in the last quarter of the time with input.
        peaks: number of peaks then.
        detection: time from the start of the input until a cell is active.
        forgetting: time from the end of the input until no cell is active.
        memory: whether a cell is active at the end of the run, without input (1 or 0).
        drift: distance from the peak at the end of the input to that at the end of the run, in axis units, on
            the first axis.
    """

    winner: Each
    peaks: Each
    detection: Each
    forgetting: Each
    memory: Each
    drift: Each


def outcomes(
    outputs: NDArray[np.float32], axes: Axes, on: NDArray[np.bool_], window: float, level: float
) -> FieldOutcomes:
    """Measure the outputs of a field.

    Args:
        outputs: windows x trials x cells.
        axes: axes of the cells.
        on: whether an input is on, for each window.
        window: length of a window, document time.
        level: largest output of the rate model.
    """
    trials = outputs.shape[1]
    none = np.full(trials, np.nan)
    active = outputs.max(-1) > level / 2
    found = FieldOutcomes(none, none, none, none, none, none)
    if not on.any():
        return found
    first, last = int(np.argmax(on)), int(len(on) - np.argmax(on[::-1]))
    with_input = outputs[last - max(1, (last - first) // 4) : last].mean(0)
    seen = with_input.max(-1) > level / 2
    winner = np.where(seen, with_input.argmax(-1), np.nan)
    number = np.array([_count(v, axes, level) for v in with_input], float)
    detection = np.where(active[first:].any(0), (active[first:].argmax(0) + 0.5) * window, np.nan)
    found = dc.replace(found, winner=winner, peaks=number, detection=detection)
    if last == len(on):
        return found
    after = active[last:]
    gone = np.where(seen & ~after.all(0), ((~after).argmax(0) + 0.5) * window, np.nan)
    stays = after[-max(1, len(after) // 20) :].all(0)
    gone = np.where(stays, np.nan, gone)
    memory = np.where(seen, stays.astype(float), np.nan)
    end = outputs[-max(1, len(after) // 20) :].mean(0)
    drift = np.array(
        [
            _place(b, axes, level) - _place(a, axes, level) if s else np.nan
            for a, b, s in zip(with_input, end, stays & seen, strict=True)
        ]
    )
    if axes and axes[0].periodic:
        drift = (drift + axes[0].range / 2) % axes[0].range - axes[0].range / 2
    return dc.replace(found, forgetting=gone, memory=memory, drift=drift)


def _count(values: NDArray[np.float32], axes: Axes, level: float) -> int:
    return len(peaks(values.reshape(shape(axes)), axes, level / 2))


def _place(values: NDArray[np.float32], axes: Axes, level: float) -> float:
    """Return the position of the highest peak on the first axis."""
    found = peaks(values.reshape(shape(axes)), axes, level / 2)
    return found[0].position[0] if len(found) and found[0].position else np.nan
