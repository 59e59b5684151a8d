"""The expressions and statements of a script as a tree."""

from __future__ import annotations

import dataclasses as dc
from typing import TypeAlias

from deodar_interop.importers.cosivina.launchers.tokens import Token


@dc.dataclass(frozen=True)
class NumberNode:
    """A number."""

    value: float


@dc.dataclass(frozen=True)
class TextNode:
    """A text."""

    value: str


@dc.dataclass(frozen=True)
class NameNode:
    """The name of a variable or a function."""

    name: str


@dc.dataclass(frozen=True)
class WholeNode:
    """A colon alone as an index: everything."""


@dc.dataclass(frozen=True)
class UnaryNode:
    """An operator with one operand: `-`, `+`, `~`, or `'` behind it."""

    operator: str
    operand: ScriptNode


@dc.dataclass(frozen=True)
class BinaryNode:
    """An operator between two operands."""

    operator: str
    left: ScriptNode
    right: ScriptNode


@dc.dataclass(frozen=True)
class RangeNode:
    """A range, first : step : last."""

    first: ScriptNode
    step: ScriptNode | None
    last: ScriptNode


@dc.dataclass(frozen=True)
class ListNode:
    """A matrix in brackets or a cell array in braces, row by row."""

    cells: bool
    rows: tuple[tuple[ScriptNode, ...], ...]


@dc.dataclass(frozen=True)
class IndexNode:
    """What is in parentheses or braces behind an expression: an index, or the arguments of a call."""

    target: ScriptNode
    braces: bool
    arguments: tuple[ScriptNode, ...]


@dc.dataclass(frozen=True)
class MemberNode:
    """A member of a structure or an object."""

    target: ScriptNode
    name: str


ScriptNode: TypeAlias = (
    NumberNode
    | TextNode
    | NameNode
    | WholeNode
    | UnaryNode
    | BinaryNode
    | RangeNode
    | ListNode
    | IndexNode
    | MemberNode
)


@dc.dataclass(frozen=True)
class Plain:
    """A statement that is an assignment or a call, in words."""

    line: int
    tokens: tuple[Token, ...]


@dc.dataclass(frozen=True)
class ScriptLoop:
    """A `for` loop: its variable and range in words."""

    line: int
    head: tuple[Token, ...]
    body: ScriptBody


@dc.dataclass(frozen=True)
class ScriptRepetition:
    """A `while` loop: its condition in words."""

    line: int
    condition: tuple[Token, ...]
    body: ScriptBody


@dc.dataclass(frozen=True)
class ScriptChoice:
    """Conditions in words and what depends on them; the condition of `else` is empty."""

    line: int
    branches: tuple[tuple[tuple[Token, ...], ScriptBody], ...]


@dc.dataclass(frozen=True)
class Switch:
    """A `switch`: its subject in words, and its cases; that of `otherwise` is empty."""

    line: int
    subject: tuple[Token, ...]
    cases: tuple[tuple[tuple[Token, ...], ScriptBody], ...]


@dc.dataclass(frozen=True)
class Attempt:
    """What is between `try` and `catch`."""

    line: int
    body: ScriptBody


@dc.dataclass(frozen=True)
class Jump:
    """`break`, `continue` or `return`."""

    line: int
    word: str


@dc.dataclass(frozen=True)
class Unread:
    """A statement that is not read, and why."""

    line: int
    why: str


@dc.dataclass(frozen=True)
class ScriptFunction:
    """A function of a script: its name, the names of its arguments and results, and its statements."""

    line: int
    name: str
    arguments: tuple[str, ...]
    results: tuple[str, ...]
    body: ScriptBody


ScriptStep: TypeAlias = (
    Plain | ScriptLoop | ScriptRepetition | ScriptChoice | Switch | Attempt | Jump | Unread
)
ScriptBody: TypeAlias = tuple[ScriptStep, ...]
