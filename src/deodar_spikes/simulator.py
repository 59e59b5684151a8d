"""Simulate a graph of NIR in JAX, many copies at once: trials, and chips with different neurons.

A step computes the nodes in the order of `graph.py`. A CubaLIF advances by one Euler step:

    I += dt/tau_syn (-I + w_in x),  then  v += dt/tau_mem (v_leak - v + r I),
    then a spike if v > v_threshold, and v = v_reset.

The neurons of a cell have equal synapses, so that a matrix of 600 x 600 weights is one of 30 x 30 between the
sums over blocks of inputs and copies of the results.
"""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable, Hashable, Mapping
from typing import TypeAlias

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from numpy.typing import NDArray

from deodar.errors import GraphError, TimeError
from deodar.numerics.processor import on_cpu
from deodar_spikes.graph import INPUT, OUTPUT, AffineNode, NeuronNode, NirGraph, order


@dc.dataclass(frozen=True, eq=False)
class Factors:
    """y = core (sums of x over blocks), repeated.

    Attributes:
        core: blocks of rows x blocks of columns.
        rows, columns: rows and columns of a block.
    """

    core: NDArray[np.float32]
    rows: int
    columns: int

    def __call__(self, x: Array) -> Array:
        """Return the product for copies x values."""
        if self.columns > 1:
            x = x.reshape(*x.shape[:-1], -1, self.columns).sum(-1)
        y = jnp.matmul(x, self.core.T, precision="highest")
        return jnp.repeat(y, self.rows, axis=-1) if self.rows > 1 else y


def factors(weight: NDArray[np.float32]) -> Factors:
    """Return the factors of a matrix with the largest blocks of equal rows and columns."""
    rows = _block(weight)
    core = weight[::rows]
    columns = _block(core.T)
    return Factors(np.ascontiguousarray(core[:, ::columns]), rows, columns)


def _block(rows: NDArray[np.float32]) -> int:
    """Return the largest number of which all runs of equal neighbouring rows are multiples."""
    changes = np.flatnonzero((rows[1:] != rows[:-1]).any(axis=1)) + 1
    return math.gcd(len(rows), *(int(k) for k in changes))


Copies: TypeAlias = Mapping[str, Mapping[str, NDArray[np.float32]]]
"""Parameters of nodes that differ between copies: copies x values, by name of the node and the parameter
(`bias` of an Affine, any of a CubaLIF).
"""

NodeValues: TypeAlias = "dict[str, Array | NDArray[np.float32]]"
"""Values of one node by name, copies x values."""

SpikingProgram: TypeAlias = Callable[..., tuple[dict[str, NodeValues], Array]]


@dc.dataclass(frozen=True)
class SpikingState:
    """Currents, potentials and outputs of the step before, by node, copies x values."""

    values: Mapping[str, NodeValues]


