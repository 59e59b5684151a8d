"""Features in pairs: every two values of different features stand together in a model, and what runs it in
one way runs it in the others.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from itertools import combinations, product
from typing import Any

import numpy as np
import pytest

import deodar as dd

X = dd.Axis("x", 0, 20, samples=21)
RING = dd.Axis("x", 0, 360, samples=36, periodic=True)
Y = dd.Axis("y", 0, 10, samples=11)

FEATURES: dict[str, list[Any]] = {
    "axes": [[], [X], [RING], [X, Y]],
    "kernel": ["none", "one", "two"],
    "quadrature": ["point", "cell"],
    "noise": [0.0, 0.4],
    "ticks": [1, 3],
    "delay": ["", "line", "connection"],
    "sources": ["one", "two", "window"],
    "swept": ["", "tau", "noise"],
    "precision": ["float32", "float64"],
}


def rows_of_pairs(features: Mapping[str, list[Any]], seed: int = 1) -> list[dict[str, Any]]:
    """Return rows of features in which every two values of different features stand together at least once.

    Each row is the best of some that are drawn: the one with most pairs that no row has yet.
    """
    draw = random.Random(seed)
    choices = [[(name, k) for k in range(len(values))] for name, values in features.items()]
    missing = {frozenset(pair) for a, b in combinations(choices, 2) for pair in product(a, b)}
    rows: list[list[tuple[str, int]]] = []
    while missing:
        drawn = [[draw.choice(choice) for choice in choices] for _ in range(200)]
        rows.append(max(drawn, key=lambda row: len(missing & pairs(row))))
        missing -= pairs(rows[-1])
    return [{name: features[name][k] for name, k in row} for row in rows]


def pairs(row: list[tuple[str, int]]) -> set[frozenset[tuple[str, int]]]:
    return {frozenset(pair) for pair in combinations(row, 2)}


def built(row: Mapping[str, Any]) -> dd.Model:
    """Return a model with the features of a row: two fields, the second behind the first."""
    model, axes = dd.Model("pairs"), row["axes"]
    scale = 6.0 if len(axes) < 2 else 3.0
    kernels = [dd.Gaussian(scale, 2.0, normalized=True), dd.Gaussian(-0.4 * scale, 5.0, normalized=True)]
    count = {"none": 0, "one": 1, "two": 2}[row["kernel"]] if axes else 0
    quadrature = row["quadrature"] if axes else "point"
    options = {
        "kernel": kernels[:count],
        "quadrature": quadrature,
        "noise": row["noise"],
        "resting_level": -2.0,
    }
    u = model.add(dd.Field("u", axes, **options), ticks=row["ticks"])
    v = model.add(dd.Field("v", axes, tau=10.0, noise=row["noise"]))
    for k in range(2 if row["sources"] == "two" else 1):
        windows = [(5.0, 20.0)] if row["sources"] == "window" else None
        name = f"s{k}"
        if axes:
            center = [a.lower + (0.3 + 0.4 * k) * a.range for a in axes]
            source = dd.GaussianStimulus(name, axes, center=center, sigma=2.0, amplitude=5, windows=windows)
        else:
            source = dd.Boost(name, [], 3.0 + k, windows=windows)
        model.add(source) >> u
    if row["delay"] == "line":
        u >> model.add(dd.DelayLine("late", axes, delay=4.0)) >> v
    else:
        model.connect(u, v, "delayed" if row["delay"] == "connection" else "")
    return model


@pytest.mark.parametrize("row", rows_of_pairs(FEATURES), ids=str)
def test_every_way_to_run_a_model_has_its_values(row: dict[str, Any]) -> None:
    model = built(row)
    settings: dict[str, Any] = {"seed": 4, "precision": row["precision"]}
    run = dd.simulate(model, 40.0, record=["u", "v.output"], every=4.0, **settings)
    tolerance = (
        {"rtol": 2e-4, "atol": 2e-4} if row["precision"] == "float32" else {"rtol": 1e-10, "atol": 1e-10}
    )

    session = dd.Session(model, **settings)
    for k, _ in enumerate(run["time"].values):
        np.testing.assert_allclose(session.read("u.activation"), run["u.activation"].values[k], **tolerance)
        np.testing.assert_allclose(session.read("v.output"), run["v.output"].values[k], **tolerance)
        session.step(4)

    path = {"": "u.resting_level", "tau": "u.tau", "noise": "u.noise"}[row["swept"]]
    values = [-1.5, -2.0] if path == "u.resting_level" else [30.0, 20.0] if path == "u.tau" else [0.8, 0.4]
    if path == "u.noise" and not row["noise"]:
        path, values = "v.tau", [25.0, 10.0]
    swept = dd.simulate(
        model, 40.0, record=["u", "v.output"], every=4.0, trials=2, sweep={path: values}, **settings
    )
    for name in run.data_vars:
        point = swept[name].isel({path: 1, "trial": 0}).transpose(*run[name].dims)
        np.testing.assert_allclose(point.values, run[name].values, **tolerance)
    other = swept["u.activation"].isel({path: 0, "trial": 0})
    assert path.startswith("v") or not np.array_equal(other.values, run["u.activation"].values)
    same = [swept["v.output"].isel({path: 1, "trial": k}).values for k in range(2)]
    assert np.array_equal(*same) == (row["noise"] == 0.0)
