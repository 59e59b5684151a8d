"""Experiments on a cluster: rows are those of this process, whatever dies, and every call ends."""

from __future__ import annotations

import csv
import os
import pickle
import re
import signal
import socket
import subprocess
import sys
import time
import types
from pathlib import Path

import pytest
import yaml
from distributed import LocalCluster

from deodar.batch import cluster_task, on_cluster
from deodar.batch import scheduler as schedulers
from deodar.batch.on_cluster import ClusterPool
from deodar.cluster import Cluster, slurm_settings
from deodar.errors import MissingExtra, ParameterError, RecordError, WorkerError
from deodar.experiments import results, row_line
from deodar.recording import provenance, writer_lock
from deodar.resources import Resources
from deodar.session.interrupt import SecondInterrupt
from deodar.worlds.camera import Camera
from tests.deodar.experiments import clustered

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def rows(tmp_path_factory):
    """Return the lines of the experiment, run in this process."""
    folder = tmp_path_factory.mktemp("here") / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("NPROC", "1")
        clustered.small_pieces(patch)
        clustered.experiment().run(folder)
    return clustered.lines(folder)


@pytest.fixture
def pieces(monkeypatch):
    """Cut trials into small pieces, and state one core, as workers do."""
    monkeypatch.setenv("NPROC", "1")
    clustered.small_pieces(monkeypatch)


def _run(folder, cluster, progress=None):
    return clustered.within(
        lambda: clustered.experiment().run(folder, on=Resources(cluster=cluster, progress=progress))
    )


def _paths():
    return os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])


def test_rows_are_the_same_while_workers_are_killed(tmp_path, rows, pieces):
    """First one of the workers is killed, later all of them at once."""
    killed = []

    def watch(progress):
        count = {2: 1, 12: 2}.get(int(progress))
        for worker in clustered.processes()[:count] if count else ():
            worker.kill()
            killed.append(worker.pid)

    _run(tmp_path / "out", "local:2", watch)
    assert len(killed) == 3
    assert clustered.lines(tmp_path / "out") == rows
    assert not clustered.processes(), "the workers have ended"


def test_a_killed_caller_leaves_no_process_and_is_resumed(tmp_path, rows, pieces):
    folder = tmp_path / "out"
    code = (
        "import pytest; from tests.deodar.experiments import clustered\n"
        "with pytest.MonkeyPatch.context() as patch:\n"
        "    clustered.small_pieces(patch); from deodar.resources import Resources\n"
        f"    clustered.experiment().run({str(folder)!r}, on=Resources(cluster='local:1'))"
    )
    caller = subprocess.Popen([sys.executable, "-c", code], env=os.environ | {"PYTHONPATH": _paths()})
    file, end = folder / "trials.jsonl", time.monotonic() + clustered.LIMIT
    while (
        caller.poll() is None
        and time.monotonic() < end
        and not (file.exists() and file.read_bytes().count(b"\n") >= 5)
    ):
        time.sleep(0.002)
    workers = clustered.processes(caller.pid)
    caller.kill()
    caller.wait()
    stored = file.read_bytes().count(b"\n")
    assert 5 <= stored < len(rows) and workers
    _run(folder, "local:1")
    assert clustered.lines(folder) == rows
    assert not any(worker.is_running() for worker in workers)


