"""Reading and writing of JSON.

`read` is for documents, which may be untrusted: it requires finite numbers, unique keys, bounded nesting and
UTF-8. `foreign` is for files of other tools, which break these rules. `parse` is for text that deodar wrote.
`text` and `line` write. Numbers are written with the fewest digits that restore the same number; NumPy values
are written as numbers and lists, tuples as lists. Keys keep their order.
"""

from __future__ import annotations

import dataclasses as dc
import itertools
import json
import math
import re
import unicodedata
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias, cast

from deodar.errors import DocumentError, OutputError, Problem

Json: TypeAlias = "bool | int | float | str | Sequence[Json] | Mapping[str, Json] | None"
"""A value that JSON can hold."""

JsonObject: TypeAlias = dict[str, Json]
"""An object of JSON."""

MOST_VALUES = 2_000_000
"""Number of values of one text: each takes up to 200 bytes of memory (a guess, many times the largest known
architecture).
"""

FEW_VALUES = 200_000
"""Number of values of a file that people write: an arena, a robot, what is tuned (a guess)."""

DEEPEST = 64
"""Largest depth of nesting (a guess, several times that of the deepest known document)."""

MOST_REPEATED = 100
"""Number of repeated keys that are listed."""

MOST_AMBIGUOUS = 10_000
"""Largest number of objects with repeated keys in a file of another tool (a guess)."""

HALF_CHARACTER = re.compile(rb"\\u[dD][89a-fA-F]|\xed[\xa0-\xbf]")
"""A half of a character that has two, as JSON or UTF-8 writes it."""

MOST_DIGITS = 300
"""Most digits of an integer; more exceed the range of a double."""


# -------------------------------------------------------------------------------------------------------- out


def composed(text: str) -> str:
    """Return a text with accents as parts of their letters."""
    return text if text.isascii() else unicodedata.normalize("NFC", text)


def text(data: object, indent: int = 2, finite: bool = False) -> str:
    """Write readable JSON: one entry per line, characters without escapes, no newline at the end.

    Args:
        data: the value to write.
        indent: spaces for each level.
        finite: whether numbers that are not finite, which JSON does not define, are an error; otherwise they
            are written as `NaN` and `Infinity`, which Python reads.

    Raises:
        OutputError: if a number is not finite and `finite` is true; the message states its path.
        TypeError: if a value has no form in JSON.
    """
    return _written(data, finite, indent=indent, ensure_ascii=False)


def line(
    data: object,
    ascii: bool = False,
    sort: bool = False,
    finite: bool = False,
    other: Callable[[object], object] | None = None,
) -> str:
    """Write JSON in one line.

    Args:
        data: the value to write.
        ascii: whether to escape characters beyond ASCII.
        sort: whether to write keys in alphabetical order.
        finite: as in `text`.
        other: converts a value that has no form in JSON; None: such a value is an error.

    Raises:
        OutputError, TypeError: as in `text`.
    """
    return _written(data, finite, ensure_ascii=ascii, sort_keys=sort, default=other or _plain)


def _plain(value: object) -> object:
    """Convert NumPy arrays and numbers to lists and numbers."""
    as_list = getattr(value, "tolist", None)
    if as_list is None:
        raise TypeError(f"{type(value).__name__} has no form in JSON")
    return as_list()


def _written(data: object, finite: bool, default: Callable[[object], object] = _plain, **options: Any) -> str:
    try:
        return json.dumps(data, allow_nan=not finite, default=default, **options)
    except ValueError:
        found = _not_finite(data, ())
        if found is None:
            raise
        path, value = found
        raise OutputError(
            f"the number {value} cannot be written: it is not finite", where=".".join(map(str, path))
        ) from None


def _not_finite(data: object, path: tuple[KeyStep, ...]) -> tuple[tuple[KeyStep, ...], float] | None:
    """Return the path and value of the first number that is not finite."""
    if isinstance(data, float):
        return None if math.isfinite(data) else (path, data)
    data = _plain(data) if hasattr(data, "tolist") else data
    inside = (
        cast("Mapping[Any, object]", data).items()
        if isinstance(data, Mapping)
        else enumerate(cast("list[object]", data))
        if isinstance(data, (list, tuple))
        else ()
    )
    found = (_not_finite(value, (*path, step)) for step, value in inside)
    return next((each for each in found if each is not None), None)


