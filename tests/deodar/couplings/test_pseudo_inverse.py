"""The pseudo-inverse of a matrix."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd
from deodar.errors import ModelError

RANDOM = np.random.default_rng(6)


def inverted(values, **parameters):
    axes = [dd.Axis(n, 0, size - 1, size) for n, size in zip("abc", values.shape, strict=False)]
    model = dd.Model("inverse")
    model.add(dd.Pattern("matrix", axes, values)) >> model.add(dd.PseudoInverse(name="p", **parameters))
    record = dd.simulate(model, 1, dt=1.0, record=["p"], precision="float64")["p.output"]
    assert (
        record.dims[1:] == tuple(f"{a.name} of p" for a in axes[::-1])
        or record.shape[1:] == values.shape[::-1]
    )
    return record.values[-1]


@pytest.mark.parametrize("shape", [(3, 3), (3, 7), (6, 2)])
def test_a_matrix_of_full_rank(shape):
    matrix = RANDOM.normal(size=shape)
    np.testing.assert_allclose(inverted(matrix), np.linalg.pinv(matrix), atol=1e-12)
    damped = matrix.T @ np.linalg.inv(matrix @ matrix.T + 0.09 * np.eye(shape[0]))
    np.testing.assert_allclose(inverted(matrix, damping=0.3), damped, atol=1e-12)


def test_matrices_of_lower_rank_and_of_none():
    matrix = np.outer(RANDOM.normal(size=4), RANDOM.normal(size=3))
    np.testing.assert_allclose(inverted(matrix), np.linalg.pinv(matrix, rcond=1e-6), atol=1e-12)
    assert not inverted(np.zeros((4, 3))).any()
    assert not inverted(np.zeros((4, 3)), damping=0.1).any()


def test_small_singular_values_count_as_zero():
    matrix = np.diag([2.0, 0.1])
    np.testing.assert_allclose(inverted(matrix, least=0.1), np.diag([0.5, 0.0]), atol=1e-12)
    np.testing.assert_allclose(inverted(matrix, least=0.01), np.diag([0.5, 10.0]), atol=1e-12)


def test_one_axis_is_a_column():
    column = np.array([1.0, 2.0, -2.0])
    np.testing.assert_allclose(inverted(column), column / 9, atol=1e-12)


def test_a_volume_is_refused():
    with pytest.raises(ModelError, match="needs an input of one or two axes, not of 3"):
        inverted(np.ones((2, 2, 2)))
