"""What a computation may use, and what it shows."""

from __future__ import annotations

import dataclasses as dc
from numbers import Integral
from typing import Any

from deodar.cluster import Cluster
from deodar.errors import ParameterError, instance_of, show
from deodar.progress import Shown


@dc.dataclass(frozen=True, repr=False)
class Resources:
    """What a computation may use, and what it shows, as functions take it: `on=dd.Resources(workers=4)`.

    It does not change what is computed; in single precision the last digits may differ. A function refuses a
    field that it cannot use. All use `cores`, and all but `Session` use `progress`. Beside these `simulate`
    uses all fields, `Session` a device or several, `Experiment.run` and `run_jobs` workers or a cluster, and
    `resume` a cluster.

    Attributes:
        device: device of the run: cpu, gpu, or one of several as gpu:1; none: the CPU.
        devices: number of devices of the kind of `device` that share the copies of a run in equal parts, or
            "all" of them; after `join_hosts` of all hosts, each of which returns the record. A copy has the
            bits that it has in a batch of the size of one part. The fields of a single run, or of a session,
            are divided along an axis. None: one device.
        workers: number of processes of one core each that share the copies of a run, or the trials of an
            experiment; one per core is best. None: this process.
        cluster: workers on this or many machines, in place of `workers`: a `dd.Cluster`, or its address such
            as `local:4` or `tcp://HOST:8786`. A run has the pieces that it has without workers; `batch` makes
            them smaller. A run in one piece is computed in this process.
        batch: copies that run at once in one process; none: as many as fit into the cache, all on devices
            other than the CPU.
        cores: cores of the CPU for every program of this process, fixed when the first one runs: see
            `use_cores`. None: as it is.
        progress: None: a progress bar on a terminal and in a notebook, if the work takes longer than a
            second. True: a bar at once; without a terminal lines. False: none. Or a function that is called
            with the number of what is done; this number prints as a sentence, so `print` prints sentences,
            and its attribute `of` is the total.
    """

    device: str | None = None
    devices: int | str | None = None
    workers: int | None = None
    cluster: Cluster | str | None = None
    batch: int | None = None
    cores: int | None = None
    progress: Shown = None

    def __post_init__(self) -> None:
        for name, what, fix in (
            ("workers", "a number of processes", "One for each core is best"),
            ("batch", "a number of copies that run at once", ""),
        ):
            given = getattr(self, name)
            if given is not None and not _counts(given):
                raise ParameterError(f"{name} is {show(given)}; expected {what}, at least 1", fix=fix)
        if self.cluster is None:
            return
        Cluster.of(self.cluster)
        for name in ("workers", "devices"):
            if getattr(self, name) is not None:
                raise ParameterError(f"{name} and cluster exclude each other", fix="Leave one of them out")

    def __repr__(self) -> str:
        given = {field.name: getattr(self, field.name) for field in dc.fields(self)}
        return f"Resources({', '.join(f'{k}={v!r}' for k, v in given.items() if v is not None)})"

    @property
    def shared(self) -> bool:
        """Whether worker processes are to compute."""
        return self.workers is not None or self.cluster is not None


def use_resources(on: Resources, user: str, *fields: str) -> Resources:
    """Set the number of cores, and return the resources.

    Args:
        on: the resources that a caller gave.
        user: the function that uses it.
        fields: names of the fields that the function uses, beside `cores`.

    Raises:
        ParameterError: it is something else, or another field is given.
        CoresError: JAX has started with another number of cores.
    """
    instance_of(Resources, on, "on")
    usable = (*fields, "cores")
    for field in dc.fields(on):
        if getattr(on, field.name) is not None and field.name not in usable:
            raise ParameterError(
                f"{user} cannot use {field.name}",
                where="on",
                fix=f"Leave it out; {user} uses {', '.join(usable)}",
            )
    if on.cores is not None:
        # start-up time: this brings JAX
        from deodar.cores import use_cores

        use_cores(on.cores)
    return on


def _counts(value: Any) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool) and int(value) >= 1
