"""The functions of MATLAB, and one of cosivina, that launchers compute arguments with."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from deodar_interop.importers.cosivina.launchers.expressions import NotRead
from deodar_interop.importers.cosivina.launchers.matlab_values import (
    cells,
    counted,
    described,
    flag,
    is_cells,
    is_numbers,
    is_text,
    joined,
    number,
    numbers,
    real,
    require_size,
    string,
    strings,
    text,
    whole,
)

FunctionArguments = Sequence[Any]

RANDOM = frozenset(("rand", "randn", "randi", "randperm", "now", "clock", "tic", "toc", "datestr", "input"))
"""Functions whose result differs from run to run."""

MOST_CHARACTERS = 20_000_000
"""Most characters of one text that a function makes; each takes four bytes."""

MOST_CELLS = 1_000_000
"""Most cells that a function makes; each takes about two hundred bytes."""

FORMAT = re.compile(r"%(?:%|([-+ 0#]*)(\d{1,3})?(?:\.(\d{1,2}))?([diufeEgGscxX]))")


def _sized(arguments: FunctionArguments, value: float) -> np.ndarray:
    """Return an array of one number, of a size in one argument or in several."""
    sizes = [a for a in arguments if not is_text(a)]
    size = [int(v) for v in numbers(sizes[0]).reshape(-1)] if len(sizes) == 1 else [whole(a) for a in sizes]
    size = [1, 1] if not size else size * 2 if len(size) == 1 else size
    size = [max(n, 0) for n in size]
    require_size(math.prod(size))
    if len(size) > 4:
        raise NotRead("an array of more than 4 dimensions is not read")
    return np.full(size, value)


def _each(function: Callable[[np.ndarray], Any]) -> Callable[[FunctionArguments], Any]:
    """Return a function of every number."""

    def apply(arguments: FunctionArguments) -> Any:
        (value,) = arguments
        return np.asarray(function(numbers(value)), dtype=float)

    return apply


def _rounded(value: np.ndarray) -> np.ndarray:
    return np.sign(value) * np.floor(np.abs(value) + 0.5)


def _round(arguments: FunctionArguments) -> Any:
    digits = whole(arguments[1], -30, 30) if len(arguments) > 1 else 0
    return _rounded(numbers(arguments[0]) * 10.0**digits) / 10.0**digits


def _along(function: Callable[..., Any]) -> Callable[[FunctionArguments], Any]:
    """Return a function along a dimension: the first one that is longer than one."""

    def apply(arguments: FunctionArguments) -> Any:
        value = numbers(arguments[0])
        d = _dimension(value, arguments[1] if len(arguments) > 1 else None)
        return np.asarray(function(value, axis=d, keepdims=True), dtype=float) if d < value.ndim else value

    return apply


def _dimension(value: np.ndarray, dimension: Any) -> int:
    if dimension is not None:
        return whole(dimension, 1, 8) - 1
    return next((d for d, n in enumerate(value.shape) if n != 1), 0)


def _extreme(function: Callable[..., Any], pair: Callable[..., Any]) -> Callable[[FunctionArguments], Any]:
    """Return the largest or smallest of an array, or of two arrays."""
    single = _along(function)

    def apply(arguments: FunctionArguments) -> Any:
        if len(arguments) == 2:
            return np.asarray(pair(numbers(arguments[0]), numbers(arguments[1])))
        return single([arguments[0], *arguments[2:]])

    return apply


def _two(function: Callable[..., Any]) -> Callable[[FunctionArguments], Any]:
    """Return a function of two arrays, number by number."""

    def apply(arguments: FunctionArguments) -> Any:
        first, second = arguments
        return np.asarray(function(numbers(first), numbers(second)), dtype=float)

    return apply


def _mod(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.where(second == 0, first, np.mod(first, np.where(second == 0, 1, second)))


def _size(arguments: FunctionArguments) -> Any:
    shape = arguments[0].shape if isinstance(arguments[0], np.ndarray) else (1, 1)
    if len(arguments) > 1:
        d = whole(arguments[1], 1, 20) - 1
        return number(shape[d] if d < len(shape) else 1)
    return np.array([shape], dtype=float)


def _length(arguments: FunctionArguments) -> Any:
    (value,) = arguments
    size = value.shape if isinstance(value, np.ndarray) else (1, 1)
    return number(max(size) if min(size) else 0)


def _numel(arguments: FunctionArguments) -> Any:
    (value,) = arguments
    return number(value.size if isinstance(value, np.ndarray) else 1)


def _repmat(arguments: FunctionArguments) -> Any:
    value = arguments[0]
    if not isinstance(value, np.ndarray):
        raise NotRead("objects are not repeated")
    copies = [int(v) for a in arguments[1:] for v in numbers(a).reshape(-1)]
    counts = [max(n, 0) for n in (copies * 2 if len(copies) == 1 else copies)]
    require_size(value.size * math.prod(counts))
    return np.tile(value, counts if len(counts) >= value.ndim else (*counts, 1))


def _linspace(arguments: FunctionArguments) -> Any:
    count = whole(arguments[2], 0) if len(arguments) > 2 else 100
    require_size(count)
    return np.linspace(real(arguments[0]), real(arguments[1]), count).reshape(1, -1)


def _colon(arguments: FunctionArguments) -> Any:
    first, *step, last = (real(a) for a in arguments)
    return counted(first, step[0] if step else 1.0, last)


def _reshape(arguments: FunctionArguments) -> Any:
    value = arguments[0]
    sizes = [[-1.0] if a.size == 0 else numbers(a).reshape(-1).tolist() for a in arguments[1:]]
    return value.reshape([int(v) for size in sizes for v in size], order="F")


def _eye(arguments: FunctionArguments) -> Any:
    size = _sized(arguments, 0.0)
    return np.eye(*size.shape[:2])


def _diag(arguments: FunctionArguments) -> Any:
    value = numbers(arguments[0])
    if min(value.shape) != 1:
        return np.diag(value).reshape(-1, 1)
    require_size(float(value.size) ** 2)
    return np.diag(value.reshape(-1))


def _norm(arguments: FunctionArguments) -> Any:
    return number(float(np.linalg.norm(numbers(arguments[0]))))


def _gauss(arguments: FunctionArguments) -> Any:
    positions, center, sigma = numbers(arguments[0]), real(arguments[1]), real(arguments[2])
    if sigma == 0:
        return (positions == center).astype(float)
    return np.exp(-0.5 * ((positions - center) / sigma) ** 2)


def _find(arguments: FunctionArguments) -> Any:
    value = numbers(arguments[0])
    places = np.flatnonzero(value.reshape(-1, order="F")) + 1.0
    places = places[: whole(arguments[1], 0)] if len(arguments) > 1 else places
    return places.reshape((1, -1) if value.shape[0] == 1 else (-1, 1))


def _sort(arguments: FunctionArguments) -> Any:
    value = numbers(arguments[0])
    ordered = np.sort(value, axis=_dimension(value, None))
    falling = len(arguments) > 1 and is_text(arguments[-1]) and string(arguments[-1]).lower() == "descend"
    return np.flip(ordered, axis=_dimension(value, None)) if falling else ordered


def _unique(arguments: FunctionArguments) -> Any:
    different = np.unique(numbers(arguments[0]))
    return different.reshape((1, -1) if arguments[0].shape[0] == 1 else (-1, 1))


def _any(arguments: FunctionArguments) -> Any:
    return flag(bool((numbers(arguments[0]) != 0).any()))


def _all(arguments: FunctionArguments) -> Any:
    return flag(bool((numbers(arguments[0]) != 0).all()))


def _strcmp(arguments: FunctionArguments, fold: bool = False) -> Any:
    first, second = arguments

    def same(a: Any, b: Any) -> bool:
        if not (is_text(a) and is_text(b)):
            return False
        first, second = string(a), string(b)
        return first.lower() == second.lower() if fold else first == second

    if is_cells(first) and not is_cells(second):
        first, second = second, first
    if is_cells(second) and not is_cells(first):
        return np.array([same(first, cell) for cell in second.reshape(-1)]).reshape(second.shape)
    return flag(same(first, second))


def _strncmp(arguments: FunctionArguments, fold: bool = False) -> Any:
    first, second, count = arguments[0], arguments[1], whole(arguments[2], 0)

    def cut(value: Any) -> Any:
        if is_cells(value):
            return cells([cut(cell) for cell in value.reshape(-1)]).reshape(value.shape)
        if not is_text(value):
            return value
        plain = string(value)
        return text(plain[:count]) if len(plain) >= count else number(0)

    return _strcmp((cut(first), cut(second)), fold)


def _strfind(arguments: FunctionArguments) -> Any:
    inside, pattern = string(arguments[0]), string(arguments[1])
    places = [k + 1.0 for k in range(len(inside)) if pattern and inside.startswith(pattern, k)]
    return np.array([places]) if places else np.zeros((0, 0))


# ----------------------------------------------------------------------------------------------------- text


def shown(value: float) -> str:
    """Return a number as `num2str` writes it."""
    if math.isinf(value) or math.isnan(value):
        return "NaN" if math.isnan(value) else "Inf" if value > 0 else "-Inf"
    if value == math.floor(value) and abs(value) < 1e15:
        return str(int(value))
    digits = max(math.floor(math.log10(abs(value))) + 5, 5)
    return f"{value:.{min(digits, 16)}g}"


def _num2str(arguments: FunctionArguments) -> Any:
    value = arguments[0]
    if is_text(value):
        return value
    if len(arguments) > 1 and is_text(arguments[1]):
        return text(formatted(string(arguments[1]), [value]))
    if len(arguments) > 1:
        return text(f"{real(value):.{whole(arguments[1], 1, 20)}g}")
    array = numbers(value)
    if array.size == 1:
        return text(shown(real(value)))
    require_size(array.size * 24)
    lines = ["  ".join(shown(float(v)) for v in row) for row in array.reshape(array.shape[0], -1)]
    width = max((len(line) for line in lines), default=0)
    return np.array([list(line.rjust(width)) for line in lines], dtype="<U1").reshape(len(lines), width)


def formatted(pattern: str, values: FunctionArguments) -> str:
    """Return a text with values in the places of a pattern, which is used again until all are used."""
    written: list[float | str] = []
    for value in values:
        if is_text(value):
            written.append(string(value))
        elif is_numbers(value):
            written += [float(v) for v in value.reshape(-1, order="F")]
        else:
            raise NotRead(f"{described(value)} cannot be written into a text")
    pattern = pattern.replace("\\n", "\n").replace("\\t", "\t")
    places = sum(match.group(4) is not None for match in FORMAT.finditer(pattern))
    require_size(len(pattern) * (1 + len(written) / max(places, 1)) * 2)
    out: list[str] = []
    while True:
        ended = False

        def fill(match: re.Match[str]) -> str:
            nonlocal ended
            flags, width, digits, kind = match.groups()
            if kind is None:
                return "%"
            if ended or not written:
                ended = True
                return ""
            return _filled(written.pop(0), flags or "", width or "", digits, kind)

        out.append(FORMAT.sub(fill, pattern))
        if not written or not places:
            return "".join(out)


def _filled(value: float | str, flags: str, width: str, digits: str | None, kind: str) -> str:
    if isinstance(value, str) and kind != "s":
        raise NotRead(f"%{kind} does not write the text {value[:40]!r}")
    if kind in "diu" and isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return f"%{flags}{width}d" % int(value)
    if kind in "sc" and isinstance(value, float):
        return f"%{flags.replace('0', '')}{width}s" % shown(value)
    if kind in "xX":
        raise NotRead("hexadecimal numbers are not written")
    kind = "f" if kind in "diu" else "s" if kind == "c" else kind
    return f"%{flags}{width}{'' if digits is None else '.' + digits}{kind}" % value


def _sprintf(arguments: FunctionArguments) -> Any:
    return text(formatted(string(arguments[0]), arguments[1:]))


def _require_few(count: int, most: int, what: str) -> None:
    """Refuse a value that a few words of a script would make too large, before memory is taken for it."""
    if count > most:
        raise NotRead(f"it makes {count:,} {what}; at most {most:,} are made")


def _strcat(arguments: FunctionArguments) -> Any:
    if any(is_cells(a) for a in arguments):
        count = max(a.size for a in arguments if is_cells(a))
        parts = [strings(a) if is_cells(a) else [string(a)] * count for a in arguments]
        _require_few(sum(len(word) for part in parts for word in part), MOST_CHARACTERS, "characters")
        return cells([text("".join(part)) for part in zip(*parts, strict=True)])
    return text("".join(string(a).rstrip() for a in arguments))


def _cellstr(arguments: FunctionArguments) -> Any:
    (value,) = arguments
    return value if is_cells(value) else cells([text(row) for row in strings(value)], column=True)


def _num2cell(arguments: FunctionArguments) -> Any:
    value = arguments[0]
    _require_few(value.size, MOST_CELLS, "cells")
    array = np.empty(value.size, dtype=object)
    for k, entry in enumerate(value.reshape(-1)):
        array[k] = np.full((1, 1), entry, dtype=value.dtype)
    return array.reshape(value.shape)


def _cell(arguments: FunctionArguments) -> Any:
    size = _sized(arguments, 0.0).shape
    _require_few(math.prod(size), MOST_CELLS, "cells")
    array = np.empty(size, dtype=object)
    for k in np.ndindex(size):
        array[k] = np.zeros((0, 0))
    return array


def _cell2mat(arguments: FunctionArguments) -> Any:
    return joined([list(row) for row in arguments[0]])


def _string(function: Callable[[str], str]) -> Callable[[FunctionArguments], Any]:
    """Return a function of a text, or of each of a cell array."""

    def apply(arguments: FunctionArguments) -> Any:
        (value,) = arguments
        if is_cells(value):
            texts = cells([text(function(s)) for s in strings(value)])
            return texts.reshape(value.shape, order="F")
        return text(function(string(value)))

    return apply


def _strrep(arguments: FunctionArguments) -> Any:
    whole_text, old, new = (string(a) for a in arguments)
    if not old:
        return text(whole_text)
    require_size(len(whole_text) + whole_text.count(old) * len(new))
    return text(whole_text.replace(old, new))


def _fullfile(arguments: FunctionArguments) -> Any:
    return text("/".join(part.rstrip("/") for a in arguments if (part := string(a))))


def _str2double(arguments: FunctionArguments) -> Any:
    try:
        return number(float(string(arguments[0])))
    except ValueError:
        return number(math.nan)


def _strjoin(arguments: FunctionArguments) -> Any:
    by, words = string(arguments[1]) if len(arguments) > 1 else " ", strings(arguments[0])
    _require_few(len(by) * len(words) + sum(map(len, words)), MOST_CHARACTERS, "characters")
    return text(by.join(words))


def _transposed(arguments: FunctionArguments) -> Any:
    return arguments[0].T


def _concatenated(arguments: FunctionArguments, column: bool) -> Any:
    return joined([[a] for a in arguments] if column else [list(arguments)])


def _double(arguments: FunctionArguments) -> Any:
    return numbers(arguments[0])


def _char(arguments: FunctionArguments) -> Any:
    (value,) = arguments
    if is_text(value):
        return value
    if is_cells(value):
        rows = strings(value)
        width = max((len(row) for row in rows), default=0)
        _require_few(width * len(rows), MOST_CHARACTERS, "characters")
        return np.array([list(row.ljust(width)) for row in rows], dtype="<U1").reshape(len(rows), width)
    return joined([[text(" ")[:, :0], value]])


def _cumulative(arguments: FunctionArguments) -> Any:
    value = numbers(arguments[0])
    return np.cumsum(value, axis=_dimension(value, None))


def _difference(arguments: FunctionArguments) -> Any:
    value = numbers(arguments[0])
    return np.diff(value, axis=_dimension(value, None))


def _flipped(arguments: FunctionArguments, axis: int) -> Any:
    return np.flip(arguments[0], axis=axis)


def _member(arguments: FunctionArguments) -> Any:
    value, among = arguments
    if is_text(value) and is_cells(among):
        return flag(string(value) in strings(among))
    return np.isin(numbers(value), numbers(among))


def _strsplit(arguments: FunctionArguments) -> Any:
    by = string(arguments[1]) if len(arguments) > 1 else " "
    if not by:
        raise NotRead("a text is split at nothing")
    content = string(arguments[0])
    _require_few(content.count(by) + 1, MOST_CELLS, "cells")
    return cells([text(part) for part in content.split(by)])


FUNCTIONS: Mapping[str, Callable[[FunctionArguments], Any]] = {
    **{"round": _round, "floor": _each(np.floor), "ceil": _each(np.ceil), "fix": _each(np.trunc)},
    **{"abs": _each(np.abs), "sqrt": _each(np.sqrt), "exp": _each(np.exp), "sign": _each(np.sign)},
    **{"log": _each(np.log), "log2": _each(np.log2), "log10": _each(np.log10), "sin": _each(np.sin)},
    **{"cos": _each(np.cos), "tan": _each(np.tan), "atan": _each(np.arctan), "tanh": _each(np.tanh)},
    **{"mod": _two(_mod), "rem": _two(np.fmod), "atan2": _two(np.arctan2), "hypot": _two(np.hypot)},
    **{"max": _extreme(np.max, np.maximum), "min": _extreme(np.min, np.minimum)},
    **{"sum": _along(np.sum), "prod": _along(np.prod), "mean": _along(np.mean)},
    **{"cumsum": _cumulative, "diff": _difference, "norm": _norm, "diag": _diag, "eye": _eye},
    **{"size": _size, "length": _length, "numel": _numel, "repmat": _repmat, "reshape": _reshape},
    "ndims": lambda a: number(a[0].ndim if isinstance(a[0], np.ndarray) else 2),
    "zeros": lambda a: _sized(a, 0.0),
    "ones": lambda a: _sized(a, 1.0),
    "nan": lambda a: _sized(a, math.nan),
    "NaN": lambda a: _sized(a, math.nan),
    "inf": lambda a: _sized(a, math.inf),
    "Inf": lambda a: _sized(a, math.inf),
    "pi": lambda _: number(math.pi),
    "eps": lambda _: number(np.finfo(float).eps),
    "true": lambda a: _sized(a, 1.0).astype(bool),
    "false": lambda a: _sized(a, 0.0).astype(bool),
    "logical": lambda a: numbers(a[0]) != 0,
    "not": lambda a: numbers(a[0]) == 0,
    "linspace": _linspace,
    "colon": _colon,
    "gauss": _gauss,
    "find": _find,
    "sort": _sort,
    "unique": _unique,
    "any": _any,
    "all": _all,
    "ismember": _member,
    "isempty": lambda a: flag(isinstance(a[0], np.ndarray) and a[0].size == 0),
    "iscell": lambda a: flag(is_cells(a[0])),
    "ischar": lambda a: flag(is_text(a[0])),
    "isnumeric": lambda a: flag(is_numbers(a[0])),
    "isscalar": lambda a: flag(isinstance(a[0], np.ndarray) and a[0].size == 1),
    "strcmp": _strcmp,
    "strcmpi": lambda a: _strcmp(a, fold=True),
    "strncmp": _strncmp,
    "strncmpi": lambda a: _strncmp(a, fold=True),
    "strfind": _strfind,
    "num2str": _num2str,
    "int2str": lambda a: _num2str([_rounded(numbers(a[0]))]),
    "sprintf": _sprintf,
    "strcat": _strcat,
    "strjoin": _strjoin,
    "strsplit": _strsplit,
    "strrep": _strrep,
    "str2double": _str2double,
    "fullfile": _fullfile,
    "upper": _string(str.upper),
    "lower": _string(str.lower),
    "strtrim": _string(str.strip),
    "deblank": _string(str.rstrip),
    "cellstr": _cellstr,
    "cell": _cell,
    "num2cell": _num2cell,
    "cell2mat": _cell2mat,
    "double": _double,
    "single": _double,
    "char": _char,
    "string": _num2str,
    "transpose": _transposed,
    "horzcat": lambda a: _concatenated(a, column=False),
    "vertcat": lambda a: _concatenated(a, column=True),
    "fliplr": lambda a: _flipped(a, 1),
    "flipud": lambda a: _flipped(a, 0),
}
"""The functions by name; each takes its arguments and returns one value."""
