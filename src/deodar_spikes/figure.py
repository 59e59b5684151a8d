"""Outputs of rates and of spikes side by side: one column for each, one row for each element."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from deodar.figures import _style

MOST_CELLS = 400


def spikes_figure(
    runs: Mapping[str, Mapping[str, NDArray[np.float32]]], times: NDArray[np.float64], unit: str
) -> Figure:
    """Draw one trial as a map of time and cells for each element and run, on one scale for each element.

    Args:
        runs: outputs by the name of what computed them and by element: times x cells.
        times: document time of each value.
        unit: the document's unit of time.
    """
    labels = list(next(iter(runs.values())))
    with _style.style():
        figure = _style.figure(_style.DOUBLE, (_style.PANEL - 0.3) * len(labels) + 0.3)
        grid = figure.subplots(len(labels), len(runs), squeeze=False, sharex=True, sharey="row")
        for row, label in enumerate(labels):
            most = max(float(np.max(r[label])) for r in runs.values()) or 1.0
            for column, (name, run) in enumerate(runs.items()):
                ax = grid[row][column]
                values = run[label][:, : MOST_CELLS * 100]
                if values.shape[1] == 1:
                    ax.plot(times, values[:, 0], color=_style.COLOR.output)
                    ax.set_ylim(0, 1.1 * most)
                else:
                    shown = ax.imshow(
                        values.T,
                        aspect="auto",
                        origin="lower",
                        vmin=0,
                        vmax=most,
                        interpolation="nearest",
                        extent=(float(times[0]), float(times[-1]), -0.5, values.shape[1] - 0.5),
                    )
                    if column == len(runs) - 1:
                        figure.colorbar(shown, ax=ax, label="output")
                if not row:
                    ax.set_title(name)
                if not column:
                    ax.set_ylabel(label)
                if row == len(labels) - 1:
                    ax.set_xlabel(f"time ({unit})")
    return figure
