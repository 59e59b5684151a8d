"""Several hosts that compute one model together: how they join, agree and share what they read.

Each host runs the same script in a process of its own. Arrays of a divided program lie on devices of all
hosts; a host reads them by a gather, which all hosts call. What depends on one host alone (its clock,
Ctrl-C, an error) the hosts exchange before each chunk (`host_link.py`), so that one of them ends the run of
all, instead of leaving the others in a program that waits for it.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import hashlib
import os
import sys
import tempfile
import threading
import time
from collections.abc import Generator, Hashable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import jax
import jax.numpy as jnp
import numpy as np
from jax.experimental import multihost_utils
from jax.extend.backend import register_backend_factory
from jax.sharding import Mesh, NamedSharding, PartitionSpec, Sharding

from deodar import codec
from deodar.compiler import gloo_port
from deodar.compiler.gloo_port import ConnectionEnds, GlooPort
from deodar.compiler.host_link import SILENT, HostLinks, lost_hosts
from deodar.compiler.host_meeting import loopback, meet
from deodar.errors import HostsError, ParameterError, first_line, show

T = TypeVar("T")

TIMEOUT = 60.0
"""Seconds after which a host that does not answer is given up, unless `join_hosts` states another time."""

AUTO = "auto"
"""Address that stands for what SLURM or Open MPI state in the environment."""

SHOWN = 300
"""Longest text of a value that an error shows; longer ones are compared by a hash."""

_joined: list[HostLinks] = []
"""The links to the other hosts; empty on one host."""

LOOK = 5.0
"""Seconds after which hosts compare their connections while a program connects their devices."""

SHORT_PATH = 70
"""Most characters of a folder in which a socket has a path (107 are allowed, 103 on macOS)."""


def join_hosts(
    address: str = AUTO, count: int | None = None, index: int | None = None, timeout: float = TIMEOUT
) -> None:
    """Join the other hosts that run the same script, so that they compute one model together.

    Call it before the first run, on every host, and after `use_cores`. From then on `devices="all"` means the
    devices of all hosts, in `simulate` and in `Session`: every host makes the same calls and gets the same
    values. Without `devices` each host computes alone. Hosts prove to each other that they have one key of
    the user, a file of the folder of states, or the one that `DEODAR_HOSTS_KEY` names; it is made at its
    first use. Messages are not encrypted. With the address 127.0.0.1, for several processes of one machine,
    all hosts listen there alone. On the CPU hosts exchange numbers through TCP (Gloo).

    Args:
        address: `HOST:PORT` of the first host, a port that is free there; `auto`: what SLURM or Open MPI
            state in the environment, also for count and index.
        count: number of hosts.
        index: number of this host, from 0.
        timeout: seconds to wait for the others, at the start and whenever they exchange something.

    Raises:
        HostsError: this is Windows; JAX has started, or cannot start; a host does not come, or has another
            key; versions differ between the hosts; a program that is no host has connected; or devices have
            not connected in time.
        ParameterError: an argument is not valid.
    """
    _require(address, count, index, timeout)
    if sys.platform == "win32":
        # without sockets that have a path, and a list of those of a process
        raise HostsError("hosts cannot join on Windows", fix="Use Linux, or one host")
    if _joined:
        raise HostsError("the hosts have joined already", fix="Call join_hosts once, at the start")
    bridge: Any = sys.modules.get("jax._src.xla_bridge")  # JAX has no public function for this
    if bridge is not None and bridge.backends_are_initialized():
        raise HostsError(
            "JAX has started, and cannot use the devices of other hosts any more",
            fix="Call dd.join_hosts(...) before the first run",
        )
    place_of_host = _of_environment(timeout) if address == AUTO else (address, count or 1, index or 0, None)
    place, number, index_here, local = place_of_host
    if number < 2:
        return
    links = meet(place, number, index_here, timeout)
    links.begin()
    try:
        _start_jax(links, loopback(place.rpartition(":")[0]).strip("[]") or links.address, local)
    except BaseException as error:
        links.failed = True
        started = bool(_joined)
        if started:
            # JAX of the others depends on the first host, which therefore waits for them
            links.end()
            _joined.clear()
        if links.index == 0 or not started:  # else JAX, whose bytes the link carries, would end this process
            links.close()
        if not isinstance(error, Exception) or isinstance(error, HostsError):
            raise
        raise HostsError(
            f"JAX has not started on the hosts: {type(error).__name__}: {first_line(error)}",
            fix="Start the run again on all hosts",
        ) from error


def _start_jax(links: HostLinks, address: str, local: Any) -> None:
    """Start JAX on all hosts, and connect their devices. If a host ends meanwhile, so does this process.

    Args:
        links: the links with the other hosts.
        address: the address of this host for connections of Gloo.
        local: the devices of this process, if the environment states them.
    """
    jax.config.update("jax_cpu_collectives_implementation", "gloo")
    # without it JAX ends this process when another one has ended, before an error can be raised
    jax.config.update("jax_enable_recoverability", True)
    # else SIGTERM, as from scancel, would no longer end this process
    jax.config.update("jax_enable_preemption_service", False)
    # who has found the service of JAX could join or end the run: its socket is of this user alone, and is
    # removed when all hosts have connected
    with tempfile.TemporaryDirectory(prefix="deodar-", dir=_short_folder()) as folder:
        place = Path(folder) / "jax"
        with links.carrying(place):
            links.inside = time.monotonic()
            jax.distributed.initialize(
                f"unix:{place}",
                links.count,
                links.index,
                local_device_ids=local,
                coordinator_bind_address=f"unix:{place}",
                cluster_detection_method="deactivate",
                # longer than the links need to find that a host has ended: then JAX aborts and names none
                initialization_timeout=round(max(links.timeout, 2 * SILENT)),
            )
    links.gloo = _gloo_at(address)
    links.inside = 0.0
    _joined.append(links)
    # registered after that of JAX, so called before it
    atexit.register(links.end)
    connect(jax.devices())


def _short_folder() -> str | None:
    """Return the folder of temporary files, if its path leaves room for the name of a socket."""
    return None if len(tempfile.gettempdir()) < SHORT_PATH else "/tmp"


def _gloo_at(address: str) -> GlooPort:
    """Let Gloo listen at an address of this host, not at the one to which the system resolves its name."""
    bridge: Any = sys.modules["jax._src.xla_bridge"]  # JAX has no public functions for this
    before = gloo_port.listeners(address)
    collectives = bridge._jax.make_gloo_tcp_collectives(
        bridge.distributed.global_state.client, hostname=address
    )
    [number] = gloo_port.listeners(address) - before
    register_backend_factory(
        "cpu", functools.partial(bridge.make_cpu_client, collectives), priority=0, fail_quietly=False
    )
    return GlooPort(gloo_port.copy_of(number))


def connect(devices: Sequence[Any]) -> None:
    """Connect devices of several hosts, once, before a program runs on them; all hosts call it.

    Raises:
        HostsError: a host has ended, a program that is no host has connected, or the devices have not
            connected in time.
    """
    if not span(devices) or (numbers := tuple(d.id for d in devices)) in _joined[0].connected:
        return
    links, gloo = _joined[0], _joined[0].gloo
    assert gloo is not None
    with gloo.open(), _no_words_of_gloo():
        require_equal("the devices", list(numbers))
        meeting = DeviceMeeting(devices)
        _await(meeting, links, gloo)
    with calling(True):
        meeting.require()
    links.connected.add(numbers)


def _await(meeting: DeviceMeeting, links: HostLinks, gloo: GlooPort) -> None:
    """Wait on all hosts until the devices are connected, with each other alone.

    Raises:
        HostsError: a program that is no host has connected, or the time of the links is over.
    """
    until = time.monotonic() + links.timeout
    before = list[ConnectionEnds]()
    while True:
        # another program in the place of a device would let this one wait without end
        meeting.wait(LOOK)
        ended = meeting.ended  # connections are complete only if they are listed after the end
        words = [ended, time.monotonic() > until, gloo.address, gloo_port.connections()]
        answers = links.exchange("the connections", words)
        ended_everywhere, late = all(a[0] for a in answers), any(a[1] for a in answers)
        ports = [str(a[2]) for a in answers]
        ends = [(str(pair[0]), str(pair[1])) for a in answers for pair in a[3]]
        unmatched = gloo_port.strangers(ports, ends)
        # hosts that still connect may have listed one end earlier than the other
        others = unmatched if ended_everywhere else sorted({*unmatched} & {*before})
        if ended_everywhere and not others:
            return
        if others or late:
            # those of the hosts too: JAX ends a process that exits while a program waits for one
            gloo_port.end([pair for pair in ends if {*pair} & {*ports}])
            meeting.wait(LOOK)
            raise gloo_port.error_of(others) if others else gloo_port.unreached(ports, links.timeout)
        before = unmatched


class DeviceMeeting:
    """A program on devices of all hosts, which connects them, in a thread of its own.

    Attributes:
        ended: whether the program has ended.
    """

    def __init__(self, devices: Sequence[Any]) -> None:
        self.ended = False
        self._error: Exception | None = None
        self._thread = threading.Thread(target=self._run, args=(devices,), daemon=True, name="deodar-devices")
        self._thread.start()

    def wait(self, seconds: float) -> None:
        """Wait for the end of the program."""
        self._thread.join(seconds)

    def require(self) -> None:
        """Raise the error of the program, if it has one."""
        if self._error is not None:
            raise self._error

    def _run(self, devices: Sequence[Any]) -> None:
        try:
            _meet_on_devices(devices)
        except Exception as error:  # it is raised where the program is awaited
            self._error = error
        self.ended = True


def _meet_on_devices(places: Sequence[Any]) -> None:
    """Run a program on devices of all hosts, which connects them, and ends here if it cannot."""
    shared = NamedSharding(Mesh(np.array(places), ("devices",)), PartitionSpec("devices"))
    ones = placed(np.ones(len(places), np.float32), shared)
    whole = NamedSharding(shared.mesh, PartitionSpec())
    jax.block_until_ready(jax.jit(jnp.sum, out_shardings=whole)(ones))


@contextlib.contextmanager
def _no_words_of_gloo() -> Generator[None]:
    """Let the standard output be the standard error: Gloo prints there when it connects, beside an answer in
    JSON.
    """
    sys.stdout.flush()
    before = os.dup(1)
    os.dup2(2, 1)
    try:
        yield
    finally:
        os.dup2(before, 1)
        os.close(before)


def _of_environment(timeout: float) -> tuple[str, int, int, Any]:
    """Return address, count, index and own devices as the environment states them."""
    clusters: Any = sys.modules["jax._src.clusters"]  # JAX has no public function for this
    parameters = clusters.ClusterEnv.auto_detect_unset_distributed_params(
        None, None, None, None, None, max(1, round(timeout))
    )
    if None in parameters[:3]:
        raise HostsError(
            "neither SLURM nor Open MPI states the hosts in the environment",
            fix="Start with srun or mpirun, or give address, count and index",
        )
    return parameters


def _require(address: str, count: int | None, index: int | None, timeout: float) -> None:
    host, _, port = str(address).rpartition(":")
    if address != AUTO and not (host and port.isdecimal() and 0 < int(port) < 2**16):
        raise ParameterError(
            f"address is {show(address)}; expected HOST:PORT of the first host, or {AUTO!r}",
            fix="For example dd.join_hosts('node1:7007', 2, 0)",
        )
    if address == AUTO:
        if count is not None or index is not None:
            raise ParameterError("count and index need the address of the first host")
    elif not _whole(count, 1) or not _whole(index, 0) or not (index or 0) < (count or 0):
        raise ParameterError(
            f"count and index are {show(count)} and {show(index)}; expected the number of hosts, and that of"
            " this host from 0"
        )
    if isinstance(timeout, bool) or not isinstance(timeout, (int, float)) or not 1 <= timeout < 1e6:
        raise ParameterError(f"timeout is {show(timeout)}; expected seconds, at least 1")


def _whole(n: object, least: int) -> bool:
    return isinstance(n, int) and not isinstance(n, bool) and n >= least


# -------------------------------------------------------------------------------------------- what is joined


def count() -> int:
    """Return the number of hosts that have joined; 1 without others."""
    return _joined[0].count if _joined else 1


def first() -> bool:
    """Return whether this is the first host, or the only one."""
    return not _joined or _joined[0].index == 0


def span(devices: Sequence[Any]) -> bool:
    """Return whether some of these devices belong to another host."""
    return bool(_joined) and any(d.process_index != _joined[0].index for d in devices)


def own(devices: Sequence[T]) -> T:
    """Return the first of these devices that belongs to this host."""
    index = _joined[0].index if _joined else 0
    mine = [d for d in devices if getattr(d, "process_index", 0) == index]
    return (mine or devices)[0]


def topology(devices: Sequence[Any]) -> Hashable:
    """Return how a compiled program depends on the hosts of its devices."""
    return (_joined[0].index, *(d.process_index for d in devices)) if span(devices) else ()


# ------------------------------------------------------------------------------------------------- agreement


def require_equal(subject: str, value: Any) -> None:
    """Raise an error unless all hosts have an equal value (plain data).

    Raises:
        HostsError: they differ.
    """
    if not _joined:
        return
    text = codec.line(value, sort=True)
    compared = text if len(text) <= SHOWN else digest(value)
    answers = _joined[0].exchange(subject, compared)
    for k, answer in enumerate(answers):
        if answer != answers[0]:
            difference = f" ({answers[0]} on host 0, {answer} on host {k})" if len(text) <= SHOWN else ""
            raise HostsError(
                f"the hosts 0 and {k} differ in {subject}{difference}",
                fix="Run the same script with the same files and versions on all hosts",
            )


def digest(value: Any) -> str:
    """Return the hash of a value (plain data), which hosts compare in its place."""
    return hashlib.sha256(codec.line(value, sort=True).encode()).hexdigest()


def of_first(subject: str, value: T, across: bool) -> T:
    """Return the value (plain data) of the first host; its own one where a run is not `across` hosts."""
    return _joined[0].exchange(subject, value)[0] if across and _joined else value


def any_of(subject: str, value: bool, across: bool) -> bool:
    """Return whether a value is true on any host."""
    return any(_joined[0].exchange(subject, value)) if across and _joined else value


@contextlib.contextmanager
def together(across: bool) -> Generator[None]:
    """End the run of all hosts if it ends with an error on this one."""
    try:
        yield
    except BaseException as error:
        if across and _joined:
            _joined[0].failed = True
        if across and _joined and not isinstance(error, HostsError):
            _joined[0].leave(f"{type(error).__name__}: {first_line(error)}")
        raise


def require_one(subject: str, across: bool) -> None:
    """Raise an error if something that one host alone can do is asked of several.

    Raises:
        HostsError: the run is across hosts.
    """
    if across:
        raise HostsError(
            f"{subject} on {count()} hosts is not supported", fix="Leave it out, or use one host"
        )


# ---------------------------------------------------------------------------------------------------- arrays


def gathered(array: Any) -> np.ndarray:
    """Return an array on this host; all hosts call it for one that lies on devices of several."""
    if not _joined or not isinstance(array, jax.Array) or array.is_fully_addressable:
        return np.asarray(array)
    if not array.is_fully_replicated:  # no program may have run on its devices yet
        connect(sorted(array.sharding.device_set, key=lambda device: device.id))
    with calling(True):
        if array.is_fully_replicated:
            return np.asarray(array.addressable_data(0))
        return np.asarray(multihost_utils.process_allgather(array, tiled=True))


def placed(array: Any, sharding: Sharding) -> Any:
    """Return an array that every host has, on the devices where it is expected."""
    if not _joined or sharding.is_fully_addressable:
        return jax.device_put(array, sharding)
    if isinstance(array, jax.Array) and not array.is_fully_addressable:
        return array
    host_array = np.asarray(array)
    return jax.make_array_from_callback(host_array.shape, sharding, lambda index: host_array[index])


@contextlib.contextmanager
def calling(across: bool) -> Generator[None]:
    """Name the host that has ended if a program of several hosts fails."""
    if not across or not _joined:
        yield
        return
    links = _joined[0]
    links.inside = time.monotonic()
    try:
        yield
    except jax.errors.JaxRuntimeError as error:
        links.failed = True
        links.lost_soon()
        raise HostsError(
            f"{lost_hosts(links.lost) or 'another host has ended'} ({first_line(error)})",
            fix="The output of that host has the cause. Start the run again on all hosts",
        ) from None
    finally:
        links.inside = 0.0
