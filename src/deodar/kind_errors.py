"""Errors of the code of users' kinds: the class, its file and line, and the rule that the line breaks.

Kinds are elements, couplings, kernels, sigmoids, worlds and measures. JAX traces most of their methods, and
its own messages are about tracers; here they become sentences about the contract of a kind.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
import inspect
import linecache
import re
import sys
import traceback
from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from numbers import Number
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, NamedTuple, NoReturn, cast

import numpy as np

from deodar import plugins, registry
from deodar.errors import DeodarError, KindError, Problem, first_line, show

if TYPE_CHECKING:
    from jax import Array

LIBRARIES = frozenset({*sys.stdlib_module_names, "jax", "jaxlib", "numpy", "scipy"})
"""Packages whose frames are no code of a kind."""


class ContractRule(NamedTuple):
    """A rule of the contract, and the exceptions that Python or JAX raise where a line breaks it.

    Attributes:
        exception: name of the class of the exception, or of one of its bases.
        pattern: what its message contains.
        fault: what the line does.
        fix: what to write instead.
    """

    exception: str
    pattern: str
    fault: str
    fix: str


IN_STATE = "Keep what changes in the state: `init` returns its start, `advance` the next value"

RULES = (
    ContractRule(
        "TracerBoolConversionError",
        "",
        "asks whether a value is true or greater; values are traced there",
        "Use jnp.where(condition, a, b), jnp.maximum or jnp.minimum in place of if, while, and, max and min",
    ),
    ContractRule(
        "TracerIntegerConversionError",
        "",
        "uses a value as an index or a count of Python; values are traced there",
        "Use jnp.take(array, index); a number of samples follows from the axes",
    ),
    ContractRule(
        "TracerArrayConversionError",
        "",
        "gives a value to NumPy; values are traced there",
        "Use jax.numpy: import jax.numpy as jnp",
    ),
    ContractRule(
        "NonConcreteBooleanIndexError",
        "",
        "selects samples by a condition, so that the shape would depend on values; they are traced there",
        "Use jnp.where(condition, array, 0.0)",
    ),
    ContractRule(
        "UnexpectedTracerError",
        "",
        "uses a value that an earlier call has stored; a traced value exists during its call only",
        IN_STATE,
    ),
    ContractRule(
        "ConcretizationTypeError",
        "",
        "asks for the number of a value (float, int, item, a function of math); values are traced there",
        "Leave it an array, and use the functions of jax.numpy",
    ),
    ContractRule("FrozenInstanceError", "", "assigns to an attribute, and a kind is frozen", IN_STATE),
    ContractRule(
        "TypeError",
        r"JAX arrays are immutable|'\w*(Tracer|ArrayImpl)' object does not support item assignment",
        "assigns to samples of an array, and arrays do not change",
        "Write array = array.at[index].set(value)",
    ),
)


class LiveValueUsed(TypeError):
    """Raised where `prepare` or a kernel's `along` uses a live parameter."""


def _refuse(self: NotHere, *_: object) -> NoReturn:
    raise LiveValueUsed(self.path)


def _multiple(self: NotHere, factor: object) -> NotHere:
    if not isinstance(factor, (Number, NotHere)):
        raise LiveValueUsed(self.path)
    return self


class NotHere:
    """The placeholder of a live parameter inside `prepare`, which must not use it.

    Arithmetic with numbers is allowed: `prepare` also lists a kernel's terms, whose amplitudes it does not
    use.

    Args:
        path: the path of the parameter.
    """

    __array_ufunc__ = None

    def __init__(self, path: str) -> None:
        self.path = path

    def __neg__(self) -> NotHere:
        return self

    def __repr__(self) -> str:
        return f"the live parameter {self.path!r}"

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = _multiple
    __truediv__ = __rtruediv__ = __pow__ = __rpow__ = _multiple
    __lt__ = __le__ = __gt__ = __ge__ = __bool__ = __float__ = __int__ = __array__ = _refuse


