"""Where the studio runs the trials of an experiment: processes of this machine, or a cluster."""

from __future__ import annotations

import dataclasses as dc
import os
from collections.abc import Callable

from deodar.cluster import Cluster
from deodar.errors import DocumentError
from deodar_studio.files.workspace import Workspace

USUAL_WORKERS = max(1, min(8, (os.cpu_count() or 2) - 1))
"""Number of worker processes, unless a page states one: a core is left to the studio (8 is a guess: each
process takes about 300 MB).
"""

MOST_WORKERS = max(8, os.cpu_count() or 2)
"""Most worker processes on this machine that a page may ask for."""

SLURM = "slurm:"


@dc.dataclass(frozen=True)
class RunPlace:
    """Where a run computes its trials.

    Attributes:
        workers: number of processes on this machine, of one core each.
        cluster: the workers that a scheduler manages, in place of `workers`; None: there are none.
    """

    workers: int = USUAL_WORKERS
    cluster: Cluster | None = None

    @classmethod
    def of(
        cls, workers: int, address: str, at: Callable[[str], Cluster], space: Workspace, free: bool
    ) -> RunPlace:
        """Return the place that a page asks for.

        A scheduler can run programs in the process that connects to it, and a file of SLURM has commands. So
        a page may name both only if `free`: its user can start programs here anyway.

        Args:
            workers: number of processes on this machine; 0: the usual one.
            address: that of a cluster; empty: none.
            at: returns the cluster at an address.
            space: the files of the studio; `slurm:FILE` is one of them.
            free: whether pages may name clusters beyond the processes of `local:N`.

        Raises:
            DocumentError: the studio does not allow it, or too many processes.
            ParameterError: the address of the cluster is wrong.
            WorkerError: it leads beyond this machine, without encryption.
        """
        cluster = None
        if address:
            if not free and not address.startswith("local:"):
                raise DocumentError(
                    f"this studio does not connect to {address}: it can be reached from other machines, or"
                    " without a token, and a scheduler may run programs in it",
                    fix="Use local:N, or run the file by a command: deodar experiment FILE --cluster ADDRESS",
                )
            if address.startswith(SLURM) and address != SLURM:
                address = f"{SLURM}{space.inside(address.removeprefix(SLURM).strip())}"
            cluster = at(address)
        count = workers if cluster is None else cluster.processes
        if count > MOST_WORKERS:
            raise DocumentError(
                f"{count} processes are too many for this machine", fix=f"Use at most {MOST_WORKERS}"
            )
        return cls(workers or USUAL_WORKERS, cluster)
