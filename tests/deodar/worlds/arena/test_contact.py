"""A disc among boxes: it never enters or crosses a wall, for any step; it slides or sticks."""

from __future__ import annotations

import functools

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from deodar.worlds.arena import contact

RADIUS = 0.037
TOLERANCE = 2e-5


@functools.cache
def mover(sticks: bool):
    def many(positions, steps, boxes, present):
        def one(p, path):
            return jax.lax.scan(
                lambda q, s: (lambda r: (r[0], r))(contact.move(q, s, boxes, present, RADIUS, sticks)),
                p,
                path,
            )[1]

        return jax.vmap(one)(positions, steps)

    return jax.jit(many)


def chamber(rng: np.random.Generator, boxes: int = 12) -> np.ndarray:
    """Return a closed room of one metre with walls of a few millimetres, and thin and thick boxes in it."""
    t = rng.uniform(0.001, 0.01)
    walls = [(0, 0, 1, t), (0, 1 - t, 1, 1), (0, 0, t, 1), (1 - t, 0, 1, 1)]
    for _ in range(boxes):
        x, y = rng.uniform(0.05, 0.95, 2)
        w, h = rng.choice([0.002, 0.05, 0.3], 2)
        walls.append((x - w / 2, y - h / 2, x + w / 2, y + h / 2))
    return np.asarray(walls, np.float32)


def free(rng: np.random.Generator, boxes: np.ndarray, n: int) -> np.ndarray:
    """Return positions in the room at which the disc is free."""
    out: list[np.ndarray] = []
    while len(out) < n:
        p = rng.uniform(0, 1, 2).astype(np.float32)
        distance = p - np.clip(p, boxes[:, :2], boxes[:, 2:])
        if np.sqrt((distance**2).sum(1)).min() > RADIUS + 1e-4:
            out.append(p)
    return np.asarray(out)


def gap(positions: np.ndarray, boxes: np.ndarray) -> np.ndarray:
    """Return the smallest gap between the disc and a box, in double precision; -radius if its centre is
    inside a box.
    """
    p = np.asarray(positions, np.float64)[..., None, :]
    distance = p - np.clip(p, boxes[:, :2].astype(float), boxes[:, 2:].astype(float))
    return np.sqrt((distance**2).sum(-1)).min(-1) - RADIUS


@pytest.mark.parametrize("sticks", [False, True])
@pytest.mark.parametrize("longest", [0.005, 0.2, 30.0])
def test_no_step_ends_inside_a_wall_or_outside_of_a_closed_room(longest: float, sticks: bool) -> None:
    for seed in range(6):
        rng = np.random.default_rng(seed)
        boxes = chamber(rng)
        start = free(rng, boxes, 50)
        turn, length = rng.uniform(0, 2 * np.pi, (50, 40)), rng.uniform(0, longest, (50, 40))
        steps = (length[..., None] * np.stack([np.cos(turn), np.sin(turn)], -1)).astype(np.float32)
        ends, _ = mover(sticks)(start, steps, boxes, np.ones(len(boxes), bool))
        ends = np.asarray(ends)
        assert gap(ends, boxes).min() > -TOLERANCE
        assert (ends > 0).all() and (ends < 1).all()


def test_a_disc_does_not_pass_a_wall_thinner_than_its_step() -> None:
    rng = np.random.default_rng(1)
    boxes = np.asarray([(0.5, -1, 0.5005, 2)], np.float32)
    start = np.stack([rng.uniform(0.1, 0.45, 200), rng.uniform(0, 1, 200)], -1).astype(np.float32)
    steps = np.stack([rng.uniform(0, 3, (200, 20)), rng.uniform(-0.02, 0.02, (200, 20))], -1).astype(
        np.float32
    )
    ends, touched = mover(False)(start, steps, boxes, np.ones(1, bool))
    assert np.asarray(ends)[..., 0].max() < 0.5 - RADIUS + TOLERANCE and np.asarray(touched).any(axis=1).all()


def test_a_disc_slides_along_a_wall_or_sticks_to_it() -> None:
    wall = np.asarray([(0, -10, 1, 10)], np.float32)
    start, steps = np.asarray([[-0.5, 0.0]], np.float32), np.asarray([[[1.0, 1.0]]], np.float32)
    slid, touched = mover(False)(start, steps, wall, np.ones(1, bool))
    np.testing.assert_allclose(slid[0, 0], [-RADIUS, 1.0], atol=1e-5)
    assert touched[0, 0]
    stuck, _ = mover(True)(start, steps, wall, np.ones(1, bool))
    np.testing.assert_allclose(stuck[0, 0], [-RADIUS, 0.5 - RADIUS], atol=1e-5)
    away, touched = mover(False)(np.asarray(slid[0]), -steps, wall, np.ones(1, bool))
    np.testing.assert_allclose(away[0, 0], [-RADIUS - 1, 0], atol=1e-5)
    assert not touched[0, 0]