class KindNames(NamedTuple):
    """The names that the methods of an element may read.

    Attributes:
        ports: its input ports.
        inputs: those that the present call reads.
        state: its states.
    """

    ports: Sequence[str] = ()
    inputs: Sequence[str] = ()
    state: Sequence[str] = ()


# ------------------------------------------------------------------------------------------------ translation


@contextlib.contextmanager
def errors_of_kind(kind: object = None, where: str = "", names: KindNames | None = None) -> Generator[None]:
    """Raise KindError from any exception of the code of a user's kind.

    Errors of deodar, a lack of memory and exceptions of deodar's own kinds pass unchanged.

    Args:
        kind: the object whose methods are called, or its class; None: the exception alone says which it is.
        where: path of the element.
        names: what the methods may read, if it is an element.
    """
    try:
        yield
    except KindError as error:
        placed = [dc.replace(p, where=p.where or where) for p in error.problems]
        raise KindError(placed, kind=error.kind) from error.__cause__
    except (DeodarError, MemoryError):
        raise
    except Exception as error:  # code of a user may raise any exception
        cls = _culprit([frame for frame, _ in traceback.walk_tb(error.__traceback__)], kind)
        if cls is None:
            raise
        problem = problem_of(error, cls, names)
        raise KindError([dc.replace(problem, where=where)], kind=cls.__name__) from error


def problem_of(error: Exception, cls: type, names: KindNames | None = None) -> Problem:
    """Return the problem that an exception of a user's kind stands for."""
    frames = list(traceback.walk_tb(error.__traceback__))
    theirs = [(frame, line) for frame, line in frames if _is_of_user(frame)]
    fault, fix = _broken(error, [frame for frame, _ in theirs], names or KindNames())
    if theirs:
        frame, line = theirs[-1]
        place = f"{_file(frame.f_code.co_filename)}, line {line},"
        return Problem("", f"{cls.__name__}.{_method(theirs[0][0], cls)} in {place} {fault}", fix)
    method = frames[-1][0].f_code.co_name
    if isinstance(error, NotImplementedError) and hasattr(cls, method):
        return Problem("", f"{position(cls)} has no method {method}", f"Define it: def {method}(self, ...)")
    return Problem("", f"{position(cls)} {fault}", fix)


def rule_of(error: Exception) -> ContractRule | None:
    """Return the rule that was broken where Python or JAX raise an exception."""
    bases = {base.__name__ for base in type(error).__mro__}
    broken = (r for r in RULES if r.exception in bases and re.search(r.pattern, str(error)))
    return next(broken, None)


def leaked(elements: Mapping[str, object]) -> KindError:
    """Return the error of a program that contains a traced value of an earlier one.

    Args:
        elements: the elements of the program by path.
    """
    rule = next(rule for rule in RULES if rule.exception == "UnexpectedTracerError")
    classes = {cls: path for path, element in elements.items() for cls in foreign(element)}
    subject = " or ".join(map(position, classes)) or "an element"
    path, cls = next(((path, cls.__name__) for cls, path in classes.items()), ("", ""))
    return KindError(f"{subject} {rule.fault}", path, rule.fix, cls)


def position(cls: type, method: str = "") -> str:
    """Return a class, or a method of it, with its file and line: `Lens.output in lens.py, line 12,`."""
    name = f"{cls.__name__}.{method}" if method else cls.__name__
    declared = inspect.unwrap(getattr(cls, method)) if method else cls
    try:
        file, (_, line) = inspect.getsourcefile(declared), inspect.getsourcelines(declared)
    except (OSError, TypeError):  # typed at a prompt
        return name
    return f"{name} in {_file(str(file))}, line {max(1, line)},"


def foreign(kind: object) -> list[type]:
    """Return the classes outside deodar of a part and of the parts inside it."""
    classes = dict.fromkeys(type(part) for part in _parts(kind))
    return [cls for cls in classes if not registry.own(cls)]


def _parts(kind: object) -> Iterator[object]:
    yield kind
    for parameter in vars(kind).values() if dc.is_dataclass(kind) else ():
        parts = cast("tuple[object, ...]", parameter) if isinstance(parameter, tuple) else (parameter,)
        for part in parts:
            if dc.is_dataclass(part):
                yield from _parts(part)


