"""The arguments of a program: nested dictionaries of arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple, NotRequired, TypeAlias, TypedDict, cast

import numpy as np
from jax import Array

from deodar.compiler.functions import Constants
from deodar.element import Arrays
from deodar.numerics.exact import Exact, split
from deodar.numerics.pytree import PyTree

if TYPE_CHECKING:
    from jax.typing import DTypeLike

EitherArray = Array | np.ndarray
"""An array of a program or of the host."""

NoiseKeys: TypeAlias = "dict[str, Array] | dict[str, Array | NoiseKeys]"
"""Two key words for each row of the noisy groups; under `world` the arrays of a world inside the step."""


class ProgramValues(TypedDict):
    """The parameters of a model.

    Attributes:
        vector: all scalar leaves.
        arrays: arrays by group and leaf.
        swept: one value for each sweep.
        world: arrays that all copies of a world inside the step share.
    """

    vector: EitherArray
    arrays: dict[str, EitherArray]
    swept: tuple[EitherArray, ...]
    world: NotRequired[Arrays]


class BodyState(TypedDict):
    """The state of a world inside the step: the world, what its sensors show, the commands of its motors."""

    now: PyTree
    sensed: Arrays
    commands: Arrays


class ProgramState(TypedDict):
    """The state of a model.

    Attributes:
        groups: the state of each group.
        held: new states of slow groups that are not yet visible.
        world: the state of a world inside the step.
    """

    groups: list[Arrays]
    held: dict[str, Arrays]
    world: NotRequired[BodyState]


class ProgramClock(TypedDict):
    """When it is, and how many steps and records there are to be; empty where no output depends on time."""

    tick: Array
    origin: Array
    period: Array
    head: Array
    every: Array
    records: Array
    start: Exact
    dt: Exact


class ProgramArguments(NamedTuple):
    """The arguments of a chunk and of a reader, in their order; a JAX PyTree.

    Attributes:
        values, constants, keys, sensed: as of `Chunk`, before `hoist`; batched like the copies.
        state: state of the copies.
        whole, real: the clock, as `packed` gives it.
    """

    values: ProgramValues
    constants: list[Constants]
    state: ProgramState
    keys: NoiseKeys
    sensed: Mapping[str, EitherArray]
    whole: EitherArray
    real: EitherArray


WHOLE = ("tick", "origin", "period", "head", "every", "records")
REAL = ("start", "dt")


def packed(now: Mapping[str, float], dtype: DTypeLike) -> tuple[np.ndarray, np.ndarray]:
    """Pack the time and the numbers of steps and records into two arrays, as each argument of a program costs
    microseconds.

    The time is `start` at the tick `origin`; `start` and `dt` keep the digits of float64.
    """
    whole = np.array([now.get(name, 0) for name in WHOLE], np.uint32)
    return whole, np.stack(split([now.get(name, 0.0) for name in REAL], dtype))


def unpacked(whole: EitherArray, real: EitherArray) -> ProgramClock:
    """Return the packed numbers by name."""
    named = {name: whole[k] for k, name in enumerate(WHOLE)} | {
        name: Exact(real[0, k], real[1, k]) for k, name in enumerate(REAL)
    }
    return cast("ProgramClock", named)
