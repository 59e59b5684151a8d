"""The scheduler of a cluster: at an address, in this process, or with jobs of SLURM as its workers.

The only module that imports Dask.
"""

from __future__ import annotations

import contextlib
import logging
import os
import signal
import socket
import time
import warnings
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from deodar import codec, regular_file
from deodar.batch.pool import quiet
from deodar.cluster import Cluster, slurm_settings
from deodar.errors import MissingExtra, ParameterError, WorkerError, first_line

CONNECT_SECONDS = 20.0
"""Wall time in which a scheduler must answer at the start, in seconds."""

PORT_SECONDS = 1.0
"""Wall time of one attempt to reach the port of a scheduler, in seconds."""

CLOSE_SECONDS = 10.0
"""Wall time in which connections and processes must end, in seconds."""

ALLOWED_FAILURES = 5
"""Number of processes that a task of `local:N` may end, before the run ends with an error."""


def version() -> str:
    """Return the version of Dask in this process; a scheduler must have the same.

    Raises:
        MissingExtra: it is not installed.
    """
    return str(_library().__version__)


def connected(cluster: Cluster, stack: contextlib.ExitStack, look: Callable[[], None] | None) -> Any:
    """Return a client of the scheduler of a cluster, which is started unless it runs already.

    Args:
        cluster: where the workers are.
        stack: ends what is started here, and closes the client.
        look: called several times a second while something that listens at an address is awaited; it may
            raise an exception. None: the wait for it cannot be ended.

    Raises:
        WorkerError: no scheduler answers.
        ParameterError: the file of SLURM is wrong.
        MissingExtra: Dask is not installed.
    """
    where: Any = cluster.address
    stack.enter_context(_silent())
    if cluster.processes:
        where = _local(cluster.processes, stack)
    elif cluster.file is not None:
        where, jobs = _slurm(cluster.file)
        stack.callback(_closed, where)
        where.scale(jobs=jobs)
    elif look is not None:
        _await_port(cluster, look)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of other versions, which the caller compares
            client = _library().Client(where, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, TimeoutError, ValueError, RuntimeError) as error:
        raise _no_scheduler(cluster, error) from None
    stack.callback(_closed, client)
    return client


def _local(processes: int, stack: contextlib.ExitStack) -> Any:
    """Start a scheduler in this process, and the processes of `local:N`.

    Their ports are open to every user of the machine, and a client of one can run programs in it: they
    require a certificate that exists in these processes alone, and none of them serves pages.
    """
    # an extra
    import dask.config

    # the main script is hidden as long as processes may start: a new one takes the place of a dead one
    with quiet(main=True):
        settings = {
            "distributed.scheduler.allowed-failures": ALLOWED_FAILURES,
            "distributed.scheduler.http.routes": [],
        }
        with dask.config.set(settings):
            cluster = _library().LocalCluster(
                n_workers=0,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                security=_own_certificate(),
                dashboard_address="127.0.0.1:0",
                scheduler_kwargs={"dashboard": False},
                silence_logs=logging.CRITICAL,
                memory_limit=0,
                env={"NPROC": "1"},
                config={"distributed.worker.http.routes": []},
                preload=["deodar.batch.cluster_task"],
            )
    stack.callback(_closed, cluster)
    stack.callback(_end_processes, cluster)
    stack.enter_context(quiet(main=False, signals=False))
    cluster.scale(processes)
    return cluster


def _own_certificate() -> Any:
    """Return a certificate of this process, which its workers get when they start."""
    try:
        return _library().Security.temporary()
    except ImportError:
        raise MissingExtra("cryptography", "cluster", "processes of a cluster on this machine") from None


def _await_port(cluster: Cluster, look: Callable[[], None]) -> None:
    """Wait until something listens at the address of a scheduler; the client itself cannot be stopped."""
    address = urlsplit(cluster.address)
    end = time.monotonic() + CONNECT_SECONDS
    while True:
        try:
            socket.create_connection((address.hostname, address.port), PORT_SECONDS).close()
            return
        except OSError as error:
            if time.monotonic() > end:
                raise _no_scheduler(cluster, error) from None
        look()
        time.sleep(0.1)


def _no_scheduler(cluster: Cluster, error: Exception) -> WorkerError:
    return WorkerError(
        f"no scheduler of Dask answers at {cluster.address} ({first_line(error)})",
        fix="Start one there with: dask scheduler; or state its address, which it prints",
    )


def _library() -> Any:
    """Import Dask (extra `cluster`), or raise an error that says how to install it."""
    try:
        # an extra
        import distributed
    except ImportError:
        raise MissingExtra("distributed", "cluster", "a cluster of workers") from None
    return distributed


def _slurm(file: Path) -> tuple[Any, int]:
    """Return the cluster that a file describes, and the number of its jobs; none is submitted yet."""
    _library()
    try:
        # an extra
        import yaml

        with _signals_kept():
            # an extra
            from dask_jobqueue.slurm import SLURMCluster
    except ImportError:
        raise MissingExtra("dask-jobqueue", "cluster", "a cluster of SLURM") from None
    try:
        text = regular_file.read_text(file)
        plain = codec.parse(text) if file.suffix.lower() == ".json" else yaml.safe_load(text)
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise ParameterError(f"cannot be read ({first_line(error)})", where=str(file)) from None
    settings, jobs = slurm_settings(plain, str(file))
    try:
        return SLURMCluster(**settings), jobs
    except (TypeError, ValueError) as error:
        raise ParameterError(f"dask_jobqueue refuses it: {first_line(error)}", where=str(file)) from None


@contextlib.contextmanager
def _signals_kept() -> Generator[None]:
    """Keep the handlers of signals: an import of dask_jobqueue sets that of Ctrl-C; in a thread it fails."""
    set_handler = signal.signal
    signal.signal = lambda *_: None
    try:
        yield
    finally:
        signal.signal = set_handler


def _end_processes(cluster: Any) -> None:
    """End the processes of `local:N` at once: an orderly end of each takes seconds."""
    for nanny in list(cluster.workers.values()):
        nanny.auto_restart = False
        with contextlib.suppress(OSError, AttributeError, TypeError):
            os.kill(nanny.pid, signal.SIGTERM)


def _closed(closable: Any) -> None:
    """Close a client or a cluster, whose processes may have died already."""
    with contextlib.suppress(Exception):
        closable.close(timeout=CLOSE_SECONDS)


@contextlib.contextmanager
def _silent() -> Any:
    """Keep Dask's log of workers that die off the terminal: errors of this module say what matters."""
    log = logging.getLogger("distributed")
    before = log.level
    log.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        log.setLevel(before)
