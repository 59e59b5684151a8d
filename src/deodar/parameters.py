"""The declaration of parameters, and the checks that follow from it.

A part (element, coupling, kernel, sigmoid) is a frozen dataclass. Its annotations state the type of a
parameter, the cost of a change, the unit and the range::

    tau: Annotated[float, Live("time", role="time constant", lower=1e-6)] = 20.0

This line defines the range check, the JSON form and its schema, the page of the manual, the form in the
studio and the traced leaf of the compiled program.
"""

from __future__ import annotations

import collections.abc
import dataclasses as dc
import functools
import hashlib
import math
import numbers
import re
import sys
import types
import typing
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal

import numpy as np

from deodar import docstring
from deodar.declarations import TIME_ROLES, Cost, Declaration, Needed, Recompile
from deodar.declarations import Live as Live
from deodar.declarations import Rebuild as Rebuild
from deodar.errors import ParameterError, Problem, UnknownName, did_you_mean
from deodar.errors import an as an
from deodar.errors import show as show
from deodar.part_type import PartType
from deodar.synonyms import argument, synonym

PerAxis = float | Sequence[float]
"""One number for all axes, or one for each."""

PeakBoundary = Annotated[
    Sequence[str] | None,
    Recompile(choices=("periodic", "zero")),
]
"""Whether a Gaussian wraps round the ends of its axes."""


