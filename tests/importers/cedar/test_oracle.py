"""The reference reproduces what real cedar computed, with noise off and iterations of 10 ms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.importers.cedar.oracle import Architecture, run

DATA = Path(__file__).parent / "data"
AT = (1, 2, 5, 20, 100)
KNOWN_BUG = "2to3 20 short.output"


def stored(name):
    """Return the values of real cedar by iteration and slot."""
    with np.load(DATA / f"{name}.npz") as z:
        return {(int(n), slot): z[key] for key in z for slot, n in [key.rsplit("|", 1)]}


@pytest.mark.parametrize("name", sorted(path.stem for path in DATA.glob("*.json")))
def test_the_traces_of_cedar_are_reproduced(name):
    done = run(DATA / f"{name}.json", AT[-1], 10, AT)
    reference = stored(name)
    assert len(reference) > 50
    for (n, slot), wanted in reference.items():
        found = done[slot][AT.index(n)]
        assert found.shape == wanted.shape, slot
        if slot != KNOWN_BUG:
            assert np.abs(found - wanted).max() < (1e-4 if n <= 5 else 1e-3), (slot, n)


def test_where_cedar_leaves_slices_empty_the_reference_fills_them():
    found = run(DATA / "projection_steps.json", 1, 10)[KNOWN_BUG][1]
    wanted = stored("projection_steps")[1, KNOWN_BUG]
    wrong = np.abs(found - wanted).max(axis=(0, 2)) > 1e-4
    assert wrong.tolist() == [False] * 10 + [True] * 2
    assert np.abs(found[:, 10:] - found[:, :1]).max() == 0


def test_the_listeners_of_a_group_are_its_looped_steps():
    order = Architecture(DATA / "elementaryBehavior.json").order
    names = ["CoS field", "CoS node", "intention field", "intention node"]
    assert order == [f"Elementary behavior.{name}" for name in names]
