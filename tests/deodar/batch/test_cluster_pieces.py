"""Large batches on a cluster: the same bits as in pieces here, in memory and in a file."""

from __future__ import annotations

import numpy as np
import pytest
import xarray
from distributed import LocalCluster

import deodar as dd
from deodar import codec
from deodar.batch import cluster_pieces
from deodar.batch.on_cluster import ClusterPool
from deodar.cli import main
from deodar.cluster import Cluster
from deodar.errors import Interrupted, ParameterError, RecordError, RunWarning, WorkerError
from deodar.recording import provenance, repeat
from deodar.recording.record import about
from deodar.worlds.camera import Camera
from tests.deodar.batch import test_diverged
from tests.deodar.experiments.robots import decider


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
        ) as cluster:
            yield cluster.scheduler_address


@pytest.fixture(autouse=True)
def one_core(monkeypatch):
    """State one core, as workers do."""
    monkeypatch.setenv("NPROC", "1")


def simulated(model=None, out=None, trials=7, sweep=None, **used):
    on = dd.Resources(**{"batch": 2} | used)
    simulated_model = decider() if model is None else model
    return dd.simulate(
        simulated_model, 100, record=["u.activation"], every=10, trials=trials, sweep=sweep, out=out, on=on
    )


def test_a_batch_on_a_cluster_has_the_same_bits(address):
    xarray.testing.assert_identical(
        simulated().drop_attrs(deep=False), simulated(cluster=address).drop_attrs(deep=False)
    )


def test_a_record_is_written_by_the_caller(tmp_path, address):
    written = simulated(cluster=address, out=dd.Output(tmp_path / "there.zarr", snapshots=10.0))
    local = simulated(out=tmp_path / "here.zarr")
    np.testing.assert_array_equal(written["u.activation"].values, local["u.activation"].values)
    assert written.sizes["trial"] == 7


def test_copies_that_diverge_are_named(tmp_path, address):
    options = {"sweep": {"g.factor": [0.1, 1e6, 0.3]}, "trials": None}
    for out in (None, tmp_path / "there.zarr"):
        with pytest.warns(RunWarning, match="1 of 3 copies are NaN"):
            record = simulated(test_diverged.model(), cluster=address, out=out, **options)
        assert (record.diverged.values != "").tolist() == [False, True, False]
        assert np.isnan(record["u.activation"].values[1]).all()
        assert np.isfinite(record["u.activation"].values[::2]).all()


def test_what_a_cluster_cannot_compute_is_refused(address):
    with pytest.raises(ParameterError, match="workers and cluster exclude each other"):
        simulated(workers=2, cluster=address)
    with pytest.raises(ParameterError, match="devices and cluster exclude each other"):
        simulated(devices=2, cluster=address)
    with pytest.raises(WorkerError, match="a record states one machine"):
        simulated(cluster=Cluster(address, mixed=True))
    with pytest.raises(WorkerError, match="Camera is bound to this machine"):
        cluster_pieces.run(Cluster(address), decider(), Camera(0), [], None, int)


# ------------------------------------------------------------------------------------------------ continuing


def stopped(out, after=150, **options):
    """Write a run of four pieces that stops after some of its 400 steps."""

    def progress(done):
        if done >= after:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted):
        simulated(out=dd.Output(out, snapshots=20.0), progress=progress, **options)
    return out


@pytest.mark.parametrize("begun", ["here", "in workers"])
def test_a_stopped_run_continues_on_a_cluster_with_the_same_bits(tmp_path, address, begun):
    options = {} if begun == "here" else {"workers": 2}
    path = stopped(tmp_path / "there.zarr", **options)
    assert np.isnan(dd.open_record(path)["u.activation"].values).any()
    done: list[int] = []
    resumed = dd.resume(path, on=dd.Resources(cluster=address, progress=done.append))
    whole = simulated(out=tmp_path / "here.zarr")
    assert resumed["u.activation"].values.tobytes() == whole["u.activation"].values.tobytes()
    assert about(resumed)["complete"] is True and about(resumed)["workers"] == options.get("workers")
    assert done[-1] == 400  # the missing pieces may all arrive at once, before the first call


