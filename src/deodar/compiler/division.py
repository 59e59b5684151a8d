"""The division of a program among several devices: of the copies of a batch, or of the fields of one copy."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable, Hashable, Sequence
from typing import Any, Literal, Protocol, Self

import jax
import numpy as np
from jax.sharding import Mesh, NamedSharding, PartitionSpec

from deodar.compiler import hosts
from deodar.compiler.arguments import ProgramArguments
from deodar.compiler.copy_batch import Batch, Divided
from deodar.compiler.device import Device, name
from deodar.errors import DeviceError
from deodar.model.resolve import Node
from deodar.numerics.axes import shape
from deodar.numerics.choice import Shards

DEVICES = "devices"
"""Name of the axis of devices in a mesh."""

LEAST = 2
"""Least number of samples of the divided axis on each device."""


@dc.dataclass(frozen=True)
class Distribution:
    """The request to run one program on several devices.

    Attributes:
        devices: the devices, at least two of one kind.
        along: what is divided: the points of a sweep, the trials, or the fields of a single copy.
    """

    devices: tuple[Device, ...]
    along: Divided | Literal["field"]

    @property
    def key(self) -> Hashable:
        """A key whose change requires a new program."""
        return (self.along, tuple(map(name, self.devices)))

    @property
    def of_fields(self) -> Self | None:
        """The distribution itself if it divides the fields of one copy."""
        return self if self.along == "field" else None

    @property
    def across(self) -> bool:
        """Whether the devices belong to several hosts."""
        return hosts.span(self.devices)

    @property
    def own(self) -> Device:
        """The first device that belongs to this host."""
        return hosts.own(self.devices)

    def part(self, batch: Batch) -> Batch:
        """Return the copies that one device computes."""
        return batch if self.along == "field" else batch.share(self.along, len(self.devices))

    @property
    def mesh(self) -> Mesh:
        """The devices as a mesh with one axis."""
        return Mesh(np.array(self.devices), (DEVICES,))


class Division(Protocol):
    """The division of the programs of an executable: where each array is, and how functions are divided."""

    def shardings(self, arguments: ProgramArguments) -> ProgramArguments:
        """Return the sharding of every array of these arguments."""
        ...

    def divided(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function of the same arguments that computes the same on all devices together."""
        ...


class DividedCopies:
    """The copies of a batch in equal parts, one for each device.

    Each device runs the program of its own part, and no number passes between devices. A copy has the bits
    that it has in a batch as large as one part.

    Args:
        distribution: the devices, and whether they divide points or trials.
        batch: all copies.
        rebuilt: for each group of the plan whether its constants differ between points.
    """

    def __init__(self, distribution: Distribution, batch: Batch, rebuilt: Sequence[bool]) -> None:
        self._mesh = distribution.mesh
        shared, first = PartitionSpec(), PartitionSpec(DEVICES)
        points = first if distribution.along == "points" else shared
        self._copies = first if points is first or batch.points is None else PartitionSpec(None, DEVICES)
        self._shared, self._points = shared, points
        self._constants = [points if swept else shared for swept in rebuilt]

    def shardings(self, arguments: ProgramArguments) -> ProgramArguments:
        """Return the sharding of every array of these arguments."""
        return jax.tree.map(
            lambda spec, part: jax.tree.map(lambda _: NamedSharding(self._mesh, spec), part),
            self._specs(arguments),
            arguments,
            is_leaf=lambda part: isinstance(part, PartitionSpec),
        )

    def divided(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function of the same arguments that computes the same on all devices together."""

        def whole(*parts: Any) -> Any:
            specs = tuple(self._specs(ProgramArguments(*parts)))
            # without the check of replication: loops carry arrays that begin as equal zeros everywhere
            return jax.shard_map(
                function, mesh=self._mesh, in_specs=specs, out_specs=self._copies, check_vma=False
            )(*parts)

        return whole

    def _specs(self, arguments: ProgramArguments) -> Any:
        """Return for each part of the arguments how it is divided; a part may be a whole PyTree."""
        values = {**dict.fromkeys(arguments.values, self._shared), "swept": self._points}
        return ProgramArguments(
            values,  # pyright: ignore[reportArgumentType]  # prefixes of the arguments
            self._constants,  # pyright: ignore[reportArgumentType]
            self._copies,  # pyright: ignore[reportArgumentType]
            self._copies,  # pyright: ignore[reportArgumentType]
            self._shared,  # pyright: ignore[reportArgumentType]
            self._shared,  # pyright: ignore[reportArgumentType]
            self._shared,  # pyright: ignore[reportArgumentType]
        )


def distributed(batch: Batch, devices: tuple[Device, ...]) -> tuple[Distribution | None, Batch]:
    """Return the distribution of a batch among devices, and the batch with the copies that fill it up.

    The larger number of points or trials is divided. All parts have the size of the largest, and devices that
    would get none are left out, except where they belong to several hosts. A single copy has its fields
    divided.

    Raises:
        DeviceError: the batch has one trial or point, which is computed as a batch.
    """
    if len(devices) == 1:
        return None, batch
    if not batch.shape:
        return Distribution(devices, "field"), batch
    if batch.size == 1:
        raise DeviceError(
            f"a batch of one copy cannot be divided among {len(devices)} devices",
            fix="Leave out trials and sweep, so that the fields are divided; or leave out devices",
        )
    points, trials = batch.points or 1, batch.trials or 1
    copies = max(points, trials)
    part = -(-copies // len(devices))
    # every host runs the program, even if its copies only fill up the batch
    used = len(devices) if hosts.span(devices) else -(-copies // part)
    if points >= trials:
        return Distribution(devices[:used], "points"), dc.replace(batch, points=used * part)
    return Distribution(devices[:used], "trials"), dc.replace(batch, trials=used * part)


def divided_axis(nodes: Sequence[Node], devices: int) -> Shards:
    """Return the axis along which a model is divided: of the largest element with a state, the first that
    gives all devices the same number of samples.

    Raises:
        DeviceError: it has no such axis.
    """
    largest = max((n for n in nodes if n.element.stateful), key=_cells, default=None)
    axes = max(largest.outs.values(), key=lambda a: math.prod(shape(a)), default=()) if largest else ()
    for axis in axes:
        if axis.samples % devices == 0 and axis.samples >= LEAST * devices:
            return Shards(axis.name, axis.samples, devices)
    if not axes or largest is None:
        raise DeviceError(
            f"the model has no field that {devices} devices could divide",
            fix="Leave out devices; trials and sweep points of any model are divided",
        )
    fitting = sorted(
        {d for a in axes for d in range(2, a.samples // LEAST + 1) if a.samples % d == 0 and d <= 1024}
    )
    sizes = ", ".join(f"{a.name}: {a.samples}" for a in axes)
    fewer = ", ".join(map(str, [d for d in fitting if d < devices][-3:])) or "none"
    raise DeviceError(
        f"no axis can be divided into {devices} equal parts ({sizes})",
        where=largest.path,
        fix=f"Use a number of samples that is a multiple of {devices}, or fewer devices: {fewer}",
    )


def _cells(n: Node) -> int:
    return max((math.prod(shape(axes)) for axes in n.outs.values()), default=0)
