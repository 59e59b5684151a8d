"""The contract of users' kinds, checked by evaluating their methods without numbers.

Every method is traced with arrays of which only shape and type are known, so that nothing is compiled or run.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
import functools
import re
from collections.abc import Callable, Generator, Hashable, Iterator, Sequence
from typing import Any, NoReturn

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.core import Tracer
from jax.extend.core import ClosedJaxpr
from jax.typing import ArrayLike

from deodar.element import Arrays, Element, PortAxes, Setting, Time
from deodar.errors import KindError, Problem, show
from deodar.kind_errors import (
    Expected,
    KindNames,
    NotHere,
    errors_of_kind,
    foreign,
    leaked,
    misshapen,
    position,
    require_arrays,
)
from deodar.leaves import bind, get, leaves, resting, structure
from deodar.model.document import Document
from deodar.model.resolve import Node
from deodar.numerics.axes import Axes, shape
from deodar.numerics.exact import Exact, split
from deodar.numerics.kernels._base import Kernel, Term, is_sampled, sampled, samples_amplitude
from deodar.numerics.sigmoids import SigmoidFunction
from deodar.parameters import Part, parameters

NUMBERS = ("random numbers, a clock or a counter", "Draw noise from `at.noise`: declare `noise_axes`")

LeafArrays = dict[str, np.ndarray | Exact]
"""The traced leaves of a part by path."""


@contextlib.contextmanager
def errors_in(doc: Document) -> Generator[None]:
    """Raise KindError, with the path of an element, from any exception of the code of a user's kind."""
    try:
        with errors_of_kind():
            yield
    except KindError as error:
        named = (e.path for e in doc.entries if error.kind in [cls.__name__ for cls in foreign(e.element)])
        path = next(named, "")
        placed = [dc.replace(p, where=p.where or path) for p in error.problems]
        raise KindError(placed, kind=error.kind) from error.__cause__


def broken(nodes: Sequence[Node]) -> Iterator[Problem]:
    """Yield what the users' kinds among resolved elements do against their contract, one problem each."""
    for n in nodes:
        if n.declared and foreign(n.element) and not n.element.external_code():
            resolved = _Resolved(
                structure(n.element, frozenset(resting(n.element))),
                tuple(n.ins.items()),
                tuple(n.outs.items()),
                n.element,
            )
            for p in _of_structure(resolved):
                yield dc.replace(p, where=n.path)


@dc.dataclass(frozen=True)
class _Resolved:
    """An element with the axes of its ports; equal to others from which only traced numbers differ."""

    structure: tuple[Hashable, ...]
    ins: tuple[tuple[str, Axes], ...]
    outs: tuple[tuple[str, Axes], ...]
    element: Element = dc.field(compare=False)


@functools.lru_cache(maxsize=1024)
def _of_structure(resolved: _Resolved) -> tuple[Problem, ...]:
    nameless = dc.replace(resolved.element, name="")
    return tuple(one_copy(nameless, dict(resolved.ins), dict(resolved.outs)))


def one_copy(element: Element, ins: PortAxes, outs: PortAxes, precision: str = "") -> list[Problem]:
    """Return what one copy of an element, or a part inside it, does against the contract.

    Args:
        element: the element.
        ins: axes of its input ports.
        outs: axes of its output ports.
        precision: that of all its numbers, float32 or float64; "": float32, to which others are converted.
    """
    try:
        with jax.enable_x64(precision == "float64"):
            copy = _TracedCopy(element, Setting(ins, outs, np.dtype(precision or "float32")), bool(precision))
            for part, path in _parts(element):
                copy.check_part(part, path)
            copy.check_element()
    except KindError as error:
        return list(error.problems)
    return []


