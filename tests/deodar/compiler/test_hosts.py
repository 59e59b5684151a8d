"""One model over the devices of two hosts: two processes of this computer with two devices each."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Generator, Sequence
from pathlib import Path

import jax
import numpy as np
import pytest

import deodar as dd
from deodar.compiler import host_link, hosts
from deodar.compiler.host_link import HostLinks
from deodar.compiler.host_meeting import meet
from deodar.errors import HostsError, ParameterError, UnknownName
from deodar.recording.record import about
from tests import host_devices
from tests.deodar.compiler.meeting import free_port

LIMIT = 300.0
"""Seconds after which a process of a test is ended."""


VALUES = """
import sys, numpy as np, deodar as dd
from deodar.batch.run_file import RunOutput
from deodar.errors import (
    DeviceError, HostsError, NotFinite, OutputError, OutputExists, UnknownName, WorkerError
)
from deodar.recording.record import about
from tests.deodar.compiler.test_shard import plane, volume

host, port, folder = int(sys.argv[1]), sys.argv[2], sys.argv[3]
if host >= 0:
    dd.join_hosts("127.0.0.1:" + port, 2, host, timeout=100)

def full(self):
    raise OutputError("full")

def line(tau=20.0, **given):
    made = dd.Model("line")
    x = dd.Axis("x", 0, 40, samples=41)
    kernel = [dd.Gaussian(12, 3, normalized=True)]
    u = made.add(dd.Field("u", [x], kernel=kernel, global_inhibition=0.02, noise=1.0, tau=tau, **given))
    made.add(dd.GaussianStimulus("place", [x], center=20, sigma=3, amplitude=6)) >> u
    return made

def values(made, devices="all", workers=None, batch=None, **given):
    given = {"record": ["u"], "every": 20, **given}
    data = dd.simulate(made, 60, on=dd.Resources(None, devices, workers, batch=batch), **given)
    return data["u.activation"].values if "u.activation" in data else data.attrs

found = {
    "trials": values(line(), trials=6, precision="float64"),
    "few": values(line(), trials=3),
    "points": values(line(), sweep={"u.tau": [10.0, 15.0, 20.0, 25.0]}, trials=2),
    "pieces": values(line(), trials=8, batch=4),
    "waves": values(volume()),
    "halo": values(plane(1.0, "zero")),
    "noise": values(volume(kernel=[], noise=1.0, global_inhibition=0.0)),
}
found["alone"] = values(line(), trials=6, precision="float64", devices=None)
session = dd.Session(volume(), seed=3, on=dd.Resources(devices="all"))
session.run(10)
kept = session.snapshot()
session.inject("u", 2.0, 2)
session.set("u.resting_level", -4.0)
session.run(5)
found["session"] = session.read("u")
session.restore(kept)
found["restored"] = session.read("u")
np.savez(f"{folder}/found{host}.npz", **found)