class FrozenArray:
    """An array that is a parameter: float64, read-only, compared and hashed by its content."""

    def __init__(self, data: Any) -> None:
        require_value(data)
        array = np.array(data, dtype=np.float64, order="C")
        array.setflags(write=False)
        self.data: np.ndarray = array
        self.digest = hashlib.blake2b(
            array.tobytes() + repr(array.shape).encode(), digest_size=16
        ).hexdigest()

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the array."""
        return self.data.shape

    def __reduce__(self) -> tuple[type[FrozenArray], tuple[np.ndarray]]:
        return type(self), (self.data,)  # copies and pickles by NumPy would be writable

    def __eq__(self, other: object) -> bool:
        return isinstance(other, FrozenArray) and other.digest == self.digest

    def __hash__(self) -> int:
        return hash(self.digest)

    def __repr__(self) -> str:
        return f"array{list(self.shape)}"


class Reference:
    """A reference to a value in a model, such as `u.kernel`; it is replaced by the model's present value when
    a value is needed.
    """

    def __value__(self) -> Any:
        raise NotImplementedError


ArrayLike = (
    FrozenArray
    | np.ndarray
    | Sequence[float]
    | Sequence[np.ndarray]
    | Sequence[Sequence[float]]
    | Sequence[Sequence[Sequence[float]]]
)
"""What an array is made from: an array, or numbers in nested sequences."""

PLAIN = ("number", "integer", "flag", "text", "texts", "per_axis", "numbers", "pairs")
ValueForm = Literal[
    "number",
    "integer",
    "flag",
    "text",
    "texts",
    "per_axis",
    "axes",
    "axis",
    "part",
    "parts",
    "array",
    "numbers",
    "pairs",
    "value",
]


@dc.dataclass(frozen=True, kw_only=True)
class Parameter(Declaration):
    """One parameter, read from its declaration."""

    owner: type[Any] = dc.field(repr=False, compare=False)
    name: str
    form: ValueForm
    cost: Cost
    default: Any
    of: type[Any] | None
    optional: bool

    @functools.cached_property
    def meaning(self) -> str:
        """The phrase with which the docstring of its class describes it; "" without a description."""
        description = docstring.descriptions(self.owner).get(self.name, "")
        return re.split(r"; |\. ", description.replace("`", ""))[0].rstrip(".")

    @property
    def traced(self) -> bool:
        """Whether the values are leaves of the compiled program."""
        return self.form == "array" or (
            self.cost != "recompile" and self.form in ("number", "per_axis", "numbers")
        )


class Part(metaclass=PartType):
    """The base class of parts: a frozen dataclass whose annotations are read by `parameters`."""

    def __new__(cls, *args: Any, **kwargs: Any) -> Part:
        require_known(cls, args, kwargs)
        return super().__new__(cls)

    def __post_init__(self) -> None:
        problems = [*set_normal(self)] or [Problem(where, fault) for where, fault in self.validate()]
        if problems:
            kind = type(self).__name__
            raise ParameterError([dc.replace(p, where=f"{kind}.{p.where}") for p in problems])

    def validate(self) -> Iterator[tuple[str, str]]:
        """Cross-parameter checks: yield (parameter, what is wrong). Override in subclasses."""
        return iter(())

    short: ClassVar[str] = ""
    """The short form of the part, for messages."""

    @classmethod
    def accept(cls, value: Any) -> Any:
        """Convert the short form of a part to an instance, for parts that have one."""
        return value

    @classmethod
    def example(cls) -> Part:
        """Return an instance that works without other parts, for the tests, the manual and the studio's
        palette.
        """
        return cls()

    @classmethod
    def __declared__(cls) -> tuple[Parameter, ...]:
        return parameters(cls)

    def __dir__(self) -> list[str]:
        return sorted({*dir(type(self)), *(p.name for p in parameters(type(self)))})


def require_known(cls: type[Any], args: Sequence[Any], values: Mapping[str, Any]) -> None:
    """Refuse a call with a name that is no parameter of a class, or with too many values by position."""
    declared = [p.name for p in parameters(cls)]
    for name, stated in values.items():
        if name not in declared:
            fix = argument(cls.__name__, name, stated) or did_you_mean(name, declared)
            raise UnknownName(f"{cls.__name__} has no parameter {name!r}", fix=fix)
    if len(args) > len(positional(cls)):
        raise ParameterError(
            f"{cls.__name__} takes {len(positional(cls))} values by position, not {len(args)}",
            fix=f"In this order: {', '.join(positional(cls))}; the others by name",
        )


def set_normal(part: Any) -> Iterator[Problem]:
    """Give each parameter of a new object its stored form; yield the problems of those that have none."""
    for p in parameters(type(part)):
        argument = getattr(part, p.name)
        if isinstance(p.default, Needed) and (argument is None or isinstance(argument, Needed)):
            yield Problem(p.name, f"{type(part).__name__} needs {p.name}", _call(type(part), p))
            continue
        try:
            # an unchanged object is kept, so that changes can be detected by identity
            if not _same(stored := normal(p, argument), argument):
                object.__setattr__(part, p.name, stored)
        except ValueError as error:
            yield Problem(p.name, str(error))


def _call(cls: type[Any], last: Parameter) -> str:
    """Return a call with the missing parameter and the positional parameters before it."""
    known, order = {p.name: p for p in parameters(cls)}, positional(cls)
    before = [known[name] for name in order[: order.index(last.name)]]
    likes = [
        p.default if isinstance(p.default, Needed) else Needed("[x]")
        for p in (*before, last)
        if p.form in ("axis", "axes")
    ]
    names = [name for like in likes for name in like.names]
    call = ", ".join(
        [*(p.name if p.form not in ("axis", "axes") else "[x]" for p in before), last.default.like]
    )
    each = "is" if len(names) == 1 else "are each"
    return (
        f"Write: {cls.__name__}({call}), where {' and '.join(names)} {each} an Axis, such as x = dd.Axis('x',"
        " 0, 100, samples=101)"
    )


# --------------------------------------------------------------------------------------- reading declarations


@functools.cache
def parameters(cls: type[Any]) -> tuple[Parameter, ...]:
    """Return the parameters of a part in the order of its fields."""
    hints = typing.get_type_hints(cls, include_extras=True)
    return tuple(_read(cls, field, hints[field.name]) for field in dc.fields(cls))


@functools.cache
def positional(cls: type[Any]) -> tuple[str, ...]:
    """Return the names of the parameters that may be given by position."""
    return tuple(field.name for field in dc.fields(cls) if not field.kw_only)


def parameter(cls: type[Any], name: str) -> Parameter:
    """Return the parameter of that name; an unknown name is an error that suggests the nearest."""
    for p in parameters(cls):
        if p.name == name:
            return p
    row = synonym(cls.__name__, name)
    fix = f"Its name here: {row.path}" if row else did_you_mean(name, [p.name for p in parameters(cls)])
    raise UnknownName(f"{cls.__name__} has no parameter {name!r}", fix=fix)


def _read(cls: type[Any], field: dc.Field[Any], hint: Any) -> Parameter:
    d: Declaration = Recompile()
    if typing.get_origin(hint) is typing.Annotated:
        hint, *extra = typing.get_args(hint)
        d = next((e for e in extra if isinstance(e, Declaration)), d)
    form, of, optional = _form(hint)
    default = field.default
    if default is dc.MISSING and field.default_factory is not dc.MISSING:
        default = field.default_factory()
    if bool(re.search(r"\btime\b", d.unit)) != (d.role != ""):
        raise TypeError(
            f"{cls.__name__}.{field.name}: a parameter whose unit has time in it, and no other, declares a"
            f" role: {', '.join(TIME_ROLES)}"
        )
    declared: dict[str, Any] = vars(d) | {"cost": d.cost, "exact": d.exact or d.role == "moment"}
    return Parameter(
        **declared, owner=cls, name=field.name, form=form, default=default, of=of, optional=optional
    )


def _form(hint: Any) -> tuple[ValueForm, type[Any] | None, bool]:
    origin, args = typing.get_origin(hint), typing.get_args(hint)
    if origin in (types.UnionType, typing.Union):
        rest = [a for a in args if a is not type(None)]
        optional = len(rest) < len(args)
        if FrozenArray in rest:
            return "array", None, optional
        if float in rest and str in rest:
            return "value", object, optional
        if float in rest and len(rest) == 2:
            return "per_axis", None, optional
        if str in rest:
            return "text", None, optional
        if len(rest) == 1:
            form, of, _ = _form(rest[0])
            return form, of, True
    if form := _SIMPLE.get(hint):
        return form, None, False
    if hint is object:
        return "value", object, False
    if origin in (collections.abc.Mapping, dict):
        return ("pairs" if args[1] is str else "numbers"), None, False
    if origin in (collections.abc.Sequence, tuple, list):
        if args[0] is str:
            return "texts", None, False
        return ("parts" if issubclass(args[0], Part) else "axes"), args[0], False
    if isinstance(hint, type):
        return ("part" if issubclass(hint, Part) else "axis"), hint, False
    raise TypeError(f"no parameter can be declared as {hint}")


# -------------------------------------------------------------------------------------------- checking values


def normal(p: Parameter, value: Any) -> Any:
    """Return the value in its stored form, or raise a ValueError that states the problem."""
    if isinstance(value, Reference):
        value = value.__value__()
    if value is None and not p.optional:
        raise ValueError("needs a value")
    return None if value is None else _NORMAL[p.form](p, value)


def _same(a: Any, b: Any) -> bool:
    return a is b or (
        type(a) is type(b) is tuple and len(a) == len(b) and all(x is y for x, y in zip(a, b, strict=True))
    )


def require_value(value: Any) -> None:
    """Raise an error for a value that JAX traces, as inside `jax.jit` or `jax.grad`: it has no number yet."""
    core = sys.modules.get("jax.core")  # without it nothing is traced, and importing JAX takes long
    if core is not None and isinstance(value, core.Tracer):
        raise ParameterError(
            "models and simulate take numbers, and this value is one that JAX traces",
            fix="Inside jit, grad and vmap: d = dd.dynamics(model, [PATH]); dd.rollout(d, n, {PATH: value})",
        )


def real(value: Any) -> float | None:
    """Return the value as a number, or None if it is not a number; booleans and text are not numbers.

    Raises:
        ParameterError: the value is one that JAX traces.
    """
    require_value(value)
    if hasattr(value, "item"):  # a scalar of NumPy or JAX
        value = value.item() if np.ndim(value) == 0 else None
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return None
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _number(p: Parameter, value: Any) -> float:
    number = real(value)
    if number is None:
        raise ValueError(f"needs a number, not {show(value)}")
    if not math.isfinite(number):
        raise ValueError(f"needs a finite number, not {number}")
    if p.lower is not None and number < p.lower:
        raise ValueError(f"is {number:g}, below its lower bound {p.lower:g}")
    if p.upper is not None and number > p.upper:
        raise ValueError(f"is {number:g}, above its upper bound {p.upper:g}")
    return number


def _integer(p: Parameter, value: Any) -> int:
    number = real(value)
    if number is None or not math.isfinite(number) or number != round(number):
        raise ValueError(f"needs a whole number, not {show(value)}")
    return round(_number(p, number))


def _flag(p: Parameter, value: Any) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"needs true or false, not {show(value)}")
    return bool(value)


def _text(p: Parameter, value: Any) -> str:
    if callable(value) and hasattr(value, "__qualname__"):
        if "<" in value.__qualname__:
            raise ValueError(
                "needs a function that is found by its name in a module; a lambda or a function inside"
                " another one is not"
            )
        value = f"{value.__module__}:{value.__qualname__}"
    if not isinstance(value, str):
        raise ValueError(f"needs text, not {show(value)}")
    if not is_text(value):
        raise ValueError(f"contains characters that UTF-8 cannot encode: {show(value)}")
    if p.choices and value not in p.choices:
        raise ValueError(
            f"is {value!r}; expected one of {', '.join(p.choices)}. {did_you_mean(value, p.choices)}"
        )
    return value


def _texts(p: Parameter, value: Any) -> tuple[str, ...]:
    return tuple(_text(p, v) for v in ([value] if isinstance(value, str) else _items(value)))


def _per_axis(p: Parameter, value: Any) -> float | tuple[float, ...]:
    if isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim == 1):
        if not len(value):
            raise ValueError("needs one number, or one for each axis, not none")
        return tuple(_number(p, v) for v in typing.cast(Any, value))
    return _number(p, value)


def _declared(p: Parameter, value: Any) -> Any:
    assert p.of is not None
    if isinstance(value, Reference):
        value = value.__value__()
    if not isinstance(value, p.of) and issubclass(p.of, Part):
        value = p.of.accept(value)
    if not isinstance(value, p.of):
        short = f"; {p.of.short}" if issubclass(p.of, Part) and p.of.short else ""
        raise ValueError(f"needs {an(p.of.__name__)}, not {show(value)}{short}")
    return value


def _list(p: Parameter, value: Any) -> tuple[Any, ...]:
    assert p.of is not None
    return tuple(_declared(p, v) for v in ([value] if isinstance(value, p.of) else _items(value)))


def _array(p: Parameter, value: Any) -> FrozenArray:
    if isinstance(value, FrozenArray):
        return value
    try:
        array = FrozenArray(value)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"needs an array of numbers, not {show(value)}") from None
    if not np.isfinite(array.data).all():
        raise ValueError("needs finite numbers; some are not")
    return array


def _numbers(p: Parameter, value: Any) -> tuple[tuple[str, float], ...]:
    return tuple(sorted((k, _number(p, v)) for k, v in _named(value, "numbers")))


def _pairs(p: Parameter, value: Any) -> tuple[tuple[str, str], ...]:
    return tuple((k, _text(p, v)) for k, v in _named(value, "names"))


def _named(value: Any, what: str) -> list[tuple[str, Any]]:
    """Return pairs of a unique name and a value, from a mapping or a sequence of pairs."""
    items = list(value.items()) if isinstance(value, Mapping) else _items(value)
    if not all(
        isinstance(item, (tuple, list)) and len(typing.cast(Any, item)) == 2 and isinstance(item[0], str)
        for item in items
    ):
        raise ValueError(f"needs a mapping from names to {what}, not {show(value)}")
    names = [k for k, _ in items]
    if len(set(names)) < len(names):
        raise ValueError(f"contains the same name twice: {show(value)}")
    return [(k, v) for k, v in items]


def is_text(value: str) -> bool:
    """Return whether text can be written to a file: it has no unpaired surrogates."""
    try:
        value.encode()
    except UnicodeEncodeError:
        return False
    return True


_SIMPLE: dict[Any, ValueForm] = {
    float: "number",
    int: "integer",
    bool: "flag",
    str: "text",
    FrozenArray: "array",
}
_NORMAL: dict[ValueForm, Callable[[Parameter, Any], Any]] = {
    "number": _number,
    "integer": _integer,
    "flag": _flag,
    "text": _text,
    "texts": _texts,
    "per_axis": _per_axis,
    "axes": _list,
    "axis": _declared,
    "part": _declared,
    "parts": _list,
    "array": _array,
    "numbers": _numbers,
    "pairs": _pairs,
    "value": _declared,
}


def _items(value: Any) -> list[Any]:
    if isinstance(value, (str, bytes)) or not isinstance(value, collections.abc.Iterable):
        raise ValueError(f"needs a list, not {show(value)}")
    return list(typing.cast(Any, value))