class _TracedCopy:
    """One copy of an element, of whose numbers only the type is known."""

    def __init__(self, element: Element, at: Setting, strict: bool) -> None:
        self.element, self.at, self.strict = element, at, strict
        rests, self.costs, self.values = resting(element), dict[str, str](), LeafArrays()
        for path, number, p in leaves(element):
            if path not in rests:
                self.costs[path] = "rebuild" if p.form == "array" else p.cost
                parts = [np.asarray(half) for half in split(number, at.dtype)]
                self.values[path] = Exact(*parts) if p.exact else parts[0]

    def bound(self, values: LeafArrays, only: str = "") -> Element:
        """Return the element with traced leaves, or with those of one cost."""

        def leaf(path: str) -> object:
            return NotHere(path) if only and self.costs.get(path, only) != only else values.get(path)

        return bind(self.element, leaf)

    def traced(self, function: Callable[..., Any], *args: Any, names: KindNames | None = None) -> Any:
        """Return what a function would return, as shapes; it has to be the same function in each call.

        Raises:
            KindError: it breaks the contract.
        """
        with errors_of_kind(self.element, names=names):
            first, shapes = jax.make_jaxpr(function, return_shape=True)(*args)
            second = jax.make_jaxpr(lambda *values: function(*values))(*args)  # JAX keeps the first one
        if any(isinstance(constant, Tracer) for constant in first.consts):
            raise leaked({"": self.element})
        if _text(first) != _text(second) or not _equal(first.consts, second.consts):
            cls = (foreign(self.element) or [type(self.element)])[0]
            raise KindError(
                f"{position(cls)} computes another function in each call, as with {NUMBERS[0]}; what Python"
                " computes there stays as it was when the program was compiled",
                fix=NUMBERS[1],
                kind=cls.__name__,
            )
        return shapes

    def check_element(self) -> None:
        """Trace the functions of the element in the order in which a program calls them."""
        element, at, values = self.element, self.at, self.values
        constants = self.traced(lambda v: self.bound(v, "rebuild").prepare(at), values)
        constants = self.traced(
            lambda v, c: self.bound(v).hoist(dc.replace(at, constants=c)), values, constants
        )
        state = self.traced(lambda v: self._checked(v, "init", at, None), values)
        noise_axes = element.noise_axes()
        noise = None if noise_axes is None else self.full(noise_axes)
        read = {"constants": constants, "state": state, "noise": noise}
        inputs = {port: self.full(at.ins[port]) for port in element.ports() if port in at.ins}
        if element.external:
            inputs[element.external] = self.full(at.outs["output"])
        passed = {port for out in at.outs for port in type(element).direct.get(out, ())} | {element.external}
        seen = {port: array for port, array in inputs.items() if port in passed}
        shapes = {port: shape(axes) for port, axes in at.outs.items()}
        self._stage("output", {**read, "inputs": seen}, shapes)
        if element.stateful:
            inputs |= {port: self.full(at.outs[port]) for port in element.reads_own_output}
            self._stage("advance", {**read, "inputs": inputs}, state)
        if element.stateful != bool(state):
            state_of_init = "no state" if element.stateful else "a state, and the class has no `advance`"
            self._raise("", f"has an `init` that returns {state_of_init}")

    def _stage(self, method: str, read: dict[str, Any], expected: Expected) -> None:
        def stage(values: LeafArrays, read: dict[str, Any], moment: Any) -> Arrays:
            at = dc.replace(self.at, **read, time=Time(*moment), convolve=lambda y: y)
            return self._checked(values, method, at, expected)

        start = Time.at(0.0, 1.0, self.at.dtype)
        names = KindNames(self.element.ports(), tuple(read["inputs"]), tuple(read["state"]))
        self.traced(stage, self.values, read, (start.origin, start.passed, start.step), names=names)

    def _checked(self, values: LeafArrays, method: str, at: Setting, expected: Expected | None) -> Arrays:
        arrays = getattr(self.bound(values), method)(at)
        require_arrays(self.element, method, arrays, expected)
        for name, part in arrays.items() if self.strict else ():
            for dtype in map(jnp.result_type, jax.tree.leaves(part)):
                if jnp.issubdtype(dtype, jnp.floating) and dtype != at.dtype:
                    self._raise(method, f"returns {dtype} numbers for {name!r} in a program of {at.dtype}")
        return jax.tree.map(jnp.asarray, arrays)

    def _raise(self, method: str, fault: str) -> NoReturn:
        kind = type(self.element)
        raise KindError(f"{position(kind, method)} {fault}", kind=kind.__name__)

    def check_part(self, part: Part, path: str) -> None:
        """Trace the functions of a kernel or a sigmoid."""
        at, convolution = self.at, self.element.convolution
        if isinstance(part, Kernel):
            port = "" if convolution is None else convolution.of
            axes = at.outs[port] if port in at.outs else at.ins.get(port, ())
            self.traced(lambda v: _weights(get(self.bound(v, "rebuild"), path), axes, at), self.values)
            self.traced(lambda v: _amplitudes(get(self.bound(v), path)), self.values)
        if isinstance(part, SigmoidFunction):
            u = self.full(next(iter(at.outs.values()), ()))
            self.traced(lambda v, u: _outputs(get(self.bound(v), path), u), self.values, u)

    def full(self, axes: Axes) -> jax.ShapeDtypeStruct:
        """Return the form of an array over axes."""
        return jax.ShapeDtypeStruct(shape(axes), self.at.dtype)


