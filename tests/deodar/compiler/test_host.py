"""Evaluation with NumPy gives what the compiled function gives, or leaves the function to the compiler."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array, lax

import deodar as dd
from deodar.compiler import host
from deodar.compiler.build import Build
from deodar.compiler.copy_batch import Batch
from deodar.compiler.executable import Executable
from tests.contracts import build

RNG = np.random.default_rng(3)
A = RNG.normal(size=(4, 5)).astype(np.float32)
B = RNG.normal(size=(5, 3)).astype(np.float32)
WORDS = RNG.integers(0, 2**32, (4, 5), np.uint32)
WHOLE = RNG.integers(-9, 9, (4, 5)).astype(np.int32)
STACK = RNG.normal(size=(3, 4, 5)).astype(np.float32)

FUNCTIONS: dict[str, tuple[Callable[..., Any], tuple[np.ndarray, ...]]] = {
    "arithmetic": (lambda a: ((a + 1) * a - a / 3, -a, a**3, abs(a), a % 2), (A,)),
    "functions": (
        lambda a: (jnp.exp(a), jnp.log(abs(a)), jnp.sin(a), jnp.cos(a), jnp.tanh(a), jnp.sqrt(abs(a))),
        (A,),
    ),
    "more functions": (
        lambda a: (jax.nn.sigmoid(a), lax.rsqrt(abs(a)), jnp.expm1(a), jnp.log1p(abs(a)), jnp.sign(a)),
        (A,),
    ),
    "rounding": (lambda a: (jnp.floor(2 * a), jnp.ceil(2 * a), jnp.round(2 * a), (4 * a).astype(int)), (A,)),
    "limits": (
        lambda a: (jnp.clip(a, -0.5, 0.5), (1e12 * a).astype(jnp.int32), (jnp.nan * a).astype(jnp.int32)),
        (A,),
    ),
    "comparison": (lambda a: (a > 0, a <= 0.5, (a == a) & ~(a < 0), jnp.where(a > 0, a, 7), a != 1), (A,)),
    "words": (
        lambda w: (w + w, w ^ (w >> 3), w << 5, w * w, lax.shift_right_logical(w, jnp.uint32(9))),
        (WORDS,),
    ),
    "shapes": (
        lambda a: (a.T, a.reshape(2, 10), a[1:, ::2], a[None], jnp.concatenate([a, a], 1), a[::-1]),
        (A,),
    ),
    "sums": (lambda a: (a.sum(), a.sum(0), a.max(1), a.min(), a.prod(1), (a > 0).any(), a.mean(0)), (A,)),
    "products": (lambda a, b: (a @ b, jnp.dot(a[0], b), jnp.einsum("ij,kj->ki", a, b.T)), (A, B)),
    "products of stacks": (lambda s: (jnp.einsum("kij,klj->kil", s, s), jax.vmap(jnp.vdot)(s, s)), (STACK,)),
    "taken": (lambda a, k: (a[jnp.abs(k[0]) % 4], jnp.take(a, jnp.array([0, 4, 2]), 1), a[1, 2]), (A, WHOLE)),
    "taken outside": (lambda a: a.at[jnp.array([1, 9])].get(mode="fill"), (A,)),
    "taken in copies": (
        lambda s, k: jax.vmap(lambda a, i: a[:, i])(s, jnp.abs(k[:3, 0]) % 5),
        (STACK, WHOLE),
    ),
    "spectra": (lambda a: (jnp.fft.rfftn(a), jnp.fft.rfft(a, axis=0)), (A,)),
    "complex numbers": (
        lambda a: (jnp.real(c := jnp.fft.rfftn(a)), jnp.imag(c), jnp.conj(c), lax.complex(a, -a)),
        (A,),
    ),
    "rest": (
        lambda a: (jnp.sinh(a), jnp.cosh(a), jnp.tan(a), jnp.square(a), lax.clamp(-0.2, a, 0.4), lax.tan(a)),
        (A,),
    ),
    "counted": (lambda a: (jnp.arange(7), jnp.stack([a, a]), jnp.isfinite(a / 0), (a > 0).all(1)), (A,)),
    "nested": (lambda a: (jax.jit(lambda b: b + 1)(a), jax.nn.softplus(a), jax.nn.relu(a)), (A,)),
}


def evaluated(function: Callable[..., Any], *args: Any) -> list[np.ndarray] | None:
    traced = jax.jit(function, keep_unused=True).trace(*args)
    if not host.supports(traced.jaxpr.jaxpr):
        return None
    return host.evaluate(traced.jaxpr, jax.tree.leaves(args))


def agree(arrays: list[np.ndarray], expected: Any) -> None:
    expected_arrays: list[Array] = jax.tree.leaves(expected)
    assert len(arrays) == len(expected_arrays)
    for a, b in zip(arrays, expected_arrays, strict=True):
        assert a.dtype == b.dtype and a.shape == b.shape
        np.testing.assert_allclose(a, b, rtol=3e-5, atol=3e-6 * max(1.0, float(np.abs(b).max(initial=0))))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_values_are_those_of_the_compiled_function(name: str) -> None:
    function, args = FUNCTIONS[name]
    leaves = evaluated(function, *args)
    assert leaves is not None
    agree(leaves, jax.jit(function)(*args))


def test_a_function_with_an_unknown_primitive_is_left_to_the_compiler() -> None:
    assert evaluated(lambda a: jnp.linalg.eigh(a @ a.T), A) is None
    assert evaluated(lambda a: jax.jit(jnp.sort)(a), A) is None
    assert evaluated(lambda w: w // 3, WHOLE) is None, "NumPy rounds integers down, XLA towards 0"


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize("kind", [*build.KINDS, *build.PARTS])
def test_every_element_starts_as_compiled(kind: str, precision: str) -> None:
    document = build.around(build.any_example(kind)).document
    batch = Batch(points=None, trials=2)
    program = Executable(Build(document, precision, batch=batch))
    values = program.values(document)
    arguments = values, np.uint32(5), np.arange(2, dtype=np.uint32)
    prepare, start = program.program.prepare, program._start
    with program._settings():
        prepared, started = jax.jit(lambda values, *others: (prepare(values), start(values, *others)))(
            *arguments
        )
        for leaves, expected in (
            (evaluated(prepare, values), prepared),
            (evaluated(start, *arguments), started),
        ):
            if leaves is not None:
                agree(leaves, expected)


def test_nearly_all_kinds_start_without_a_compiled_function() -> None:
    compiled = []
    for kind in [*build.KINDS, *build.PARTS]:
        document = build.around(build.any_example(kind)).document
        if Executable(Build(document)).compiled:
            compiled.append(kind)
    assert len(compiled) <= 2, compiled


def test_a_field_starts_without_a_compiled_function(monkeypatch: pytest.MonkeyPatch) -> None:
    x = dd.Axis("x", 0, 20, samples=21)
    model = dd.Model("u")
    model.add(dd.Field("u", [x], kernel=[dd.Gaussian(2, 3)], noise=0.1, noise_length=0.0))
    assert Executable(Build(model.document)).compiled == 0
