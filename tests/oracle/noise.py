"""Counter-based noise in unsigned 32-bit NumPy: Threefry-2x32 with 20 rounds, and Box-Muller."""

from __future__ import annotations

import math

import numpy as np

WORD = 0xFFFFFFFF


def threefry(counter, key):
    """Return two words from two words of a counter and two of a key; all are Python integers."""
    x0, x1 = counter
    keys = (key[0], key[1], key[0] ^ key[1] ^ 0x1BD11BDA)
    x0, x1 = (x0 + keys[0]) & WORD, (x1 + keys[1]) & WORD
    for r in range(20):
        turn = ((13, 15, 26, 6), (17, 29, 16, 24))[(r // 4) % 2][r % 4]
        x0 = (x0 + x1) & WORD
        x1 = (((x1 << turn) | (x1 >> (32 - turn))) & WORD) ^ x0
        if r % 4 == 3:
            k = (r + 1) // 4
            x0, x1 = (x0 + keys[k % 3]) & WORD, (x1 + keys[(k + 1) % 3] + k) & WORD
    return x0, x1


def words(seed, trial, ident, cells, tick):
    """Return the two words of each cell at the element's own tick."""
    key = threefry((ident, trial), (seed, 0x5EED))
    return np.array([threefry((cell, tick // 2), key) for cell in range(cells)], np.uint32)


def normals(seed, trial, ident, shape, tick):
    """Return standard normal deviates: the first of a pair on even ticks, the second on odd ticks."""
    pairs = words(seed, trial, ident, math.prod(shape), tick)
    uniform = ((pairs >> np.uint32(9)).astype(float) + 0.5) / 2**23
    radius, angle = np.sqrt(-2 * np.log(uniform[:, 0])), 2 * math.pi * uniform[:, 1]
    return (radius * (np.cos(angle) if tick % 2 else np.sin(angle))).reshape(shape)
