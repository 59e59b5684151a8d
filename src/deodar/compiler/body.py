"""A world inside the step: the sensors and motors that a model uses, as pure functions of one copy."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from deodar.compiler.arguments import BodyState
from deodar.element import Arrays
from deodar.elements.world_ports import Motor, Sensor
from deodar.errors import WorldError
from deodar.kind_errors import position
from deodar.numerics.pytree import PyTree
from deodar.worlds._failure import errors_of
from deodar.worlds._pure import PureWorld

T = TypeVar("T")


@dataclass(frozen=True)
class Body:
    """A pure world, with the sensors and motors that a model uses.

    The state of a copy contains `now` (the world), `sensed` (its readings, by the sensor's id) and `commands`
    (the commands of its motors, by name); every array has a leading axis of one, like the rows of groups.

    Attributes:
        world: functions of the world; its arrays are arguments of a run.
        sensors, motors: the sensors and motors that the model uses, by id.
        holds: whether readings last for several steps of the model, at its own dt.
    """

    world: PureWorld
    sensors: Mapping[str, Sensor]
    motors: Mapping[str, Motor]
    holds: bool = False

    @property
    def key(self) -> Hashable:
        """A key whose change requires a new program."""
        return (
            type(self.world),
            self.world.structure(),
            tuple(sorted(self.sensors)),
            tuple(sorted(self.motors)),
            self.holds,
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

    def periods(self, ident: str) -> int:
        """Return the number of periods of the world for which a reading of a sensor is held."""
        signal = self.world.sensors.get(self.sensors[ident].sensor)
        if signal is None or signal.period is None or self.world.period is None:
            return 1
        return max(1, round(signal.period / self.world.period))

    def begin(self, shared: Arrays, own: PyTree, now: PyTree) -> BodyState:
        """Return the state of a copy at the start."""
        commands = {
            name: jnp.zeros(signal.shape or (), jnp.result_type(float))
            for name, signal in self.world.motors.items()
        }
        return _rows({"now": now, "sensed": self._sensed(shared, own, now, {}), "commands": commands})

    def sensed(self, state: BodyState) -> Arrays:
        """Return the readings of the sensors."""
        return {ident: value[0] for ident, value in state["sensed"].items()}

    def listen(self, state: BodyState, commands: Arrays, tick: Array, period: Array) -> BodyState:
        """Return the state after the step from `tick`: motors receive commands at multiples of the period."""
        held = dict(state["commands"])
        listens = tick % period == 0
        for ident, command in commands.items():
            name = self.motors[ident].motor
            held[name] = jnp.where(listens, command[None].astype(held[name].dtype), held[name])
        return {**state, "commands": held}

    def advance(self, shared: Arrays, own: PyTree, state: BodyState, tick: Array, period: Array) -> BodyState:
        """Return the state at `tick`: at multiples of the period the world advances by a period, with the
        commands of its start, and is read.
        """
        # without the axis of one: the compiler gives arrays that have it another layout in the branches, and
        # copies the readings of a batch in each step
        before = _copy(state["now"]), self.sensed(state)

        def advanced() -> tuple[PyTree, Arrays]:
            with errors_of(self.world, "advance"):
                now = self.world.advance(shared, own, before[0], _copy(state["commands"]))
                self._require(now, before[0])
            now = jax.tree.map(lambda a, b: jnp.asarray(a, b.dtype), now, before[0])
            return now, self._sensed(shared, own, now, before[1])

        now, sensed = lax.cond(tick % period == 0, advanced, lambda: before)
        return {"now": _rows(now), "sensed": _rows(sensed), "commands": state["commands"]}

    def _require(self, new: PyTree, old: PyTree) -> None:
        """Raise WorldError if a state of the world has not the form of the one before."""
        # shapes are compared as lists: a state may be a class of the user, without `__eq__`
        shapes = [[list(jnp.shape(a)) for a in jax.tree.leaves(tree)] for tree in (new, old)]
        forms = [jax.tree.structure(tree) for tree in (new, old)]
        if forms[0] != forms[1] or shapes[0] != shapes[1]:
            texts = [", ".join(map(str, listed)) for listed in shapes] if forms[0] == forms[1] else forms
            subject = position(type(self.world), "advance")
            raise WorldError(f"{subject} returns a state of the form {texts[0]}; it began with {texts[1]}")

    def _sensed(self, shared: Arrays, own: PyTree, now: PyTree, before: Arrays) -> Arrays:
        """Return the readings of the sensors; `before` are the last ones, which may be held."""
        dtype = dtype_of((shared, own, now))
        out: Arrays = {}
        for ident, sensor in self.sensors.items():
            request = sensor.sensor, tuple(sensor.axes)
            with errors_of(self.world, "read"):
                out[ident] = jnp.asarray(
                    self.world.reading(shared, own, now, request, before.get(ident)), dtype
                )
        return out


def dtype_of(arrays: PyTree) -> np.dtype[np.floating]:
    """Return the precision of a world's arrays."""
    return next(a.dtype for a in jax.tree.leaves(arrays) if a.dtype.kind == "f")


def batched(tree: T, batch: Sequence[int]) -> T:
    """Reshape arrays of copies (copies, ...) to arrays of a batch (points, trials, ...), or of one copy
    without a batch.
    """
    return jax.tree.map(lambda a: np.asarray(a).reshape((*batch, *np.shape(a)[1:])), tree)


def unbatched(tree: T, batch: Sequence[int]) -> T:
    """Reverse `batched`."""
    return jax.tree.map(lambda a: np.asarray(a).reshape(-1, *np.shape(a)[len(batch) :]), tree)


def _rows(tree: T) -> T:
    return jax.tree.map(lambda a: jnp.asarray(a)[None], tree)


def _copy(tree: T) -> T:
    return jax.tree.map(lambda a: a[0], tree)