@pytest.fixture(scope="module")
def scheduler():
    """Return a scheduler in this process, with one worker that has one thread."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("NPROC", "1")
        with _cluster(1) as cluster:
            yield cluster


def _cluster(workers):
    return LocalCluster(
        n_workers=workers,
        threads_per_worker=1,
        host="127.0.0.1",
        dashboard_address="127.0.0.1:0",
        memory_limit=0,
    )


def test_a_scheduler_that_runs_already_is_used_by_its_address(tmp_path, rows, pieces, scheduler):
    _run(tmp_path / "out", scheduler.scheduler_address)
    assert clustered.lines(tmp_path / "out") == rows
    assert len(clustered.processes()) == 1, "its worker still runs"


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("jax", "0.1", "a worker has jax 0.1, and this process jax"),
        ("python", "3.0", "has python 3.0"),
        ("cores", "4", "computes with 4 cores"),
    ],
)
def test_a_worker_that_differs_is_refused_before_the_first_task(
    tmp_path, pieces, scheduler, monkeypatch, name, value, says
):
    real = cluster_task.run
    monkeypatch.setattr(cluster_task, "run", _Disguised({name: value}, real))
    with pytest.raises(WorkerError, match=says.replace("a worker", "the worker tcp://[0-9.:]+")):
        _run(tmp_path / "out", scheduler.scheduler_address)
    assert not (tmp_path / "out" / "trials.jsonl").exists()


class _Disguised:
    """A task whose worker states something else about itself."""

    def __init__(self, about, function):
        self.about, self.function = about, function

    def __call__(self, payload, precision):
        about, result = self.function(payload, precision)
        return {**about, **self.about}, result


def test_workers_of_two_kinds_are_refused_or_named(tmp_path, pieces, monkeypatch):
    first = {"machine": "A", "device": "cpu cpu", "cores": "1"}
    pool = object.__new__(on_cluster.ClusterPool)
    monkeypatch.setattr(on_cluster, "_made_here", lambda precision: {"jax": "1", **first})
    for mixed in (False, True):
        pool.cluster, pool._precision, pool._class = Cluster("local:2", mixed=mixed), "float32", {}
        pool._description, pool._accepted = {}, {}
        pool._accept({"jax": "1", **first}, "a worker")
        if mixed:
            pool._accept({"jax": "1", **first, "machine": "B"}, "a worker")
            assert pool.made_by["machine"] == "mixed"
        else:
            with pytest.raises(WorkerError, match="differ in their machine: 'A' and 'B'"):
                pool._accept({"jax": "1", **first, "machine": "B"}, "a worker")
            assert pool.made_by["machine"] == "A"


def test_rows_of_a_mixed_cluster_name_their_machine(tmp_path, rows, pieces, scheduler):
    table = _run(tmp_path / "out", Cluster(scheduler.scheduler_address, mixed=True))
    machine = provenance.machine()
    assert set(table.machine.values.tolist()) == {machine}
    marked = [row_line.read(line.encode(), True) | {"machine": machine} for line in rows if '"key"' in line]
    lines = [line for line in clustered.lines(tmp_path / "out") if '"key"' in line]
    assert lines == [row_line.write(row, True).decode().strip() for row in marked]
    with pytest.raises(results.DeodarError, match="made_by differ"):
        _run(tmp_path / "out", scheduler.scheduler_address)


DISGUISE = """
from deodar.recording import provenance
provenance.machine = lambda: "another machine"
"""


def test_outcomes_are_compared_on_two_kinds_of_machines(tmp_path, rows, pieces, scheduler):
    (tmp_path / "disguise.py").write_text(DISGUISE)
    command = [sys.executable, "-m", "distributed.cli.dask_worker", scheduler.scheduler_address]
    command += ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--preload", str(tmp_path / "disguise.py")]
    environment = {**os.environ, "NPROC": "1", "PYTHONPATH": _paths()}
    with subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL) as disguised:
        try:
            clustered.within(lambda: scheduler.wait_for_workers(2, timeout=60))
            _run(tmp_path / "out", Cluster(scheduler.scheduler_address, mixed=True))
        finally:
            disguised.terminate()
    with (tmp_path / "out" / "machines.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    assert [row["trial"] for row in table] == ["0", "1"], "the two trials of one piece of twelve"
    kinds = {provenance.machine(), "another machine"}
    assert all({row["machine"], row["other machine"]} == kinds for row in table)
    assert all(row["equal"] == "True" and row["outcome"] == row["other outcome"] for row in table)


def test_no_worker_is_an_error_after_a_while(tmp_path, pieces):
    with _cluster(0) as empty:
        cluster = Cluster(empty.scheduler_address, patience=0.5)
        with pytest.raises(WorkerError, match=r"has had no worker for 0.5 s.*patience=3600"):
            _run(tmp_path / "out", cluster)


def test_no_scheduler_is_an_error(tmp_path, pieces, monkeypatch):
    monkeypatch.setattr(schedulers, "CONNECT_SECONDS", 0.5)
    with pytest.raises(WorkerError, match=r"no scheduler of Dask answers at tcp://127.0.0.1:9"):
        _run(tmp_path / "out", "tcp://127.0.0.1:9")


def test_a_scheduler_of_another_version_is_refused(tmp_path, pieces, scheduler, monkeypatch):
    monkeypatch.setattr(schedulers, "version", lambda: "1.0")
    with pytest.raises(WorkerError, match=r"has distributed [\d.]+, and this process distributed 1.0"):
        _run(tmp_path / "out", scheduler.scheduler_address)


def test_a_task_that_ends_every_worker_is_an_error(monkeypatch):
    monkeypatch.setattr(schedulers, "ALLOWED_FAILURES", 1)

    def call():
        with ClusterPool(Cluster("local:1")) as pool:
            pool.give("bad", os._exit, 3)
            while pool.busy:
                pool.wait(0.2)

    with pytest.raises(WorkerError, match=r"the same task has ended 2 worker processes.*its key is bad"):
        clustered.within(call)


def test_errors_of_tasks_are_raised_and_other_results_are_kept(scheduler):
    with ClusterPool(Cluster(scheduler.scheduler_address)) as pool:
        pool.give("good", sum, [1, 2])
        pool.give("bad", results.load_results, "nowhere")
        out = []
        with pytest.raises(RecordError, match="is not the folder of an experiment"):
            clustered.within(lambda: _collect(pool, out))
    assert out == [("good", 3)]


def _collect(pool, out):
    while pool.busy:
        out += pool.wait(0.2)
    pool.wait(0)


def test_what_cannot_travel_is_refused(tmp_path, scheduler, monkeypatch):
    setup = clustered.experiment().setup()
    setup.world = Camera(0)
    with pytest.raises(WorkerError, match="Camera is bound to this machine and its clock"):
        results.run_trials(setup, tmp_path / "out", Resources(cluster=scheduler.scheduler_address))
    with pytest.raises(ParameterError, match="workers and cluster exclude each other"):
        clustered.experiment().run(tmp_path / "out", on=Resources(workers=2, cluster="local:2"))
    monkeypatch.setattr(_collect, "__module__", "__main__")
    with pytest.raises(WorkerError, match="_collect is written in the script itself"):
        on_cluster.pickled(_collect, ())


def test_one_caller_at_a_time_writes_into_a_folder(tmp_path, pieces):
    (tmp_path / "out").mkdir()
    with (
        writer_lock.locked(tmp_path / "out"),
        pytest.raises(RecordError, match="is being written by another process"),
    ):
        clustered.experiment().run(tmp_path / "out")


def test_ctrl_c_keeps_what_runs_and_a_second_call_resumes(tmp_path, rows, pieces, scheduler):
    pressed = []

    def watch(progress):
        if progress and not pressed:
            pressed.append(progress)
            os.kill(os.getpid(), signal.SIGINT)

    address = scheduler.scheduler_address
    with pytest.raises(KeyboardInterrupt):
        clustered.experiment().run(tmp_path / "out", on=Resources(cluster=address, progress=watch))
    stored = len(clustered.lines(tmp_path / "out"))
    assert pressed[0] + 1 < stored < len(rows)
    _run(tmp_path / "out", address)
    assert clustered.lines(tmp_path / "out") == rows


def test_a_scheduler_that_dies_is_an_error(tmp_path, rows, pieces, monkeypatch):
    monkeypatch.setattr(on_cluster, "SILENT_SECONDS", 2.0)
    code = (
        "import time\nfrom tests.deodar.experiments.test_cluster import _cluster\n"
        "if __name__ == '__main__':\n"
        "    print(_cluster(1).scheduler_address, flush=True); time.sleep(100)"
    )
    script = tmp_path / "scheduler.py"
    script.write_text(code)
    env = os.environ | {"NPROC": "1", "PYTHONPATH": _paths()}
    process = subprocess.Popen([sys.executable, script], stdout=subprocess.PIPE, text=True, env=env)
    address = process.stdout.readline().strip()

    def watch(progress):
        if progress == 6:
            process.kill()

    with process, pytest.raises(WorkerError, match=r"the scheduler of .* has not answered for 2 s"):
        _run(tmp_path / "out", address, watch)
    _run(tmp_path / "out", "local:1")
    assert clustered.lines(tmp_path / "out") == rows


def test_a_result_that_never_arrives_is_computed_again(scheduler, monkeypatch):
    """As if the worker had died with the result: its future is finished, and nothing comes."""
    monkeypatch.setattr(on_cluster, "FETCH_SECONDS", 0.3)
    real, attempts = ClusterPool._follow, []

    async def follow(self, key, attempt, future):
        attempts.append(attempt)
        if attempt:
            await real(self, key, attempt, future)

    monkeypatch.setattr(ClusterPool, "_follow", follow)
    out = []
    with ClusterPool(Cluster(scheduler.scheduler_address)) as pool:
        pool.give("sum", sum, [1, 2])
        clustered.within(lambda: _collect(pool, out))
    assert out == [("sum", 3)] and attempts == [0, 1]


def test_a_result_that_arrives_on_no_attempt_is_an_error(scheduler, monkeypatch):
    monkeypatch.setattr(on_cluster, "FETCH_SECONDS", 0.0)
    monkeypatch.setattr(on_cluster, "CHECK_EVERY", 0.05)
    monkeypatch.setattr(on_cluster, "MOST_ATTEMPTS", 3)

    async def follow(self, key, attempt, future):
        pass

    monkeypatch.setattr(ClusterPool, "_follow", follow)
    with ClusterPool(Cluster(scheduler.scheduler_address)) as pool:
        pool.give("sum", sum, [1, 2])
        with pytest.raises(WorkerError, match="the task sum was submitted 3 times without a result"):
            clustered.within(lambda: _collect(pool, []))


def test_a_second_ctrl_c_ends_at_once(tmp_path, rows, pieces, scheduler):
    def watch(progress):
        if progress:
            os.kill(os.getpid(), signal.SIGINT)
            os.kill(os.getpid(), signal.SIGINT)

    address = scheduler.scheduler_address
    with pytest.raises(SecondInterrupt):
        clustered.experiment().run(tmp_path / "out", on=Resources(cluster=address, progress=watch))
    assert len(clustered.lines(tmp_path / "out")) == 3, "the header and the first piece"
    _run(tmp_path / "out", address)
    assert clustered.lines(tmp_path / "out") == rows


def test_workers_of_several_threads_are_refused(tmp_path, pieces):
    with (
        LocalCluster(
            n_workers=1,
            threads_per_worker=2,
            processes=False,
            protocol="tcp",
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
        ) as wide,
        pytest.raises(WorkerError, match=r"workers have several threads: \S+ \(2\). Start them with one"),
    ):
        _run(tmp_path / "out", wide.scheduler_address)


def test_code_that_a_worker_cannot_import_is_an_error(monkeypatch):
    module = types.ModuleType("only_here")
    exec("def one():\n    return 1", module.__dict__)
    monkeypatch.setitem(sys.modules, "only_here", module)
    payload = on_cluster.pickled(module.one, ())
    monkeypatch.delitem(sys.modules, "only_here")
    good, error = pickle.loads(cluster_task.run(payload, "float32")[1])
    assert not good and isinstance(error, WorkerError)
    assert "a worker cannot import what the task needs (ModuleNotFoundError: No module named 'only" in str(
        error
    )


def test_records_need_a_folder_that_every_worker_sees(tmp_path, monkeypatch):
    (tmp_path / "experiment.json").write_text("{}")
    elsewhere = types.SimpleNamespace(everywhere=lambda function, file, content: [True, False])
    with pytest.raises(WorkerError, match="a worker does not see the folder of the results"):
        results._require_shared(elsewhere, tmp_path)
    client = types.SimpleNamespace(everywhere=lambda function, *arguments: [function(*arguments)])
    results._require_shared(client, tmp_path)
    assert not results._sees(tmp_path / "none", b"")


# ------------------------------------------------------------------------------------------------- addresses


@pytest.mark.parametrize(
    ("address", "says"),
    [
        ("local:0", "states no number of processes"),
        ("slurm:", "names no file"),
        ("machine", "is not the address of a cluster. Write local:N"),
        ("tcp://host:99999", "is not the address of a cluster"),
        ("tcp://10.0.0.5:8786", "leads beyond this machine, without encryption.*trust_network=True"),
        ("slurm:jobs.yaml", "the workers of SLURM are beyond this machine"),
    ],
)
def test_an_address_that_is_wrong_or_not_trusted_is_refused(address, says):
    with pytest.raises((ParameterError, WorkerError), match=says):
        Cluster(address)


def test_encrypted_and_trusted_addresses_are_accepted():
    assert Cluster("tls://10.0.0.5:8786").processes == 0
    assert Cluster("tcp://10.0.0.5:8786", trust_network=True).file is None
    assert Cluster("tcp://127.0.0.1:8786").address and Cluster("local:3").processes == 3


SLURM = """\
jobs: 20
queue: normal
account: fields
cores: 8
memory: 16GB
walltime: "04:00:00"
job_script_prologue:
  - source ~/venv/bin/activate
