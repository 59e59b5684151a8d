"""Where a cluster of workers is: on this machine, at the address of a scheduler, or in the queue of SLURM.

This file states a cluster; `scheduler.py` connects to it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deodar.errors import ParameterError, WorkerError, option, show

LOCAL = ("127.0.0.1", "localhost", "[::1]")
"""Hosts that are this machine."""

HOW = "Write local:N, tcp://HOST:PORT, tls://HOST:PORT or slurm:FILE"
_ADDRESS = re.compile(r"(tcp|tls)://(\[[0-9a-fA-F:.]+\]|[\w.-]+):(\d{1,5})")

PATIENCE = 60.0
"""Wall time without any worker after which a run ends with an error, in seconds."""


@dataclass(frozen=True)
class Cluster:
    """Worker processes of one core each, on this machine or on many, which a scheduler of Dask manages.

    Attributes:
        address: `local:N` starts N processes on this machine and ends them; `tcp://HOST:PORT` or
            `tls://HOST:PORT` is a scheduler that runs already; `slurm:FILE` submits jobs to SLURM, and FILE
            (YAML or JSON) has the arguments of `dask_jobqueue.SLURMCluster` and the number of `jobs`.
        trust_network: allow a scheduler beyond this machine, in a network of your own: messages are not
            encrypted, and anyone who can connect to the scheduler or a worker can run programs there.
        mixed: allow workers whose processors differ. Each row then names its machine, and rows of
            different machines may differ in their last digits.
        patience: wall time without any worker after which a run ends with an error, s.
    """

    address: str
    trust_network: bool = False
    mixed: bool = False
    patience: float = PATIENCE

    def __post_init__(self) -> None:
        if not isinstance(self.address, str):
            raise ParameterError(f"a cluster is named by a text, not {show(self.address)}", fix=HOW)
        kind, _, rest = self.address.partition(":")
        if kind == "local":
            if not rest.isdecimal() or int(rest) < 1:
                raise ParameterError(
                    f"{self.address!r} states no number of processes", fix="Write for example local:4"
                )
        elif kind == "slurm":
            if not rest:
                raise ParameterError(
                    f"{self.address!r} names no file", fix="Write for example slurm:jobs.yaml"
                )
            self._require_trust("the workers of SLURM are")
        else:
            found = _ADDRESS.fullmatch(self.address)
            if found is None or int(found[3]) > 65535:
                raise ParameterError(f"{self.address!r} is not the address of a cluster", fix=HOW)
            if found[1] == "tcp" and found[2] not in LOCAL:
                self._require_trust(f"{self.address} leads")

    def _require_trust(self, what: str) -> None:
        if not self.trust_network:
            raise WorkerError(
                f"{what} beyond this machine, without encryption",
                fix=option(
                    "Use a scheduler at tls://HOST:PORT; in a network of your own state that you trust it:",
                    "trust_network",
                    "",
                    "True",
                    "the box Trust the network",
                ),
            )

    @classmethod
    def of(cls, given: Cluster | str) -> Cluster:
        """Return a cluster by its address, or the cluster itself."""
        return given if isinstance(given, Cluster) else cls(given)

    @property
    def processes(self) -> int:
        """Number of processes that `local:N` starts; 0 for other clusters."""
        return int(self.address.partition(":")[2]) if self.address.startswith("local:") else 0

    @property
    def file(self) -> Path | None:
        """The file of `slurm:FILE`; None for other clusters."""
        return Path(self.address.partition(":")[2]) if self.address.startswith("slurm:") else None


def slurm_settings(data: Any, where: str) -> tuple[dict[str, Any], int]:
    """Return the arguments of `dask_jobqueue.SLURMCluster`, and the number of jobs.

    Without an entry of its own a job has one core and 2 GB; each core is a process. Every process gets
    `NPROC=1`, so that its programs use one core. The pages on which Dask shows what a cluster does are for
    this machine alone, unless the file states `dashboard_address` in `scheduler_options`; workers have none.

    Args:
        data: content of the file.
        where: name of the file.
    """
    if not isinstance(data, dict) or not all(isinstance(key, str) for key in data):
        raise ParameterError(
            "holds no table of settings", where=where, fix="Write for example queue: normal, and jobs: 20"
        )
    given = dict(data)
    jobs, cores = given.pop("jobs", 1), given.get("cores", 1)
    for name, value in (("jobs", jobs), ("cores", cores)):
        if isinstance(value, bool) or not isinstance(value, int) or value < 1:
            raise ParameterError(f"{name} is {show(value)}; expected a whole number, at least 1", where=where)
    if given.get("processes", cores) != cores:
        raise ParameterError(
            f"processes is {show(given['processes'])}, but each of the {cores} cores is a process",
            where=where,
            fix="Leave processes out",
        )
    shapes = {"job_script_prologue": list, "worker_extra_args": list, "scheduler_options": dict}
    for name, shape in shapes.items():
        if not isinstance(given.setdefault(name, shape()), shape):
            what = "a list" if shape is list else "a table"
            raise ParameterError(f"{name} is {show(given[name])}; expected {what}", where=where)
    given |= {
        "cores": cores,
        "processes": cores,
        "job_script_prologue": [*given["job_script_prologue"], "export NPROC=1"],
        "worker_extra_args": [*given["worker_extra_args"], "--no-dashboard"],
        "scheduler_options": {"dashboard_address": "127.0.0.1:0", **given["scheduler_options"]},
    }
    return {"memory": "2GB", **given}, jobs
