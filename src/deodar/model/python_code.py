"""Python code as text: literals, and calls that are broken into lines where they are too long."""

from __future__ import annotations

import dataclasses as dc
import keyword
import math
import re
import unicodedata
from collections.abc import Collection, Iterable, Mapping
from typing import Any, cast

WIDTH = 88
"""Largest width of a line; what Python's formatters take where nothing else is stated."""

INDENT = 4


@dc.dataclass(frozen=True)
class Bracketed:
    """A call, a list or a dictionary: the text that opens it, its items, and the bracket that closes it."""

    opening: str
    items: tuple[Code, ...]
    closing: str


@dc.dataclass(frozen=True)
class Prefixed:
    """An item with a name or a key before it, such as `tau=20`."""

    prefix: str
    value: Code


@dc.dataclass(frozen=True)
class Chain:
    """Items that `>>` connects, after the text `target`, such as `gain = `."""

    target: str
    items: tuple[Code, ...]


@dc.dataclass(frozen=True)
class LongText:
    """A text that is written on several lines if it is long."""

    value: str


Code = str | Bracketed | Prefixed | Chain | LongText


def call(function: str, /, *items: Code, **named: Code) -> Bracketed:
    """Return a call."""
    return Bracketed(f"{function}(", (*items, *(Prefixed(f"{k}=", v) for k, v in named.items())), ")")


def listed(items: Iterable[Code]) -> Bracketed:
    """Return a list."""
    return Bracketed("[", tuple(items), "]")


def pair(items: Iterable[Code]) -> Bracketed:
    """Return a tuple of at least two items."""
    return Bracketed("(", tuple(items), ")")


def lines(code: Code, indent: int = 0) -> str:
    """Return the text of a statement, indented."""
    return " " * indent + _laid(code, indent, indent, 0)


def text(value: str) -> str:
    """Return a text as a literal on one line, in double quotes unless it contains them."""
    quote = "'" if '"' in value and "'" not in value else '"'

    def written(c: str) -> str:
        if c in (quote, "\\"):
            return "\\" + c
        return c if c.isprintable() else repr(c)[1:-1]

    return quote + "".join(map(written, value)) + quote


def number(value: float) -> str:
    """Return a number as short as possible; reading it as a float gives the same number."""
    whole = value == math.trunc(value) and abs(value) < 1e15 and str(value) != "-0.0"
    return str(math.trunc(value)) if whole else repr(value).replace("e+", "e")


def literal(value: Any) -> Code:
    """Return plain data, as JSON has them, as Python code; whole numbers stay whole, others stay floats."""
    if isinstance(value, str):
        return text(value)
    if isinstance(value, Mapping):
        items = cast("Mapping[str, Any]", value).items()
        return Bracketed("{", tuple(Prefixed(f"{text(k)}: ", literal(v)) for k, v in items), "}")
    if isinstance(value, (list, tuple)):
        return listed(literal(v) for v in cast("list[Any]", value))
    return repr(value)


def variable(name: str, taken: Collection[str]) -> str:
    """Return a name for a variable that is like another name and not taken."""
    plain = re.sub(r"\W+", "_", unicodedata.normalize("NFKC", name)).strip("_")
    plain = unicodedata.normalize("NFKC", plain)
    if not plain.isidentifier():
        plain = f"n{plain}" if f"n{plain}".isidentifier() else "element"
    if keyword.iskeyword(plain) or keyword.issoftkeyword(plain):
        plain += "_"
    candidate, n = plain, 1
    while candidate in taken:
        n += 1
        candidate = f"{plain}_{n}"
    return candidate


def _flat(code: Code) -> str:
    """Return code on one line."""
    match code:
        case str():
            return code
        case LongText(value):
            return text(value)
        case Prefixed(prefix, value):
            return prefix + _flat(value)
        case Chain(target, items):
            return target + " >> ".join(map(_flat, items))
        case Bracketed(opening, items, closing):
            return opening + ", ".join(map(_flat, items)) + closing


def _laid(code: Code, indent: int, before: int, after: int) -> str:
    """Return code that begins `before` columns into a line, and has `after` characters behind it."""
    line = _flat(code)
    if before + len(line) + after <= WIDTH:
        return line
    inner = indent + INDENT
    start = "\n" + " " * inner
    end = "\n" + " " * indent
    match code:
        case str():
            return line
        case LongText(value):
            parts = _wrapped(value, WIDTH - inner)
            return f"({start}{start.join(parts)}{end})" if len(parts) > 1 else line
        case Prefixed(prefix, value):
            return prefix + _laid(value, indent, before + len(prefix), after)
        case Chain(target, items):
            rows = [_laid(operand, inner, inner + 3 * (k > 0), 0) for k, operand in enumerate(items)]
            return f"{target}({start}{f'{start}>> '.join(rows)}{end})"
        case Bracketed(opening, items, closing):
            if not items:
                return line
            row = ", ".join(map(_flat, items))
            # formatters give each item of a list or a dictionary a line of its own, and those of a call one
            literal_of_several = opening in ("[", "{", "(") and len(items) > 1
            if inner + len(row) <= WIDTH and not literal_of_several:
                return f"{opening}{start}{row}{end}{closing}"
            if len(items) == 1:
                return opening + start + _laid(items[0], inner, inner, 0) + end + closing
            return opening + "".join(f"{start}{_laid(i, inner, inner, 1)}," for i in items) + end + closing


def _wrapped(value: str, width: int) -> list[str]:
    """Return a text as literals of at most `width` characters, cut between words."""
    out: list[str] = []
    row = ""
    for word in re.findall(r"\s*\S+\s*$|\s*\S+", value) or [value]:
        if row and len(text(row + word)) > width:
            out.append(text(row))
            row = ""
        row += word
    return [*out, text(row)]
