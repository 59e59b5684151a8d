"""The noise of the kernels is that of deodar: equal integers, equal deviates up to rounding."""

from __future__ import annotations

import os
import subprocess
import sys

import deodar_native
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from deodar.numerics import noise

ROUNDING = 4e-6
CELLS = [1, 2, 7, 15, 16, 17, 33, 2500, 10_007, 40_000]


@pytest.mark.parametrize("cells", CELLS)
@pytest.mark.parametrize(("seed", "block"), [(0, 0), (1, 1), (2**32 - 1, 2**31 - 1)])
def test_the_integers_equal_those_of_deodar(cells: int, seed: int, block: int) -> None:
    key = noise.element_keys(seed, 3, [0xDEADBEEF])[0]
    expected = np.stack(noise.bits(cells, key, jnp.uint32(block)))
    np.testing.assert_array_equal(deodar_native.bits(cells, key, jnp.uint32(block)), expected)


@pytest.mark.parametrize("cells", CELLS)
@pytest.mark.parametrize("tick", [0, 5, 2**32 - 1])
def test_deviates_equal_those_of_deodar_up_to_rounding(cells: int, tick: int) -> None:
    key = noise.element_keys(7, 0, [42])[0]
    expected = noise.block(cells, key, jnp.uint32(tick), jnp.float32)
    found = np.asarray(deodar_native.noise(key, jnp.uint32(tick), jnp.uint32(tick), jnp.zeros((2, cells))))
    assert found.shape == (2, cells) and found.dtype == np.float32
    np.testing.assert_allclose(found[0], np.real(expected), rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(found[1], np.imag(expected), rtol=0, atol=ROUNDING)


def test_the_block_stays_at_odd_ticks_apart_from_the_first() -> None:
    key, other = (noise.element_keys(7, trial, [42])[0] for trial in (0, 1))
    zeros = jnp.zeros((2, 50))
    drawn = deodar_native.noise(key, jnp.uint32(6), jnp.uint32(6), zeros)
    kept = deodar_native.noise(other, jnp.uint32(7), jnp.uint32(6), drawn)
    np.testing.assert_array_equal(kept, drawn)
    np.testing.assert_array_equal(deodar_native.noise(key, jnp.uint32(7), jnp.uint32(7), zeros), drawn)
    assert not np.array_equal(deodar_native.noise(key, jnp.uint32(8), jnp.uint32(6), drawn), drawn)


def test_rows_trials_and_ticks_may_be_mapped() -> None:
    keys = jnp.stack([noise.element_keys(1, trial, [4, 5, 6]) for trial in (0, 1)])
    ticks, zeros = jnp.asarray([6, 18], jnp.uint32), jnp.zeros((2, 21))
    rows = jax.vmap(
        lambda key, tick, drawn: deodar_native.noise(key, tick, jnp.uint32(0), drawn), in_axes=(0, None, 0)
    )
    found = jax.jit(jax.vmap(rows))(keys, ticks, jnp.zeros((2, 3, 2, 21)))
    assert found.shape == (2, 3, 2, 21)
    for trial in range(2):
        for row in range(3):
            alone = deodar_native.noise(keys[trial, row], ticks[trial], jnp.uint32(0), zeros)
            np.testing.assert_array_equal(found[trial, row], alone)


def test_any_number_of_threads_gives_the_same_bits() -> None:
    """A process has one number of threads, so each one has its own process."""
    code = (
        "import jax, jax.numpy as jnp, numpy as np, hashlib, deodar_native as d;"
        "keys = jnp.arange(6, dtype=jnp.uint32).reshape(3, 2);"
        "t, z = jnp.uint32(8), jnp.zeros((2, 70_001));"
        "rows = jax.jit(jax.vmap(lambda key: d.noise(key, t, t, z + key[0])));"
        "print(hashlib.sha256(np.asarray(rows(keys)).tobytes()).hexdigest())"
    )
    found = [
        subprocess.run(
            [sys.executable, "-c", code],
            env=os.environ | {"NPROC": str(threads)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for threads in (1, 4)
    ]
    assert found[0] == found[1] != ""


def test_every_set_of_vectors_of_this_processor_gives_the_same_numbers() -> None:
    """A process uses one set, so each one has its own process."""
    code = (
        "import jax.numpy as jnp, numpy as np, deodar_native as d;"
        "k, b = jnp.asarray([1, 2], jnp.uint32), jnp.uint32(3);"
        "print(d.vectors(), np.asarray(d.bits(37, k, b)).tobytes().hex(),"
        " np.asarray(d.noise(k, b, b, jnp.zeros((2, 37)))).tobytes().hex())"
    )
    sets = ["plain", "avx2", "avx512"]
    sets = sets[: sets.index(deodar_native.vectors()) + 1]
    found: list[list[str]] = []
    for name in sets:
        done = subprocess.run(
            [sys.executable, "-c", code],
            env=os.environ | {"DEODAR_NATIVE": name},
            capture_output=True,
            text=True,
            check=True,
        )
        found.append(done.stdout.split())
    assert [vectors for vectors, _, _ in found] == sets
    deviates = [np.frombuffer(bytes.fromhex(noise), np.float32) for _, _, noise in found]
    for (_, integers, _), deviate in zip(found, deviates, strict=True):
        assert integers == found[0][1]
        np.testing.assert_allclose(deviate, deviates[0], rtol=0, atol=ROUNDING)


def test_an_unknown_set_of_vectors_is_an_error_that_lists_the_names() -> None:
    done = subprocess.run(
        [sys.executable, "-c", "import deodar_native; deodar_native.vectors()"],
        env=os.environ | {"DEODAR_NATIVE": "sse9"},
        capture_output=True,
        text=True,
    )
    assert done.returncode and "'sse9'; expected off" in done.stderr
