"""Weights between two arrays: reading them and changing them, at a cost that follows what is active.

Weights stand as a matrix, source places first; activity is given with everything that does not count set to
0. Nothing is touched while one side is silent. For a single copy of a model only the rows of active source
places are read and written; a batch of copies is computed whole, and rests while all its copies do (what
`vmap` makes of a condition would compute it always).
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence

import jax
import jax.numpy as jnp
from jax import Array, lax
from jax.custom_batching import custom_vmap

SOURCE_RULES = ("outstar", "association", "hebb")
"""Rules that change the weights that leave active source places."""

TARGET_RULES = ("instar", "oja")
"""Rules that change the weights that reach active target places, whether their source is active or not."""

RULES = (*SOURCE_RULES, *TARGET_RULES)


def read(weights: Array, pre: Array) -> Array:
    """sum_i pre_i W_ij: what arrives at each target place.

    Args:
        weights: source places, target places.
        pre: activity of the source places; not negative.
    """
    return _read(weights, pre)


def learn(
    rule: str, weights: Array, pre: Array, post: Array, speed: Array, loss: Array, most: Array
) -> Array:
    """The weights one step later.

    Unchanged to the bit where both `speed` and `loss` are 0, or one side is silent.

    Args:
        rule: one of `RULES`.
        weights: source places, target places.
        pre: activity of the source places; not negative, 0 where nothing is active.
        post: the same of the target places.
        speed: step times rate of learning times gate.
        loss: step times rate of decay times gate.
        most: upper bound of weights that change.
    """
    if rule in SOURCE_RULES:
        return _rows(rule)(weights, pre, post, speed, loss, most)
    return _many(rule)(*(jnp.asarray(a)[None] for a in (weights, pre, post, speed, loss, most)))[0]


def after(value: Array, result: Array) -> Array:
    """The value, to be used only once `result` is there.

    A step that reads weights and changes them would keep a second copy of them if nothing said that the
    reading comes first.
    """
    return jnp.where(
        result.ravel()[0] > jnp.inf, jnp.zeros_like(value), value
    )  # never true, which the compiler does not know


def change(rule: str, weights: Array, pre: Array, post: Array, speed: Array, loss: Array) -> Array:
    """New weights by the rule itself; all arguments of shapes that broadcast.

    A step longer than the relaxation time ends at the attractor and not beyond, where the rule has one that
    does not depend on other weights.
    """
    match rule:
        case "outstar":
            new = weights + jnp.minimum(speed * pre, 1.0) * (post - weights)
        case "association":
            new = weights + jnp.minimum(speed, 1.0) * jnp.sign(pre) * (jnp.sign(post) - weights)
        case "hebb":
            new = weights + speed * pre * post
        case "instar":
            new = weights + jnp.minimum(speed * post, 1.0) * (pre - weights)
        case _:
            new = weights + speed * post * (pre - post * weights)
    return new - jnp.minimum(loss, 1.0) * weights


# ---------------------------------------------------------------------------------- one copy: the active rows


def _active(pre: Array, wanted: Array) -> tuple[Array, Array]:
    """The active places first, and how many they are; none unless wanted."""
    places = pre.shape[0]

    def find() -> tuple[Array, Array]:
        here = pre > 0
        return jnp.nonzero(here, size=places, fill_value=0)[0].astype(jnp.int32), jnp.sum(
            here, dtype=jnp.int32
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
    """The rule for copies along the first axis of everything."""

    @custom_vmap
    def many(weights: Array, pre: Array, post: Array, speed: Array, loss: Array, most: Array) -> Array:
        def step(weights: Array) -> Array:
            x, y = pre[:, :, None], post[:, None, :]
            s, l, m = (a[:, None, None] for a in (speed, loss, most))
            here = (x if rule in SOURCE_RULES else y) > 0
            both = (jnp.any(pre > 0, axis=1) & jnp.any(post > 0, axis=1) & ((speed != 0) | (loss != 0)))[
                :, None, None
            ]
            return jnp.where(here & both, jnp.minimum(change(rule, weights, x, y, s, l), m), weights)

        # a loop that is taken once or not at all: unlike a condition it never copies what it leaves alone
        return lax.fori_loop(
            0, _learns(pre, post, speed, loss).astype(jnp.int32), lambda _, weights: step(weights), weights
        )

    @many.def_vmap
    def _(size: int, batched: Sequence[bool], *args: Array) -> tuple[Array, bool]:
        return _split(size, many(*_joined(size, batched, args))), True

    return many


def _spread(size: int, batched: Sequence[bool], args: Sequence[Array]) -> list[Array]:
    """Every argument with the axis of copies."""
    return [
        a if has else jnp.broadcast_to(a, (size, *jnp.shape(a))) for a, has in zip(args, batched, strict=True)
    ]


def _joined(size: int, batched: Sequence[bool], args: Sequence[Array]) -> list[Array]:
    """Copies of copies along one axis."""
    return [a.reshape(-1, *a.shape[2:]) for a in _spread(size, batched, args)]


def _split(size: int, result: Array) -> Array:
    return jax.tree.map(lambda a: a.reshape(size, -1, *a.shape[1:]), result)