"""


def test_a_job_of_slurm_has_a_process_for_each_core(tmp_path):
    (tmp_path / "jobs.yaml").write_text(SLURM)
    script = clustered.slurm_script(tmp_path / "jobs.yaml")
    for line in (
        "#SBATCH -p normal",
        "#SBATCH -A fields",
        "#SBATCH --cpus-per-task=8",
        "#SBATCH --mem=15G",
        "#SBATCH -t 04:00:00",
        "source ~/venv/bin/activate",
        "export NPROC=1",
    ):
        assert line in script.splitlines()
    assert "--nworkers 8" in script and "--nthreads 1 " in script and "--no-dashboard" in script


def test_pages_of_dask_are_for_this_machine_unless_the_file_says_otherwise(tmp_path):
    settings, _ = slurm_settings({}, "jobs.yaml")
    assert settings["scheduler_options"] == {"dashboard_address": "127.0.0.1:0"}
    defaults = {"scheduler_options": {"dashboard_address": ":8787", "port": 8786}}
    assert slurm_settings(defaults, "jobs.yaml")[0]["scheduler_options"] == defaults["scheduler_options"]


def test_the_file_of_slurm_on_the_page_is_read():
    page = (ROOT / "docs" / "many-machines.md").read_text(encoding="utf-8")
    [text] = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    settings, jobs = slurm_settings(yaml.safe_load(text), "the page")
    assert jobs == 20 and settings["cores"] == settings["processes"] == 8
    assert settings["job_script_prologue"] == ["source ~/venv/bin/activate", "export NPROC=1"]


def test_the_library_of_slurm_is_opened_in_a_thread_and_keeps_ctrl_c(tmp_path):
    (tmp_path / "jobs.yaml").write_text(SLURM)
    code = (
        "import signal, threading\n"
        "from pathlib import Path\n"
        "from tests.deodar.experiments.clustered import slurm_script\n"
        f"file = Path({str(tmp_path / 'jobs.yaml')!r})\n"
        "one = threading.Thread(target=lambda: print(slurm_script(file)))\n"
        "one.start()\n"
        "one.join()\n"
        "assert signal.getsignal(signal.SIGINT) is signal.default_int_handler\n"
        "signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
        "assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"PYTHONPATH": _paths()},
    )
    assert (done.returncode, done.stderr) == (0, "") and "#SBATCH -p normal" in done.stdout


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("- 1", "holds no table of settings"),
        ("jobs: 0", "jobs is 0; expected a whole number, at least 1"),
        ("{cores: 8, processes: 2}", "each of the 8 cores is a process"),
        ("{queue: [", "cannot be read"),
        ("job_script_prologue: source me", "job_script_prologue is 'source me'; expected a list"),
        ("scheduler_options: 8787", "scheduler_options is 8787; expected a table"),
    ],
)
def test_a_wrong_file_of_slurm_is_refused(tmp_path, text, says):
    (tmp_path / "jobs.yaml").write_text(text)
    with pytest.raises(ParameterError, match=says):
        clustered.slurm_script(tmp_path / "jobs.yaml")


def test_without_the_extra_an_error_says_what_to_install(monkeypatch):
    for name, package in (("distributed", "distributed"), ("dask_jobqueue.slurm", "dask-jobqueue")):
        with monkeypatch.context() as patch:
            patch.setitem(sys.modules, name, None)
            with pytest.raises(MissingExtra, match=rf"{package}.*pip install 'deodar\[cluster\]'"):
                clustered.slurm_script(Path("none.yaml"))


# ---------------------------------------------------------------------------------------------------- watched


def test_a_run_on_a_cluster_is_watched_and_stopped(tmp_path, rows, pieces):
    """Who watches sees the workers come, and ends them without waiting for their pieces."""
    seen = []

    def watch(standing):
        seen.append(standing)
        return standing.running > 0

    setup, before = clustered.experiment().setup(), clustered.processes()
    with pytest.raises(KeyboardInterrupt):
        clustered.within(
            lambda: results.run_trials(setup, tmp_path / "out", Resources(cluster="local:2"), watch=watch)
        )
    assert seen[0].running == 0, "who watches is called before the first piece"
    assert (seen[-1].workers, seen[-1].running) == (2, 4)
    assert clustered.processes() == before, "its workers have ended"
    _run(tmp_path / "out", "local:2")
    assert clustered.lines(tmp_path / "out") == rows


def test_the_search_for_a_scheduler_can_be_stopped():
    calls = []

    def watch(standing):
        calls.append(standing)
        return len(calls) > 3

    with socket.socket() as taken:  # bound, but nothing listens
        taken.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{taken.getsockname()[1]}"
        with pytest.raises(KeyboardInterrupt), ClusterPool(Cluster(address), watch=watch):
            pass
    assert len(calls) == 4


def test_a_search_without_a_scheduler_ends_with_an_error(monkeypatch):
    monkeypatch.setattr(schedulers, "CONNECT_SECONDS", 0.3)
    with (
        pytest.raises(WorkerError, match=r"no scheduler of Dask answers at tcp://127\.0\.0\.1:9 \("),
        ClusterPool(Cluster("tcp://127.0.0.1:9"), watch=lambda standing: False),
    ):
        pass


def test_the_wait_for_a_first_worker_can_be_stopped():
    end = time.monotonic() + 1
    with _cluster(0) as empty:
        patient = Cluster(empty.scheduler_address, patience=3600)
        with (
            pytest.raises(KeyboardInterrupt),
            ClusterPool(patient, watch=lambda standing: time.monotonic() > end),
        ):
            pass
    assert time.monotonic() - end < clustered.LIMIT