# --------------------------------------------------------------------------------------------------------- in


def parse(content: bytes | str) -> Any:
    """Read JSON that deodar wrote, or a value that a user typed; of a repeated key the last value counts.

    Raises:
        ValueError: if it is not JSON, or nested too deeply.
    """
    try:
        return json.loads(content)
    except RecursionError:
        raise ValueError("is nested too deeply") from None


def leading(content: str, start: int = 0) -> tuple[Any, int]:
    """Read the JSON value that begins at position `start` of a text; return it and the position of its end.

    Raises:
        ValueError: if no value begins there.
    """
    return json.JSONDecoder().raw_decode(content, start)


def read(content: bytes | str, most: int | None = None) -> Any:
    """Read JSON with finite numbers, unique keys and bounded nesting.

    Args:
        content: the text.
        most: largest number of values; None: MOST_VALUES.

    Raises:
        DocumentError: if it is not such JSON; the message states line and column, or all repeated keys.
    """
    collected = _Collected(MOST_REPEATED)

    def refuse(constant: str) -> Any:
        raise DocumentError(f"holds the number {constant}, which is not finite")

    def whole(digits: str) -> int:
        if len(digits) > MOST_DIGITS:
            raise DocumentError(f"holds a number of {len(digits)} digits, {digits[:20]}...")
        return int(digits)

    def number(digits: str) -> float:
        value = float(digits)
        if not math.isfinite(value):
            raise DocumentError(f"holds the number {digits[:40]}, which is not finite")
        return value

    written = content.encode("utf-8", "surrogatepass") if isinstance(content, str) else content
    _require_few(written, most)
    try:
        data = json.loads(
            content, parse_constant=refuse, parse_float=number, parse_int=whole, object_pairs_hook=collected
        )
    except json.JSONDecodeError as error:
        raise _not_json(error) from None
    except UnicodeDecodeError:
        raise DocumentError("is not JSON: it is not text in UTF-8") from None
    except RecursionError:
        raise _too_deep() from None
    _require_depth(data)
    twice = repeated(data) if collected.ambiguous else []
    if twice:
        raise DocumentError(
            [
                Problem(r.where, f"the key {r.key!r} occurs {_times(len(r.values))}", "Keep one of them")
                for r in twice
            ]
        )
    if HALF_CHARACTER.search(written) or b"\0" in written:  # another encoding hides a half
        try:
            json.dumps(data, ensure_ascii=False).encode()
        except UnicodeEncodeError:
            raise DocumentError("holds half a character (a lone surrogate), which is not text") from None
    return data


def foreign(content: bytes, leading: bool = False) -> Any:
    """Read JSON of another tool.

    At most MOST_VALUES values. A byte order mark, control characters in strings, Latin-1 text, numbers
    that are not finite and repeated keys (marked, see `repeated`) are accepted.

    Args:
        content: the content of the file.
        leading: whether to read the first value and ignore the text after it.

    Raises:
        DocumentError: if it is still not JSON.
    """
    content = content.removeprefix(b"\xef\xbb\xbf")
    _require_few(content)
    try:
        try:
            written = content.decode(json.detect_encoding(content), "surrogatepass")
        except UnicodeDecodeError:
            # older versions of MATLAB wrote the system's encoding
            written = content.decode("latin-1")
        decoder = json.JSONDecoder(strict=False, object_pairs_hook=_Collected(MOST_AMBIGUOUS))
        data = decoder.raw_decode(written.lstrip())[0] if leading else decoder.decode(written)
    except json.JSONDecodeError as error:
        raise _not_json(error) from None
    except RecursionError:
        raise _too_deep() from None
    except ValueError:
        raise DocumentError("holds a number of thousands of digits") from None
    _require_depth(data)
    return data


def _not_json(error: json.JSONDecodeError) -> DocumentError:
    return DocumentError(f"is not JSON: {error.msg} in line {error.lineno}, column {error.colno}")


