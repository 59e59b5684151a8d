"""Convolution in spectral modes: every symmetric kernel is diagonal there, and smooth kernels need few modes.

On a periodic axis of `length` samples the modes are cosines and sines, with reflecting boundaries cosines (of
the field and its image). With zero padding, the axis is extended to a periodic one that is long enough for
all kernels; only the field's samples are transformed.

Modes may be apart by their symmetries, so that the transforms (`transforms`) are products of half the size.
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
        by_parity: whether modes of even and of odd frequency are apart. Half a ring further the former are
            the same, the latter opposite. For a periodic axis with an even number of samples.
        by_symmetry: whether symmetric and antisymmetric modes are apart; within each parity if both hold. The
            former are the same at the mirror image of a sample, the latter opposite. The mirror is in the
            middle of the axis, or of its first half if modes are apart by parity as well.
        divided: whether devices divide the samples; the axis is then transformed last, so that the sum over
            devices has few numbers.
    """

    boundary: str
    samples: int
    length: int
    highest: int
    by_parity: bool = False
    by_symmetry: bool = False
    divided: bool = False

    @property
    def classes(self) -> int:
        """The number of classes of modes: all of a class have the same symmetries."""
        return (1 + self.by_parity) * (1 + self.by_symmetry)

    @property
    def turns(self) -> np.ndarray:
        """The frequency of each mode, in periods per length."""
        return self._modes()[0].ravel()

    @property
    def count(self) -> int:
        """The number of modes."""
        return self.turns.size

    def axis(self, axis: Axis) -> Axis:
        """Return an axis over the modes of an axis."""
        return Axis(f"waves of {axis.name}", 0, self.count, samples=self.count)

    def basis(self) -> np.ndarray:
        """Return the modes at the samples, of norm 1 over the length: shape (samples, count).

        Classes follow each other: even before odd ones, then symmetric before antisymmetric ones. Each has
        as many columns as the largest, the last of which may be 0.
        """
        n, (m, antisymmetric, present) = np.arange(self.samples)[:, None], (a.ravel() for a in self._modes())
        if self.boundary == "reflect":
            waves = np.cos(np.pi * m * (n + 0.5) / self.samples)
            return present * waves * np.sqrt(np.where(m == 0, 1, 2) / self.samples)
        angle = 2 * np.pi * m * (n - self._origin) / self.length
        alone = (m == 0) | (2 * m == self.length)
        waves = np.where(antisymmetric, np.sin(angle), np.cos(angle))
        return present * waves * np.sqrt(np.where(alone, 1, 2) / self.length)

    def tables(self) -> np.ndarray:
        """Return the modes of each class at the samples that folding leaves: shape (classes, samples,
        modes).
        """
        samples_left = (self.folded_samples + 1) // 2 if self.by_symmetry else self.folded_samples
        return np.moveaxis(self.basis()[:samples_left].reshape(samples_left, self.classes, -1), 1, 0)

    @property
    def folded_samples(self) -> int:
        """The number of samples that one parity has: those of the axis, or of half of it."""
        return self.samples // 2 if self.by_parity else self.samples

    @property
    def _origin(self) -> float:
        """The sample from which phases are counted."""
        return (self.folded_samples - 1) / 2 if self.by_symmetry else 0

    def _modes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return of each mode its frequency, whether it is antisymmetric, and whether it is more than a
        column of zeros: shape (classes, modes).
        """
        if self.boundary == "reflect":
            turns = np.arange(self.highest + 1)
            sine = turns % 2 == 1
        else:
            turns = np.repeat(np.arange(self.highest + 1), 2)[1:]
            sine = (np.arange(len(turns)) % 2 == 0) & (turns > 0)
            if 2 * self.highest == self.length:  # of the fastest mode, cosine or sine is 0 at every sample
                turns, sine = turns[:-1], np.append(sine[:-2], self._origin % 1 != 0)
        number = (1 + self.by_symmetry) * self.by_parity * (turns % 2) + self.by_symmetry * sine
        members = [np.flatnonzero(number == k) for k in range(self.classes)]
        most = max(len(modes) for modes in members)
        table = np.array([np.pad(modes, (0, most - len(modes)), constant_values=-1) for modes in members])
        return np.where(table < 0, 0, turns[table]), sine[table], table >= 0

    def gains(self, axis: Axis, profile: Profile, dtype: DTypeLike) -> Array:
        """Return the gain of a symmetric kernel for each mode, times the grid step: shape (count,)."""
        turns = np.unique(self.turns)
        gains_of_turns = jnp.asarray(self._cosines(turns), dtype) @ self._ring(axis, profile, dtype)
        return gains_of_turns[np.searchsorted(turns, self.turns)]

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
