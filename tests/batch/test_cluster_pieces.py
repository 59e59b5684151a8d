"""Large batches on a cluster: the same bits as in pieces here, in memory and in a file."""

from __future__ import annotations

import numpy as np
import pytest
import xarray
from distributed import LocalCluster

import deodar as dd
from deodar.batch import cluster_pieces
from deodar.batch.cluster import Cluster
from deodar.errors import ParameterError, RunWarning, WorkerError
from deodar.worlds.camera import Camera
from tests.batch import test_diverged
from tests.experiments.robots import decider


@pytest.fixture(scope="module")
def address():
    """Return the address of a scheduler with one worker."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("NPROC", "1")
        with LocalCluster(
            n_workers=1,
            threads_per_worker=1,
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            memory_limit=0,
        ) as made:
            yield made.scheduler_address


@pytest.fixture(autouse=True)
def one_core(monkeypatch):
    """State one core, as workers do."""
    monkeypatch.setenv("NPROC", "1")


def simulated(model=None, **given):
    asked = {"record": ["u.activation"], "every": 10, "trials": 7, "batch": 2}
    return dd.simulate(decider() if model is None else model, 100, progress=False, **asked | given)


def test_a_batch_on_a_cluster_has_the_same_bits(address):
    xarray.testing.assert_identical(
        simulated().drop_attrs(deep=False), simulated(cluster=address).drop_attrs(deep=False)
    )


def test_a_record_is_written_by_the_caller(tmp_path, address):
    written = simulated(cluster=address, out=tmp_path / "there.zarr", snapshots=10.0)
    here = simulated(out=tmp_path / "here.zarr")
    np.testing.assert_array_equal(written["u.activation"].values, here["u.activation"].values)
    assert written.sizes["trial"] == 7


def test_copies_that_diverge_are_named(tmp_path, address):
    given = {"sweep": {"g.factor": [0.1, 1e6, 0.3]}, "trials": None, "batch": 2}
    for out in (None, tmp_path / "there.zarr"):
        with pytest.warns(RunWarning, match="1 of 3 copies are NaN"):
            data = simulated(test_diverged.model(), cluster=address, out=out, **given)
        assert (data.diverged.values != "").tolist() == [False, True, False]
        assert np.isnan(data["u.activation"].values[1]).all()
        assert np.isfinite(data["u.activation"].values[::2]).all()


def test_what_a_cluster_cannot_compute_is_refused(address):
    with pytest.raises(ParameterError, match="workers and cluster exclude each other"):
        simulated(workers=2, cluster=address)
    with pytest.raises(ParameterError, match="devices and cluster exclude each other"):
        simulated(devices=2, cluster=address)
    with pytest.raises(WorkerError, match="a record states one machine"):
        simulated(cluster=Cluster(address, mixed=True))
    with pytest.raises(WorkerError, match="Camera is bound to this machine"):
        cluster_pieces.run(Cluster(address), decider(), Camera(0), [], None, int)
