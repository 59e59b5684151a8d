"""Batches in pieces, of which the last is filled up to the width of the others."""

from __future__ import annotations

import numpy as np
import pytest

import deodar as dd

AMPLITUDES = [0.0, 1.0, 2.0, 3.0, 4.0]


@pytest.fixture(scope="module")
def model() -> dd.Model:
    model = dd.Model("pieces")
    n = model.add(dd.Field("n", [], tau=10, resting_level=-5, noise=0.2))
    model.add(dd.Boost("b", [])) >> n
    return model


@pytest.mark.parametrize("batch", [2, 4])
@pytest.mark.parametrize(
    ("trials", "sweep"),
    [
        (5, None),
        (None, {"b.amplitude": AMPLITUDES}),
        (2, {"b.amplitude": AMPLITUDES}),
        (5, {"n.tau": [5.0, 10.0]}),
    ],
)
def test_a_batch_in_pieces_has_the_values_of_the_whole_batch(
    model: dd.Model, trials: int | None, sweep: dict[str, list[float]] | None, batch: int
) -> None:
    whole, pieces = (
        dd.simulate(
            model,
            20,
            record="n.activation",
            trials=trials,
            sweep=sweep,
            precision="float64",
            on=dd.Resources(batch=size),
        )["n.activation"]
        for size in (100, batch)
    )
    assert pieces.dims == whole.dims and pieces.shape == whole.shape
    np.testing.assert_allclose(pieces.values, whole.values, rtol=0, atol=1e-10)
    assert np.ptp(whole.values) > 0