def _parts(part: Part, prefix: str = "") -> Iterator[tuple[Part, str]]:
    """Yield the parts inside a part, with their paths."""
    for p in parameters(type(part)):
        setting: Any = getattr(part, p.name)
        inner = {p.name: setting} if p.form == "part" and setting is not None else {}
        if p.form == "parts" and setting is not None:
            inner = {f"{p.name}.{k}": kernel for k, kernel in enumerate(setting)}
        for name, part_inside in inner.items():
            yield part_inside, prefix + name
            yield from _parts(part_inside, f"{prefix}{name}.")


def _weights(kernel: Kernel, axes: Axes, at: Setting) -> list[Array]:
    """Return the weights of each term of a kernel along each axis, at a few lags."""
    samples = sampled(kernel, axes, at.dtype) if axes else None
    if samples is not None:
        return [samples]
    weights: list[Array] = []
    for term in kernel.terms():
        if not isinstance(term, Term):
            _raise(kernel, "terms", f"returns {show(term)} among the terms; expected a dd.Term")
        for d, axis in enumerate(axes):
            lag = jnp.asarray(axis.points[:3, None] - axis.points[None, :], at.dtype)
            along = term.along(d, lag, axis.range if axis.periodic else None, axis.step)
            if fault := misshapen(along, lag.shape):
                _raise(kernel, "terms", f"has a term whose `along` returns {fault}, one weight for each lag")
            weights.append(jnp.asarray(along))
    return weights


def _amplitudes(kernel: Kernel) -> list[Array]:
    """Return the amplitude of each term of a kernel, or that of its array."""
    if is_sampled(kernel):
        if fault := misshapen(samples_amplitude(kernel), ()):
            _raise(kernel, "", f"has an amplitude that is {fault}")
        return [jnp.asarray(samples_amplitude(kernel))]
    amplitudes = [term.amplitude for term in kernel.terms()]
    for amplitude in amplitudes:
        if fault := misshapen(amplitude, ()):
            _raise(kernel, "terms", f"has a term whose amplitude is {fault}")
    return [jnp.asarray(amplitude) for amplitude in amplitudes]


def _outputs(sigmoid: SigmoidFunction, u: Array) -> list[Array]:
    """Return the output of a sigmoid and its mean between two activations."""
    arrays = {"__call__": sigmoid(u), "mean": sigmoid.mean(u, u)}
    for method, array in arrays.items():
        if fault := misshapen(array, u.shape):
            _raise(sigmoid, method, f"returns {fault}, one output for each activation")
    return list(arrays.values())


def _raise(part: Part, method: str, fault: str) -> NoReturn:
    raise KindError(f"{position(type(part), method)} {fault}", kind=type(part).__name__)


def _text(function: ClosedJaxpr) -> str:
    return re.sub(r"0x[0-9a-f]+", "", str(function))


def _equal(one: Sequence[ArrayLike], two: Sequence[ArrayLike]) -> bool:
    pairs = zip(map(_numbers, one), map(_numbers, two), strict=True)
    return all(np.array_equal(a, b, equal_nan=True) for a, b in pairs)


def _numbers(array: ArrayLike) -> ArrayLike:
    """Return an array as numbers, also if it is one of keys of random numbers."""
    keys = isinstance(array, Array) and jnp.issubdtype(array.dtype, jax.dtypes.prng_key)
    return jax.random.key_data(array) if keys else array
