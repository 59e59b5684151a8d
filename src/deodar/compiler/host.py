"""Evaluation of a traced function with NumPy, for functions that run once or rarely.

Compiling such a function takes a hundred times as long as running it. The values equal those of the compiled
function up to rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
from jax.extend.core import ClosedJaxpr, Jaxpr, JaxprEqn, Literal, Var

Rule: TypeAlias = Callable[..., Any]
"""A function of the parameters of a primitive and of its operands."""


def supports(jaxpr: Jaxpr) -> bool:
    """Return whether every primitive of a function can be evaluated."""
    return all(
        supports(inner.jaxpr) if (inner := _inner(equation)) is not None else _rule(equation) is not None
        for equation in jaxpr.eqns
    )


def evaluate(function: ClosedJaxpr, arguments: Sequence[Any]) -> list[np.ndarray]:
    """Return the results of a function that `supports` accepts, for flat arguments."""
    with np.errstate(all="ignore"):
        outputs = _run(function, arguments)
    return [
        np.asarray(value, _dtype(variable))
        for value, variable in zip(outputs, function.jaxpr.outvars, strict=True)
    ]


def _run(function: ClosedJaxpr, arguments: Sequence[Any]) -> list[Any]:
    jaxpr, values = function.jaxpr, dict[Var, Any]()
    last = _last_uses(jaxpr)

    def value(atom: Var | Literal) -> Any:
        return np.asarray(atom.val, _dtype(atom)) if isinstance(atom, Literal) else values[atom]

    inputs = [*function.consts, *arguments]
    for variable, argument in zip([*jaxpr.constvars, *jaxpr.invars], inputs, strict=True):
        values[variable] = np.asarray(argument, _dtype(variable))
    for number, equation in enumerate(jaxpr.eqns):
        operands = [value(atom) for atom in equation.invars]
        if (inner := _inner(equation)) is not None:
            outputs = _run(inner, operands)
        else:
            rule = _rule(equation)
            assert rule is not None, equation.primitive.name
            outputs = [rule(equation.params, *operands)]
        for variable, output in zip(equation.outvars, outputs, strict=True):
            values[variable] = np.asarray(output, _dtype(variable))
        for variable in last.get(number, ()):  # large intermediate arrays end where they were needed last
            values.pop(variable, None)
    return [value(atom) for atom in jaxpr.outvars]


def _last_uses(jaxpr: Jaxpr) -> dict[int, list[Var]]:
    """Return for each equation the variables that no later one reads."""
    last: dict[Var, int] = {}
    for number, equation in enumerate(jaxpr.eqns):
        for atom in [*equation.invars, *equation.outvars]:
            if not isinstance(atom, Literal):
                last[atom] = number
    out: dict[int, list[Var]] = {}
    returned = {atom for atom in jaxpr.outvars if not isinstance(atom, Literal)}
    for variable, number in last.items():
        if variable not in returned:
            out.setdefault(number, []).append(variable)
    return out


def _dtype(atom: Var | Literal) -> np.dtype[Any]:
    # the class of an array has it, its base has not
    return np.dtype(getattr(atom.aval, "dtype"))  # noqa: B009


def _inner(equation: JaxprEqn) -> ClosedJaxpr | None:
    """Return the function that an equation calls once, if it does nothing else."""
    name = CALLS.get(equation.primitive.name)
    return None if name is None else equation.params[name]


CALLS = {"jit": "jaxpr", "pjit": "jaxpr", "closed_call": "call_jaxpr", "custom_jvp_call": "call_jaxpr"}
"""Primitives that call a function once, and the parameter that holds it."""


def _rule(equation: JaxprEqn) -> Rule | None:
    name, params = equation.primitive.name, equation.params
    if name in UNLESS and UNLESS[name](params, [_dtype(atom) for atom in equation.invars]):
        return None
    if name in ELEMENTWISE:
        function = ELEMENTWISE[name]
        return lambda _, *operands: function(*operands)
    return RULES.get(name)


def _broadcast(params: Mapping[str, Any], x: np.ndarray) -> np.ndarray:
    shape, places = params["shape"], params["broadcast_dimensions"]
    spread = [1] * len(shape)
    for place, length in zip(places, x.shape, strict=True):
        spread[place] = length
    return np.broadcast_to(x.reshape(spread), shape)


def _slice(params: Mapping[str, Any], x: np.ndarray) -> np.ndarray:
    strides = params["strides"] or (1,) * x.ndim
    bounds = zip(params["start_indices"], params["limit_indices"], strides, strict=True)
    return x[tuple(slice(*bound) for bound in bounds)]


def _iota(params: Mapping[str, Any]) -> np.ndarray:
    shape, dimension = params["shape"], params["dimension"]
    along = [length if d == dimension else 1 for d, length in enumerate(shape)]
    return np.broadcast_to(np.arange(shape[dimension], dtype=params["dtype"]).reshape(along), shape)


def _converted(params: Mapping[str, Any], x: np.ndarray) -> np.ndarray:
    """Convert a type; integers are those towards 0, the nearest that exist, and 0 for what is undefined."""
    new = np.dtype(params["new_dtype"])
    if x.dtype.kind == "f" and new.kind in "iu":
        limits = np.iinfo(new)
        x = np.clip(np.trunc(np.nan_to_num(x.astype(np.float64))), limits.min, limits.max)
    return x.astype(new)


def _fourier(params: Mapping[str, Any], x: np.ndarray) -> np.ndarray:
    kind, lengths = params["fft_type"].name, params["fft_lengths"]
    function = {"FFT": np.fft.fftn, "IFFT": np.fft.ifftn, "RFFT": np.fft.rfftn}[kind]
    return function(x, lengths, range(x.ndim - len(lengths), x.ndim))


def _gathered(params: Mapping[str, Any], x: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """Take one slice of `x` for each vector of `indices`, whose last axis is that of the vectors."""
    dimensions, sizes = params["dimension_numbers"], params["slice_sizes"]
    lead, inside = indices.shape[:-1], np.ones(indices.shape[:-1], bool)
    starts = {d: indices[..., k].astype(np.int64) for k, d in enumerate(dimensions.start_index_map)}
    for d, k in zip(dimensions.operand_batching_dims, dimensions.start_indices_batching_dims, strict=True):
        starts[d] = np.arange(lead[k]).reshape([-1 if i == k else 1 for i in range(len(lead))])
    dropped = {*dimensions.collapsed_slice_dims, *dimensions.operand_batching_dims}
    window = [d for d in range(x.ndim) if d not in dropped]
    places: list[Any] = []
    for d, size in enumerate(sizes):
        start, most = starts.get(d, np.zeros((), np.int64)), x.shape[d] - size
        inside = inside & (start >= 0) & (start <= most)
        start = np.broadcast_to(np.clip(start, 0, most), lead).reshape(*lead, *[1] * len(window))
        along = np.arange(size).reshape([size if d == axis else 1 for axis in window])
        places.append(start + along)
    picked = x[tuple(np.broadcast_arrays(*places))]
    if params["mode"].name == "FILL_OR_DROP":
        outside = params["fill_value"] if params["fill_value"] is not None else np.nan
        picked = (
            np.where(inside.reshape(*lead, *[1] * len(window)), picked, outside)
            if not inside.all()
            else picked
        )
    slices = iter(range(len(lead), picked.ndim))
    others = iter(range(len(lead)))
    return picked.transpose(
        [next(slices if k in dimensions.offset_dims else others) for k in range(picked.ndim)]
    )


def _product(params: Mapping[str, Any], a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Sum over contracted dimensions; dimensions of both that are not summed come first (as in XLA)."""
    (sum_a, sum_b), (both_a, both_b) = params["dimension_numbers"]
    letters = iter(range(a.ndim + b.ndim))
    of_a = [next(letters) for _ in range(a.ndim)]
    of_b = [next(letters) for _ in range(b.ndim)]
    for i, j in [*zip(sum_a, sum_b, strict=True), *zip(both_a, both_b, strict=True)]:
        of_b[j] = of_a[i]
    out = [of_a[i] for i in both_a]
    out += [k for i, k in enumerate(of_a) if i not in (*sum_a, *both_a)]
    out += [k for j, k in enumerate(of_b) if j not in (*sum_b, *both_b)]
    return np.einsum(a, of_a, b, of_b, out, optimize=True)