if host >= 0:
    def fails(kind, text, call):
        try:
            call()
        except kind as error:
            assert text in str(error), error
        else:
            raise AssertionError(text)

    out = values(volume(), out=dd.Output(f"{folder}/night.zarr", snapshots=20.0))
    if host == 0:
        assert np.array_equal(out, found["waves"])
        made_by = about(dd.open_record(f"{folder}/night.zarr"))["made_by"]
        assert (made_by["devices"], made_by["hosts"]) == ("4", "2"), made_by
    else:
        assert out == {"written_by": "host 0", "out": f"{folder}/night.zarr"}, out
    # the script continues after errors of all hosts, and after an error of one
    fails(NotFinite, "step", lambda: values(volume(kernel=[dd.Gaussian(1e38, 3.0)])))
    fails(HostsError, "hosts 0 and 1 differ in the model", lambda: values(line(tau=15.0 + host), trials=4))
    fails(HostsError, "differ in the arguments of simulate", lambda: values(line(), trials=4, seed=host))
    kind, text = (UnknownName, "missing") if host else (HostsError, "host 1 has ended the run: UnknownName")
    fails(kind, text, lambda: values(line(), trials=4, record=["missing"] if host else ["u"]))
    kind, text = (HostsError, "host 0 has ended the run: OutputExists") if host else (OutputExists, "night")
    fails(kind, text, lambda: values(volume(), out=f"{folder}/night.zarr"))
    if host == 0:
        close, RunOutput.close = RunOutput.close, full
    kind, text = (HostsError, "host 0 has ended the run: OutputError") if host else (OutputError, "full")
    fails(kind, text, lambda: values(line(), trials=4, out=f"{folder}/full.zarr"))
    if host == 0:
        RunOutput.close = close
    fails(DeviceError, "Type a multiple of 2 up to 4", lambda: values(line(), trials=4, devices=3))
    fails(HostsError, "a world on 2 hosts", lambda: values(line(), trials=4, world=dd.Arena("blocks")))
    fails(WorkerError, "worker processes", lambda: values(line(), trials=4, workers=2))
    fails(HostsError, "resuming a run on 2 hosts", lambda: dd.resume(f"{folder}/night.zarr", 80))
    fails(HostsError, "the record of a session", lambda: session.record(f"{folder}/no.zarr", ["u"]))
    calls = [lambda: session.run(5 + host), lambda: session.inject("u", 1.0 + host)]
    session.run(5)
    fails(HostsError, "differ in the calls of the session", calls[0])
    fails(HostsError, "differ in what is injected", calls[1])
    session.set("u.tau", 30.0 + host)
    fails(HostsError, "differ in the calls of the session", session.step)
    fails(HostsError, "follows the wall clock", lambda: session.run_live(5))
    fails(HostsError, "joined already", lambda: dd.join_hosts("127.0.0.1:" + port, 2, host))
    alone = dd.simulate(line(), 20 + host)
    assert alone.sizes["time"] == 1
    assert np.array_equal(values(line(), trials=3), found["few"])
    # its arrays lie on one device of each host, which no program has connected
    some = dd.Session(volume(), seed=3, on=dd.Resources(devices=2))
    start = some.snapshot()
    some.run(5)
    some.restore(start)
print("good")
"""

ENDING = """
import os, signal, sys, deodar as dd
from deodar.compiler import host_link, hosts
from deodar.errors import HostsError, Interrupted
from tests.deodar.compiler.test_shard import plane

host, port, how, trials = int(sys.argv[1]), sys.argv[2], sys.argv[3], int(sys.argv[4])
host_link.SILENT, host_link.STUCK = 3.0, 1.0
dd.join_hosts("127.0.0.1:" + port, 2, host, timeout=100)
made = plane(1.0, "zero", (24, 8) if trials else (96, 40))

def end(across=True):
    print("now", flush=True)
    os.kill(os.getpid(), getattr(signal, how))

def shown(done):
    if host and done > 1000 and trials:
        end()
    elif host and not trials:
        # after the exchange before the next chunk, so that the other host waits in the program
        hosts.calling = end

try:
    given = {"record": ["u"], "every": 100.0, "out": sys.argv[5]} if how == "SIGINT" else {}
    dd.simulate(made, 1e8, trials=trials or None, on=dd.Resources(devices="all", progress=shown), **given)
except (HostsError, Interrupted) as error:
    print(type(error).__name__, error)
"""


SESSION = """
import sys, deodar as dd
from deodar.errors import HostsError
from deodar.session import run
from tests.deodar.compiler.test_shard import volume

class Broken:
    left = 6

    def perf_counter(self):
        self.left -= 1
        if not self.left:
            raise OSError("the disk is gone")
        return 0.001 * self.left

host, port = int(sys.argv[1]), sys.argv[2]
dd.join_hosts("127.0.0.1:" + port, 2, host, timeout=100)
session = dd.Session(volume(), on=dd.Resources(devices="all"))
session.run(10)
if host:
    run.time = Broken()
try:
    session.run(1e8)
except (HostsError, OSError) as error:
    print(type(error).__name__, error)
"""


JOINING = """
import sys, deodar as dd
from deodar.compiler import host_link

host_link.STUCK = 1.0
dd.join_hosts("127.0.0.1:" + sys.argv[2], 2, int(sys.argv[1]), timeout=5)
"""


INTRUDED = """
import socket, subprocess, sys, time, deodar as dd
from deodar.compiler import hosts
from deodar.errors import HostsError

intruder = '''
import socket, sys
host, port = sys.argv[1].split()
link = socket.create_connection((host, int(port)), 60)
print("connected", flush=True)
link.recv(1)
'''
connects = hosts._meet_on_devices

def connects_never(devices):
    time.sleep(600)

def connects_with_another(devices):
    process = subprocess.Popen(
        [sys.executable, "-c", intruder, hosts._joined[0].gloo.address], stdout=subprocess.PIPE
    )
    assert process.stdout.readline() == b"connected\\n"
    connects(devices)

