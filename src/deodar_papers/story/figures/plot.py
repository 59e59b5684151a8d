"""A plot of activation over one axis: every column of pixels has one value, and lines are smooth."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deodar_papers.story.figures.canvas import SCALE, Canvas, Colour

EDGE_STEPS, GLOW_STEPS, HALO_STEPS = 6, 10, 6
"""Steps of coverage of an edge, of the area below it and of the light around it: fewer colours make a smaller
file.
"""

GLOW, HALO = 0.36, 0.28
"""Largest share of the glow's colour in the area, and in the light around the line."""

HALO_WIDTH = 4.0
"""Width of the light around the line, units."""


class Plot:
    """The place of a plot.

    Args:
        box: left, top, right and bottom in units.
        low, high: values at the bottom and at the top.
        samples: number of values over the width.
    """

    def __init__(self, box: Sequence[float], low: float, high: float, samples: int) -> None:
        self.left, self.top, self.right, self.bottom = (round(v * SCALE) for v in box)
        self.low, self.high = low, high
        self._at_columns = interpolation(np.linspace(0, samples - 1, self.right - self.left), samples)
        self._rows = (np.arange(self.top, self.bottom)[:, None] + 0.5).astype(np.float32)

    def height(self, level: float) -> float:
        """Return the y of a level, in units."""
        return float(self._row(np.float32(level))) / SCALE

    def shade(self, canvas: Canvas, base: float, values: np.ndarray, colour: Colour, alpha: float) -> None:
        """Fill the area between a level and a curve above it."""
        bottom, top = self._row(np.float32(base)), self._row(self._at_columns @ values)[None]
        first, rows = self._between(float(top.min()) - 1, float(bottom) + 1)
        cover = np.clip(rows - top + 0.5, 0, 1) * np.clip(bottom - rows + 0.5, 0, 1)
        canvas.blend(self.top + first, self.left, cover, colour, alpha)

    def line(self, canvas: Canvas, values: np.ndarray, colour: Colour, width: float = 1.0) -> None:
        """Draw a curve in one colour."""
        first, cover, _ = self._line(values, width)
        canvas.blend(self.top + first, self.left, cover, colour)

    def activation(self, canvas: Canvas, values: np.ndarray, width: float = 2.4, halo: bool = True) -> None:
        """Draw activation: below the threshold and above it in two colours, and the area above it glows."""
        theme = canvas.theme
        threshold = float(self._row(np.float32(0.0)))
        if (values > 0).any():
            self._glow(canvas, values, threshold, halo)
        first, cover, rows = self._line(values, width)
        over = np.clip(threshold - rows + 0.5, 0, 1)
        canvas.blend(self.top + first, self.left, cover * (1 - over), theme.below)
        canvas.blend(self.top + first, self.left, cover * over, theme.above)

    def _glow(self, canvas: Canvas, values: np.ndarray, threshold: float, halo: bool) -> None:
        curve = self._row(self._at_columns @ values)[None]
        first, rows = self._between(float(curve.min()) - 10 * SCALE, threshold + 1)
        depth = np.clip((threshold - rows) / max(threshold - float(curve.min()), 1), 0, 1)
        cover = np.clip(rows - curve + 0.5, 0, 1) * _steps(depth, GLOW_STEPS) * GLOW
        if halo:
            light = np.exp(-((self._distance(curve, rows) / (HALO_WIDTH * SCALE)) ** 2))
            cover = np.maximum(cover, _steps(light, HALO_STEPS) * HALO)
        over = np.clip(threshold - rows + 0.5, 0, 1)
        canvas.blend(self.top + first, self.left, cover * over, canvas.theme.glow)

    def _line(self, values: np.ndarray, width: float) -> tuple[int, np.ndarray, np.ndarray]:
        """Return the number of the first row of a curve, the coverage of the rows, and their middles."""
        curve = self._row(self._at_columns @ values)[None]
        first, rows = self._between(float(curve.min()) - 3 * SCALE, float(curve.max()) + 3 * SCALE)
        cover = np.clip(width * SCALE / 2 + 0.5 - self._distance(curve, rows), 0, 1)
        return first, _steps(cover, EDGE_STEPS), rows

    @staticmethod
    def _distance(curve: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """Return the distance of pixels from a curve, which is straight between two columns."""
        return np.abs(rows - curve) / np.sqrt(1 + np.gradient(curve[0])[None] ** 2)

    def _row(self, level: np.ndarray | np.float32) -> np.ndarray:
        return np.asarray(
            self.bottom - (level - self.low) / (self.high - self.low) * (self.bottom - self.top)
        )

    def _between(self, top: float, bottom: float) -> tuple[int, np.ndarray]:
        """Return the number of the first row of pixels between two heights, and the middles of the rows."""
        first = max(int(top) - self.top, 0)
        last = min(int(bottom) + 2 - self.top, len(self._rows))
        return first, self._rows[first : max(last, first + 1)]


def _steps(cover: np.ndarray, count: int) -> np.ndarray:
    """Round shares to a number of steps."""
    return np.rint(cover * count) / count


def interpolation(at: np.ndarray, samples: int) -> np.ndarray:
    """Return the matrix that interpolates samples at positions in samples, by cubic convolution."""
    before = np.clip(np.floor(at).astype(int), 0, samples - 2)
    f = at - before
    weights = {
        -1: -0.5 * f**3 + f**2 - 0.5 * f,
        0: 1.5 * f**3 - 2.5 * f**2 + 1,
        1: -1.5 * f**3 + 2 * f**2 + 0.5 * f,
        2: 0.5 * f**3 - 0.5 * f**2,
    }
    matrix = np.zeros((len(at), samples), np.float32)
    for offset, weight in weights.items():
        np.add.at(matrix, (np.arange(len(at)), np.clip(before + offset, 0, samples - 1)), weight)
    return matrix
