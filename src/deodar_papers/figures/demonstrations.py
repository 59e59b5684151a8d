"""Several sequences that were taught and produced: their time courses, and the learned weights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from deodar.architectures.color_search import HUES
from deodar.figures._style import AMOUNTS, COLOR, DOUBLE, MEDIUM, style
from deodar.figures._style import figure as sheet
from deodar_papers.figures.sequence import TICKS, DrawnSearch, draw_hues, draw_nodes, line_colour

HEIGHT = 3.0
"""Height of one demonstration, inches."""


class DrawnDemonstration(DrawnSearch, Protocol):
    """A sequence that was taught and produced, with the weights of its nodes, (nodes, hues)."""

    @property
    def weights(self) -> np.ndarray: ...


def demonstrations_figure(results: Sequence[DrawnDemonstration], titles: Sequence[str]) -> Figure:
    """Draw for each demonstration the ordinal nodes and both fields over time, and at the right the learned
    weights. Triangles mark the times at which blocks were found, in the colour of the block.
    """
    with style():
        out = sheet(DOUBLE, HEIGHT * len(results))
        grid = out.add_gridspec(3 * len(results), 2, width_ratios=[6.0, 1.0])
        for n, (result, title) in enumerate(zip(results, titles, strict=True)):
            first = out.add_subplot(grid[3 * n, 0])
            draw_nodes(first, result)
            first.set_title(f"({'abcdef'[n]}) {title}", loc="left")
            rows = [first]
            for k, (name, words) in enumerate((("action", "action"), ("satisfaction", "CoS")), 1):
                axes = out.add_subplot(grid[3 * n + k, 0], sharex=first)
                image = draw_hues(axes, result, name)
                out.colorbar(image, ax=axes, label="activation", pad=0.01, aspect=8, ticks=TICKS)
                axes.set_ylabel(f"{words}, hue")
                rows.append(axes)
            for time, letter in zip(result.found, result.produced, strict=True):
                rows[2].plot(
                    time / 1000,
                    1.0,
                    "v",
                    color=line_colour(result.hues[letter]),
                    transform=rows[2].get_xaxis_transform(),
                    clip_on=False,
                    markersize=4.5,
                )
            for axes in rows:
                axes.axvline(result.begins / 1000, color=COLOR.threshold, linewidth=MEDIUM)
            for axes in rows[:2]:
                axes.tick_params(labelbottom=False)
            rows[2].set_xlabel("time (s)")
            image = _weights(out.add_subplot(grid[3 * n : 3 * n + 3, 1]), result)
            out.colorbar(image, ax=out.axes[-1], label="weight", aspect=24)
    return out


def _weights(axes: Axes, result: DrawnDemonstration) -> Any:
    count = len(result.sequence)
    # cut between violet and red, as the fields beside it
    turned = np.roll(result.weights[:count], HUES // 12, axis=1)
    low = -HUES // 12 - 0.5
    image = axes.imshow(
        turned.T,
        extent=(0.5, count + 0.5, low, low + HUES),
        origin="lower",
        cmap=AMOUNTS,
        vmin=0.0,
        vmax=1.0,
        aspect="auto",
    )
    axes.set_xticks(range(1, count + 1))
    axes.set_yticks(list(result.hues.values()), list(result.hues))
    axes.set_xlabel("ordinal node")
    axes.set_title("weights", loc="left")
    return image