def test_a_run_that_began_on_a_cluster_continues_on_new_workers_and_here(tmp_path, address):
    whole = simulated(out=tmp_path / "here.zarr")["u.activation"].values
    for name, options in (("new workers", {"cluster": "local:2"}), ("this process", {})):
        path = stopped(tmp_path / f"{name}.zarr", after=100, cluster=address)
        assert dd.resume(path, on=dd.Resources(**options))["u.activation"].values.tobytes() == whole.tobytes()


def test_only_the_missing_pieces_of_a_run_are_given_to_workers(tmp_path, address, monkeypatch):
    path, tasks = stopped(tmp_path / "there.zarr"), []
    real = ClusterPool.give

    def give(self, key, function, *arguments, **options):
        tasks.append((key, arguments[2].state))
        real(self, key, function, *arguments, **options)

    monkeypatch.setattr(ClusterPool, "give", give)
    dd.resume(path, on=dd.Resources(cluster=address))
    assert [key for key, _ in tasks] == [1, 2, 3]
    assert [state is not None for _, state in tasks] == [True, False, False], "piece 1 has a state"


def test_versions_and_machine_of_the_workers_are_compared_with_the_record(tmp_path, address, monkeypatch):
    with monkeypatch.context() as elsewhere:
        elsewhere.setattr(provenance, "machine", lambda: "a toaster")
        path = stopped(tmp_path / "there.zarr")
    with pytest.raises(RecordError, match=r"machine: a toaster then, .* now"):
        dd.resume(path, on=dd.Resources(cluster=address))
    heard: list[str] = []

    def accept(differences):
        heard.extend(difference.what for difference in differences)
        return True

    assert about(dd.resume(path, accept=accept, on=dd.Resources(cluster=address)))["complete"] is True
    assert heard == ["machine"]
    monkeypatch.setattr(provenance, "cores", lambda: 7)
    path = stopped(tmp_path / "cores.zarr")
    with pytest.raises(RecordError, match="cores: 7 then, 1 now"):
        dd.resume(path, on=dd.Resources(cluster=address))


def test_a_run_in_one_piece_continues_here(tmp_path, monkeypatch):
    monkeypatch.setattr(ClusterPool, "__enter__", lambda self: pytest.fail("no worker is needed"))
    options = {"trials": 2}

    def progress(done):
        if done >= 50:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted):
        simulated(out=tmp_path / "there.zarr", progress=progress, **options)
    resumed = dd.resume(tmp_path / "there.zarr", on=dd.Resources(cluster="local:2"))
    assert resumed["u.activation"].values.tobytes() == simulated(**options)["u.activation"].values.tobytes()


def test_what_a_cluster_cannot_continue_is_refused(tmp_path, address, monkeypatch):
    path = stopped(tmp_path / "there.zarr")
    with pytest.raises(WorkerError, match="a record states one machine"):
        dd.resume(path, on=dd.Resources(cluster=Cluster(address, mixed=True)))
    request = repeat.request
    monkeypatch.setattr(
        repeat,
        "request",
        lambda *arguments: (
            request(*arguments)[0],
            request(*arguments)[1] | {"on": dd.Resources("gpu", batch=2)},
        ),
    )
    with pytest.raises(WorkerError, match="one core each, and the run has device = gpu"):
        dd.resume(path, on=dd.Resources(cluster=address))


def test_the_command_continues_a_run_on_a_cluster(tmp_path, address, capsys):
    path = stopped(tmp_path / "there.zarr")
    assert main(["run", str(path), "--resume", "--cluster", address, "--json"]) == 0
    assert codec.parse(capsys.readouterr().out)["complete"] is True
    whole = simulated(out=tmp_path / "here.zarr")["u.activation"].values
    assert dd.open_record(path)["u.activation"].values.tobytes() == whole.tobytes()
    assert main(["run", str(path), "--resume", "--cluster", "tcp://10.0.0.5:8786"]) == 1
    assert "leads beyond this machine, without encryption" in capsys.readouterr().err
