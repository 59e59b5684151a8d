"""A video: pictures with durations, one palette, and its files."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from deodar.figures import _encode
from deodar.figures._encode import VideoPalette

Paint = Callable[[], np.ndarray]
"""A picture that is drawn when it is needed: all of them would fill the memory."""


@dataclass(frozen=True)
class Shot:
    """A picture and how long it is shown, in hundredths of a second."""

    paint: Paint
    hundredths: int


@dataclass(frozen=True)
class MovingPicture:
    """A moving picture.

    Attributes:
        shots: its pictures in order.
        rate: pictures in a second; a shot is shown for a whole number of them.
        colours: the palette of a GIF.
        tolerance: differences of colour that a GIF leaves out (`VideoPalette`).
    """

    shots: Sequence[Shot]
    rate: float
    colours: np.ndarray
    tolerance: int

    @property
    def seconds(self) -> float:
        """Its duration."""
        return sum(map(self._repeats, self.shots)) / self.rate

    def frames(self) -> Iterator[np.ndarray]:
        """Draw the pictures; one that is shown longer comes several times."""
        for shot in self.shots:
            picture = shot.paint()
            for _ in range(self._repeats(shot)):
                yield picture

    def write(self, path: Path) -> None:
        """Write a GIF or an MP4, by the ending of the name."""
        palette = VideoPalette(self.colours, self.tolerance)
        _encode.write(self.frames(), path, _encode.format_of(path), self.rate, palette=palette)

    def _repeats(self, shot: Shot) -> int:
        return max(1, round(shot.hundredths / 100 * self.rate))
