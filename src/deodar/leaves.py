"""The numbers inside a part: the traced leaves of a program, and one value by its path."""

from __future__ import annotations

import dataclasses as dc
import functools
import math
import typing
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence, Sized
from typing import Any, TypeVar

import numpy as np

from deodar.declarations import LIMITING, Role
from deodar.errors import UnknownName
from deodar.parameters import FrozenArray, Parameter, Part, PerAxis, parameter, parameters

P = TypeVar("P", bound=Part)
T = TypeVar("T")
LeafValue = tuple[str, float | np.ndarray, Parameter]
"""The path of a leaf, its value, and the declaration of its parameter."""


# ---------------------------------------------------------------------------------------------- traced leaves


def leaves(
    part: Part, prefix: str = "", of: Callable[[type[Part]], Iterable[Parameter]] = parameters
) -> Iterator[LeafValue]:
    """Yield (path, value, declaration) of every traced leaf, including nested parts: `kernel.0.sigma`.

    Args:
        part: the part.
        prefix: the beginning of each path.
        of: the parameters of a class that are asked, at any depth.
    """
    for p in of(type(part)):
        yield from parameter_leaves(p, getattr(part, p.name), prefix, of)


def parameter_leaves(
    p: Parameter, value: Any, prefix: str = "", of: Callable[[type[Part]], Iterable[Parameter]] = parameters
) -> Iterator[LeafValue]:
    """Yield the traced leaves of one parameter, as `leaves` does."""
    path = prefix + p.name
    if value is None:
        return
    if p.form == "part":
        yield from leaves(value, path + ".", of)
    elif p.form == "parts":
        for i, item in enumerate(value):
            yield from leaves(item, f"{path}.{i}.", of)
    elif p.traced:
        if p.form == "numbers":
            yield from ((f"{path}.{name}", number, p) for name, number in value)
        elif isinstance(value, tuple):
            yield from ((f"{path}.{i}", v, p) for i, v in enumerate(typing.cast(Any, value)))
        else:
            yield path, (value.data if isinstance(value, FrozenArray) else value), p


def bind(part: P, values: Callable[[str], Any], prefix: str = "") -> P:
    """Return a copy whose traced leaves are `values(path)`; leaves for which it is None keep their value."""
    new = object.__new__(type(part))
    for p in parameters(type(part)):
        value, path = getattr(part, p.name), prefix + p.name
        if value is None:
            pass
        elif p.form == "part":
            value = bind(value, values, path + ".")
        elif p.form == "parts":
            value = tuple(bind(item, values, f"{path}.{i}.") for i, item in enumerate(value))
        elif p.traced:
            if p.form == "numbers":
                value = tuple((name, _or(values(f"{path}.{name}"), number)) for name, number in value)
            elif isinstance(value, tuple):
                value = tuple(_or(values(f"{path}.{i}"), v) for i, v in enumerate(typing.cast(Any, value)))
            else:
                value = _or(values(path), value)
        object.__setattr__(new, p.name, value)
    return new


def _or(value: T | None, default: T) -> T:
    return default if value is None else value


def structure(part: Part, neutral: frozenset[str] = frozenset(), prefix: str = "") -> tuple[Hashable, ...]:
    """Return a hashable description of everything but traced leaves and the name: equal structure, equal
    code.

    Leaves in `neutral` are omitted from the program, which is a different structure.
    """
    out: list[Hashable] = [type(part)]
    for p in parameters(type(part)):
        value, path = getattr(part, p.name), prefix + p.name
        if p.name == "name" or value is None:
            continue
        if p.form == "part":
            out.append((p.name, structure(value, neutral, path + ".")))
        elif p.form == "parts":
            out.append((p.name, tuple(structure(v, neutral, f"{path}.{i}.") for i, v in enumerate(value))))
        elif p.traced:
            if isinstance(value, FrozenArray):
                form: int | tuple[int | str, ...] = value.shape
            elif p.form == "numbers":
                form = tuple(k for k, _ in value)
            else:
                form = len(typing.cast(Any, value)) if isinstance(value, tuple) else 0
            still = tuple(sorted(n for n in neutral if n == path or n.startswith(path + ".")))
            out.append((p.name, form, still))
        else:
            out.append((p.name, value))
    return tuple(out)


def same_structure(a: Part, b: Part) -> bool:
    """Return whether two parts have equal structures; quick where only numbers differ."""
    if type(a) is not type(b):
        return False
    moved = [p for p in parameters(type(a)) if getattr(a, p.name) is not getattr(b, p.name)]
    numbers = all(p.traced and isinstance(getattr(a, p.name), float) for p in moved)
    return (numbers and all(isinstance(getattr(b, p.name), float) for p in moved)) or (
        structure(a) == structure(b)
    )


def parameter_values(part: Part) -> Iterator[tuple[Parameter, Any]]:
    """Yield the declaration and the value of every parameter of a part and, at any depth, of its inner parts.

    An inner part comes before its own parameters, those of a list one by one; None is left out.
    """
    for p in parameters(type(part)):
        value = getattr(part, p.name)
        if p.form in ("part", "parts") and value is not None:
            for inner in value if p.form == "parts" else (value,):
                yield p, inner
                yield from parameter_values(inner)
        elif value is not None:
            yield p, value


