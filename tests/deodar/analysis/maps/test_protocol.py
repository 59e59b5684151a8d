"""What the lanes of a map share, and that their number changes no label."""

from __future__ import annotations

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.analysis.maps import protocol
from deodar.analysis.maps.request import requested
from deodar.analysis.settling_copies import LANE_BYTES
from tests.deodar.analysis.maps.test_regime_map import EXCITATION, INHIBITION, line

WIDTH = "u.kernel.0.sigma"


def shapes(path: str, samples: int = 31) -> tuple[int, set[tuple[int, ...]]]:
    """Return the number of lanes, and the shapes of their constants."""
    over = {path: [4.0, 8.0], INHIBITION: [0.1, 0.2]}
    regime_protocol = protocol.RegimeProtocol(requested(line(samples), over, "u", None, {}))
    parameters = np.ones((regime_protocol.copies.count, 5), np.float32)
    constants = jax.eval_shape(regime_protocol.copies.constants, parameters)
    return regime_protocol.copies.count, {leaf.shape for leaf in jax.tree.leaves(constants)}


def test_lanes_that_differ_by_an_amplitude_share_one_matrix():
    lanes, shape = shapes(EXCITATION)
    assert lanes == protocol.MOST_LANES and (1, 31, 31) in shape and (lanes, 1, 31, 31) not in shape


def test_lanes_that_differ_by_a_width_have_a_matrix_each():
    lanes, shape = shapes(WIDTH)
    assert lanes == protocol.MOST_LANES and (lanes, 1, 31, 31) in shape


def test_large_matrices_of_lanes_are_bounded():
    lanes, shape = shapes(WIDTH, 301)
    assert lanes * 301**2 * 4 <= LANE_BYTES < protocol.MOST_LANES * 301**2 * 4
    assert (lanes, 1, 301, 301) in shape


@pytest.mark.parametrize("path", [EXCITATION, WIDTH])
def test_the_number_of_lanes_changes_no_label(path, monkeypatch):
    over = {path: (2, 9, 7), INHIBITION: (0.05, 1.2, 7)}
    many = dd.regime_map(line(31), over, refine=False)
    monkeypatch.setattr(protocol, "MOST_LANES", 8)
    few = dd.regime_map(line(31), over, refine=False)
    assert (many.labels == few.labels).all() and len(many.shares) >= 3
