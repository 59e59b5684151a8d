"""The fields of one copy, divided among several devices along one axis.

Everything over that axis lies in parts, one for each device; everything else is on all of them. The compiler
of JAX divides the operations (`jit` with shardings); this module chooses the axis, states how many bytes pass
between devices in a step, and refuses models for which that would be whole fields.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from jax.sharding import NamedSharding, PartitionSpec

from deodar.compiler.arguments import ProgramArguments, ProgramState
from deodar.compiler.division import DEVICES, Distribution
from deodar.compiler.functions import convolved_axes
from deodar.compiler.plan import Plan, RowGroup
from deodar.compiler.sharing import REST, WAVES
from deodar.compiler.strategies import role
from deodar.compiler.traffic import Traffic, collectives
from deodar.errors import DeviceError
from deodar.numerics import convolution, interaction
from deodar.numerics.axes import Axes, shape
from deodar.numerics.choice import Shards, exchanged

ARRIVING, INPUT_REST = "input" + WAVES, "input" + REST
"""Ports of what arrives as spectral modes, and of what does not."""

AGREEMENT = 1.2
"""Largest ratio of the traffic of a compiled program to the planned one."""

SCALARS = 64
"""Bytes of sums to single numbers that every group of elements may add, such as global inhibition."""


def planned(plan: Plan, itemsize: int) -> list[Traffic]:
    """Return the bytes that each element of a divided plan exchanges in a step that computes it.

    Sums over the divided axis are counted by the size of their result, exchanges with neighbours by what a
    device receives.

    Raises:
        DeviceError: an element would exchange whole fields.
    """
    shards = plan.shards
    assert shards is not None
    read = {r.source[0] for (_, port), reads in plan.reads.items() if port == ARRIVING for r in reads}
    return [
        traffic
        for g, group in enumerate(plan.groups)
        if not group.still
        for traffic in _of_group(group, shards, itemsize, g in read)
    ]


def _of_group(group: RowGroup, shards: Shards, itemsize: int, read: bool) -> Iterator[Traffic]:
    """Yield the traffic of a group; `read`: whether others read its spectral modes."""
    node = group.like
    axes = convolved_axes(node)
    if shards.index(axes) is not None:
        for key in _transformed(group, axes, read):
            yield _of_kernels(group, key, axes, shards, itemsize)
        return
    reads = any(shards.index(node.ins[port]) is not None for port in node.reads if port in node.ins)
    shows = any(shards.index(a) is not None for a in node.outs.values())
    if reads and not shows:  # it sums over the axis
        size = sum(math.prod(shape(a)) for a in node.outs.values())
        yield Traffic(node.id, node.path, "sum", group.rows * size * itemsize)


def _transformed(group: RowGroup, axes: Axes, read: bool) -> list[str]:
    """Return the kinds of boundaries for which the elements of a group convolve an array over the axis."""
    kernels, shared = group.like.element.kernels(), group.strategy.shared
    keys = list(dict.fromkeys(interaction.boundaries(k, axes) for k in kernels))
    if not shared:
        return keys
    if role(group.like) == "source":  # its modes are computed once, for its own kernels and for others
        return keys if shared in keys or not read else [*keys, shared]
    # what arrives as modes needs no sum
    return keys if group.like.reads[INPUT_REST] else [key for key in keys if key != shared]


def _of_kernels(group: RowGroup, key: str, axes: Axes, shards: Shards, itemsize: int) -> Traffic:
    """Return the traffic of the kernels with one kind of boundaries."""
    node, whole = group.like, math.prod(shape(axes)) * itemsize
    choice = dict(group.strategy.choices).get(key)
    method = "matrices" if choice is None else choice.method
    size = whole
    if choice is not None and method in ("waves", "taps"):
        kernels = [k for k in node.element.kernels() if interaction.boundaries(k, axes) == key]
        size = itemsize * exchanged(choice, axes, sum(len(k.widths()) for k in kernels), shards)
    if size >= whole:
        raise DeviceError(
            f"its kernel is applied by {method} along the axis {shards.axis!r}, which is divided among"
            f" {shards.devices} devices: a step would exchange {size * group.rows:,} bytes, a whole field"
            f" ({whole * group.rows:,} bytes) or more",
            where=node.path,
            fix=(
                "Use Gaussian kernels of several samples' width, precision='float32' and"
                " accuracy='default'; or one device"
            ),
        )
    return Traffic(node.id, node.path, method, group.rows * size)


class DividedFields:
    """The fields of one copy in equal parts along one axis, one for each device.

    Args:
        distribution: the devices.
        plan: the plan, made for this number of devices.
        itemsize: bytes of a number.
    """

    def __init__(self, distribution: Distribution, plan: Plan, itemsize: int) -> None:
        assert plan.shards is not None
        self.shards, self._plan = plan.shards, plan
        self._mesh = distribution.mesh
        self.traffic = planned(plan, itemsize)

    def shardings(self, arguments: ProgramArguments) -> ProgramArguments:
        """Return the sharding of every array of these arguments."""
        everywhere = self._sharding(PartitionSpec())
        arrays = {
            key: self._sharding(self._spec(int(key.partition(":")[0]), np.shape(a)))
            for key, a in arguments.values["arrays"].items()
        }
        shardings = jax.tree.map(lambda _: everywhere, arguments)
        return shardings._replace(
            values={**shardings.values, "arrays": arrays},  # pyright: ignore[reportArgumentType]
            state=self.placed(arguments.state, lambda _, spec: self._sharding(spec)),
        )

    def divided(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function of the same arguments that computes the same on all devices together."""
        return function

    def constrained(self, state: ProgramState) -> ProgramState:
        """Return the state, in parts."""
        return self.placed(state, lambda a, spec: lax.with_sharding_constraint(a, self._sharding(spec)))

    def placed(self, state: ProgramState, put: Callable[[Any, PartitionSpec], Any]) -> ProgramState:
        """Return what a function makes of every array of a state and of the parts in which it lies."""

        def group(g: int, tree: Any) -> Any:
            return jax.tree.map(lambda a: put(a, self._spec(g, np.shape(a))), tree)

        out: Any = {
            "groups": [group(g, tree) for g, tree in enumerate(state["groups"])],
            "held": {g: group(int(g), tree) for g, tree in state["held"].items()},
        }
        if "world" in state:
            out["world"] = jax.tree.map(lambda a: put(a, PartitionSpec()), state["world"])
        return out

    def recorded(self, g: int, port: str, record: Array) -> Array:
        """Return the values of a port, in parts."""
        node = self._plan.groups[g].like
        axes = node.outs[port] if port in node.outs else node.ins[port]
        index = self.shards.index(axes)
        if index is None:
            return record
        spec = PartitionSpec(*[None] * (record.ndim - len(axes) + index), DEVICES)
        return lax.with_sharding_constraint(record, self._sharding(spec))

    def tapped(self, axes: Axes, weights: Array, y: Array, boundary: str, d: int) -> Array:
        """Convolve along one axis by lags; along the divided one with samples of the neighbours."""
        index = self.shards.index(axes)
        if index is None:
            return convolution.tapped(weights, y, boundary, d)
        spec = PartitionSpec(*[None] * index, DEVICES)
        function = self._tapped_part if d == index else convolution.tapped
        part = functools.partial(function, boundary=boundary, axis=d)
        divided = jax.shard_map(
            part, mesh=self._mesh, in_specs=(PartitionSpec(), spec), out_specs=spec, check_vma=False
        )
        return divided(weights, y)

    def _tapped_part(self, weights: Array, y: Array, boundary: str, axis: int) -> Array:
        reach, n, count = weights.shape[0] - 1, y.shape[axis], self.shards.devices
        first = lax.slice_in_dim(y, 0, reach, axis=axis)
        last = lax.slice_in_dim(y, n - reach, n, axis=axis)
        ring = range(count)
        before = lax.ppermute(last, DEVICES, [(k, (k + 1) % count) for k in ring])
        after = lax.ppermute(first, DEVICES, [((k + 1) % count, k) for k in ring])
        if boundary != "periodic":
            at = lax.axis_index(DEVICES)
            mirrored = boundary == "reflect"
            outside = [lax.rev(a, (axis,)) if mirrored else jnp.zeros_like(a) for a in (first, last)]
            before = jnp.where(at == 0, outside[0], before)
            after = jnp.where(at == count - 1, outside[1], after)
        return convolution.lagged(weights, before, after, y, axis)

    def require(self, text: str) -> None:
        """Raise an error if a compiled program exchanges more than was planned.

        Args:
            text: the compiled program of a chunk.

        Raises:
            DeviceError: elements whose functions cannot be divided along the axis; they are named.
        """
        exchanges = collectives(text)
        planned = sum(t.bytes for t in self.traffic)
        counted = sum(c.bytes for c in exchanges)
        if counted <= AGREEMENT * planned + SCALARS * len(self._plan.groups):
            return
        by = {n.id: n.path for group in self._plan.groups for n in group.nodes}
        expected = dict.fromkeys(by, 0)
        for t in self.traffic:
            expected[t.element] += t.bytes
        sums: dict[str, int] = {}
        for c in exchanges:
            sums[c.element] = sums.get(c.element, 0) + c.bytes
        above = {i: size for i, size in sums.items() if size > AGREEMENT * expected.get(i, 0) + SCALARS}
        named = [i for i in sorted(above, key=lambda i: -above[i]) if i in by]
        names = ", ".join(by[i] for i in named) or "the model"
        raise DeviceError(
            f"cannot be divided among {self.shards.devices} devices along {self.shards.axis!r}: a step would"
            f" exchange {counted:,} bytes, where {planned:,} are needed by kernels and sums",
            where=names,
            fix="Leave out devices, or those elements. A field needs quadrature='point'",
        )

    def _spec(self, g: int, size: Sequence[int]) -> PartitionSpec:
        """Return the parts of an array of a group: those of its last axes, if they are axes of the group."""
        node = self._plan.groups[g].like
        for axes in (*node.outs.values(), *node.ins.values()):
            index = self.shards.index(axes)
            if index is not None and tuple(size[len(size) - len(axes) :]) == shape(axes):
                return PartitionSpec(*[None] * (len(size) - len(axes) + index), DEVICES)
        return PartitionSpec()

    def _sharding(self, spec: PartitionSpec) -> NamedSharding:
        return NamedSharding(self._mesh, spec)
