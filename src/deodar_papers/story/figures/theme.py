"""Colours of the moving pictures, light and dark, and those of activation."""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np


def rgb(text: str) -> np.ndarray:
    """Return red, green and blue, 0 to 255, of a colour such as `f4f4f5`."""
    return np.array(list(bytes.fromhex(text)), np.float32)


@dataclass(frozen=True)
class Theme:
    """The colours of a picture by their meaning.

    Attributes:
        page, sunk: the ground, and a place on it that is filled later.
        line, edge: the resting level, and the threshold.
        text, dim: sentences, and explanations.
        accent: what is selected.
        below, above: activation below and above the threshold.
        glow: the area between the threshold and activation above it.
        input: the localised input.
    """

    page: np.ndarray
    sunk: np.ndarray
    line: np.ndarray
    edge: np.ndarray
    text: np.ndarray
    dim: np.ndarray
    accent: np.ndarray
    below: np.ndarray
    above: np.ndarray
    glow: np.ndarray
    input: np.ndarray

    def colours(self) -> np.ndarray:
        """Return all colours as rows."""
        return np.stack(astuple(self))


def _row(colours: str) -> np.ndarray:
    return np.stack([rgb(colour) for colour in colours.split()])


def _theme(colours: str) -> Theme:
    return Theme(*_row(colours))


THEMES = {
    "light": _theme("f4f4f5 ededef e2e2e5 8b8b94 18181b 5b5b64 1f7a50 0b6cb3 c2410c ea580c 96620a"),
    "dark": _theme("121214 0d0d0f 2c2c31 6d6d78 ececef a5a5b0 5cc795 62b5f0 ff8a4c ff7832 e3ad3c"),
}

WHITE, INK = rgb("ffffff"), rgb("18181b")

BELOW = _row("ffffff d3e6f5 93c1e6 4e93cb 21659f 0e4070 08294b")
ABOVE = _row("ffffff ffe3bd ffb968 f98328 dd4d0d a02f06 641a02")
"""Colours of activation from the threshold downwards and upwards."""


def activation_colours(values: np.ndarray, low: float, high: float, steps: int = 40) -> np.ndarray:
    """Return the colours of activation, one more axis of three.

    Args:
        values: activation.
        low: activation of the last colour below 0.
        high: activation of the last colour above 0.
        steps: number of colours on each side: few enough for a palette.
    """
    colours = activation_scale(steps)
    below = steps - 1 - np.clip(values / low, 0, 1) * (steps - 1)
    above = steps + np.clip(values / high, 0, 1) * (steps - 1)
    return colours[np.rint(np.where(values < 0, below, above)).astype(int)]


def activation_scale(steps: int = 40) -> np.ndarray:
    """Return the colours of activation from the lowest to the highest."""
    at, knots = np.linspace(0, len(BELOW) - 1, steps), np.arange(len(BELOW))
    sides = [np.stack([np.interp(at, knots, side[:, c]) for c in range(3)], 1) for side in (BELOW, ABOVE)]
    return np.concatenate([sides[0][::-1], sides[1]]).astype(np.float32)
