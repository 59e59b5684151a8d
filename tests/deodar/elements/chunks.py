"""A check that the bits of a run do not depend on its chunks."""

from __future__ import annotations

import numpy as np

import deodar as dd
from deodar.element import Element

STEPS = 140


def require_the_same_in_any_chunks(element: Element) -> None:
    """Compare single steps, one chunk and uneven chunks, from a time that float32 does not resolve and
    that is no multiple of the step.
    """
    model = dd.Model("chunks", dt=0.1)
    model.describe(t0=86_400_000.037)
    model.add(element)
    path = f"{element.name}.output"
    whole = dd.simulate(model, STEPS * 0.1, record=[path])[path].values
    for lengths in ([1] * STEPS, [9, 1, 40, 2, 88]):
        session = dd.Session(model)
        for n in lengths:
            np.testing.assert_array_equal(session.read(path), whole[session.tick])
            session.step(n)