def _is_of_user(frame: FrameType) -> bool:
    if frame.f_code.co_filename == "<string>" and frame.f_code.co_name == "__setattr__":
        return False  # of `dataclass`
    module = str(frame.f_globals.get("__name__", ""))
    return module.partition(".")[0] not in LIBRARIES and not plugins.is_own(module)


def _culprit(frames: Sequence[FrameType], kind: object) -> type | None:
    """Return the class whose code failed: that of the innermost method of a user's kind."""
    classes = [] if kind is None else [kind] if isinstance(kind, type) else foreign(kind)
    classes = [cls for cls in classes if not registry.own(cls)]
    for frame in reversed(frames):
        cls = type(frame.f_locals.get("self"))
        if cls in classes or (kind is None and _is_kind(cls)):
            return cls
        for cls in classes:
            if cls.__name__ in frame.f_code.co_qualname.split("."):
                return cls
    return classes[0] if classes else None


def _is_kind(cls: type) -> bool:
    """Return whether a class outside deodar derives from one of deodar."""
    return not registry.own(cls) and any(registry.own(base) for base in cls.__mro__)


def _method(frame: FrameType, cls: type) -> str:
    """Return the method that is called first, and the function inside of it: `terms.along`."""
    names = [name for name in frame.f_code.co_qualname.split(".") if name != "<locals>"]
    bases = {base.__name__ for base in cls.__mro__}
    last = max((k for k, name in enumerate(names) if name in bases), default=-1)
    return ".".join(names[last + 1 :] or names[-1:])


def _broken(error: Exception, frames: Sequence[FrameType], names: KindNames) -> tuple[str, str]:
    """Return what the code does, and what to write instead."""
    if isinstance(error, LiveValueUsed) or _names_placeholder(error):
        part = frames[-1].f_locals.get("self") if frames else None
        numbers = vars(part).values() if dc.is_dataclass(part) else ()
        live = [number.path for number in numbers if isinstance(number, NotHere)]
        path = str(error) if isinstance(error, LiveValueUsed) else " or ".join(live)
        return (
            f"uses the live parameter {path} where only parameters that rebuild have a value",
            "Use it in `hoist`, `output` or `advance`, or as the amplitude of a dd.Term; or declare it as"
            " dd.Rebuild",
        )
    looks_up = isinstance(error, KeyError) and re.match(r"[\w.]*\b(inputs|state)\[", _expression(error))
    if looks_up and isinstance(error.args[0], str):
        return _unread(error.args[0], frames[-1].f_code.co_name if frames else "", names)
    if rule := rule_of(error):
        return rule.fault, rule.fix
    return f"raised {type(error).__name__}: {first_line(error)}", ""


def _names_placeholder(error: Exception) -> bool:
    """Return whether Python or JAX refuse the placeholder of a live parameter."""
    return isinstance(error, TypeError) and f"{NotHere.__name__}'" in str(error)


def _expression(error: Exception) -> str:
    """Return the source from where an exception was raised to the end of the line; "" if unknown."""
    last = traceback.extract_tb(error.__traceback__)[-1]
    line = linecache.getline(last.filename, last.lineno or 0).encode()
    return "" if last.colno is None else line[last.colno :].decode()


def _unread(key: str, method: str, names: KindNames) -> tuple[str, str]:
    """Return the problem of a name that a method looks up in vain."""
    if key in names.ports and key not in names.inputs:
        if method != "output":
            return f"reads the input {key!r}, and only `output` and `advance` read inputs", ""
        return (
            f"reads the input {key!r}, which the class does not declare for `output`",
            f'Write in the class: direct: ClassVar = {{"output": ("{key}",)}}',
        )
    inputs, state = (", ".join(listed) or "none" for listed in (names.ports, names.state))
    return (
        f"reads {key!r}, which does not exist there; its inputs: {inputs}; its state: {state}",
        'The class names its ports: inputs: ClassVar = ("input",); `init` returns the state',
    )


def _file(file: str) -> str:
    return "a cell" if file.startswith("<") or "ipykernel_" in file else Path(file).name


