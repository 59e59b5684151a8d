"""The integers of the noise: known answers, the mapping from ids and ticks, and the normal deviates."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import deodar as dd
from deodar.elements.changing_stimuli import Noise
from deodar.numerics import noise
from tests.oracle import noise as plain

# from the distribution of Random123 (kat_vectors, threefry2x32 20)
KNOWN = [
    ((0x00000000, 0x00000000), (0x00000000, 0x00000000), (0x6B200159, 0x99BA4EFE)),
    ((0xFFFFFFFF, 0xFFFFFFFF), (0xFFFFFFFF, 0xFFFFFFFF), (0x1CB996FC, 0xBB002BE7)),
    ((0x243F6A88, 0x85A308D3), (0x13198A2E, 0x03707344), (0xC4923A9C, 0x483DF7A0)),
]


@pytest.mark.parametrize(("counter", "key", "answer"), KNOWN)
def test_threefry_gives_the_published_answers(counter, key, answer):
    assert plain.threefry(counter, key) == answer
    words = noise.threefry(*(jnp.uint32(word) for word in (*counter, *key)))
    assert tuple(int(word) for word in words) == answer


def test_threefry_equals_that_of_jax():
    from jax.extend.random import threefry_2x32

    counter = np.arange(64, dtype=np.uint32)
    key = np.array([123456789, 987654321], np.uint32)
    theirs = np.asarray(threefry_2x32(jnp.asarray(key), jnp.asarray(counter)))
    a, b = noise.threefry(jnp.asarray(counter[:32]), jnp.asarray(counter[32:]), key[0], key[1])
    assert np.array_equal(theirs, np.concatenate([a, b]))


@pytest.mark.parametrize("seed", [0, 1, 2**32 - 1])
@pytest.mark.parametrize("trial", [0, 99])
def test_the_integers_of_an_element_are_those_of_the_plain_version(seed, trial):
    ident = 0xDEADBEEF
    key = noise.element_keys(seed, trial, [ident])[0]
    for tick in (0, 1, 2, 7, 2**32 - 1):
        words = np.stack(noise.bits(12, key, jnp.uint32(tick // 2)), axis=1)
        assert words.dtype == np.uint32
        assert np.array_equal(words, plain.words(seed, trial, ident, 12, tick))


@pytest.mark.parametrize("every", [1, 3])
@pytest.mark.parametrize("trial", [0, 7])
def test_the_noise_of_a_running_model_is_that_of_the_plain_version(every, trial):
    """The deviates of an element follow from its stored id and its own tick alone."""
    axes = [dd.Axis("x", 0, 4, 3), dd.Axis("y", 0, 1, 2)]
    model = dd.Model("noisy")
    source = model.add(Noise("n", axes, 1.0), group="deep", ticks=every)
    ident = int(model.entry(source.id).id, 16)
    noise = dd.simulate(model, 12, seed=5, trials=[trial], record="deep.n.output", precision="float64")[
        "deep.n.output"
    ].values[0]
    for tick in range(13):
        expected = plain.normals(5, trial, ident, (3, 2), tick // every) / np.sqrt(2.0) / np.sqrt(every)
        np.testing.assert_allclose(noise[tick], expected, rtol=0, atol=1e-12)


def test_float32_normals_agree_with_float64():
    key = noise.element_keys(3, 0, [42])[0]
    for tick in (0, 1):
        single = noise.normal((200_000,), key, jnp.uint32(tick), jnp.float32)
        with jax.enable_x64(True):
            double = noise.normal((200_000,), key, jnp.uint32(tick), jnp.float64)
            assert double.dtype == jnp.float64
        assert single.dtype == jnp.float32
        assert np.abs(np.asarray(single, float) - np.asarray(double)).max() < 1e-4


@pytest.mark.parametrize("word", [0, 1, 511, 512, 2**31, 2**32 - 513, 2**32 - 1])
def test_extreme_integers_give_finite_deviates(word):
    """Uniform deviates lie strictly between 0 and 1, so that no logarithm diverges."""
    uniform = float(noise.uniform(jnp.uint32(word)))
    assert uniform == ((word >> 9) + 0.5) / 2**23
    for dtype in (jnp.float32, jnp.float64):
        with jax.enable_x64(dtype == jnp.float64):
            radius = float(noise._radius(jnp.uint32(word), dtype))
            assert 0 <= radius < 6
            exact = np.sqrt(-2 * np.log(uniform))
            # near a uniform deviate of 1 the radius is the root of a small number
            assert abs(radius - exact) < (1e-4 if dtype == jnp.float64 or exact > 0.1 else 4e-3)
