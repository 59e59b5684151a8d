"""The step of one copy of a model as a pure function of its state and of some parameters, for analysis."""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.compiler.arguments import ProgramState, ProgramValues
from deodar.compiler.copy_batch import Batch
from deodar.compiler.dynamics import Dynamics
from deodar.compiler.moment import packed, unpacked
from deodar.compiler.plan import Leaf
from deodar.compiler.program import Chunk, Port, precision_context
from deodar.model.document import Document
from deodar.model.model import Model

PRECISION = "float64"


class PureStep:
    """The step of a document at one moment, in double precision.

    JAX can transform its methods; they are to be called and traced inside `precision_context("float64")`.

    Args:
        model: the model to which the document belongs.
        doc: the document, without noise and without parts of several ticks.
        parameters: the numbers that each parameter drives.
        at: document time, which does not advance.
        readings: values of sensors by id; those of others are 0.

    Attributes:
        executable: the compiled document.
        start: the state at the start.
        values: the present value of each parameter; 0 if it drives nothing.
        dt: Euler step.
    """

    def __init__(
        self,
        model: Model,
        doc: Document,
        parameters: Sequence[Sequence[Leaf]],
        at: float = 0.0,
    ) -> None:
        batch = Batch(sweep=tuple(tuple(leaves) for leaves in parameters))
        self.executable = found = Dynamics(model, doc, PRECISION).compiled(batch)
        self.dt = float(doc.step)
        values = found.values(doc)
        self.values = np.array([float(v[0]) for v in values["swept"][: len(parameters)]])
        self._base: ProgramValues = {**values, "swept": ()}
        self.start: ProgramState
        self.start, self._keys = found.init(values, 0, [0])
        self._readings = found.blind()
        whole, real = packed({"period": 1, "start": at, "dt": self.dt}, found.program.dtype)
        with precision_context(PRECISION):
            self._clock = unpacked(jnp.asarray(whole), jnp.asarray(real))

    def step(self, state: ProgramState, parameters: Array) -> ProgramState:
        """Return the state one step later, for these values of the parameters."""
        program = self.executable.program
        return program.step(self._chunk(parameters), state, {}, jnp.uint32(0), program.unperceived())

    def observe(self, ports: Sequence[Port], state: ProgramState, parameters: Array) -> tuple[Array, ...]:
        """Return the values of ports in a state."""
        return self.executable.program.observe(ports, self._chunk(parameters), state, jnp.uint32(0))

    def _chunk(self, parameters: Array) -> Chunk:
        program = self.executable.program
        swept = tuple(parameters[k] for k in range(len(self.values)))
        values: ProgramValues = {**self._base, "swept": swept}
        prepared = program.prepare_one(values)
        sensed = {**self._readings, **program.look(values, prepared, self._readings)}
        constants = program.hoist(values, prepared)
        still = program.steady(values, constants, sensed)
        return Chunk(values, constants, self._keys, sensed, self._clock, still)
