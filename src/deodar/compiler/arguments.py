"""The arguments of a program: nested dictionaries of arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple, NotRequired, TypeAlias, TypedDict

import numpy as np
from jax import Array

from deodar.compiler.functions import Constants
from deodar.element import Arrays
from deodar.numerics.exact import Exact
from deodar.numerics.pytree import PyTree

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