# ---------------------------------------------------------------------------------------------------- results


Expected = Mapping[str, "tuple[int, ...] | Array"]
"""By name the shape of an output, or the state before."""


def require_arrays(kind: object, method: str, arrays: object, expected: Expected | None) -> None:
    """Raise KindError if a method has not returned the arrays that its contract asks for.

    Args:
        kind: the object that has the method.
        method: name of the method: `output`, `init` or `advance`.
        arrays: what it has returned.
        expected: what they have to be; an output may have a shape that spreads to its own. None: any arrays.
    """
    classes = foreign(kind) or [type(kind)]
    cls = type(kind) if type(kind) in classes else classes[0]
    called = next((name for name in (method, "__call__", "terms") if name in vars(cls)), "")
    noun = "output port" if method == "output" else "state"
    for fault, fix in _faults(arrays, expected, noun):
        raise KindError(f"{position(cls, called)} {fault}", fix=fix, kind=cls.__name__)


def _faults(arrays: object, expected: Expected | None, noun: str) -> Iterator[tuple[str, str]]:
    if not isinstance(arrays, Mapping):
        returned = "an array" if hasattr(arrays, "shape") else show(arrays)
        yield f"returns {returned}, not a dict of arrays", 'Write: return {"NAME": array}'
        return
    values = cast("Mapping[str, object]", arrays)
    declared = values.keys() if expected is None else expected
    for name in values.keys() - declared:
        yield f"returns {name!r}, which is no {noun}; expected {_listed(declared)}", ""
    for name in declared:
        if name not in values:
            yield f"returns no value for the {noun} {name!r}", f"It returns {_listed(declared)}"
            continue
        form = None if expected is None else expected[name]
        if fault := _fault_of(values[name], form, noun):
            yield f"returns {fault} for the {noun} {name!r}", ""


def _fault_of(arrays: object, form: tuple[int, ...] | Array | None, noun: str) -> str:
    """Return why arrays are no output of a shape, or no state like the one before; "" if they are."""
    if noun == "state":
        return _fault_of_state(arrays, cast("Array | None", form))
    shape = cast("tuple[int, ...]", form)
    spreads = not misshapen(arrays, None) and _spreads(np.shape(cast("np.ndarray", arrays)), shape)
    return "" if spreads else misshapen(arrays, shape)


def _fault_of_state(tree: object, before: Array | None) -> str:
    import jax  # start-up time of the engine

    arrays, form = jax.tree.flatten(tree)
    if fault := next((f"{show(a)} in place of an array" for a in arrays if not _is_array(a)), ""):
        return fault
    if before is None:
        return ""
    if form != jax.tree.structure(before):
        return f"{form} in place of {jax.tree.structure(before)}"
    pairs = zip(map(np.shape, arrays), map(np.shape, jax.tree.leaves(before)), strict=True)
    return next((f"an array of shape {list(a)} in place of {list(b)}" for a, b in pairs if a != b), "")


def _is_array(array: object) -> bool:
    return isinstance(array, Number) or hasattr(array, "dtype")


def _spreads(shape: tuple[int, ...], target: tuple[int, ...]) -> bool:
    try:
        return np.broadcast_shapes(shape, target) == target
    except ValueError:
        return False


def misshapen(array: object, shape: tuple[int, ...] | None) -> str:
    """Return how an array differs from one of real numbers of a shape; "" if it does not."""
    if isinstance(array, (bool, int, float)):
        array = np.float32(array)
    dtype: np.dtype | None = getattr(array, "dtype", None)
    if dtype is None:
        return f"{show(array)} in place of an array"
    # bfloat16 has the kind V, and keys of random numbers have none
    if getattr(dtype, "kind", "O") not in "biufV":
        return f"{dtype} numbers in place of real ones"
    if shape is not None and np.shape(cast("np.ndarray", array)) != shape:
        return f"an array of shape {list(np.shape(cast('np.ndarray', array)))} in place of {list(shape)}"
    return ""


def _listed(names: Iterable[str]) -> str:
    return ", ".join(map(repr, names)) or "an empty dict"
