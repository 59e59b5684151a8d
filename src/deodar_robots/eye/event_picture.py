"""The events of a camera as a picture for people, in which each event fades."""

from __future__ import annotations

import math

import numpy as np

from deodar.worlds._scene import ScenePicture

FADES = 40.0
"""Time after which an event has faded to 1/e, ms: longer than the page takes for a picture."""

FULL = 3.0
"""Events of a pixel that give it the full colour."""

NOTHING, ON, OFF = (np.asarray(c, float) for c in ((22, 24, 28), (255, 176, 64), (84, 160, 255)))
"""Red, green and blue of pixels without events, with on events and with off events: orange and blue differ
for people who do not see red and green apart.
"""


class EventPicture:
    r"""Events that fade, drawn in one colour for brighter and in another one for darker pixels.

    Equation:
        p \leftarrow p\, e^{-T / \mathrm{fades}} + n_{\mathrm{on}} - n_{\mathrm{off}}

    Args:
        side: columns and rows of the camera.
    """

    def __init__(self, side: int) -> None:
        self._levels = np.zeros((side, side))

    def clear(self) -> None:
        """Forget all events."""
        self._levels[:] = 0

    def add(self, on: np.ndarray, off: np.ndarray, period: float) -> None:
        """Add the numbers of events of a period (ms), columns first."""
        self._levels *= math.exp(-period / FADES)
        self._levels += on
        self._levels -= off

    def scene(self) -> ScenePicture:
        """Return the picture for the view of a world, with row 0 at the bottom, as plots draw it."""
        level = np.clip(self._levels.T[::-1] / FULL, -1, 1)[..., None]
        drawn = NOTHING + np.maximum(level, 0) * (ON - NOTHING) + np.maximum(-level, 0) * (OFF - NOTHING)
        rows, columns = drawn.shape[:2]
        return ScenePicture("events", columns, rows, drawn.round().astype(np.uint8).tobytes())
