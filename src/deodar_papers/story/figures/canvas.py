"""A picture that is drawn in units of a page of 640 x 400, with smooth edges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from PIL import Image, ImageDraw

from deodar_papers.story.figures import letters
from deodar_papers.story.figures.theme import Theme

WIDE, HIGH = 640, 400
"""Size of a picture in units."""

SCALE = 1.5
"""Pixels of a unit."""

LARGER = 4
"""Factor by which a polygon is drawn larger before it is reduced."""

MIDDLE_OF_DIGITS = 0.605
"""Distance of the middle of digits from the top of a mask of text, in sizes of type."""

Colour = np.ndarray
"""Red, green and blue, 0 to 255."""


class Canvas:
    """A picture of floats, `pixels`, whose methods take units."""

    def __init__(self, theme: Theme) -> None:
        self.theme = theme
        self.pixels = np.empty((round(HIGH * SCALE), round(WIDE * SCALE), 3), np.float32)
        self.pixels[:] = theme.page

    def copy(self) -> Canvas:
        """Return another canvas with the same pixels."""
        twin = object.__new__(Canvas)
        twin.theme, twin.pixels = self.theme, self.pixels.copy()
        return twin

    def frame(self) -> np.ndarray:
        """Return the picture as bytes."""
        return (self.pixels + 0.5).astype(np.uint8)

    def blend(self, row: int, column: int, cover: np.ndarray, colour: Colour, alpha: float = 1.0) -> None:
        """Mix a colour into a rectangle of pixels.

        Args:
            row: pixel of its upper end, which may lie outside.
            column: pixel of its left end, which may lie outside.
            cover: share of the colour for each pixel, 0 to 1.
            colour: the colour.
            alpha: factor of `cover`.
        """
        rows, columns = self.pixels.shape[:2]
        top, left = max(row, 0), max(column, 0)
        bottom, right = min(row + cover.shape[0], rows), min(column + cover.shape[1], columns)
        if bottom <= top or right <= left:
            return
        share = cover[top - row : bottom - row, left - column : right - column, None] * np.float32(alpha)
        view = self.pixels[top:bottom, left:right]
        view += (colour - view) * share

    def text(
        self,
        x: float,
        y: float,
        text: str,
        size: float = 12,
        weight: int = 400,
        colour: Colour | None = None,
        side: Literal["left", "middle", "right"] = "left",
    ) -> None:
        """Write a line; y is the middle of its digits, and x its left end, middle or right end."""
        cover = letters.mask(text, _type(size), weight)
        back = {"left": 0.0, "middle": 0.5, "right": 1.0}[side] * (cover.shape[1] - 2)
        row, column = round(y * SCALE - size * SCALE * MIDDLE_OF_DIGITS), round(x * SCALE - back)
        self.blend(row, column, cover, self.theme.text if colour is None else colour)

    def rectangle(self, box: Sequence[float], colour: Colour, radius: float = 0.0) -> None:
        """Fill a rectangle (left, top, right, bottom) with round corners."""
        left, top, right, bottom = (v * SCALE for v in box)
        row, column, y, x = _grid((left, top), (right, bottom), 0)
        if radius:
            inner = radius * SCALE
            dx = np.maximum(np.maximum(left + inner - x, x - (right - inner)), 0)
            dy = np.maximum(np.maximum(top + inner - y, y - (bottom - inner)), 0)
            cover = _edge(inner - np.hypot(dx, dy))
        else:
            cover = _edge(np.minimum(x - left, right - x)) * _edge(np.minimum(y - top, bottom - y))
        self.blend(row, column, cover, colour)

    def disc(self, x: float, y: float, radius: float, colour: Colour) -> None:
        """Fill a disc."""
        row, column, distance = self._around(x, y, radius)
        self.blend(row, column, _edge(radius * SCALE - distance), colour)

    def ring(self, x: float, y: float, radius: float, colour: Colour, alpha: float) -> None:
        """Draw a circle with a line of two units."""
        row, column, distance = self._around(x, y, radius + 1)
        self.blend(row, column, _edge(SCALE - np.abs(distance - radius * SCALE)), colour, alpha)

    def _around(self, x: float, y: float, radius: float) -> tuple[int, int, np.ndarray]:
        """Return the first row and column of the pixels around a point, and their distances from it."""
        centre = np.array([x, y]) * SCALE
        row, column, rows, columns = _grid(centre - radius * SCALE, centre + radius * SCALE, 2)
        return row, column, np.hypot(columns - centre[0], rows - centre[1])

    def line(
        self,
        begin: tuple[float, float],
        end: tuple[float, float],
        colour: Colour,
        width: float = 1.0,
        dash: tuple[float, float] | None = None,
    ) -> None:
        """Draw a straight line between two points (x, y); `dash` has the lengths of a dash and of a gap."""
        p, q = np.array(begin) * SCALE, np.array(end) * SCALE
        row, column, y, x = _grid(np.minimum(p, q), np.maximum(p, q), width * SCALE / 2 + 2)
        length = float(np.hypot(*(q - p)))
        ux, uy = (q - p) / length
        along = (x - p[0]) * ux + (y - p[1]) * uy
        across = np.abs((y - p[1]) * ux - (x - p[0]) * uy)
        cover = _edge(width * SCALE / 2 - across) * _edge(np.minimum(along, length - along))
        if dash is not None:
            on, off = dash[0] * SCALE, dash[1] * SCALE
            phase = np.mod(along, on + off)
            cover = cover * _edge(np.minimum(phase, on - phase))
        self.blend(row, column, cover, colour)

    def polygon(self, corners: Sequence[np.ndarray], colour: Colour) -> None:
        """Fill a polygon of corners (x, y)."""
        points = np.array(corners) * SCALE
        low, high = np.floor(points.min(0)).astype(int) - 1, np.ceil(points.max(0)).astype(int) + 1
        columns, rows = (high - low) * LARGER
        picture = Image.new("L", (int(columns), int(rows)), 0)
        ImageDraw.Draw(picture).polygon([tuple(c) for c in (points - low) * LARGER], fill=255)
        self.blend(int(low[1]), int(low[0]), np.asarray(picture.reduce(LARGER), np.float32) / 255, colour)


def width(text: str, size: float, weight: int = 400) -> float:
    """Return the width of a line of text in units."""
    return (letters.mask(text, _type(size), weight).shape[1] - 2) / SCALE


def _type(size: float) -> float:
    """Return a size of type in pixels, to half a pixel."""
    return round(size * SCALE * 2) / 2


def _edge(inside: np.ndarray) -> np.ndarray:
    """Return the coverage of pixels from their distance to an edge, in pixels; inside it is above 0."""
    return np.clip(inside + 0.5, 0, 1).astype(np.float32)


def _grid(
    low: Sequence[float] | np.ndarray, high: Sequence[float] | np.ndarray, margin: float
) -> tuple[int, int, np.ndarray, np.ndarray]:
    """Return the first row and column of the pixels between two points (x, y), and the middles of all."""
    left, top = (int(np.floor(v - margin)) for v in low)
    right, bottom = (int(np.ceil(v + margin)) + 1 for v in high)
    rows, columns = np.ogrid[top:bottom, left:right]
    return top, left, rows + 0.5, columns + 0.5
