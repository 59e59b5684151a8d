"""Random weights that do not depend on the sampling."""

from __future__ import annotations

import math

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import DTypeLike

from deodar.numerics.axes import Axes
from deodar.numerics.noise import threefry
from deodar.numerics.scalar import Scalar

STREAM = 0x3A57
"""Second key word of random weights (that of noise is another one); the first is the seed."""


def random_weights(pre: Axes, post: Axes, patches: int, share: Scalar, seed: int, dtype: DTypeLike) -> Array:
    """Return random weights: uniform in (0, 1) for a `share` of the pairs of patches, 0 for the others.

    Each axis, of the source and of the target, is divided into `patches` equal patches; all weights between
    two patches are equal. They depend on the numbers of the patches (Threefry, counter (source patch, target
    patch), key (seed, STREAM)), so that samples at the same position have the same weight at every sampling,
    and integrals agree up to the sampling of the patches. Independent weights for each sample would become a
    homogeneous map as the sampling becomes finer.

    Returns:
        Array (source samples, target samples).
    """
    u32 = jnp.uint32
    rows, columns = (jnp.asarray(_patch(axes, patches)) for axes in (pre, post))
    words = threefry(
        rows[:, None] + jnp.zeros_like(columns)[None, :],
        columns[None, :] + jnp.zeros_like(rows)[:, None],
        u32(seed),
        u32(STREAM),
    )
    weight, luck = ((word >> 9).astype(dtype) / 2**23 + 2.0**-24 for word in words)
    return jnp.where(luck < share, weight, jnp.zeros_like(weight))


def _patch(axes: Axes, patches: int) -> np.ndarray:
    """Return the number of the patch of each sample, with samples in their order."""
    number = np.zeros((), np.int64)
    for axis in axes:
        share = (axis.points - axis.lower) / axis.range
        patch = np.minimum(np.floor(share * patches + 1e-9).astype(np.int64), patches - 1)
        number = number[..., None] * patches + patch
    return number.reshape(math.prod(a.samples for a in axes)).astype(np.uint32)