if sys.argv[1] == "1":
    hosts._meet_on_devices = globals()[sys.argv[3]]
hosts.LOOK = 1.0
socket.setdefaulttimeout(3.0)  # as a script may do; the connections of the hosts last longer
try:
    dd.join_hosts("127.0.0.1:" + sys.argv[2], 2, int(sys.argv[1]), timeout=float(sys.argv[4]))
except HostsError as error:
    print(error)
"""


@pytest.fixture(autouse=True)
def states(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the hosts of a test have a key of their own."""
    monkeypatch.setenv("DEODAR_STATE", str(tmp_path / "state"))


def started(
    script: str, host: int, devices: int, *arguments: str, **environment: str
) -> subprocess.Popen[str]:
    """Start a script as one host."""
    environment = {**os.environ, "XLA_FLAGS": host_devices.flags(devices), "NPROC": "1", **environment}
    command = [sys.executable, "-c", script, str(host), *arguments]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment
    )


def ended(processes: Sequence[subprocess.Popen[str]]) -> list[tuple[int, str, str]]:
    """Return status and output of processes, none of which outlives the limit."""
    try:
        texts = [process.communicate(timeout=LIMIT) for process in processes]
    finally:
        for process in processes:
            process.kill()
    return [(process.returncode, *text) for process, text in zip(processes, texts, strict=True)]


def test_two_hosts_compute_what_one_computes(tmp_path: Path) -> None:
    port = free_port()
    processes = [started(VALUES, host, 2, port, str(tmp_path)) for host in (1, 0)]
    for status, out, err in (*ended(processes), *ended([started(VALUES, -1, 4, port, str(tmp_path))])):
        assert (status, out) == (0, "good\n"), err
    first, second, alone = (np.load(tmp_path / f"found{k}.npz") for k in (0, 1, -1))
    assert first["trials"].tobytes() == alone["alone"].tobytes() == first["alone"].tobytes()
    for name in alone:
        assert first[name].tobytes() == second[name].tobytes(), name
        assert np.abs(alone[name]).max() > 0.1, name
        if name in ("waves", "halo", "session", "restored"):
            assert np.abs(first[name] - alone[name]).max() < 1e-4, name
        else:
            assert first[name].tobytes() == alone[name].tobytes(), name


@pytest.mark.parametrize(
    ("signal_name", "status", "text"),
    [("SIGKILL", -9, "HostsError host 1 has ended"), ("SIGINT", 0, "Interrupted stopped at")],
)
def test_the_end_of_one_host_is_an_error_on_the_other(
    signal_name: str, status: int, text: str, tmp_path: Path
) -> None:
    port, out = free_port(), str(tmp_path / "night.zarr")
    second, first = ended([started(ENDING, host, 2, port, signal_name, "4", out) for host in (1, 0)])
    assert first[0] == 0 and first[1].startswith(text), first[2]
    assert second[0] == status, second[2]
    if signal_name == "SIGINT":
        record = dd.open_record(out)
        assert about(record)["complete"] is False and record.sizes["time"] > 10


@pytest.mark.parametrize(("signal_name", "seconds"), [("SIGKILL", 1.0), ("SIGSTOP", 3.0)])
def test_a_divided_field_of_which_a_host_ends_or_stops_ends_on_the_others(
    signal_name: str, seconds: float
) -> None:
    port = free_port()
    second, first = (started(ENDING, host, 2, port, signal_name, "0") for host in (1, 0))
    try:
        assert second.stdout is not None and second.stdout.readline() == "now\n"
        began = time.monotonic()
        _, err = first.communicate(timeout=LIMIT)
        taken = time.monotonic() - began
    finally:
        second.kill()
        first.kill()
        second.communicate()
    assert first.returncode == 1, err
    assert err.splitlines()[-1] == "deodar: host 1 has ended, so this process ends", err
    assert taken < seconds + 4 * host_link.BEAT


def test_an_error_of_one_host_ends_the_session_of_the_others_with_its_reason() -> None:
    port = free_port()
    second, first = ended([started(SESSION, host, 2, port) for host in (1, 0)])
    assert second[:2] == (0, "OSError the disk is gone\n"), second[2]
    assert first[1].startswith("HostsError host 1 has ended the run: OSError: the disk is gone"), first[2]


