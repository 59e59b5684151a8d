"""Convolution as a product in a space of waves: every symmetric kernel is diagonal there, and smooth ones
need few of them.

On a ring of `length` samples the waves are cosines and sines, before a mirror cosines (of the field and its
image). A border beyond which there is nothing is a ring long enough that no kernel reaches round it; only the
field's own samples are transformed.
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
    """Which waves stand for the samples of one axis.

    Attributes:
        boundary: `periodic`, `zero` or `reflect`.
        samples: of the axis.
        length: samples of the ring (of field and image together before a mirror).
        highest: the fastest wave that is kept, in turns a ring.
    """

    boundary: str
    samples: int
    length: int
    highest: int

    @property
    def turns(self) -> np.ndarray:
        """Turns a ring of each wave."""
        if self.boundary == "reflect":
            return np.arange(self.highest + 1)
        pairs = np.repeat(np.arange(self.highest + 1), 2)[1:]
        return pairs[:-1] if 2 * self.highest == self.length else pairs

    @property
    def count(self) -> int:
        """Number of waves."""
        return len(self.turns)

    def axis(self, axis: Axis) -> Axis:
        """An axis over the waves of another one."""
        return Axis(f"waves of {axis.name}", 0, self.count, samples=self.count)

    def basis(self) -> np.ndarray:
        """The waves at the samples, of length 1 over the ring: shape (samples, count)."""
        n, m = np.arange(self.samples)[:, None], self.turns
        if self.boundary == "reflect":
            waves = np.cos(np.pi * m * (n + 0.5) / self.samples)
            return waves * np.sqrt(np.where(m == 0, 1, 2) / self.samples)
        sine = (np.arange(self.count) % 2 == 0) & (m > 0)
        angle = 2 * np.pi * m * n / self.length
        alone = (m == 0) | (2 * m == self.length)
        return np.where(sine, np.sin(angle), np.cos(angle)) * np.sqrt(np.where(alone, 1, 2) / self.length)

    def gains(self, axis: Axis, profile: Profile, dtype: DTypeLike) -> Array:
        """What a symmetric kernel makes of each wave, times the grid step: shape (count,)."""
        turns = np.unique(self.turns)
        found = jnp.asarray(self._cosines(turns), dtype) @ self._ring(axis, profile, dtype)
        return found[np.searchsorted(turns, self.turns)]

    def spectrum(self, axis: Axis, profile: Profile, dtype: DTypeLike) -> Array:
        """The same for all waves of the ring in the order of a Fourier transform: shape (length,)."""
        turns = np.arange(self.length)
        return jnp.asarray(self._cosines(turns), dtype) @ self._ring(axis, profile, dtype)

    def _ring(self, axis: Axis, profile: Profile, dtype: DTypeLike) -> Array:
        lag = np.arange(self.length)
        lag = np.where(2 * lag <= self.length, lag, lag - self.length) * axis.step
        # also round the ring that stands for a border, so that the kernel is smooth on it: what comes round
        # meets no sample
        return profile(jnp.asarray(lag, dtype), axis.step * self.length) * jnp.asarray(axis.step, dtype)

    def _cosines(self, turns: np.ndarray) -> np.ndarray:
        return np.cos(2 * np.pi * turns[:, None] * np.arange(self.length) / self.length)
