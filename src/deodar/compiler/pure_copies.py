"""The step of many copies of a model as pure functions of their states and parameters, for analysis."""

from __future__ import annotations

from collections.abc import Sequence

import jax
import jax.numpy as jnp
from jax import Array

from deodar.compiler.arguments import ProgramState, ProgramValues
from deodar.compiler.copy_batch import Batch
from deodar.compiler.dynamics import Dynamics
from deodar.compiler.functions import Constants
from deodar.compiler.moment import packed, unpacked
from deodar.compiler.plan import Leaf
from deodar.compiler.program import Chunk, precision_context
from deodar.model.document import Document
from deodar.model.model import Model


class PureCopies:
    """The step of several copies of a document that differ in some parameters.

    Copies share what no parameter rebuilds: kernels whose amplitudes alone differ have one matrix for all.
    JAX can transform the methods; they are to be called and traced inside `precision_context(precision)`.

    Args:
        model: the model to which the document belongs.
        doc: the document, without noise, without sensors and without parts of several ticks.
        parameters: the numbers that each parameter drives.
        copies: number of copies.
        precision: float32 or float64.
        dt: Euler step.

    Attributes:
        executable: the compiled document.
        count: number of copies.
        dt: Euler step.
        rebuilt: whether a parameter rebuilds constants, so that each copy has its own.
    """

    def __init__(
        self,
        model: Model,
        doc: Document,
        parameters: Sequence[Sequence[Leaf]],
        copies: int,
        precision: str,
        dt: float,
    ) -> None:
        batch = Batch(points=copies, sweep=tuple(tuple(leaves) for leaves in parameters))
        self.executable = found = Dynamics(model, doc, precision).compiled(batch)
        self.count, self.dt = copies, dt
        self._base: ProgramValues = {**found.values(doc), "swept": ()}
        self.rebuilt = any(found.program.rebuilt)
        self._rebuilt = [0 if own else None for own in found.program.rebuilt]
        whole, real = packed({"period": 1, "dt": self.dt}, found.program.dtype)
        with precision_context(precision):
            self._clock = unpacked(jnp.asarray(whole), jnp.asarray(real))

    def constants(self, parameters: Array) -> list[Constants]:
        """Return the constants for parameters (copies, parameters)."""
        return self.executable.program.prepare(self._values(parameters.T))

    def start(self, parameters: Array) -> ProgramState:
        """Return the states at the start of a run, copies first."""
        program, nothing = self.executable.program, jnp.uint32(0)
        return jax.vmap(lambda own: program.init(self._values(own), nothing, nothing)[0])(parameters)

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
        program = self.executable.program

        def one(
            own: Array, constants: list[Constants], state: ProgramState
        ) -> tuple[ProgramState, ProgramState]:
            values = self._values(own)
            hoisted = program.hoist(values, constants)
            still = program.steady(values, hoisted, {})
            chunk = Chunk(values, hoisted, {}, {}, self._clock, still)

            def step(state: ProgramState) -> ProgramState:
                return program.step(chunk, state, {}, jnp.uint32(0), program.unperceived())

            before = jax.lax.fori_loop(0, steps - 1, lambda _, state: step(state), state)
            return before, step(before)

        return jax.vmap(one, in_axes=(0, self._rebuilt, 0))(parameters, constants, state)

    def _values(self, parameters: Array) -> ProgramValues:
        """Return the values for parameters whose first axis is that of the parameters."""
        return {**self._base, "swept": tuple(parameters)}
