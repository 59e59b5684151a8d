"""Projective maps between two planes, from four pairs of points."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

PAIRS = 4
"""Pairs of points that determine a projective map."""


def homography(source: Array, target: Array) -> Array:
    """Return the 3 x 3 matrix of the projective map that takes four points to four others.

    In homogeneous coordinates, the matrix M of four points p takes the three unit vectors to multiples of the
    first three points, and (1, 1, 1) to the fourth one; the map is M of the target times the inverse of M of
    the source. Its scale is arbitrary.

    Args:
        source: the four points in the first plane, shape (4, 2); no three of them on one line.
        target: where they lie in the second plane, shape (4, 2); no three of them on one line.

    Reference:
        Hartley & Zisserman (2004), Multiple View Geometry in Computer Vision, 2nd ed., section 2.3.
    """
    return _basis(target) @ _inverse(_basis(source))


def mapped(matrix: Array, points: Array) -> Array:
    """Return the images of points, shape (..., 2); not finite or far away on the horizon of the map."""
    images = points @ matrix[:, :2].T + matrix[:, 2]
    return images[..., :2] / images[..., 2:]


def in_front(matrix: Array, points: Array, known: Array) -> Array:
    """Return for each point whether it lies on the same side of the horizon of the map as a known point."""
    return (points @ matrix[2, :2] + matrix[2, 2]) * (known @ matrix[2, :2] + matrix[2, 2]) > 0


def spread(points: Array) -> Array:
    """Return the smallest area of a triangle of three of the points, as a share of the largest one.

    It is 0 if three of the four points lie on one line.
    """
    p = _homogeneous(points)
    areas = jnp.abs(
        jnp.stack([_triple(*(p[k] for k in range(PAIRS) if k != dropped)) for dropped in range(PAIRS)])
    )
    return jnp.min(areas) / jnp.maximum(jnp.max(areas), jnp.finfo(areas.dtype).tiny)


def _basis(points: Array) -> Array:
    a, b, c, d = _homogeneous(points)
    weights = jnp.stack([_triple(d, b, c), _triple(a, d, c), _triple(a, b, d)])
    return jnp.stack([a, b, c], axis=1) * weights


def _inverse(matrix: Array) -> Array:
    """Return the inverse, but for its scale."""
    a, b, c = matrix.T
    return jnp.stack([jnp.cross(b, c), jnp.cross(c, a), jnp.cross(a, b)])


def _homogeneous(points: Array) -> Array:
    return jnp.concatenate([points, jnp.ones((len(points), 1), points.dtype)], axis=1)


def _triple(a: Array, b: Array, c: Array) -> Array:
    return jnp.dot(a, jnp.cross(b, c), precision="highest")
