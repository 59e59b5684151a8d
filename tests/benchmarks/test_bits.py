"""Bits depend on the width of a batch alone: a few of the thousand random combinations of
`benchmarks/bits.py`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import deodar as dd

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import bits


def test_copies_of_equal_width_agree_to_the_bit() -> None:
    problems = bits.check(10, seed=1, names=["two lines of 31"], widths=(1, 3), workers_every=0)
    assert not problems.differences and problems.compared > 50
    assert {key[1] for key in problems.first} == {1, 3}


def test_a_difference_in_the_last_digit_is_found() -> None:
    found = bits.Found()
    found.take(("m", 1, 0, "u", 0), np.float32([1.0, 2.0]), "first")
    found.take(("m", 1, 0, "u", 0), np.float32([1.0, 2.0000002]), "second")
    assert len(found.differences) == 1 and found.compared == 1


def test_the_last_piece_is_as_wide_as_the_others() -> None:
    """Trials 0 to 3 in pieces of 3 and 1, of which the second is filled up; points of a sweep likewise."""
    model = bits.MODELS["two lines of 31"](1)

    def run(batch: int, **others: object) -> np.ndarray:
        on = dd.Resources(batch=batch)
        recording = dd.simulate(model, 20, record=["u1.activation"], every=20, on=on, **others)  # type: ignore[arg-type]
        return recording["u1.activation"].values

    np.testing.assert_array_equal(run(trials=[0, 1, 2, 3], batch=3)[3], run(trials=[3, 5, 7], batch=3)[0])
    sweep = {"s.amplitude": [2.0, 4.0, 6.0, 8.0]}
    np.testing.assert_array_equal(
        run(sweep=sweep, batch=3)[3], run(sweep={"s.amplitude": [8.0, 1.0, 3.0]}, batch=3)[0]
    )
    record = run(sweep=sweep, trials=2, batch=6)
    assert record.shape[:2] == (4, 2)
    np.testing.assert_array_equal(
        record[3], run(sweep={"s.amplitude": [8.0, 1.0, 3.0]}, trials=2, batch=6)[0]
    )


def test_a_batch_of_one_has_the_bits_of_a_single_run() -> None:
    model = bits.MODELS["a plane, a line and a node"](1)
    alone = dd.simulate(model, 20, record=["u0.activation"])["u0.activation"].values
    np.testing.assert_array_equal(
        dd.simulate(model, 20, record=["u0.activation"], trials=2, on=dd.Resources(batch=1))[
            "u0.activation"
        ].values[0],
        alone,
    )
