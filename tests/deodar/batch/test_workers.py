"""Worker processes: the same noise and results for every split; their errors reach the caller."""

from __future__ import annotations

import ctypes
import os
import pickle
import platform
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import jax
import numpy as np
import psutil
import pytest

import deodar as dd
from deodar.batch import pool
from deodar.elements.changing_stimuli import Noise
from deodar.recording.record import about
from deodar.recording.repeat import repeat
from deodar.worlds._base import World

RECORD = ["u.activation", "u.output", "xi.output"]


def small() -> dd.Model:
    model = dd.Model("small")
    u = model.add(
        dd.Field(
            "u",
            [dd.Axis("x", 0, 60, samples=31)],
            tau=10,
            kernel=[dd.Gaussian(1.0, 4)],
            global_inhibition=0.1,
            noise=0.3,
        )
    )
    model.add(dd.GaussianStimulus("s", u.element.axes, center=30, sigma=4, amplitude=8)) >> u
    model.add(Noise("xi", u.element.axes, amplitude=0.2), ticks=2) >> u
    return model


def children() -> list[psutil.Process]:
    """Worker processes of this one."""
    processes = []
    for child in psutil.Process().children():
        try:
            if "spawn_main" in " ".join(child.cmdline()):
                processes.append(child)
        except psutil.NoSuchProcess:
            continue
    return processes


def test_the_results_do_not_depend_on_the_split() -> None:
    model = small()

    def run(**split: int) -> dict[str, np.ndarray]:
        on = dd.Resources(**split)
        record = dd.simulate(model, 60, record=RECORD, every=20, seed=4, trials=5, precision="float64", on=on)
        assert (
            record.sizes["trial"] == 5
            and about(record)["complete"]
            and about(record)["trials"] == [0, 1, 2, 3, 4]
        )
        return {path: record[path].values for path in RECORD}

    whole = run()
    for split in ({"batch": 2}, {"workers": 2}):
        values = run(**split)
        for path in RECORD:
            assert np.abs(values[path] - whole[path]).max() <= 1e-10 * max(1.0, np.abs(whole[path]).max()), (
                split,
                path,
            )
        # the same noise, to the last bit
        assert np.array_equal(values["xi.output"], whole["xi.output"]), split
    assert np.abs(whole["u.activation"][0] - whole["u.activation"][1]).max() > 0.1
    assert not children()


def test_a_sweep_is_split_along_its_longest_entry_and_repeated_to_the_bit() -> None:
    model, sweep = small(), {"s.amplitude": [4.0, 8.0], "u.tau": [10.0, 15.0, 20.0]}
    whole = dd.simulate(model, 40, sweep=sweep, trials=[3, 1])
    split = dd.simulate(model, 40, sweep=sweep, trials=[3, 1], on=dd.Resources(workers=2))
    assert split["u.activation"].dims == whole["u.activation"].dims and split.drop_attrs().coords.identical(
        whole.drop_attrs().coords
    )
    assert np.abs(split["u.activation"] - whole["u.activation"]).max() <= 1e-4
    provenance = about(split)
    assert provenance["batch"] == 8 and provenance["sweep"] == sweep  # pieces of 2 values and of 1, times 4
    assert provenance["workers"] == 2 and provenance["made_by"]["cores"] == "1"
    done = repeat(split, dd.simulate)
    assert done.same_bits and not done.differences


def test_an_incomplete_record_is_compared_with_the_trials_that_it_has() -> None:
    whole = dd.simulate(small(), 50, trials=6, on=dd.Resources(batch=2))
    some = whole.isel(trial=[0, 1, 4, 5])
    some.attrs["deodar"] = some.attrs["deodar"].replace('"complete": true', '"complete": false')
    assert repeat(some, dd.simulate).same_bits
    assert not repeat(some.assign(**{"u.activation": some["u.activation"] + 1}), dd.simulate).same_bits


def test_workers_do_not_run_the_main_script(tmp_path: Path) -> None:
    """A script needs no guard."""
    code = """
import deodar as dd
print("begun", flush=True)
model = dd.Model("m")
model.add(dd.Field("u", [dd.Axis("x", 0, 1, samples=11)], noise=0.1))
print(dd.simulate(model, 10, trials=2, on=dd.Resources(workers=2)).sizes["trial"])
"""
    script = tmp_path / "script.py"
    script.write_text(code)
    done = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, timeout=600, cwd=tmp_path
    )
    assert (done.returncode, done.stdout.split(), done.stderr) == (0, ["begun", "2"], "")


