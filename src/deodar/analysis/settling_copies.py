"""The step of many copies of a model that differ in some parameters, for loops that JAX compiles."""

from __future__ import annotations

import jax
import numpy as np
from jax import Array

from deodar.compiler.arguments import ProgramState
from deodar.compiler.build import Build
from deodar.compiler.dynamics import Dynamics
from deodar.compiler.functions import Constants
from deodar.model import edit
from deodar.model.document import Leaf
from deodar.model.model import Model


class SettlingCopies:
    """Several copies of a model without noise, sensors and parts of several ticks, from time 0.

    Copies share what no parameter rebuilds: kernels whose amplitudes alone differ have one matrix for all.
    The methods are to be called and traced inside `dynamics.context()`.

    Args:
        model: the model.
        parameters: the numbers that each parameter drives.
        copies: number of copies, at least 2.
        precision: float32 or float64.
        dt: Euler step.

    Attributes:
        dynamics: the step of one copy.
        count: number of copies.
        rebuilt: whether a parameter rebuilds constants, so that each copy has its own.
    """

    def __init__(
        self, model: Model, parameters: list[tuple[Leaf, ...]], copies: int, precision: str, dt: float
    ) -> None:
        doc = edit.describe(model.document, dt=dt, t0=0.0)
        drives = {str(k): leaves for k, leaves in enumerate(parameters)}
        self.dynamics = Dynamics(model, Build(doc, precision), drives, width=copies, plain=False)
        self.count = copies
        self.rebuilt = any(self.dynamics.rebuilt)
        self._axes = [0 if differs else None for differs in self.dynamics.rebuilt]

    @property
    def dtype(self) -> np.dtype[np.floating]:
        """The working precision."""
        return self.dynamics.executable.program.dtype

    def constants(self, parameters: Array) -> list[Constants]:
        """Return the constants for parameters (copies, parameters)."""
        return jax.vmap(
            lambda row: self.dynamics.constants(_named(row)),
            out_axes=self._axes,
        )(parameters)

    def start(self, parameters: Array) -> ProgramState:
        """Return the states at the start of a run, copies first."""
        d = self.dynamics
        return jax.vmap(lambda row: d.init(_named(row)))(parameters)

    def run(
        self, parameters: Array, constants: list[Constants], state: ProgramState, steps: int
    ) -> tuple[ProgramState, ProgramState]:
        """Return the states before and after the last of a number of steps.

        Args:
            parameters: values of the parameters, (copies, parameters).
            constants: what `constants` returned.
            state: the states, copies first.
            steps: number of steps, at least 1.
        """
        d = self.dynamics

        def one(
            row: Array, constants: list[Constants], state: ProgramState
        ) -> tuple[ProgramState, ProgramState]:
            prepared, key = d.prepare(_named(row), constants), d.key()

            def step(state: ProgramState) -> ProgramState:
                return d.step(prepared, state, {}, 0, key)

            before = jax.lax.fori_loop(0, steps - 1, lambda _, state: step(state), state)
            return before, step(before)

        return jax.vmap(one, in_axes=(0, self._axes, 0))(parameters, constants, state)


def _named(parameters: Array) -> dict[str, Array]:
    return {str(k): value for k, value in enumerate(parameters)}
