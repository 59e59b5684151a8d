"""Convolution in spectral modes: every symmetric kernel is diagonal there, and smooth kernels need few modes.

On a periodic axis of `length` samples the modes are cosines and sines, with reflecting boundaries cosines (of
the field and its image). With zero padding, the axis is extended to a periodic one that is long enough for
all kernels; only the field's samples are transformed.
"""

from __future__ import annotations

from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import DTypeLike

from deodar.numerics.axes import Axis
from deodar.numerics.convolution import Profile


@dataclass(frozen=True)
class Waves:
    """The spectral modes of one axis.

    Attributes:
        boundary: `periodic`, `zero` or `reflect`.
        samples: number of samples of the axis.
        length: number of samples of the periodic axis (with `reflect`, of field and image together).
        highest: highest mode that is kept, in periods per length.
    """

    boundary: str
    samples: int
    length: int
    highest: int

    @property
    def turns(self) -> np.ndarray:
        """The frequency of each mode, in periods per length."""
        if self.boundary == "reflect":
            return np.arange(self.highest + 1)
        pairs = np.repeat(np.arange(self.highest + 1), 2)[1:]
        return pairs[:-1] if 2 * self.highest == self.length else pairs

    @property
    def count(self) -> int:
        """The number of modes."""
        return len(self.turns)

    def axis(self, axis: Axis) -> Axis:
        """Return an axis over the modes of an axis."""
        return Axis(f"waves of {axis.name}", 0, self.count, samples=self.count)

    def basis(self) -> np.ndarray:
        """Return the modes at the samples, of norm 1 over the length: shape (samples, count)."""
        n, m = np.arange(self.samples)[:, None], self.turns
        if self.boundary == "reflect":
            waves = np.cos(np.pi * m * (n + 0.5) / self.samples)
            return waves * np.sqrt(np.where(m == 0, 1, 2) / self.samples)
        sine = (np.arange(self.count) % 2 == 0) & (m > 0)
        angle = 2 * np.pi * m * n / self.length
        alone = (m == 0) | (2 * m == self.length)
        return np.where(sine, np.sin(angle), np.cos(angle)) * np.sqrt(np.where(alone, 1, 2) / self.length)

    def gains(self, axis: Axis, profile: Profile, dtype: DTypeLike) -> Array:
        """Return the gain of a symmetric kernel for each mode, times the grid step: shape (count,)."""
        turns = np.unique(self.turns)
        found = jnp.asarray(self._cosines(turns), dtype) @ self._ring(axis, profile, dtype)
        return found[np.searchsorted(turns, self.turns)]

    def spectrum(self, axis: Axis, profile: Profile, dtype: DTypeLike) -> Array:
        """Return the gains for all modes in the order of a Fourier transform: shape (length,)."""
        turns = np.arange(self.length)
        return jnp.asarray(self._cosines(turns), dtype) @ self._ring(axis, profile, dtype)

    def _ring(self, axis: Axis, profile: Profile, dtype: DTypeLike) -> Array:
        lag = np.arange(self.length)
        lag = np.where(2 * lag <= self.length, lag, lag - self.length) * axis.step
        # the kernel wraps also on the extension of a zero-padded axis, so that it is smooth there; the
        # wrapped part meets no sample of the field
        return profile(jnp.asarray(lag, dtype), axis.step * self.length) * jnp.asarray(axis.step, dtype)

    def _cosines(self, turns: np.ndarray) -> np.ndarray:
        return np.cos(2 * np.pi * turns[:, None] * np.arange(self.length) / self.length)