def test_ctrl_c_stops_all_workers_and_returns_the_complete_pieces() -> None:
    # a shell that starts the tests behind it ignores the signal
    model, before = small(), signal.getsignal(signal.SIGINT)

    def press() -> None:
        seen.wait()
        os.kill(os.getpid(), signal.SIGINT)

    seen, presser = threading.Event(), threading.Thread(target=press)
    presser.start()
    steps, most = 20_000, 400

    def watch(done: int) -> None:
        # at least two of the pieces are more than half way, so the first of them soon complete
        if done >= steps:
            seen.set()

    with pytest.raises(dd.errors.Interrupted, match="pieces of the batch were complete") as caught:
        dd.simulate(
            model,
            steps,
            trials=most,
            record=["u.activation"],
            every=steps // 10,
            on=dd.Resources(workers=2, batch=1, progress=watch),
        )
    presser.join()
    record = caught.value.data
    assert (
        1 <= record.sizes["trial"] < most
        and about(record)["complete"] is False
        and about(record)["trials"] == [*range(most)]
    )
    assert not children() and signal.getsignal(signal.SIGINT) is before


def test_a_second_ctrl_c_ends_the_workers_at_once() -> None:
    before = signal.getsignal(signal.SIGINT)

    def watch(done: int) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        dd.simulate(small(), 50_000_000, trials=2, on=dd.Resources(workers=2, progress=watch))
    assert not children() and signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize("ending", ["stops", "fails", "dies"])
def test_no_thread_or_process_of_the_pool_remains_after_the_call(ending: str) -> None:
    """No thread and no process remains that could read a closed pipe, however the run ends."""
    before, seen = set(threading.enumerate()), []

    def watch(done: int) -> None:
        seen.extend(children())
        if ending == "stops":
            raise KeyboardInterrupt
        if ending == "fails":
            raise ValueError("enough")
        seen[0].kill()

    with pytest.raises(
        {"stops": dd.errors.Interrupted, "fails": ValueError, "dies": dd.errors.WorkerError}[ending]
    ):
        dd.simulate(small(), 50_000_000, trials=2, on=dd.Resources(workers=2, progress=watch))
    assert len({child.pid for child in seen}) == 2 and not children() and set(threading.enumerate()) == before


def test_ctrl_c_without_workers_returns_the_complete_pieces() -> None:
    def watch(done: int) -> None:
        if done > 3 * 1000:
            raise KeyboardInterrupt

    with pytest.raises(dd.errors.Interrupted, match="3 of 10 pieces") as caught:
        dd.simulate(small(), 1000, trials=10, on=dd.Resources(batch=1, progress=watch))
    assert caught.value.data["trial"].values.tolist() == [0, 1, 2]


def test_a_worker_that_dies_raises_a_worker_error() -> None:
    def kill() -> None:
        while not (processes := children()):
            time.sleep(0.05)
        processes[0].kill()

    killer = threading.Thread(target=kill)
    killer.start()
    with pytest.raises(dd.errors.WorkerError, match="ended unexpectedly"):
        dd.simulate(small(), 50_000_000, trials=2, on=dd.Resources(workers=2))
    killer.join()
    assert not children()


def test_a_worker_that_has_worked_for_long_is_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    def pids(count: int) -> list[int]:
        processes: list[int] = []
        with pool.Pool(1) as workers:
            for k in range(count):
                workers.give(k, os.getpid)
                while not (done := workers.wait(1.0)):
                    pass
                processes.append(done[0][1])
                assert len(children()) == 1
        return processes

    assert len(set(pids(3))) == 1
    monkeypatch.setattr(pool, "LONGEST", 0.0)
    assert len(set(pids(2))) == 2 and not children()


def page_faults(repetitions: int) -> float:
    """Return the page faults per page of a block of 64 MB that is allocated and freed repeatedly."""
    import resource

    libc, size = ctypes.CDLL(None), 64 * 2**20
    libc.malloc.restype = ctypes.c_void_p
    libc.free.argtypes = [ctypes.c_void_p]
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(repetitions):
        block = libc.malloc(size)
        ctypes.memset(block, 1, size)
        libc.free(block)
    return (resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before) / (size / resource.getpagesize())


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="an option of the GNU C library")
def test_a_worker_uses_the_memory_of_freed_arrays_again() -> None:
    repetitions = 20
    with pool.Pool(1) as workers:
        workers.give(0, page_faults, repetitions)
        while not (done := workers.wait(1.0)):
            pass
    assert 0 < done[0][1] < 0.2 * repetitions, "a block that the system clears has a fault a page each time"


def platforms() -> list[str]:
    """Return the platforms that JAX has started in this process."""
    jax.numpy.zeros(1).block_until_ready()
    return [str(jax.config.jax_platforms), *{device.platform for device in jax.devices()}]


