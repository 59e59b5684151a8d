"""A world inside the step: what of it a model reads and drives, as pure functions of one copy."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

from deodar.elements.motor import Motor
from deodar.elements.sensor import Sensor
from deodar.numerics.pytree import PyTree
from deodar.worlds._pure import PureWorld


@dataclass(frozen=True)
class Body:
    """A pure world and what a model uses of it.

    The state of a copy holds `now` (the world), `sensed` (what it shows, by the sensor's id) and `told` (what
    its motors were told, by name); every array has a leading axis of one, as the rows of groups have theirs.

    Attributes:
        world: its functions; its arrays come from whoever runs it.
        sensors, motors: what the model uses, by id.
    """

    world: PureWorld
    sensors: Mapping[str, Sensor]
    motors: Mapping[str, Motor]

    @property
    def key(self) -> Hashable:
        """What makes another program when it changes."""
        return (
            type(self.world),
            self.world.structure(),
            tuple(sorted(self.sensors)),
            tuple(sorted(self.motors)),
        )

    @property
    def reads(self) -> Hashable:
        """Names `begin` among the functions of the world: what sensors of the model read, and over which
        axes.
        """
        return (
            "begin",
            *((ident, sensor.sensor, tuple(sensor.axes)) for ident, sensor in sorted(self.sensors.items())),
        )

    def begin(self, shared: PyTree, own: PyTree, now: PyTree) -> PyTree:
        """The state of a copy whose world stands somewhere."""
        told = {
            name: jnp.zeros(signal.shape or (), jnp.result_type(float))
            for name, signal in self.world.motors.items()
        }
        return _rows({"now": now, "sensed": self._sensed(shared, own, now), "told": told})

    def sensed(self, state: PyTree) -> dict[str, Any]:
        """What the sensors show."""
        return {ident: value[0] for ident, value in state["sensed"].items()}

    def step(
        self, shared: PyTree, own: PyTree, state: PyTree, commands: Mapping[str, Any], tick: Any, period: Any
    ) -> PyTree:
        """The state at tick + 1: motors are told at multiples of the period, and what they do shows one
        period later.
        """
        told = dict(state["told"])
        listens = tick % period == 0
        for ident, command in commands.items():
            name = self.motors[ident].motor
            told[name] = jnp.where(listens, command[None].astype(told[name].dtype), told[name])

        def advance() -> PyTree:
            now = self.world.advance(shared, own, _copy(state["now"]), _copy(told))
            now = jax.tree.map(lambda a, b: jnp.asarray(a, b.dtype), now, _copy(state["now"]))
            return _rows({"now": now, "sensed": self._sensed(shared, own, now)})

        moved = lax.cond(
            (tick + jnp.uint32(1)) % period == 0, advance, lambda: {k: state[k] for k in ("now", "sensed")}
        )
        return {**moved, "told": told}

    def _sensed(self, shared: PyTree, own: PyTree, now: PyTree) -> PyTree:
        dtype = shared_dtype(shared)
        out: dict[str, Any] = {}
        for ident, sensor in self.sensors.items():
            axes = tuple(sensor.axes)
            read = self.world.read(shared, own, now, sensor.sensor, axes)
            out[ident] = jnp.broadcast_to(jnp.asarray(read, dtype), tuple(a.samples for a in axes))
        return out


def shared_dtype(shared: PyTree) -> Any:
    """The precision of a world's arrays."""
    return next(a.dtype for a in jax.tree.leaves(shared) if a.dtype.kind == "f")


def batched(tree: PyTree, batch: Sequence[int]) -> PyTree:
    """Arrays of copies (copies, ...) as arrays of a batch (points, trials, ...), or of one copy where there
    is no batch.
    """
    return jax.tree.map(lambda a: np.asarray(a).reshape(*batch, *np.shape(a)[1:]), tree)


def unbatched(tree: PyTree, batch: Sequence[int]) -> PyTree:
    """The same back."""
    return jax.tree.map(lambda a: np.asarray(a).reshape(-1, *np.shape(a)[len(batch) :]), tree)


def _rows(tree: PyTree) -> PyTree:
    return jax.tree.map(lambda a: jnp.asarray(a)[None], tree)


def _copy(tree: PyTree) -> PyTree:
    return jax.tree.map(lambda a: a[0], tree)