ELEMENTWISE: dict[str, Callable[..., Any]] = {
    "abs": np.abs,
    "add": np.add,
    "and": np.bitwise_and,
    "ceil": np.ceil,
    "clamp": lambda low, x, high: np.minimum(np.maximum(x, low), high),
    "complex": lambda real, imag: real + 1j * imag,
    "conj": np.conj,
    "copy": np.asarray,
    "cos": np.cos,
    "cosh": np.cosh,
    "div": np.divide,
    "eq": np.equal,
    "exp": np.exp,
    "expm1": np.expm1,
    "floor": np.floor,
    "ge": np.greater_equal,
    "gt": np.greater,
    "imag": np.imag,
    "is_finite": np.isfinite,
    "le": np.less_equal,
    "log": np.log,
    "log1p": np.log1p,
    "logistic": lambda x: 1 / (1 + np.exp(-x)),
    "lt": np.less,
    "max": np.maximum,
    "min": np.minimum,
    "mul": np.multiply,
    "ne": np.not_equal,
    "neg": np.negative,
    "not": np.invert,
    "or": np.bitwise_or,
    "pow": np.power,
    "real": np.real,
    "rem": np.fmod,
    "rsqrt": lambda x: 1 / np.sqrt(x),
    "select_n": lambda which, off, on: np.where(which, on, off),
    "shift_left": np.left_shift,
    "shift_right_logical": np.right_shift,
    "sign": np.sign,
    "sin": np.sin,
    "sinh": np.sinh,
    "sqrt": np.sqrt,
    "square": np.square,
    "stop_gradient": np.asarray,
    "sub": np.subtract,
    "tan": np.tan,
    "tanh": np.tanh,
    "xor": np.bitwise_xor,
}