def test_a_disc_slides_around_an_outer_corner_and_stops_in_an_inner_one() -> None:
    box = np.asarray([(0, 0, 1, 1)], np.float32)
    # a disc on a grazing path slides off the round corner
    end, touched = mover(False)(
        np.asarray([[-0.5, -0.03]], np.float32), np.asarray([[[1.0, 0.0]]], np.float32), box, np.ones(1, bool)
    )
    assert touched[0, 0] and end[0, 0, 1] < -0.03 and gap(np.asarray(end), box).min() > -TOLERANCE
    notch = np.asarray([(0, -1, 1, 1), (-1, 0, 1, 1)], np.float32)
    end, _ = mover(False)(
        np.asarray([[-0.3, -0.4]], np.float32),
        np.asarray([[[5.0, 4.0]]], np.float32),
        notch,
        np.ones(2, bool),
    )
    np.testing.assert_allclose(end[0, 0], [-RADIUS, -RADIUS], atol=1e-5)


def test_an_absent_wall_has_no_contact_and_a_new_one_moves_the_body_out() -> None:
    box = np.asarray([(-0.05, -0.5, 0.2, 0.5)], np.float32)
    start, still = np.zeros((1, 2), np.float32), np.zeros((1, 1, 2), np.float32)
    end, _ = mover(False)(start, still, box, np.zeros(1, bool))
    np.testing.assert_array_equal(end[0, 0], [0, 0])
    end, _ = mover(False)(start, still, box, np.ones(1, bool))
    np.testing.assert_allclose(end[0, 0], [-0.05 - RADIUS, 0], atol=1e-5)


def test_rays_end_at_the_nearest_present_box() -> None:
    boxes = jnp.asarray([(1.0, -1, 2, 1), (0.5, -1, 0.6, 1), (-3, -1, -2, 1)])
    rays = jax.jit(contact.rays)
    origins, looks = jnp.zeros((3, 2)), jnp.asarray([[1.0, 0], [-1.0, 0], [0.0, 1.0]])
    np.testing.assert_allclose(
        rays(origins, looks, boxes, jnp.asarray([True, True, True]), 5.0), [0.5, 2, 5], atol=1e-6
    )
    np.testing.assert_allclose(
        rays(origins, looks, boxes, jnp.asarray([True, False, True]), 5.0), [1, 2, 5], atol=1e-6
    )
    inside = rays(jnp.asarray([[1.5, 0.0]]), looks[:1], boxes, jnp.ones(3, bool), 5.0)
    np.testing.assert_array_equal(inside, [0.0])


@pytest.mark.parametrize(("inward", "touches"), [(0.0, False), (5e-7, False), (2e-6, True), (-1e-4, False)])
def test_a_path_along_a_wall_grazes_it_unless_it_points_into_it(inward: float, touches: bool) -> None:
    wall = np.asarray([(0, -10, 1, 10)], np.float32)
    start = np.asarray([[-RADIUS - contact.SKIN, 0.0]], np.float32)
    steps = np.asarray([[[inward, 1.0]]], np.float32)
    end, touched = mover(True)(start, steps, wall, np.ones(1, bool))
    assert bool(touched[0, 0]) is touches
    np.testing.assert_allclose(end[0, 0, 1], 0.0 if touches else 1.0, atol=1e-5)


@pytest.mark.parametrize(("gap", "touches"), [(2e-6, True), (1e-3, False)])
def test_a_disc_touches_a_box_within_the_rounding_error(gap: float, touches: bool) -> None:
    wall = np.asarray([(0, -10, 1, 10)], np.float32)
    start, steps = np.asarray([[-RADIUS - gap, 0.0]], np.float32), np.asarray([[[1e-4, 0.0]]], np.float32)
    end, touched = mover(False)(start, steps, wall, np.ones(1, bool))
    assert bool(touched[0, 0]) is touches
    np.testing.assert_allclose(end[0, 0, 0], start[0, 0] + (0.0 if touches else 1e-4), atol=1e-6)


@pytest.mark.parametrize(
    ("step", "share"), [((0.0, 1.0), contact.NOT_HIT), ((1.0, 0.0), contact.NOT_HIT), ((-1.0, 0.0), 0.0)]
)
def test_a_point_on_a_disc_enters_it_inwards_and_neither_along_it_nor_outwards(
    step: tuple[float, float], share: float
) -> None:
    moved = contact._into_disc(np.array([1.0, 0.0]), np.array(step), np.zeros((1, 2)), 1.0)
    np.testing.assert_array_equal(moved, np.float32([share]))
