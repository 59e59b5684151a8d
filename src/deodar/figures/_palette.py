"""One palette for all frames of a GIF: no colour drifts, and a frame holds what differs visibly."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from PIL import Image

MOST = 255
"""Largest number of colours: a GIF has 256, one of which is clear."""

CLEAR = 255
"""The number of the clear colour."""

WEIGHTS = np.array([0.9, 1.2, 0.8], np.float32)
"""Weights of red, green and blue in the distance of two colours: an eye sees most by green."""

AT_ONCE = 20_000
"""Number of colours whose distances to the palette are in memory at once."""


def of_samples(samples: Sequence[np.ndarray], fixed: np.ndarray) -> np.ndarray:
    """Return a palette: the fixed colours, and a median cut of the colours of sample frames.

    Every colour of the samples counts once. Counted by its pixels, the edges of letters would lose theirs to
    large areas.

    Args:
        samples: arrays (..., 3) of bytes.
        fixed: colours (colours, 3) that the palette has, at most 254.
    """
    certain = np.unique(np.rint(fixed).astype(np.uint8), axis=0)
    seen = np.zeros(1 << 24, bool)
    for sample in samples:
        seen[_keys(sample)] = True
    colours = _colours(np.flatnonzero(seen)).astype(np.uint8)
    room = MOST - len(certain)
    few = Image.fromarray(colours[None]).quantize(
        room, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE
    )
    others = np.array((few.getpalette() or [])[: 3 * room], np.uint8).reshape(-1, 3)
    return np.concatenate([certain, others])


class VideoPalette:
    """The colours of a whole video, and its frames as numbers of them.

    Args:
        colours: bytes (colours, 3), at most 255.
        tolerance: largest difference, summed over red, green and blue, up to which a pixel keeps the colour
            that is shown.
    """

    def __init__(self, colours: np.ndarray, tolerance: int = 0) -> None:
        self.colours = colours
        self._weighted = colours.astype(np.float32) * WEIGHTS
        self._nearest = np.full(1 << 24, -1, np.int16)
        wide = np.zeros((MOST, 3), int)
        wide[: len(colours)] = colours
        self._visible = np.abs(wide[:, None] - wide[None]).sum(2) > tolerance

    def table(self) -> bytes:
        """Return the colours as the table of a GIF, which has 256 entries."""
        return self.colours.tobytes().ljust(3 * 256, b"\0")

    def changes(self, frames: Iterable[np.ndarray]) -> Iterator[tuple[Image.Image, tuple[int, int]] | None]:
        """Yield for each frame the rectangle that differs from what is shown, and its corner; None without a
        difference.

        The other pixels of the rectangle are clear.
        """
        rest_of_frames = iter(frames)
        first = next(rest_of_frames)
        keys = _keys(first)
        display = self._numbers(keys)
        yield Image.fromarray(display.copy()), (0, 0)
        for last, frame in itertools.pairwise(itertools.chain([first], rest_of_frames)):
            if frame is last:
                yield None
                continue
            before, keys = keys, _keys(frame)
            changed = keys != before
            numbers = self._numbers(keys[changed])
            visible = self._visible[numbers, display[changed]]
            changed[changed] = visible
            if not visible.any():
                yield None
                continue
            display[changed] = numbers[visible]
            rows, columns = (np.flatnonzero(changed.any(axis)) for axis in (1, 0))
            box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
            part = np.where(changed[box], display[box], np.uint8(CLEAR))
            yield Image.fromarray(part), (int(columns[0]), int(rows[0]))

    def _numbers(self, keys: np.ndarray) -> np.ndarray:
        """Return the number of the nearest colour for each of some colours."""
        new = np.unique(keys[self._nearest[keys] < 0])
        for k in range(0, len(new), AT_ONCE):
            part = new[k : k + AT_ONCE]
            at = _colours(part).astype(np.float32) * WEIGHTS
            distances = (self._weighted**2).sum(1) - 2.0 * at @ self._weighted.T
            self._nearest[part] = distances.argmin(1)
        return self._nearest[keys].astype(np.uint8)


def _keys(pixels: np.ndarray) -> np.ndarray:
    """Return each colour as a number of 24 bits."""
    red, green, blue = (pixels[..., k].astype(np.int32) for k in range(3))
    return (red << 16) | (green << 8) | blue


def _colours(keys: np.ndarray) -> np.ndarray:
    """Return the colours (colours, 3) of numbers of 24 bits."""
    return np.stack([keys >> 16, (keys >> 8) & 255, keys & 255], axis=-1)