def test_a_worker_leaves_graphics_processors_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("JAX_PLATFORMS", "cuda,cpu")  # would fail here: there is no such platform
    with pool.Pool(1) as workers:
        workers.give(0, platforms)
        while not (done := workers.wait(1.0)):
            pass
    assert done[0][1] == ["cpu", "cpu"]


def test_an_error_in_a_worker_is_raised_unchanged_in_the_caller() -> None:
    model = small()
    model["u"] >> model.add(dd.Gain(1e30, name="g")) >> model.add(dd.Gain(1e30, name="h")) >> model["u"]
    with pytest.raises(dd.errors.NotFinite, match="became infinite") as caught:
        dd.simulate(model, 100, trials=2, on=dd.Resources(workers=2))
    assert caught.value.paths and caught.value.problems[0].fix


class Locked(World):
    """A world that cannot be pickled."""

    def __reduce__(self) -> str:
        raise TypeError("it is bolted to the floor")


class Paired(Exception):
    """An error that is restored only with two arguments."""

    def __init__(self, first: str, second: str) -> None:
        super().__init__(first + second)


def test_an_error_that_cannot_be_restored_is_named() -> None:
    def fail() -> None:
        raise Paired("a", "b")

    success, error = pickle.loads(pool.done(fail, ()))
    assert not success and isinstance(error, dd.errors.WorkerError)
    assert str(error).startswith("the error Paired (ab) of a worker cannot be sent to another process (Type")


def test_a_value_that_cannot_be_pickled_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(dd.errors.WorkerError, match=r"the world Locked cannot be sent .*bolted"):
        dd.simulate(small(), 10, trials=2, world=Locked(), on=dd.Resources(workers=2))
    monkeypatch.setattr(World, "__module__", "__main__")
    with pytest.raises(dd.errors.WorkerError, match="World is written in the script itself"):
        dd.simulate(small(), 10, trials=2, world=World(), on=dd.Resources(workers=2))
    with pytest.raises(dd.errors.ParameterError, match="workers is 0"):
        dd.simulate(small(), 10, trials=2, on=dd.Resources(workers=0))


def test_workers_import_the_modules_of_custom_kinds(tmp_path: Path) -> None:
    """A custom element from a module beside the script works; one in the script itself is refused by its
    name.
    """
    element = """
import dataclasses
from deodar.elements.stimuli import Boost
from deodar.registry import register

@register
@dataclasses.dataclass(frozen=True)
class Lift(Boost):
    "A boost by another name."
"""
    script = """
import deodar as dd
model = dd.Model("m")
model.add(Lift("s", amplitude=2.0)) >> model.add(dd.Field("u", [], noise=0.1))
try:
    print(dd.simulate(model, 10, trials=2, on=dd.Resources(workers=2)).sizes["trial"])
except dd.errors.WorkerError as error:
    print(error)
"""
    (tmp_path / "own.py").write_text(element)
    (tmp_path / "apart.py").write_text("from own import Lift\n" + script)
    (tmp_path / "inside.py").write_text(element + script)
    for name, says in (("apart", "2\n"), ("inside", "Lift is written in the script itself")):
        done = subprocess.run(
            [sys.executable, str(tmp_path / f"{name}.py")],
            capture_output=True,
            text=True,
            timeout=600,
            cwd=tmp_path,
        )
        assert done.stdout.startswith(says), done.stdout + done.stderr


def test_memory_counts_all_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    class Little:
        available = 500 * 2**20

    monkeypatch.setattr(psutil, "virtual_memory", lambda: Little)
    dd.simulate(small(), 5, trials=4, on=dd.Resources(batch=1))
    with pytest.raises(dd.errors.TooLarge, match="fewer workers"):
        dd.simulate(small(), 5, trials=4, on=dd.Resources(workers=4))


def test_a_worker_ends_when_its_parent_is_killed(tmp_path: Path) -> None:
    """A killed process cannot end its workers, so each worker watches it, also during a task."""
    script = tmp_path / "script.py"
    script.write_text(
        "import time\n"
        "from deodar.batch.pool import Pool\n"
        "with Pool(1) as pool:\n"
        "    worker = pool._idle[0].process.pid\n"
        "    pool.give(0, time.sleep, 600)\n"
        "    print(worker, flush=True)\n"
        "    pool.wait(600)\n"
    )
    parent = subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    worker = psutil.Process(int(parent.stdout.readline()))
    parent.kill()
    parent.wait()
    parent.stdout.close()
    ends = time.monotonic() + 60
    while runs(worker) and time.monotonic() < ends:
        time.sleep(0.05)
    assert not runs(worker)


def runs(process: psutil.Process) -> bool:
    """Return whether a process has not ended; an ended one may remain as a zombie."""
    try:
        return process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False