@dc.dataclass(frozen=True)
class StepLimit:
    """A parameter that limits the Euler step.

    Attributes:
        path: path of the parameter in its part.
        value: value of the parameter.
        role: the kind of limit, one of `LIMITING`.
    """

    path: str
    value: float
    role: Role

    @property
    def longest(self) -> float:
        """The longest step: the time itself, or the inverse of a rate."""
        if self.role != "rate":
            return self.value
        return 1 / self.value if self.value > 0 else math.inf

    def __str__(self) -> str:
        return (
            f"1/{self.path} = {self.longest:g}"
            if self.role == "rate"
            else f"the {self.role} {self.path} = {self.value:g}"
        )


def step_limits(part: Part) -> Iterator[StepLimit]:
    """Yield every parameter whose role limits the Euler step, including nested parts."""
    return (
        StepLimit(path, value, p.role)
        for path, value, p in leaves(part, of=_may_limit)
        if p.role in LIMITING and isinstance(value, float)
    )


@functools.cache
def _may_limit(cls: type[Part]) -> tuple[Parameter, ...]:
    return tuple(p for p in parameters(cls) if p.role in LIMITING or p.form in ("part", "parts"))


def resting(part: Part) -> dict[str, Parameter]:
    """Return the leaves that have their declared neutral value, with their declarations."""
    return {
        path: p
        for path, value, p in leaves(part, of=_may_rest)
        if p.neutral is not None and not isinstance(value, np.ndarray) and value == p.neutral
    }


@functools.cache
def _may_rest(cls: type[Part]) -> tuple[Parameter, ...]:
    return tuple(p for p in parameters(cls) if p.neutral is not None or p.form in ("part", "parts"))


def is_neutral(value: Any) -> bool:
    """Return whether a bound value is the plain number 0, so that the program is compiled without it."""
    values: tuple[Any, ...] = typing.cast(Any, value) if isinstance(value, tuple) else (value,)
    return all(isinstance(v, float) and v == 0.0 for v in values)


def per_axis(value: PerAxis, axes: Sized) -> tuple[float, ...]:
    """Return one value for each axis, from one value for all axes or one for each."""
    return tuple(value) if isinstance(value, Sequence) else (value,) * len(axes)


def on_axis(value: PerAxis, d: int) -> float:
    """Return the value for axis number `d`, from one value for all axes or one for each.

    Args:
        value: a parameter of the type `dd.PerAxis`.
        d: number of the axis, from 0.
    """
    return value[d] if isinstance(value, Sequence) else value


def one_axis(values: Sequence[float]) -> float | tuple[float, ...]:
    """Return one value for each axis in their short form: one value where all are equal."""
    return values[0] if values and all(v == values[0] for v in values) else tuple(values)


def with_entry(per_axes: PerAxis, axes: Sized, d: int, new: float) -> float | tuple[float, ...]:
    """Return the values for some axes with another one for axis number `d`."""
    values = per_axis(per_axes, axes)
    return one_axis((*values[:d], new, *values[d + 1 :]))


# -------------------------------------------------------------------------------------- one value by its path


def get(part: Part, path: str) -> Any:
    """Return the value of a parameter: `get(field, "kernel.0.sigma")`."""
    value = part
    for step in path.split("."):
        value = _child(value, step, path)
    return value


def replace(part: P, path: str, value: Any) -> P:
    """Return a copy with one value changed and checked: `replace(field, "kernel.0.sigma", 3)`."""
    return _replaced(part, path.split("."), value, path)


def _replaced(holder: Any, steps: Sequence[str], value: Any, path: str) -> Any:
    head, *rest = steps
    inner = _child(holder, head, path)
    new = _replaced(inner, rest, value, path) if rest else value
    if isinstance(holder, Part):
        return dc.replace(typing.cast(Any, holder), **{head: new})
    if holder and isinstance(holder[0], tuple) and len(holder[0]) == 2:
        return tuple((k, new if k == head else v) for k, v in holder)
    return (*holder[: int(head)], new, *holder[int(head) + 1 :])


def _child(holder: Any, step: str, path: str) -> Any:
    if isinstance(holder, Part):
        return getattr(holder, parameter(type(holder), step).name)
    if isinstance(holder, tuple):
        items = typing.cast("tuple[Any, ...]", holder)
        if step.isdigit() and int(step) < len(items):
            return items[int(step)]
        named = {
            pair[0]: pair[1] for pair in items if isinstance(pair, tuple) and len(typing.cast(Any, pair)) == 2
        }
        if step in named:
            return named[step]
        valid = f"Valid indices: 0 to {len(items) - 1}" if items else "The list is empty: set it first"
        raise UnknownName(f"{path}: there is no part {step!r}", fix=valid)
    none = "It is None: set it to a list first" if holder is None else ""
    raise UnknownName(f"{path}: the value before {step!r} has no parts", fix=none)
