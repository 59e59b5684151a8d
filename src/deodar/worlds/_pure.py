"""Base class of worlds that are pure functions: written for one copy, vectorised over all copies."""

from __future__ import annotations

import contextlib
import copy
import functools
import hashlib
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from jax.typing import DTypeLike

from deodar.element import Arrays
from deodar.errors import WorldError
from deodar.kind_errors import position
from deodar.numerics.axes import Axes, shape
from deodar.numerics.copies import any_copy
from deodar.numerics.noise import element_keys
from deodar.numerics.processor import on_cpu
from deodar.numerics.pytree import PyTree
from deodar.worlds._base import World


class PureWorld(World):
    """A world whose state is a PyTree of arrays, and whose step is a function of arrays that JAX can trace.

    Arguments of the functions:
        shared: arrays that are the same for all copies (walls, amplitudes), as `shared` returns them; they
            may change during a run.
        own: arrays of one copy, as `own` returns them; and under `keys` two words for each name in `noises`,
            the key of its noise.
        state: the PyTree that `start` and `advance` return.

    Noise is drawn like that of elements (`numerics.noise`), keyed by the seed, the trial and the name of the
    noise: it is the same in every batch, in both precisions, on the host and inside the compiled step.
    """

    noises: tuple[str, ...] = ()
    inside = True
    """Whether batches compute the world inside the compiled step; outside it, results are equal but slow."""

    # ------------------------------------------------------------------------------------ what a world writes

    def shared(self) -> dict[str, np.ndarray]:
        """Return the arrays that all copies share, with their present values."""
        return {}

    def own(self, trials: Sequence[int]) -> dict[str, np.ndarray]:
        """Return the arrays of each copy, copies first; `trials` has the trial number of each copy."""
        return {}

    def start(self, shared: Arrays, own: PyTree) -> PyTree:
        """Return the initial state."""
        raise NotImplementedError

    def read(self, shared: Arrays, own: PyTree, state: PyTree, sensor: str, axes: Axes) -> Any:
        """Return the reading of a sensor, sampled over `axes`."""
        raise NotImplementedError

    def advance(self, shared: Arrays, own: PyTree, state: PyTree, motors: Arrays) -> PyTree:
        """Return the state one period later; `motors` has the value of every motor."""
        raise NotImplementedError

    def for_trial(self, trial: int) -> PureWorld:
        """Return a copy of the world with the objects of one trial.

        `place`, `move` and `remove` change the copy, and with it the arrays that `own` returns for this
        trial, but not those of other trials. Actions on a trial in a batch need this method.
        """
        raise WorldError(
            f"the objects of the world {type(self).__name__} cannot be changed in one trial of a batch",
            fix="Run the trials one by one: dd.Trials(..., together=False)",
        )

    def own_values(self, trial: int) -> dict[str, np.ndarray]:
        """Return the present arrays of a copy of one trial, in the precision of the model."""
        return {name: self._cast(values)[0] for name, values in self.own([trial]).items()}

    def renews(self, state: PyTree, sensor: str) -> Array:
        """Return whether a sensor whose signal has a period of its own has a new reading in this state, the
        first one after `advance`.

        It has one at the start and after each multiple of its period. In between the reading is held and not
        computed; `read` returns the same reading all the while.
        """
        return jnp.ones((), bool)

    def reading(
        self, shared: Arrays, own: PyTree, state: PyTree, request: tuple[str, Axes], before: Array | None
    ) -> Array:
        """Return the reading of a sensor over axes; `before` is the last one, which is held if the sensor has
        no new one in any copy, or None.
        """
        sensor, axes = request
        signal = self.sensors.get(sensor)

        def read() -> Array:
            dtype = None if before is None else before.dtype
            array = jnp.asarray(self.read(shared, own, state, sensor, axes), dtype)
            if array.ndim and array.shape != shape(axes):
                what = f"{position(type(self), 'read')} returns an array of shape {list(array.shape)}"
                raise WorldError(f"{what} in place of {list(shape(axes))}", where=sensor)
            return jnp.broadcast_to(array, shape(axes))

        if before is None or signal is None or signal.period is None:
            return read()
        return lax.cond(any_copy(self.renews(state, sensor)), read, lambda: before)

    def passed(self) -> None:
        """Do what a view needs after each period on the host; batches inside the compiled step omit it."""

    # ----------------------------------------------------------------------------------- computed on the host

    def reset(self, seed: int, trials: Sequence[int] = (0,), precision: str = "float32") -> None:
        self._trials = tuple(trials)
        self._dtype: np.dtype[np.floating] = np.dtype(precision)
        numbers = np.asarray([number(name) for name in self.noises], np.uint32)
        words = self.call("keys", _keys, np.uint32(seed), np.asarray(trials, np.uint32), numbers)
        self._keys = {name: np.asarray(words)[:, k] for k, name in enumerate(self.noises)}
        copies = len(self._trials)  # a world may have no array of a copy
        self._state: PyTree = self.call(
            ("start", copies),
            lambda world: jax.vmap(world.start, in_axes=(None, 0), axis_size=copies),
            *self._values(),
        )

    def sense(self, sensor: str, axes: Axes, time: float) -> np.ndarray:
        return self._readings([(sensor, axes)])[0]

    def sense_all(self, requests: Sequence[tuple[str, Axes]], time: float) -> list[np.ndarray]:
        if type(self).sense is not PureWorld.sense:
            return super().sense_all(requests, time)
        return self._readings(requests)

    def _readings(self, requests: Sequence[tuple[str, Axes]]) -> list[np.ndarray]:
        """Read several sensors in one call of a compiled function."""
        names = self._names(requests)
        seen = self.call(
            names,
            lambda world: jax.vmap(_reading(world, names), in_axes=(None, 0, 0)),
            *self._values(),
            self._now(),
        )
        return [np.asarray(reading) for reading in seen]

    def _names(self, requests: Sequence[tuple[str, Axes]]) -> tuple[tuple[str, Axes], ...]:
        for sensor, _ in requests:
            self.require(sensor)
        return tuple((sensor, tuple(axes)) for sensor, axes in requests)

    def act(self, motors: Mapping[str, np.ndarray], time: float) -> None:
        self._state = self.call(
            "advance",
            lambda world: jax.vmap(world.advance, in_axes=(None, 0, 0, 0)),
            *self._values(),
            self._now(),
            self._commands(motors),
        )
        self.passed()

    @property
    def exchanges(self) -> bool:
        """Whether `exchange` replaces `act` and `sense_all`; False where a subclass defines one of them."""
        kind = type(self)
        methods = (kind.act, kind.sense, kind.sense_all)
        return methods == (PureWorld.act, PureWorld.sense, PureWorld.sense_all)

    def exchange(
        self,
        motors: Mapping[str, np.ndarray],
        requests: Sequence[tuple[str, Axes]],
        before: Sequence[np.ndarray] | None = None,
    ) -> list[np.ndarray]:
        """Advance by one period, as `act` does, and return the readings of several sensors after it, in one
        call of a compiled function. After an error nothing changed.

        `before` are the readings before this period; those of sensors with a period of their own are held.
        """
        names = self._names(requests)
        slow = [self.sensors[sensor].period is not None for sensor, _ in names]
        lasting = [a for a, is_slow in zip(before or [], slow, strict=False) if is_slow]

        def both(world: PureWorld) -> Callable[..., Any]:
            def advance(
                shared: Arrays, own: PyTree, state: PyTree, commands: Arrays, held: Sequence[Array]
            ) -> Any:
                new, last = world.advance(shared, own, state, commands), iter(held)
                return new, [
                    world.reading(shared, own, new, name, next(last, None) if is_slow else None)
                    for name, is_slow in zip(names, slow, strict=True)
                ]

            return jax.vmap(advance, in_axes=(None, 0, 0, 0, 0))

        self._state, seen = self.call(
            ("exchange", len(lasting), *names),
            both,
            *self._values(),
            self._now(),
            self._commands(motors),
            lasting,
        )
        self.passed()
        return [np.asarray(reading) for reading in seen]

    def _commands(self, motors: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Return the value of every motor in the precision of the model, 0 for one that nothing drives."""
        copies = len(self._trials)
        commands = {
            name: motors.get(name, np.zeros((copies, *(signal.shape or ()))))
            for name, signal in self.motors.items()
        }
        return {name: np.asarray(value, self._dtype) for name, value in commands.items()}

    def keep(self) -> Any:
        return jax.tree.map(np.asarray, self._now())

    def put(self, kept: Any) -> None:
        if kept is not None:
            self._state = kept

    def structure(self) -> Hashable:
        """Return a key of all attributes that the functions use.

        Worlds of one class with equal keys share compiled programs.
        """
        return id(self)

    def parts(self) -> tuple[PyTree, PyTree, PyTree]:
        """Return the present `shared`, `own` and `state`, the last two with copies first."""
        return *self._values(), self._now()

    def _now(self) -> PyTree:
        if not hasattr(self, "_state"):
            raise WorldError(f"the world {type(self).__name__} has not begun", fix="Type: world.reset(seed)")
        return self._state

    def _values(self) -> tuple[PyTree, PyTree]:
        own = self.own(self._trials)
        return jax.tree.map(self._cast, self.shared()), {**jax.tree.map(self._cast, own), "keys": self._keys}

    def _cast(self, values: Any) -> np.ndarray:
        array = np.asarray(values)
        return array.astype(self._dtype) if array.dtype.kind == "f" else array

    def call(self, name: Hashable, make: Callable[[PureWorld], Callable[..., Any]], *args: Any) -> Any:
        """Compile and run a function of this world, in the precision of the model.

        Worlds of one structure share the compiled function.

        Args:
            name: key of the function among those of the world; it must contain every value that the function
                uses besides the world and `args`.
            make: returns the function for a world.
            args: arguments of the function.
        """
        function = _compiled(_Program(type(self), self.structure(), name, self._dtype, self, make))
        double = jax.enable_x64(True) if self._dtype == np.float64 else contextlib.nullcontext()
        with on_cpu(), double:
            return function(*args)


@dataclass(frozen=True)
class _Program:
    """Cache key of a compiled function; keys with the same kind, structure, name and precision are equal."""

    kind: type
    structure: Hashable
    name: Hashable
    dtype: DTypeLike
    world: PureWorld = field(compare=False)
    make: Callable[[PureWorld], Callable[..., Any]] = field(compare=False)


@functools.lru_cache(maxsize=64)
def _compiled(program: _Program) -> Callable[..., Any]:
    """Compile a function of a copy of the world, which later changes of the original do not affect."""
    return jax.jit(program.make(copy.copy(program.world)))


def _reading(world: PureWorld, requests: Sequence[tuple[str, Axes]]) -> Callable[..., Any]:
    """Return the function that reads several sensors of one copy."""

    def read(shared: Arrays, own: PyTree, state: PyTree) -> Any:
        return [world.reading(shared, own, state, request, None) for request in requests]

    return read


def _keys(_: PureWorld) -> Callable[..., Any]:
    return jax.vmap(element_keys, in_axes=(None, 0, None))


def number(name: str) -> int:
    """Return the number that keys a noise of a world.

    The hashed text starts with "world: ", so that it differs from the paths that elements are numbered by.
    """
    return int.from_bytes(hashlib.blake2b(f"world: {name}".encode(), digest_size=4).digest(), "big")
