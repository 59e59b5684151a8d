"""Many copies of one field that differ in some parameters, each until it settles, for maps and tuning."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from deodar.analysis.isolated import Isolated
from deodar.analysis.selection import DISTANCE, places
from deodar.compiler.arguments import ProgramState
from deodar.compiler.build import Build
from deodar.compiler.driven import driven
from deodar.compiler.dynamics import Dynamics
from deodar.compiler.functions import Constants
from deodar.compiler.program import precision_context
from deodar.elements.field import Field
from deodar.elements.stimuli import GaussianStimulus
from deodar.errors import AnalysisError, ParameterError
from deodar.model import edit, find
from deodar.model.document import Document, Leaf
from deodar.model.model import Model
from deodar.numerics.axes import Axes
from deodar.parameters import real, show

STRONG = 1.2
"""Default input relative to the distance between resting level and threshold: it makes a peak without
interaction.
"""

TOLERANCE = 2e-4
"""Change of activation per time constant that counts as settled, relative to the same distance."""

INPUTS = ("middle", "first", "second")
"""The inputs of the protocol: one alone, and two at equal distances from it."""

LEAST_LANES = 8
"""Fewest copies that are computed at once."""

LANE_BYTES = 8 * 2**20
"""Largest number of bytes of the matrices of all copies, if each has its own; `LEAST_LANES` need fewer."""

LEAST_BLOCKS = 2
"""Blocks of steps, each a time constant long, after which a stage may end."""


# ------------------------------------------------------------------------------------------- what is measured


@dataclass(frozen=True, kw_only=True)
class SettlingRequest:
    """One field alone, with the inputs of the protocol, and the parameters in which copies differ.

    Attributes:
        isolated: the field, as other measurements see it.
        model: the same field with the inputs `middle`, `first` and `second`.
        leaves: numbers of `model` that each parameter drives.
        strength: amplitude of each input.
        limit: longest stage, in time constants.
    """

    isolated: Isolated
    model: Model
    leaves: tuple[tuple[Leaf, ...], ...]
    strength: float
    limit: float

    @property
    def places(self) -> tuple[float, ...]:
        """The positions of the two inputs; none on a node."""
        return tuple(at for (at,) in places(self.isolated, DISTANCE)) if self.isolated.axes else ()

    @property
    def samples(self) -> tuple[int, ...]:
        """The samples of the two inputs; none on a node."""
        return tuple(int(np.abs(self.isolated.axes[0].points - at).argmin()) for at in self.places)

    @property
    def tolerance(self) -> float:
        """The largest change of activation per time constant that counts as settled."""
        return TOLERANCE * self.isolated.scale

    @property
    def threshold_of(self) -> int | None:
        """Which parameter is the threshold above which a peak exists; None if none is."""
        ident = find.element(self.model.document, "field").id
        return next((k for k, leafs in enumerate(self.leaves) if (ident, "sigmoid.threshold") in leafs), None)


def require_one_axis(isolated: Isolated, who: str, fix: str) -> None:
    """Raise AnalysisError if a field has more than one axis; `who` counts its peaks."""
    if len(isolated.axes) > 1:
        problem = f"has {len(isolated.axes)} axes; {who} counts peaks on one axis, or measures a node"
        raise AnalysisError(problem, where=isolated.path, fix=fix)


def only_field(doc: Document) -> str:
    """Return the path of the only field of a document.

    Raises:
        AnalysisError: the document has none, or several.
    """
    fields = [e.path for e in doc.entries if isinstance(e.element, Field)]
    if len(fields) != 1:
        raise AnalysisError(
            f"the model has {len(fields)} fields" if fields else "the model has no field",
            fix=f"Name one: field={fields[0]!r}" if fields else "",
        )
    return fields[0]


def positive(name: str, value: Any) -> float:
    """Return a finite number above 0.

    Raises:
        ParameterError: the value is none.
    """
    number = real(value)
    if number is None or not 0 < number < float("inf"):
        raise ParameterError(f"{name} is {show(value)}; expected a number above 0")
    return number


def with_inputs(isolated: Isolated, trusted: bool) -> Model:
    """Return the isolated field with the inputs of the protocol."""
    small = Model(document=isolated.session.document, trusted=trusted)
    for name in ("input", "second", "boost"):
        small.remove(name)
    axes = isolated.axes
    where = dict.fromkeys(INPUTS, isolated.center)
    if axes:
        where["first"], where["second"] = places(isolated, DISTANCE)
    for name in INPUTS:
        stimulus = GaussianStimulus(
            name, axes, center=where[name] or 0.0, sigma=isolated.sigma or 1.0, amplitude=0.0
        )
        small.add(stimulus) >> small["field"]
    return small


def driven_alone(doc: Document, small: Document, isolated: Isolated, path: str) -> tuple[Leaf, ...]:
    """Return the numbers of the isolated field that a parameter of the model drives."""
    ids = {find.element(doc, isolated.path).id: find.element(small, "field").id}
    for path_of_input in isolated.background:
        ids[find.element(doc, path_of_input).id] = find.element(small, f"background.{path_of_input}").id
    leaves = driven(doc, path)
    driven_leaves = tuple((ids[ident], leaf) for ident, leaf in leaves if ident in ids)
    if not driven_leaves:
        raise AnalysisError(
            f"does not belong to {isolated.path}, which is measured alone",
            where=path,
            fix="Name parameters of the field, or keep the stimulus as constant input: inputs=[PATH]",
        )
    field_id = find.element(small, "field").id
    for ident, leaf in driven_leaves:
        name = leaf.split(".")[0]
        if ident == field_id and name in ("noise", "noise_length"):
            raise AnalysisError("changes no regime: noise is off in the measurement", where=path)
        if ident == field_id and name == "tau":
            raise AnalysisError(
                "changes no regime: the steady states of a field do not depend on it", where=path
            )
    return driven_leaves


# ----------------------------------------------------------------------------------------- how it is computed


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


R = TypeVar("R", bound=SettlingRequest)


class SettlingLanes(Generic[R]):
    """Copies that are computed at once, with parameters and inputs of their own.

    Args:
        request: what is measured.
        inputs: the elements whose amplitudes are the last parameters.
        most: largest number of copies; fewer if each has large matrices of its own.

    Attributes:
        lanes: number of copies.
        steps: steps of a block, which lasts a time constant.
        longest: largest number of blocks of a stage.
    """

    def __init__(self, request: R, inputs: tuple[str, ...], most: int) -> None:
        doc, session = request.model.document, request.isolated.session
        amplitudes = [((find.element(doc, name).id, "amplitude"),) for name in inputs]

        def copies(lanes: int) -> SettlingCopies:
            leaves = [*request.leaves, *amplitudes]
            return SettlingCopies(request.model, leaves, lanes, session.precision, session.dt)

        self.request = request
        self.axes: Axes = request.isolated.axes
        self.copies = copies(most)
        matrix = sum(axis.samples**2 for axis in self.axes) * self.copies.dtype.itemsize
        if self.copies.rebuilt and matrix * most > LANE_BYTES:
            self.copies = copies(max(LEAST_LANES, LANE_BYTES // matrix))
        self.lanes = self.copies.count
        self._place = self.copies.dynamics.executable.plan.row[find.element(doc, "field").id]
        tau, dt = request.isolated.field.tau, session.dt
        self.steps = max(2, math.ceil(tau / dt))
        self.longest = max(LEAST_BLOCKS, math.ceil(request.limit * tau / (self.steps * dt)))
        self._compiled: dict[Callable[..., Any], Callable[..., Any]] = {}

    def call(self, function: Callable[..., Any], *args: Any) -> Any:
        """Return what a function of arrays returns, compiled at its first call."""
        if function not in self._compiled:
            self._compiled[function] = jax.jit(function)
        precision = self.request.isolated.session.precision
        with precision_context(precision), jax.default_matmul_precision("highest"):
            return self._compiled[function](*args)

    def change(self, begin: Array, last: Array, after: Array) -> Array:
        """Return the largest change of activation per time constant: over a block, or in its last step.

        Args:
            begin: activation before the block, copies first.
            last: activation before its last step.
            after: activation after it.
        """
        tau, dt = self.request.isolated.field.tau, self.copies.dynamics.dt
        slow = jnp.abs(after - begin).max(-1) * (tau / (self.steps * dt))
        fast = jnp.abs(after - last).max(-1) * (tau / dt)
        return jnp.maximum(slow, fast)

    def threshold(self, parameters: Array) -> Array:
        """Return the activation above which a peak exists, for each copy."""
        number = self.request.threshold_of
        if number is not None:
            return parameters[:, number]
        return jnp.full(self.lanes, self.request.isolated.threshold, parameters.dtype)

    def activation(self, state: ProgramState) -> Array:
        """Return the activation of the field, copies first; a node has one sample."""
        group, row = self._place
        return state["groups"][group]["activation"][:, row].reshape(self.lanes, -1)