def test_the_command_runs_on_the_hosts_of_slurm_and_the_first_one_writes(tmp_path: Path) -> None:
    port = free_port()
    command = ["run", "example:selection", "--duration", "20", "--trials", "4", "--devices", "all"]
    command += ["--precision", "float64", "--hosts", "auto", "--out", str(tmp_path / "night"), "--json"]
    environment = {
        "SLURM_JOB_ID": "7",
        "SLURM_STEP_NODELIST": "127.0.0.1",
        "SLURM_NTASKS": "2",
        "JAX_COORDINATOR_PORT": port,
        "PYTHONWARNINGS": "ignore",
    }
    processes = [
        started(
            "import sys; from deodar.cli import main; sys.exit(main(sys.argv[2:]))",
            host,
            2,
            *command,
            **environment,
            SLURM_PROCID=str(host),
            SLURM_LOCALID=str(host),
        )
        for host in (1, 0)
    ]
    second, first = ended(processes)
    assert first[0] == second[0] == 0, first[2] + second[2]
    assert json.loads(first[1])["complete"] is True and second[1] == ""
    record = dd.open_record(tmp_path / "night")
    assert record.sizes["trial"] == 4
    alone = dd.simulate(dd.load("example:selection"), 20, trials=4, precision="float64")
    for name in alone.data_vars:
        assert np.abs(record[name].values - alone[name].values).max() < 1e-10, name


