"""Reading and learning of weights between two arrays, at a cost that depends on the number of active samples.

Weights are a matrix, source samples first; activity that does not count is 0. The weights are not read or
written while one side is inactive. For a single copy of a model only the rows of active source samples are
read and written. A batch of copies is computed as a whole, and skipped while all its copies are inactive (a
condition under `vmap` would always be computed).
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence

import jax
import jax.numpy as jnp
from jax import Array, lax
from jax.custom_batching import custom_vmap

LearningRule = Callable[[Array, Array, Array, Array], Array]
"""New weights from weights, activity of the source, activity of the target, and speed."""


def _outstar(weights: Array, pre: Array, post: Array, speed: Array) -> Array:
    return weights + jnp.minimum(speed * pre, 1.0) * (post - weights)


def _association(weights: Array, pre: Array, post: Array, speed: Array) -> Array:
    return weights + jnp.minimum(speed, 1.0) * jnp.sign(pre) * (jnp.sign(post) - weights)


def _hebb(weights: Array, pre: Array, post: Array, speed: Array) -> Array:
    return weights + speed * pre * post


def _instar(weights: Array, pre: Array, post: Array, speed: Array) -> Array:
    return weights + jnp.minimum(speed * post, 1.0) * (pre - weights)


def _oja(weights: Array, pre: Array, post: Array, speed: Array) -> Array:
    return weights + speed * post * (pre - post * weights)


SOURCE_RULES: Mapping[str, LearningRule] = {"outstar": _outstar, "association": _association, "hebb": _hebb}
"""Rules that change the weights from active source samples."""

TARGET_RULES: Mapping[str, LearningRule] = {"instar": _instar, "oja": _oja}
"""Rules that change the weights to active target samples, from active and inactive source samples."""

RULES: Mapping[str, LearningRule] = {**SOURCE_RULES, **TARGET_RULES}


def read(weights: Array, pre: Array) -> Array:
    """Return sum_i pre_i W_ij, the input of each target sample.

    Args:
        weights: array (source samples, target samples).
        pre: activity of the source samples; not negative.
    """
    return _read(weights, pre)


def learn(
    rule: str, weights: Array, pre: Array, post: Array, speed: Array, loss: Array, most: Array
) -> Array:
    """Return the weights after one step.

    They are equal to the bit if both `speed` and `loss` are 0, or if one side is inactive.

    Args:
        rule: one of `RULES`.
        weights: array (source samples, target samples).
        pre: activity of the source samples; not negative, 0 for inactive samples.
        post: activity of the target samples, likewise.
        speed: step times rate of learning times gate.
        loss: step times rate of decay times gate.
        most: upper bound of weights that change.
    """
    if rule in SOURCE_RULES:
        return _rows(rule)(weights, pre, post, speed, loss, most)
    return _many(rule)(*(jnp.asarray(a)[None] for a in (weights, pre, post, speed, loss, most)))[0]


def after(value: Array, result: Array) -> Array:
    """Return the value with a dependence on `result`, so that it is used only after `result` is computed.

    A step that reads weights and changes them would keep a second copy of them without this order.
    """
    # never true, but the compiler cannot infer that
    return jnp.where(result.ravel()[0] > jnp.inf, jnp.zeros_like(value), value)


def change(rule: str, weights: Array, pre: Array, post: Array, speed: Array, loss: Array) -> Array:
    """Return new weights by the equation of the rule; the shapes of all arguments broadcast.

    A step longer than the relaxation time ends at the attractor, if the rule has an attractor that does not
    depend on other weights.
    """
    new = RULES[rule](weights, pre, post, speed)
    return new - jnp.minimum(loss, 1.0) * weights


# ---------------------------------------------------------------------------------- one copy: the active rows


def _active(pre: Array, wanted: Array) -> tuple[Array, Array]:
    """Return the indices with active samples first, and the number of active samples; 0 unless `wanted`."""
    places = pre.shape[0]

    def find() -> tuple[Array, Array]:
        active = pre > 0
        return jnp.nonzero(active, size=places, fill_value=0)[0].astype(jnp.int32), jnp.sum(
            active, dtype=jnp.int32
        )

    return lax.cond(wanted, find, lambda: (jnp.zeros(places, jnp.int32), jnp.zeros((), jnp.int32)))


@custom_vmap
def _read(weights: Array, pre: Array) -> Array:
    places, count = _active(pre, jnp.any(pre > 0))

    def add(k: Array, total: Array) -> Array:
        row = lax.dynamic_index_in_dim(weights, places[k], keepdims=False)
        return total + pre[places[k]] * row

    return lax.fori_loop(0, count, add, jnp.zeros(weights.shape[1], weights.dtype))


@functools.cache
def _rows(rule: str) -> Callable[..., Array]:
    @custom_vmap
    def rows(weights: Array, pre: Array, post: Array, speed: Array, loss: Array, most: Array) -> Array:
        places, count = _active(pre, _learns(pre, post, speed, loss))

        def step(k: Array, weights: Array) -> Array:
            old = lax.dynamic_index_in_dim(weights, places[k], keepdims=False)
            new = jnp.minimum(change(rule, old, pre[places[k]], post, speed, loss), most)
            return lax.dynamic_update_index_in_dim(weights, new, places[k], 0)

        return lax.fori_loop(0, count, step, weights)

    @rows.def_vmap
    def _(size: int, batched: Sequence[bool], *args: Array) -> tuple[Array, bool]:
        return _many(rule)(*_spread(size, batched, args)), True

    return rows


def _learns(pre: Array, post: Array, speed: Array, loss: Array) -> Array:
    return jnp.any(pre > 0) & jnp.any(post > 0) & (jnp.any(speed != 0) | jnp.any(loss != 0))


# ------------------------------------------------------------------- a batch of copies: all of it, or nothing


@_read.def_vmap
def _(size: int, batched: Sequence[bool], *args: Array) -> tuple[Array, bool]:
    return _read_many(*_spread(size, batched, args)), True


@custom_vmap
def _read_many(weights: Array, pre: Array) -> Array:
    nothing = jnp.zeros((weights.shape[0], weights.shape[2]), weights.dtype)
    return lax.cond(
        jnp.any(pre > 0), lambda: jnp.einsum("bi,bij->bj", pre, weights, precision="highest"), lambda: nothing
    )


@_read_many.def_vmap
def _(size: int, batched: Sequence[bool], *args: Array) -> tuple[Array, bool]:
    return _split(size, _read_many(*_joined(size, batched, args))), True


@functools.cache
def _many(rule: str) -> Callable[..., Array]:
    """Return the rule for copies along the first axis of all arguments."""

    @custom_vmap
    def many(weights: Array, pre: Array, post: Array, speed: Array, loss: Array, most: Array) -> Array:
        def step(weights: Array) -> Array:
            x, y = pre[:, :, None], post[:, None, :]
            s, l, m = (a[:, None, None] for a in (speed, loss, most))
            learning = (x if rule in SOURCE_RULES else y) > 0
            paired = (jnp.any(pre > 0, axis=1) & jnp.any(post > 0, axis=1) & ((speed != 0) | (loss != 0)))[
                :, None, None
            ]
            return jnp.where(learning & paired, jnp.minimum(change(rule, weights, x, y, s, l), m), weights)

        # a loop of one iteration or none: unlike a condition it never copies unchanged arrays
        return lax.fori_loop(
            0, _learns(pre, post, speed, loss).astype(jnp.int32), lambda _, weights: step(weights), weights
        )

    @many.def_vmap
    def _(size: int, batched: Sequence[bool], *args: Array) -> tuple[Array, bool]:
        return _split(size, many(*_joined(size, batched, args))), True

    return many


def _spread(size: int, batched: Sequence[bool], args: Sequence[Array]) -> list[Array]:
    """Return every argument with the axis of copies."""
    return [
        a if has else jnp.broadcast_to(a, (size, *jnp.shape(a))) for a, has in zip(args, batched, strict=True)
    ]


def _joined(size: int, batched: Sequence[bool], args: Sequence[Array]) -> list[Array]:
    """Join two axes of copies into one."""
    return [a.reshape(-1, *a.shape[2:]) for a in _spread(size, batched, args)]


def _split(size: int, tree: Array) -> Array:
    return jax.tree.map(lambda a: a.reshape(size, -1, *a.shape[1:]), tree)
