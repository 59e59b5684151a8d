"""Contact of a disc with boxes: how far it moves, and how it slides along walls. Pure functions of one copy.

Boxes are rows (lower x, lower y, upper x, upper y) of an array, parallel to the axes; a flag for each box
says whether it is present. The disc never jumps over a wall, however long the step: it is swept along its
straight path, and stops or slides at the first touch. A disc against a box is a point against a box with
round corners (the Minkowski sum), which is convex.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import lax

SKIN = 1e-6
"""Gap that remains at a touch, m: above the rounding error of float32 at 10 m, negligible for the motion."""

CLOSE = 4e-6
"""Gap below which the disc counts as touching, m."""

GRAZING = 1e-6
"""Share of a step that may point into a touched wall without a new touch: rounding error of the slide."""

SLIDES = 6
"""Number of walls that one step may meet; a corner takes two, a notch three.

The rest of the step is dropped.
"""

PUSHES = 8
"""Largest number of boxes, placed over the disc, out of which it is pushed in one step."""

NOT_HIT = 2.0


Carry = tuple[jax.Array, jax.Array, jax.Array]
"""Position, rest of the step, and whether something was touched."""


def gaps(position: jax.Array, boxes: jax.Array, radius: jax.Array | float) -> tuple[jax.Array, jax.Array]:
    """Return for each box (n, 4) its gap to the disc, negative inside, and its outward unit vector (n, 2)."""
    lower, upper = boxes[:, :2], boxes[:, 2:]
    offset = position - jnp.clip(position, lower, upper)
    square = jnp.sum(offset * offset, axis=1)
    outside = square > 0
    distance = jnp.sqrt(jnp.where(outside, square, 1.0))
    faces = jnp.concatenate([position - lower, upper - position], axis=1)  # depth below each face
    face = jnp.argmin(faces, axis=1)
    normals = jnp.asarray([[-1, 0], [0, -1], [1, 0], [0, 1]], boxes.dtype)[face]
    gap = jnp.where(outside, distance, -jnp.min(faces, axis=1)) - radius
    return gap, jnp.where(outside[:, None], offset / distance[:, None], normals)


def push_out(
    position: jax.Array, boxes: jax.Array, present: jax.Array, radius: jax.Array | float
) -> jax.Array:
    """Move the disc out of boxes that were placed over it, the deepest first; return its position."""

    def push(_: jax.Array, p: jax.Array) -> jax.Array:
        gap, normal = gaps(p, boxes, radius)
        deepest = jnp.argmin(jnp.where(present, gap, jnp.inf))
        depth = jnp.where(present[deepest] & (gap[deepest] < -CLOSE), SKIN - gap[deepest], 0.0)
        return p + depth * normal[deepest]

    return lax.fori_loop(0, PUSHES, push, position)


def move(
    position: jax.Array,
    step: jax.Array,
    boxes: jax.Array,
    present: jax.Array,
    radius: jax.Array | float,
    sticks: bool,
) -> tuple[jax.Array, jax.Array]:
    """Move a disc by `step` as far as the boxes allow; return its position (2,) and whether it touched one.

    Args:
        position: middle of the disc (2,).
        step: displacement without contact (2,).
        boxes: (n, 4).
        present: which boxes are present (n,).
        radius: radius of the disc.
        sticks: whether the disc stops at a touch for the rest of the step; else it slides along the wall.
    """
    start = push_out(position, boxes, present, radius)

    def advance(_: int, carry: Carry) -> Carry:
        p, remaining, touched = carry
        gap, normal = gaps(p, boxes, radius)
        length = jnp.sqrt(jnp.sum(remaining * remaining))
        inward = jnp.sum(normal * remaining, axis=1) < -GRAZING * length
        share = jnp.where(
            gap <= CLOSE, jnp.where(inward, 0.0, NOT_HIT), first_touch(p, remaining, boxes, radius)
        )
        share = jnp.where(present, share, NOT_HIT)
        wall = jnp.argmin(share)
        hit = (share[wall] < 1.0) & (length > 0)
        part = jnp.minimum(share[wall], 1.0)
        q = p + part * remaining
        gap, normal = gaps(q, boxes, radius)
        out, unspent = normal[wall], (1.0 - part) * remaining
        q = q + jnp.where(hit, jnp.maximum(SKIN - gap[wall], 0.0), 0.0) * out
        along = (
            jnp.zeros_like(unspent) if sticks else unspent - jnp.minimum(jnp.sum(unspent * out), 0.0) * out
        )
        return q, jnp.where(hit, along, 0.0), touched | hit

    end, _, touched = lax.fori_loop(0, SLIDES, advance, (start, step, jnp.asarray(False)))
    return end, touched


def first_touch(
    position: jax.Array, step: jax.Array, boxes: jax.Array, radius: jax.Array | float
) -> jax.Array:
    """Return for each box the share of a step at which a disc outside touches it; above 1: no touch."""
    tall, wide = jnp.asarray([0, radius], boxes.dtype), jnp.asarray([radius, 0], boxes.dtype)
    lower, upper = boxes[:, :2], boxes[:, 2:]
    flat = jnp.minimum(
        _into_box(position, step, lower - wide, upper + wide),
        _into_box(position, step, lower - tall, upper + tall),
    )
    corners = jnp.stack([lower, upper, boxes[:, jnp.asarray([0, 3])], boxes[:, jnp.asarray([2, 1])]], axis=1)
    return jnp.minimum(flat, jnp.min(_into_disc(position, step, corners, radius), axis=1))


def _into_box(position: jax.Array, step: jax.Array, lower: jax.Array, upper: jax.Array) -> jax.Array:
    """Return the share of the step at which a point enters boxes (..., 2); 0 inside, NOT_HIT for a miss."""
    tiny = jnp.asarray(1e-30, step.dtype)
    inverse = 1.0 / jnp.where(jnp.abs(step) < tiny, tiny, step)
    to_lower, to_upper = (lower - position) * inverse, (upper - position) * inverse
    enters = jnp.max(jnp.minimum(to_lower, to_upper), axis=-1)
    leaves = jnp.min(jnp.maximum(to_lower, to_upper), axis=-1)
    return jnp.where((enters <= leaves) & (leaves >= 0), jnp.maximum(enters, 0.0), NOT_HIT)


def _into_disc(
    position: jax.Array, step: jax.Array, middles: jax.Array, radius: jax.Array | float
) -> jax.Array:
    """Return the share of the step at which a point enters discs round `middles` (..., 2)."""
    offset = position - middles
    square = jnp.sum(step * step)
    approach = -jnp.sum(offset * step, axis=-1)
    # exact for near passes, unlike the difference of squares
    across = offset[..., 0] * step[1] - offset[..., 1] * step[0]
    depth = square * radius * radius - across * across
    meets = (depth >= 0) & (approach > 0) & (square > 0)
    share = (approach - jnp.sqrt(jnp.where(meets, depth, 0.0))) / jnp.where(square > 0, square, 1.0)
    return jnp.where(meets, jnp.maximum(share, 0.0), NOT_HIT)


def rays(
    origins: jax.Array, directions: jax.Array, boxes: jax.Array, present: jax.Array, longest: float
) -> jax.Array:
    """Return the distance (m,) from each origin (m, 2) along its unit vector (m, 2) to the nearest box.

    Distances are at most `longest`.
    """

    def one(origin: jax.Array, direction: jax.Array) -> jax.Array:
        share = _into_box(origin, direction * longest, boxes[:, :2], boxes[:, 2:])
        return longest * jnp.min(jnp.where(present, jnp.minimum(share, 1.0), 1.0))

    return jax.vmap(one)(origins, directions)
