"""Shortest paths against Dijkstra's algorithm on random arenas, and on arenas with known answers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from deodar.analysis.robot_paths import arena_grid, clearance, path_length, shortest_path
from deodar.errors import AnalysisError

BORDER = (0, 0, 30, 20)


def test_the_shortest_path_in_an_empty_arena_is_straight():
    on = arena_grid([], BORDER, least=2.0)
    path = shortest_path(on, (5, 5), (15, 5))
    np.testing.assert_allclose(path, [(x, 5) for x in range(5, 16)])
    assert path_length(shortest_path(on, (5, 5), (15, 10))) == pytest.approx(5 + 5 * np.sqrt(2))


def test_a_path_keeps_its_clearance():
    boxes = [(10, 0, 12, 14)]
    on = arena_grid(boxes, BORDER, least=3.0)
    path = shortest_path(on, (5, 5), (20, 5))
    assert clearance(path, boxes, BORDER).min() >= 3.0 - 1e-6
    assert path[:, 1].max() == 17


def test_shortest_path_without_a_free_connection_is_none():
    assert shortest_path(arena_grid([(10, 0, 12, 20)], BORDER, least=1.0), (5, 5), (20, 5)) is None
    # the gap of 5 is too narrow
    assert shortest_path(arena_grid([(10, 0, 12, 15)], BORDER, least=3.0), (5, 5), (20, 5)) is None


def test_a_start_without_clearance_begins_at_the_nearest_free_cell():
    path = shortest_path(arena_grid([], BORDER, least=4.0), (0.4, 10), (20, 10))
    np.testing.assert_allclose(path[0], (4, 10))


# in the last three arenas an estimate above the true length would give a longer path
@pytest.mark.parametrize("seed", [*range(6), 14, 19, 22])
def test_the_path_is_as_short_as_that_of_dijkstra(seed):
    draw = np.random.default_rng(seed)
    low = draw.uniform(0, (28, 18), (9, 2))
    boxes = np.concatenate([low, low + draw.uniform(0.5, 5, (9, 2))], axis=1)
    on = arena_grid(boxes, BORDER, cell=1.0, least=0.7)
    free = np.argwhere(on.free)
    a, b = (tuple(free[k]) for k in draw.choice(len(free), 2, replace=False))
    number = np.arange(on.free.size).reshape(on.free.shape)
    i, j, w = [], [], []
    for p in free:
        for d in np.argwhere(np.ones((3, 3))) - 1:
            q = p + d
            if d.any() and (q >= 0).all() and (q < on.free.shape).all() and on.free[tuple(q)]:
                i, j, w = [*i, number[tuple(p)]], [*j, number[tuple(q)]], [*w, np.hypot(*d)]
    exact = dijkstra(coo_matrix((w, (i, j)), shape=(on.free.size,) * 2).tocsr(), indices=number[a])[number[b]]
    path = shortest_path(on, on.place(a), on.place(b))
    assert (np.inf if path is None else path_length(path)) == pytest.approx(exact)
    assert (path is None) == (on.regions()[a] != on.regions()[b])


def test_a_grid_without_a_free_cell_is_refused():
    with pytest.raises(AnalysisError, match="do not fit"):
        arena_grid([], BORDER, cell=40.0)
    with pytest.raises(AnalysisError, match="no free cell"):
        shortest_path(arena_grid([], BORDER, least=15.0), (1, 1), (2, 2))