def _require_few(content: bytes, most: int | None = None) -> None:
    """Refuse a text of more values than are read, before memory is taken for one of them."""
    values, most = sum(map(content.count, (b",", b"[", b"{"))), MOST_VALUES if most is None else most
    if values > most:
        raise DocumentError(
            f"holds about {values:,} values; at most {most:,} are read",
            fix="Store large tables of numbers as arrays, in a file of their own",
        )


def _too_deep() -> DocumentError:
    return DocumentError(f"is nested deeper than {DEEPEST} levels")


def _times(count: int) -> str:
    return "twice" if count == 2 else f"{count} times"


def _require_depth(data: object) -> None:
    level, below = 0, [data]
    while below:
        level += 1
        if level > DEEPEST:
            raise _too_deep()
        below = [v for item in below for v in _inside(item) if isinstance(v, (dict, list))]


def _inside(item: object) -> list[Any]:
    if isinstance(item, dict):
        return list(cast("dict[str, Any]", item).values())
    return cast("list[Any]", item) if isinstance(item, list) else []


# ----------------------------------------------------------------------------------------------- doubled keys


KeyStep = str | int
"""Key of an object, or position in a list."""


class Ambiguous(dict[str, Any]):
    """A JSON object with repeated keys: each key with its last value, as `json` returns it.

    `pairs` has all keys and values in the order of the text.
    """

    pairs: list[tuple[str, Any]]


@dc.dataclass(frozen=True)
class Repeated:
    """A key that occurs more than once.

    Attributes:
        path: steps from the root to the object with the key.
        key: the key.
        values: all values of the key, in the order of the text; the last one is used.
    """

    path: tuple[KeyStep, ...]
    key: str
    values: tuple[Any, ...]

    @property
    def where(self) -> str:
        """The path of the object as text; "" for the root."""
        return ".".join(str(step) for step in self.path)


def collect(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Create the object with these keys and values, marked for `repeated` if keys are repeated."""
    out = dict(pairs)
    if len(out) == len(pairs):
        return out
    marked = Ambiguous(out)
    marked.pairs = pairs
    return marked


class _Collected:
    """`collect` for the objects of one text, of which few have repeated keys.

    Attributes:
        ambiguous: number of objects with repeated keys.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self.ambiguous = 0

    def __call__(self, pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        """Return the object with these keys and values.

        Raises:
            DocumentError: too many objects have repeated keys.
        """
        collected = collect(pairs)
        if len(collected) < len(pairs):
            self.ambiguous += 1
            if self.ambiguous > self._most:
                raise DocumentError(f"has keys that occur twice in more than {self._most:,} objects")
        return collected


_Place = tuple["_Place", KeyStep, Any]
"""An object or list inside others: the place of what holds it, the step there, and itself."""


def repeated(data: Any) -> list[Repeated]:
    """Return the repeated keys, outermost objects first, MOST_REPEATED at most.

    Args:
        data: what was read with `collect`.
    """
    found: list[Repeated] = []
    root: Any = (None, "", data)
    level: list[_Place] = [root]
    while level and len(found) < MOST_REPEATED:
        below: list[_Place] = []
        for place in level:
            item = place[2]
            if isinstance(item, Ambiguous):
                values: dict[str, list[Any]] = {}
                for key, value in item.pairs:
                    values.setdefault(key, []).append(value)
                several = ((key, tuple(listed)) for key, listed in values.items() if len(listed) > 1)
                found += [
                    Repeated(_path(place), key, listed)
                    for key, listed in itertools.islice(several, MOST_REPEATED)
                ]
            inside = (
                cast("dict[str, Any]", item).items()
                if isinstance(item, dict)
                else enumerate(cast("list[Any]", item))
            )
            below += [(place, step, value) for step, value in inside if isinstance(value, (dict, list))]
        level = below
    return found[:MOST_REPEATED]


def _path(place: Any) -> tuple[KeyStep, ...]:
    """Return the steps from the root to a place."""
    steps: list[KeyStep] = []
    while place[0] is not None:
        place, step, _ = place
        steps.append(step)
    return tuple(reversed(steps))
