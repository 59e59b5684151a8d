"""Sweeps over a list of points: each point pairs its values, and may draw noise of its own."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest

import deodar as dd
from deodar.batch.points import SweepPoints
from deodar.errors import RunWarning
from deodar.recording import repeat

POINTS = [
    {"n.resting_level": -1.0, "s.amplitude": 2.0},
    {"n.resting_level": -2.0, "s.amplitude": 2.5},
    {"n.resting_level": -0.5, "s.amplitude": 1.0},
    {"n.resting_level": -3.0, "s.amplitude": 6.0},
    {"n.resting_level": -1.5, "s.amplitude": 0.5},
]

OWN = dd.Points(POINTS, own_noise=True)


def node(noise: float = 0.5) -> dd.Model:
    model = dd.Model("points")
    stimulus = model.add(dd.GaussianStimulus("s", amplitude=2.0))
    stimulus >> model.add(dd.Field("n", tau=10, noise=noise))
    return model


@functools.cache
def uncut(own_noise: bool, trials: int | None) -> np.ndarray:
    return run(dd.Points(POINTS, own_noise), trials)


def run(sweep: dd.Points, trials: int | None = None, **used: int) -> np.ndarray:
    on = dd.Resources(**used)
    record = dd.simulate(
        node(), 20, record="n.activation", trials=trials, sweep=sweep, precision="float64", on=on
    )
    return record["n.activation"].values


def test_a_grid_has_each_combination_once() -> None:
    grid = SweepPoints(node().document, {"n.resting_level": [-1, -2], "s.amplitude": [3, 4, 5]})
    assert np.stack(grid.values).tolist() == [[-1, -1, -1, -2, -2, -2], [3, 4, 5, 3, 4, 5]]


def test_each_point_has_its_values_and_its_coordinates() -> None:
    record = dd.simulate(node(0), 20, record="n.activation", sweep=POINTS, precision="float64")
    assert record["n.activation"].dims == ("point", "time")
    assert record["point"].values.tolist() == [0, 1, 2, 3, 4]
    for path in POINTS[0]:
        assert record[path].dims == ("point",)
        assert record[path].values.tolist() == [point[path] for point in POINTS]
    for k, point in enumerate(POINTS):
        model = node(0)
        for path, number in point.items():
            model.set(path, number)
        alone = dd.simulate(model, 20, record="n.activation", precision="float64")["n.activation"]
        np.testing.assert_allclose(record["n.activation"].values[k], alone.values, atol=1e-12)


@pytest.mark.parametrize("batch", [1, 2, 3, 5, 7])
@pytest.mark.parametrize("trials", [None, 3, 8])
@pytest.mark.parametrize("own", [False, True])
def test_a_cut_changes_no_value(batch: int, trials: int | None, own: bool) -> None:
    whole = uncut(own, trials)
    cut = run(dd.Points(POINTS, own), trials, batch=batch)
    assert whole.shape == ((5, 21) if trials is None else (5, trials, 21))
    np.testing.assert_allclose(cut, whole, atol=1e-12)


def test_points_share_the_noise_unless_they_have_their_own() -> None:
    same = [{"n.resting_level": -1.0}] * 4
    shared, separate = run(dd.Points(same)), run(dd.Points(same, own_noise=True))
    assert (shared == shared[0]).all()
    assert all((separate[a] != separate[b]).any() for a in range(4) for b in range(a))
    np.testing.assert_allclose(separate[0], shared[0], atol=1e-12)


def test_the_noise_of_points_is_independent() -> None:
    points = [{"n.resting_level": 0.0}] * 400
    record = dd.simulate(
        node(1.0), 30, record="n.activation", sweep=dd.Points(points, own_noise=True), trials=2
    )
    end = record["n.activation"].values[:, :, -1]
    spread = end - end.mean(0)
    between = np.corrcoef(np.column_stack([spread[:-1], spread[1:]]).T)
    # four standard errors of a correlation of 399 pairs
    assert np.abs(between - np.eye(4)).max() < 4 / np.sqrt(399)


def test_a_file_holds_the_points_and_is_run_again(tmp_path: Path) -> None:
    place = tmp_path / "run.zarr"
    options = {"record": "n.activation", "sweep": OWN, "trials": 2, "on": dd.Resources(batch=4)}
    written = dd.simulate(node(), 20, out=place, **options)  # type: ignore[arg-type]
    memory = dd.simulate(node(), 20, **options)  # type: ignore[arg-type]
    assert written["n.activation"].dims == ("point", "trial", "time")
    for name in ("n.activation", "point", *POINTS[0]):
        assert (written[name].values == memory[name].values).all(), name
    model, settings = repeat.request(written)
    assert settings["sweep"] == OWN
    record = dd.simulate(model, **settings)
    assert (record["n.activation"].values == memory["n.activation"].values).all()


def test_workers_share_the_points(tmp_path: Path) -> None:
    alone = run(OWN, 2, batch=4)
    divided = run(OWN, 2, batch=4, workers=2)
    assert (alone == divided).all()
    place = tmp_path / "run.zarr"
    on = dd.Resources(workers=2, batch=4)
    record = dd.simulate(
        node(), 20, record="n.activation", trials=2, sweep=OWN, precision="float64", out=place, on=on
    )
    assert (record["n.activation"].values == alone).all()
    assert record["s.amplitude"].values.tolist() == [point["s.amplitude"] for point in POINTS]


def test_a_point_that_diverges_is_named_by_its_number() -> None:
    model = dd.Model("diverges")
    model.add(dd.Field("n", tau=10, noise=0.0, kernel=[], sigmoid=dd.SemiLinear(slope=1.0)))
    model.add(dd.Gain(1.0, name="g"))
    model["n"] >> model["g"] >> model["n"]
    with pytest.warns(RunWarning, match="1 of 3 copies"):
        record = dd.simulate(
            model, 4000, record="n.activation", every=100,
            sweep=[{"n.resting_level": 1.0, "g.factor": factor} for factor in (0.5, 30.0, 0.1)],
        )  # fmt: skip
    assert record["diverged"].dims == ("point",)
    assert [bool(text) for text in record["diverged"].values] == [False, True, False]
