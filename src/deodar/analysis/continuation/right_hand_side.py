"""The right-hand side of a model as a pure function, for any method that works with functions of JAX."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.flatten_util import ravel_pytree

from deodar.compiler.arguments import ProgramState
from deodar.compiler.build import Build
from deodar.compiler.driven import driven
from deodar.compiler.dynamics import Dynamics
from deodar.compiler.program import precision_context
from deodar.element import Element
from deodar.elements.world_ports import Sensor
from deodar.errors import AnalysisError, ParameterError, did_you_mean
from deodar.leaves import leaves
from deodar.model import edit, find
from deodar.model.document import Document, Entry, Leaf
from deodar.model.model import Model
from deodar.numerics.axes import Axes, shape

PRECISION = "float64"


@dataclass(frozen=True)
class StatePart:
    """A part of the state: one array of one element.

    Attributes:
        path: path of the element.
        name: name of the array, such as `activation`.
        first: index of its first number in the full state.
        shape: samples along each axis.
        axes: axes of the port of this name; empty if the element has no such port.
        tau: time constant in document time; 1 if the element has none.
    """

    path: str
    name: str
    first: int
    shape: tuple[int, ...]
    axes: Axes
    tau: float

    @property
    def size(self) -> int:
        """How many numbers it has."""
        return math.prod(self.shape)


class RightHandSide:
    r"""The rate of change of a model without noise, at one moment, as a pure function in double precision.

    The state x is the vector of all numbers that change from step to step. Time is constant, so that
    stimuli keep the values that they have then.

    Equation:
        F(x, p) = T\, \frac{\Phi_{dt}(x, p) - x}{dt},\quad T = \mathrm{diag}(\tau)

    where Phi is the step of the model. On a field F is -u + h + s + ..., whatever the Euler step. A root of F
    is a steady state.

    Args:
        model: the model.
        doc: its document, prepared by `right_hand_side`.
        parameters: paths of the parameters p.
        at: document time.
        held: ids of elements whose state is constant, at its start.
        even: names of the axes about whose middle all states are mirror images of themselves.

    Attributes:
        parameters: paths of the parameters.
        values: their present values.
        parts: the arrays that x consists of, without those that are held.
        time_constants: tau of each number of x.
        start: x at the start of a run.
        even: the axes about which states are even.
    """

    def __init__(
        self,
        model: Model,
        doc: Document,
        parameters: Sequence[str],
        at: float = 0.0,
        held: frozenset[str] = frozenset(),
        even: Sequence[str] = (),
    ) -> None:
        self.model, self.doc, self.at, self.held = model, doc, at, held
        self.parameters, self.even = tuple(parameters), tuple(even)
        drives = {str(k): tuple(driven(doc, path)) for k, path in enumerate(parameters)}
        self._dynamics = d = Dynamics(model, Build(edit.describe(doc, t0=at), PRECISION), drives)
        self.dt = d.dt
        self.values = np.array([float(value) for value in d.parameters.values()])
        with d.context():
            self._key, self._start = d.key(), d.init()
            full, self._unravel = ravel_pytree(self._start["groups"])
        self._full = np.asarray(full, float)
        self.parts, free, tau = self._parts()
        self._orbit, self._weight = _orbits(self.parts, free, self.even)
        self.time_constants = self._reduced(tau[free]) / self._reduced(np.ones(free.size))
        self._free = free
        self.start = self._reduced(self._full[free])

    # ----------------------------------------------------------------------------------------------- layout

    def _parts(self) -> tuple[tuple[StatePart, ...], np.ndarray, np.ndarray]:
        """Return the parts that are not held, the indices of their numbers, and tau of every number."""
        plan, groups = self._dynamics.executable.plan, self._start["groups"]
        parts: list[StatePart] = []
        first, tau = 0, np.ones(self._full.size)
        by = self.doc.by_id()
        for g, state in enumerate(groups):
            for name, rows in sorted(state.items()):
                array = np.asarray(rows)
                for row, node in enumerate(plan.groups[g].nodes):
                    time_constant = float(
                        getattr(node.element, "tau", 1.0) if _has_tau(node.element) else 1.0
                    )
                    size = int(array[row].size)
                    tau[first : first + size] = time_constant
                    if node.id in by and node.id not in self.held:
                        axes = node.outs.get(name, ())
                        axes = axes if shape(axes) == array[row].shape else ()
                        parts.append(
                            StatePart(by[node.id].path, name, first, array[row].shape, axes, time_constant)
                        )
                    first += size
        free = [np.arange(part.first, part.first + part.size) for part in parts]
        return tuple(parts), np.concatenate(free) if free else np.arange(0), tau

    @property
    def size(self) -> int:
        """How many numbers x has."""
        return self.start.size

    def full(self, x: np.ndarray) -> np.ndarray:
        """Return all numbers of the parts of a state that is even."""
        return x[self._orbit] * self._weight

    def _reduced(self, numbers: np.ndarray) -> np.ndarray:
        """Return the coordinates of numbers of the parts among even states."""
        return np.bincount(
            self._orbit, numbers * self._weight, minlength=int(self._orbit.max(initial=-1)) + 1
        )

    def state(self, x: np.ndarray) -> dict[str, np.ndarray]:
        """Return the arrays of a state by element and name, such as `u.activation`."""
        numbers, at = self.full(x), 0
        arrays: dict[str, np.ndarray] = {}
        for part in self.parts:
            arrays[f"{part.path}.{part.name}"] = numbers[at : at + part.size].reshape(part.shape)
            at += part.size
        return arrays

    def vector(self, state: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return x for arrays by element and name, as `state` returns them."""
        numbers = [
            np.broadcast_to(state[f"{p.path}.{p.name}"], p.shape).astype(float).ravel() for p in self.parts
        ]
        return self._reduced(np.concatenate(numbers) if numbers else np.zeros(0))

    def shifts(self, x: np.ndarray) -> list[np.ndarray]:
        """Return the directions, of unit length, in which a state moves along each axis that is not even.

        Without input such a direction is a mode that neither grows nor decays, up to the grid: a peak may
        stand anywhere.
        """
        state = self.state(x)
        names = {axis.name: None for part in self.parts for axis in part.axes if axis.samples > 2}
        directions: list[np.ndarray] = []
        for name in names:
            if name in self.even:
                continue
            by = {f"{part.path}.{part.name}": part.axes for part in self.parts}
            vector = self.vector({key: _slope(state[key], axes, name) for key, axes in by.items()})
            if (size := float(np.linalg.norm(vector))) > 0:
                directions.append(vector / size)
        return directions

    # ------------------------------------------------------------------------------------------- functions

    def function(self, x: Array, parameters: Array) -> Array:
        """Return F; a pure function, to be traced inside `jax.enable_x64(True)`."""
        before = self._expanded(x)
        new = self._stepped(before, parameters)
        rates = (new - before)[self._free] / self.dt
        reduced = jax.ops.segment_sum(rates * self._weight, self._orbit, num_segments=self.size)
        return jnp.asarray(self.time_constants) * reduced

    def _expanded(self, x: Array) -> Array:
        return jnp.asarray(self._full).at[self._free].set(x[self._orbit] * self._weight)

    def _stepped(self, full: Array, parameters: Array) -> Array:
        d, prepared = self._dynamics, self._dynamics.prepare(self._named(parameters))
        return ravel_pytree(d.step(prepared, self._state(full), {}, 0, self._key)["groups"])[0]

    def _state(self, full: Array) -> ProgramState:
        groups: Any = self._unravel(full)
        return {"groups": groups, "held": {}}

    def _named(self, parameters: Array) -> dict[str, Array]:
        return {str(k): parameters[k] for k in range(len(self.parameters))}

    @cached_property
    def _compiled(self) -> dict[str, Callable[..., Any]]:
        f = self.function

        def run(x: Array, p: Array, steps: Array, least: Array) -> Array:
            def going(carry: tuple[Array, Array, Array]) -> Array:
                steps_left, _, rates = carry
                return (steps_left > 0) & (jnp.max(jnp.abs(rates), initial=0.0) > least)

            def step(carry: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
                steps_left, x, rates = carry
                x = x + self.dt * rates / jnp.asarray(self.time_constants)
                return steps_left - 1, x, f(x, p)

            return jax.lax.while_loop(going, step, (steps, x, f(x, p)))[1]

        return {
            "rates": jax.jit(f),
            "linear": jax.jit(lambda x, p: (f(x, p), jax.jacfwd(f, 0)(x, p), jax.jacfwd(f, 1)(x, p))),
            "along": jax.jit(lambda x, p, dx, dp: jax.jvp(f, (x, p), (dx, dp))[1]),
            "gradient": jax.jit(lambda x, p, w: jax.vjp(lambda q: f(x, q), p)[1](w)[0]),
            "back": jax.jit(lambda x, p, w: jax.vjp(lambda y: f(y, p), x)[1](w)[0]),
            "run": jax.jit(run),
            "curvature": jax.jit(
                lambda x, p, v, w: jax.grad(
                    lambda y, q: w @ jax.jvp(lambda s: f(s, q), (y,), (v,))[1], argnums=(0, 1)
                )(x, p)
            ),
        }

    def _call(self, name: str, *args: Any) -> Any:
        with precision_context(PRECISION), jax.default_matmul_precision("highest"):
            return jax.tree.map(np.asarray, self._compiled[name](*(jnp.asarray(a) for a in args)))

    def rates(self, x: np.ndarray, parameters: np.ndarray) -> np.ndarray:
        """Return F."""
        return self._call("rates", x, parameters)

    def linear(self, x: np.ndarray, parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return F and its derivatives, (states, states) and (states, parameters)."""
        return self._call("linear", x, parameters)

    def along(self, x: np.ndarray, parameters: np.ndarray, dx: np.ndarray, dp: np.ndarray) -> np.ndarray:
        """Return the derivative of F along a direction."""
        return self._call("along", x, parameters, dx, dp)

    def back(self, x: np.ndarray, parameters: np.ndarray, w: np.ndarray) -> np.ndarray:
        """Return the product of a row vector and the derivative of F in the state."""
        return self._call("back", x, parameters, w)

    def gradient(self, x: np.ndarray, parameters: np.ndarray, w: np.ndarray) -> np.ndarray:
        """Return the product of a row vector and the derivative of F in the parameters."""
        return self._call("gradient", x, parameters, w)

    def curvature(
        self, x: np.ndarray, parameters: np.ndarray, v: np.ndarray, w: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the derivatives of w F_x v in the state and in the parameters."""
        return self._call("curvature", x, parameters, v, w)

    def settle(
        self, x: np.ndarray, parameters: np.ndarray, time_constants: float, least: float = 1e-9
    ) -> np.ndarray:
        """Return the state to which the model runs, step by step.

        Args:
            x: the first state.
            parameters: values of all parameters.
            time_constants: longest run, in units of the longest time constant.
            least: largest |F| at which the run ends earlier.
        """
        steps = math.ceil(time_constants * float(self.time_constants.max(initial=1.0)) / self.dt)
        return self._call("run", x, parameters, np.int32(min(steps, 2**31 - 1)), float(least))

    def read(self, path: str, x: np.ndarray, parameters: np.ndarray) -> np.ndarray:
        """Return the value of a port in a state, such as `u.output` or `u.input`."""
        entry, port = find.shown(self.doc, path)
        reader = self._readers.setdefault((entry.id, port), self._reader(path))
        with precision_context(PRECISION):
            return np.asarray(reader(jnp.asarray(x), jnp.asarray(parameters)))

    @cached_property
    def _readers(self) -> dict[tuple[str, str], Callable[[Array, Array], Array]]:
        return {}

    def _reader(self, path: str) -> Callable[[Array, Array], Array]:
        d = self._dynamics

        def read(x: Array, p: Array) -> Array:
            prepared, state = d.prepare(self._named(p)), self._state(self._expanded(x))
            return d.observe(prepared, state, {}, 0, self._key, [path])[path]

        return jax.jit(read)


def right_hand_side(
    model: Model,
    parameters: Sequence[str] = (),
    at: float = 0.0,
    hold: Sequence[str] = (),
    even: Sequence[str] = (),
) -> RightHandSide:
    """Return the right-hand side of a model, for analysis by any library that works with functions of JAX.

    Noise is off, and every part advances in every step. `function` of the result is pure; its values and
    derivatives are in double precision.

    Args:
        model: the model.
        parameters: paths of the parameters on which it depends, live numbers or such that rebuild.
        at: document time at which stimuli are evaluated.
        hold: paths of elements whose state keeps its value at the start: what learns, and sensors, which read
            0.
        even: names of axes; states are restricted to those that are mirror images of themselves about the
            middle of each of these axes. The model must not distinguish the sides.

    Raises:
        AnalysisError: an element has no steady state and is not held, its state is not made of real numbers,
            or no part has an axis of `even`.
        ParameterError: a path is unknown, changing the parameter needs another program, or it is the strength
            of noise.
    """
    doc = model.document
    for path in parameters:
        if all(leaf in _noise(doc, leaf) for leaf in driven(doc, path)):
            raise ParameterError(
                "is the strength of noise, on which no rate of change depends",
                where=path,
                fix="Leave it out: steady states are those without noise",
            )
    held_ids = frozenset(find.element(doc, path).id for path in hold)
    for entry in doc.entries:
        if entry.id not in held_ids and (why := _restless(entry)):
            raise AnalysisError(
                why, where=entry.path, fix=f"Hold it as it is at the start: hold=[{entry.path!r}]"
            )
        for ident, leaf in _noise(doc, (entry.id, "")):
            doc = edit.put(edit.unlink(doc, ident, leaf), ident, leaf, 0.0)
        if entry.every != 1:
            doc = edit.every(doc, entry.id, 1)
    equations = RightHandSide(model, doc, parameters, at, held_ids, even)
    names = {axis.name for part in equations.parts for axis in part.axes}
    for name in even:
        if name not in names:
            raise AnalysisError(f"no state has an axis {name!r}", fix=did_you_mean(name, names))
    return equations


def _restless(entry: Entry) -> str:
    """Return why an element has no steady state; empty if it may have one."""
    kind = type(entry.element)
    if isinstance(entry.element, Sensor) or entry.element.external:
        return "reads a world, which has no steady state"
    if kind.learned_parameters is not Element.learned_parameters:
        return f"learns ({kind.__name__}), so that what it reaches depends on the past"
    return ""


def _noise(doc: Document, leaf: Leaf) -> list[Leaf]:
    """Return the strength of the noise of the element that has a leaf; none if it draws none.

    That of an element without a state, which is a source of noise, is its amplitude.
    """
    element = find.entry(doc, leaf[0]).element
    name = "noise" if element.stateful or element.noise_axes() is None else "amplitude"
    return [(leaf[0], path) for path, _, _ in leaves(element) if path == name]


def _slope(values: np.ndarray, axes: Axes, name: str) -> np.ndarray:
    """Return the derivative along the axis of a name, in steps; 0 without such an axis."""
    for d, axis in enumerate(axes):
        if axis.name == name and axis.periodic:
            waves = np.fft.fftfreq(axis.samples) * 2j * np.pi
            shape = [-1 if k == d else 1 for k in range(values.ndim)]
            return np.fft.ifft(np.fft.fft(values, axis=d) * waves.reshape(shape), axis=d).real
        if axis.name == name:
            return np.gradient(values, axis=d, edge_order=2)
    return np.zeros_like(values)


def _has_tau(element: Element) -> bool:
    tau = getattr(element, "tau", None)
    return isinstance(tau, (int, float)) and tau > 0


def _orbits(
    parts: Sequence[StatePart], free: np.ndarray, even: Sequence[str]
) -> tuple[np.ndarray, np.ndarray]:
    """Return the number of the orbit of each free number under mirroring, and the number's weight in it."""
    orbit, at = np.arange(free.size), 0
    for part in parts:
        index = np.arange(at, at + part.size).reshape(part.shape)
        least = index
        for d, axis in enumerate(part.axes):
            if axis.name in even:
                least = np.minimum(least, np.flip(least, d))
        orbit[at : at + part.size] = least.ravel()
        at += part.size
    _, numbers, counts = np.unique(orbit, return_inverse=True, return_counts=True)
    return numbers, 1 / np.sqrt(counts[numbers])