RULES: dict[str, Rule] = {
    "broadcast_in_dim": _broadcast,
    "concatenate": lambda params, *parts: np.concatenate(parts, params["dimension"]),
    "convert_element_type": _converted,
    "dot_general": _product,
    "fft": _fourier,
    "gather": _gathered,
    "integer_pow": lambda params, x: np.power(x, x.dtype.type(params["y"])),
    "iota": _iota,
    "reduce_and": lambda params, x: np.all(x, axis=params["axes"]),
    "reduce_max": lambda params, x: np.max(x, axis=params["axes"]),
    "reduce_min": lambda params, x: np.min(x, axis=params["axes"]),
    "reduce_or": lambda params, x: np.any(x, axis=params["axes"]),
    "reduce_prod": lambda params, x: np.prod(x, axis=params["axes"], dtype=x.dtype),
    "reduce_sum": lambda params, x: np.sum(x, axis=params["axes"], dtype=x.dtype),
    "reshape": lambda params, x: x.reshape(params["new_sizes"]),
    "rev": lambda params, x: np.flip(x, params["dimensions"]),
    "round": lambda _, x: np.round(x),
    "slice": _slice,
    "squeeze": lambda params, x: np.squeeze(x, params["dimensions"]),
    "stack": lambda params, *parts: np.stack(parts, params["axis"]),
    "transpose": lambda params, x: np.transpose(x, params["permutation"]),
}

UNLESS: dict[str, Callable[[Mapping[str, Any], Sequence[np.dtype]], bool]] = {
    "fft": lambda params, _: params["fft_type"].name == "IRFFT",
    "div": lambda _, dtypes: dtypes[0].kind != "f",
    "integer_pow": lambda params, dtypes: dtypes[0].kind != "f",
    "pow": lambda _, dtypes: any(d.kind != "f" for d in dtypes),
    "reduce_and": lambda _, dtypes: dtypes[0].kind != "b",
    "reduce_or": lambda _, dtypes: dtypes[0].kind != "b",
    "reshape": lambda params, _: params.get("dimensions") is not None,
    "round": lambda params, _: int(params["rounding_method"]) != 1,
    "select_n": lambda _, dtypes: len(dtypes) != 3 or dtypes[0].kind != "b",
    "shift_right_logical": lambda _, dtypes: dtypes[0].kind != "u",
}
"""Where NumPy's function of a primitive differs from it: that primitive is compiled."""
