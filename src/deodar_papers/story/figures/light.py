"""The spatial field as a light on a photograph: a peak shines, and the low field around it is a veil."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deodar_papers.story.figures.canvas import SCALE, Canvas
from deodar_papers.story.figures.plot import interpolation
from deodar_papers.story.figures.theme import WHITE, activation_colours

NEAR = -1.8
"""Activation from which on a place is drawn; light fades out over the last `FADE`."""

FADE = 1.6
LOW, HIGH = -9.0, 8.5
"""Activation of the last colours."""

OVER, UNDER = 0.9, 0.6
"""Share of the light's colour above the threshold, and most of it below."""

LINE_FROM = 0.6
"""Activation from which on a peak has a white line at the threshold."""

SUPPRESSED, DEEPEST = -5.0, -9.0
"""Lowest activation without a veil, and with the thickest."""

VEIL = 0.75
"""Largest share of the veil's colour."""


@dataclass(frozen=True)
class Patch:
    """Activation at the pixels of a rectangle of the photograph.

    Attributes:
        row: number of its first row, counted from the corner of the photograph.
        column: number of its first column.
        activation: at its pixels.
    """

    row: int
    column: int
    activation: np.ndarray


class Light:
    """Draws a spatial field on a photograph.

    Args:
        corner: row and column of the photograph's first pixel in a canvas.
        rows, columns: position of each row and each column of pixels in the field, in samples.
        samples: number of samples of the field along each axis.
    """

    def __init__(self, corner: tuple[int, int], rows: np.ndarray, columns: np.ndarray, samples: int) -> None:
        self._corner, self._rows, self._columns = corner, rows, columns
        self._at_rows, self._at_columns = (interpolation(at, samples) for at in (rows, columns))

    def draw(self, canvas: Canvas, field: np.ndarray) -> None:
        """Draw the activation of a field over x and y."""
        smooth = _smooth(field).T
        lit = np.argwhere(smooth > NEAR)
        if not len(lit):
            return
        (top, bottom), (left, right) = (
            np.searchsorted(at, [cells.min() - 1.5, cells.max() + 1.5])
            for at, cells in zip((self._rows, self._columns), lit.T, strict=True)
        )
        activation = self._at_rows[top:bottom] @ smooth @ self._at_columns[left:right].T
        patch = Patch(int(top), int(left), activation)
        if smooth.max() > 0 and (activation > 0).any():
            self._veil(canvas, patch, float(smooth.min()))
        self._shine(canvas, patch)

    def _veil(self, canvas: Canvas, patch: Patch, lowest: float) -> None:
        """Mix the colour of low activation into the surroundings of a peak, less with the distance.

        The field is low everywhere; a veil on the whole photograph would make a large file.
        """
        depth = np.clip((SUPPRESSED - lowest) / (SUPPRESSED - DEEPEST), 0, 1)
        over = np.maximum(patch.activation, 0)
        row, column = (
            float(np.average(np.arange(over.shape[axis]), weights=over.sum(1 - axis))) for axis in (0, 1)
        )
        reach = int(3 * (np.sqrt((over > 0).sum() / np.pi) + 1) + 6 * SCALE)
        row, column = int(row) + patch.row, int(column) + patch.column
        top, bottom = max(row - reach, 0), min(row + reach, len(self._rows))
        left, right = max(column - reach, 0), min(column + reach, len(self._columns))
        y, x = np.ogrid[top:bottom, left:right]
        cover = np.clip(1 - np.hypot(y - row, x - column) / reach, 0, 1) ** 0.8
        colour = activation_colours(np.array(-8.0), LOW, HIGH)
        share = round(VEIL * float(depth) * 6) / 6
        canvas.blend(self._corner[0] + top, self._corner[1] + left, _steps(cover, 16), colour, share)

    def _shine(self, canvas: Canvas, patch: Patch) -> None:
        """Mix the colours of activation into the patch, and draw the line at the threshold."""
        z = patch.activation
        row, column = self._corner[0] + patch.row, self._corner[1] + patch.column
        alpha = np.where(z < 0, np.clip(1 + z / FADE, 0, 1) * UNDER, OVER)
        view = canvas.pixels[row : row + z.shape[0], column : column + z.shape[1]]
        view += (activation_colours(z, LOW, HIGH, 20) - view) * _steps(alpha, 8)[..., None]
        if z.max() > LINE_FROM:
            steep = np.hypot(*np.gradient(z))
            line = np.clip(SCALE + 0.5 - np.abs(z) / np.maximum(steep, 1e-3), 0, 1)
            canvas.blend(row, column, _steps(line, 4), WHITE)


def _smooth(field: np.ndarray) -> np.ndarray:
    """Return a field that is smoothed by one sample, because noise of single samples frays the white line."""
    rows = np.pad(field, 1, mode="edge")
    columns = (rows[:-2] + 2 * rows[1:-1] + rows[2:]) / 4
    return (columns[:, :-2] + 2 * columns[:, 1:-1] + columns[:, 2:]) / 4


def _steps(cover: np.ndarray, count: int) -> np.ndarray:
    """Round shares to a number of steps: fewer colours make a smaller file."""
    return (np.rint(cover * count) / count).astype(np.float32)


def positions(pixels: int, ends: Sequence[float], samples: int) -> np.ndarray:
    """Return the positions of pixels along one axis of a field, in samples.

    Args:
        pixels: their number.
        ends: places of the first and the last sample, as shares of the photograph.
        samples: number of samples.
    """
    share = (np.arange(pixels) + 0.5) / pixels
    return (share - ends[0]) / (ends[1] - ends[0]) * (samples - 1)