class SpikingSimulator:
    """A graph that is ready to run.

    Args:
        graph: the graph.
        copies: number of copies.
        differing: parameters that differ between copies.

    Raises:
        TimeError: the step is not shorter than every time constant.
        GraphError: no order of its nodes exists.
    """

    def __init__(self, graph: NirGraph, copies: int = 1, differing: Copies | None = None) -> None:
        self.graph, self.copies = graph, copies
        _require_step(graph)
        self.plan = order(graph)
        self._parameters = _parameters(graph, differing or {})
        self._factors = {
            name: factors(node.weight) for name, node in graph.nodes.items() if isinstance(node, AffineNode)
        }
        self._programs: dict[Hashable, SpikingProgram] = {}

    def start(self) -> SpikingState:
        """Return the state in which all currents and potentials are 0."""
        values: dict[str, NodeValues] = {}
        for name, node in self.graph.nodes.items():
            zeros = np.zeros((self.copies, node.size), np.float32)
            if isinstance(node, NeuronNode):
                values[name] = {"current": zeros, "potential": zeros, "out": zeros}
            elif isinstance(node, AffineNode):
                values[name] = {"out": zeros}
        return SpikingState(values)

    def run(
        self, state: SpikingState, inputs: NDArray[np.float32], every: int = 1
    ) -> tuple[NDArray[np.float32], SpikingState]:
        """Advance by steps, and return the sums of the Output over windows of `every` steps.

        Args:
            state: the state before.
            inputs: steps x values of the Input for all copies, or steps x copies x values.
            every: number of steps in a window; the number of steps is a multiple of it.

        Returns:
            Sums, windows x copies x values of the Output; and the state after the steps.
        """
        size = self.graph.nodes[INPUT].size
        steps = len(inputs)
        if inputs.ndim not in (2, 3) or inputs.shape[-1] != size or steps % every:
            raise GraphError(
                f"the input has the shape {inputs.shape}",
                fix=f"Give steps x {size}, or steps x copies x {size}, and a multiple of {every} steps",
            )
        windows = inputs.reshape(steps // every, every, *inputs.shape[1:]).astype(np.float32)
        key = (windows.shape[1:], windows.ndim)
        with on_cpu():
            if key not in self._programs:
                self._programs[key] = jax.jit(self._scan)
            end, sums = self._programs[key](self._parameters, dict(state.values), windows)
        return np.asarray(sums), SpikingState(end)

    def _scan(
        self, parameters: dict[str, NodeValues], values: dict[str, NodeValues], windows: Array
    ) -> tuple[dict[str, NodeValues], Array]:
        size = self.graph.nodes[OUTPUT].size

        def one(
            carry: tuple[dict[str, NodeValues], Array], x: Array
        ) -> tuple[tuple[dict[str, NodeValues], Array], None]:
            state, total = carry
            state, out = self._advance(parameters, state, jnp.broadcast_to(x, (self.copies, x.shape[-1])))
            return (state, total + out), None

        def window(state: dict[str, NodeValues], xs: Array) -> tuple[dict[str, NodeValues], Array]:
            (state, total), _ = lax.scan(one, (state, jnp.zeros((self.copies, size), jnp.float32)), xs)
            return state, total

        return lax.scan(window, values, windows)

    def _advance(
        self, parameters: dict[str, NodeValues], state: dict[str, NodeValues], x: Array
    ) -> tuple[dict[str, NodeValues], Array]:
        """Compute one step of all nodes."""
        activities: dict[str, Array] = {INPUT: x}
        new: dict[str, NodeValues] = {}
        for e in self.plan:
            read = [activities[s] for s in e.now] + [state[s]["out"] for s in e.before]
            total = jnp.asarray(sum(read[1:], read[0]))
            node = self.graph.nodes[e.name]
            if isinstance(node, AffineNode):
                activities[e.name] = jnp.asarray(self._factors[e.name](total) + parameters[e.name]["bias"])
                new[e.name] = {"out": activities[e.name]}
            elif isinstance(node, NeuronNode):
                p, s = parameters[e.name], state[e.name]
                current = s["current"] + p["to_syn"] * (-s["current"] + p["w_in"] * total)
                v = s["potential"] + p["to_mem"] * ((p["v_leak"] - s["potential"]) + p["r"] * current)
                spike = jnp.asarray(v > p["v_threshold"])
                activities[e.name] = spike.astype(jnp.float32)
                potential = jnp.where(spike, p["v_reset"], v)
                new[e.name] = {"current": current, "potential": potential, "out": activities[e.name]}
            else:
                activities[e.name] = total
        return new, activities[OUTPUT]


def _require_step(graph: NirGraph) -> None:
    """Refuse a step that is not shorter than all time constants."""
    for name, node in graph.nodes.items():
        if isinstance(node, NeuronNode):
            for what in ("tau_syn", "tau_mem"):
                least = float(getattr(node, what).min())
                if graph.step >= least:
                    raise TimeError(
                        f"the step {graph.step * 1e3:g} ms is not below {what} = {least * 1e3:g} ms",
                        where=name,
                        fix=f"Give a step below {least * 1e3:g} ms",
                    )


def _parameters(graph: NirGraph, differing: Copies) -> dict[str, NodeValues]:
    """Return the parameters of all nodes, those that differ as copies x values."""
    out: dict[str, NodeValues] = {}
    for name, node in graph.nodes.items():
        given = differing.get(name, {})
        if isinstance(node, AffineNode):
            out[name] = {"bias": given.get("bias", node.bias)}
        elif isinstance(node, NeuronNode):
            p = {f.name: given.get(f.name, getattr(node, f.name)) for f in dc.fields(node)}
            dt = np.float32(graph.step)
            out[name] = {
                "to_syn": (dt * (1 / p["tau_syn"])).astype(np.float32),
                "to_mem": (dt * (1 / p["tau_mem"])).astype(np.float32),
                **{k: v for k, v in p.items() if k not in ("tau_syn", "tau_mem")},
            }
    return out