@contextlib.contextmanager
def linked(timeout: float = 5.0, count: int = 2) -> Generator[list[HostLinks]]:
    """Link hosts in this process."""
    address, found = f"127.0.0.1:{free_port()}", dict[int, HostLinks]()

    def host(k: int) -> None:
        found[k] = meet(address, count, k, timeout)
        found[k].begin()

    threads = [threading.Thread(target=host, args=(k,)) for k in reversed(range(count))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    try:
        yield [found[k] for k in range(count)]
    finally:
        for links in found.values():
            links.close()


def at_once(links: Sequence[HostLinks], *messages: tuple[str, object]) -> list[object]:
    """Return what an exchange gives each host, or the text of its error."""
    answers: list[object] = [None] * len(links)

    def host(k: int) -> None:
        try:
            answers[k] = links[k].exchange(*messages[k])
        except HostsError as error:
            answers[k] = str(error)

    threads = [threading.Thread(target=host, args=(k,)) for k in range(len(messages))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return answers


def test_hosts_exchange_what_they_say() -> None:
    with linked() as links:
        assert at_once(links, ("a", 1), ("a", [2.5, "x"])) == [[1, [2.5, "x"]]] * 2
        first, second = at_once(links, ("a", 1), ("b", 1))
        assert str(first).startswith("host 1 is at 'b' of its script, host 0 at 'a'")
        assert str(second).startswith("host 0 is at 'a' of its script, host 1 at 'b'")
        assert at_once(links, ("a", 1), ("a", 2)) == [[1, 2]] * 2


@pytest.mark.parametrize("leaving", [0, 1])
def test_a_host_that_leaves_a_run_ends_it_on_the_others_which_may_begin_another(leaving: int) -> None:
    with linked() as links:
        links[leaving].leave("OutputError: full")
        [answer] = at_once([links[1 - leaving]], ("a", 1))
        assert str(answer).startswith(f"host {leaving} has ended the run: OutputError: full")
        assert at_once(links, ("c", 1), ("c", 2)) == [[1, 2]] * 2


@pytest.mark.parametrize("index", [0, 1])
def test_an_error_of_a_run_on_a_device_of_one_host_concerns_no_other(
    index: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    with linked() as links:
        monkeypatch.setattr(hosts, "_joined", [links[index]])
        with pytest.raises(UnknownName):
            model = dd.load("example:selection")
            dd.simulate(model, 1, record=["missing"], on=dd.Resources(device="cpu:0", devices=1))
        assert not links[index].failed
        assert at_once(links, ("a", 1), ("a", 2)) == [[1, 2]] * 2


def test_a_host_that_does_not_answer_is_named_on_all_hosts() -> None:
    with linked(1.0, 3) as links:
        first, second = at_once(links[:2], ("a", 1), ("a", 1))
        assert str(first).startswith("a: host 2 has not answered for 1 s")
        assert second == first
        assert at_once(links[2:], ("a", 1)) == [first], "it finds that it comes too late"
        assert at_once(links, ("b", 1), ("b", 2), ("b", 3)) == [[1, 2, 3]] * 3


def test_a_first_host_that_does_not_answer_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(host_link, "GRACE", 0.1)
    with linked(1.0) as links:
        [answer] = at_once(links[1:], ("a", 1))
        assert str(answer).startswith("a: host 0 has not answered for 1 s")


@pytest.mark.parametrize("ending", [0, 1])
def test_a_host_whose_links_end_is_named_at_once(ending: int) -> None:
    with linked() as links:
        links[ending].close()
        [answer] = at_once([links[1 - ending]], ("a", 1))
        assert str(answer).startswith(f"host {ending} has ended")


@pytest.mark.parametrize("content", [b"[1]", b"no JSON", b'{"lost": "x"}'])
def test_a_host_that_says_what_no_host_says_is_lost(content: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    """The thread that reads its link ends with an error, so no other one reads its next words."""
    errors = list[object]()
    monkeypatch.setattr(threading, "excepthook", errors.append)
    with linked(60.0) as links:
        links[1]._links[0].send(content)  # pyright: ignore[reportPrivateUsage]
        [answer] = at_once([links[0]], ("a", 1))
        assert str(answer).startswith("host 1 has ended")
    assert len(errors) == 1


@pytest.mark.parametrize("ending", [0, 1])
def test_a_host_that_ends_while_jax_starts_ends_the_other_with_its_name(ending: int) -> None:
    port = free_port()
    with tempfile.TemporaryDirectory(dir="/tmp") as folder:  # a short path, which a socket can have
        joining = started(JOINING, 1 - ending, 2, port, TMPDIR=folder)
        meet(f"127.0.0.1:{port}", 2, ending, 60.0).close()
        [(status, _, err)] = ended([joining])
        assert not list(Path(folder).glob("deodar-*"))
    # the first host ends before it has started JAX: then the other one is not yet in a program of JAX
    text = (
        "deodar: host 1 has ended, so this process ends\n"
        if ending
        else f"host 0 has ended. {host_link.CAUSE}\n"
    )
    assert status == 1 and err.endswith(text), err


@pytest.mark.parametrize(
    ("function", "timeout", "text"),
    [
        ("connects_with_another", "60", "a program that is no host has connected with Gloo"),
        ("connects_never", "20", "the devices of the hosts have not connected within 20 s"),
    ],
)
def test_hosts_whose_devices_do_not_connect_with_each_other_alone_end_with_an_error(
    function: str, timeout: str, text: str
) -> None:
    """The program connects while the port of host 1 is open, as a device of another host would."""
    port = free_port()
    for status, out, err in ended([started(INTRUDED, host, 2, port, function, timeout) for host in (1, 0)]):
        assert status == 0, err
        assert out.startswith(text), out + err


def test_an_error_of_jax_at_its_start_closes_the_links(monkeypatch: pytest.MonkeyPatch) -> None:
    def initialize(*_: object, **__: object) -> None:
        raise RuntimeError("no port")

    monkeypatch.setattr(jax.distributed, "initialize", initialize)
    monkeypatch.setattr(jax.config, "update", lambda *_: None)  # pyright: ignore
    monkeypatch.setattr("jax._src.xla_bridge.backends_are_initialized", lambda: False)
    address, links = f"127.0.0.1:{free_port()}", list[HostLinks]()
    thread = threading.Thread(target=lambda: links.append(meet(address, 2, 1, 10.0)))
    thread.start()
    with pytest.raises(HostsError, match="JAX has not started on the hosts: RuntimeError: no port"):
        dd.join_hosts(address, 2, 0, timeout=10)
    thread.join()
    links[0].begin()
    with pytest.raises(HostsError, match="host 0 has ended"):
        links[0].exchange("a", 1)
    links[0].close()
    assert hosts.count() == 1


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("node1", 2, 0), "expected HOST:PORT of the first host"),
        (("node1:7007", 2, 2), "count and index are 2 and 2"),
        (("node1:7007",), "count and index are None and None"),
        (("auto", 2, 0), "count and index need the address"),
    ],
)
def test_arguments_that_are_not_valid_are_named(arguments: tuple[object, ...], text: str) -> None:
    with pytest.raises(ParameterError, match=text):
        dd.join_hosts(*arguments)  # pyright: ignore[reportArgumentType]
    with pytest.raises(HostsError, match=r"Call dd.join_hosts\(...\) before the first run"):
        dd.simulate(dd.load("example:selection"), 1)
        dd.join_hosts("node1:7007", 2, 0)


def test_hosts_are_refused_on_windows_before_they_meet(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    with pytest.raises(HostsError, match=r"hosts cannot join on Windows\. Use Linux"):
        dd.join_hosts("node1:7007", 2, 0)
