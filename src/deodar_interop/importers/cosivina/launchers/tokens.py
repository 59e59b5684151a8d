"""The words of a script, statement by statement: names, numbers, text, operators."""

from __future__ import annotations

import dataclasses as dc
import re
from typing import Literal

from deodar.errors import DocumentError

MOST_CHARACTERS = 4_000_000
"""Longest script; more are refused (a guess: eighty times the longest published one)."""

MOST_TOKENS = 400_000
"""Most words of a script, by the same rule."""

KEYWORDS = frozenset(
    (
        *("break", "case", "catch", "classdef", "continue", "else", "elseif", "end", "for", "function"),
        *("global", "if", "otherwise", "parfor", "persistent", "return", "spmd", "switch", "try", "while"),
    )
)

Form = Literal["name", "number", "text", "operator", "row"]
"""Forms of words. A `row` is a new line inside brackets, which begins a row."""

OPENING = {"(": ")", "[": "]", "{": "}"}
OPERATORS = (
    *("==", "~=", "!=", "<=", ">=", "&&", "||", ".*", "./", ".^", ".\\", ".'"),
    *"()[]{}=<>+-*/\\^:;,.~!&|@",
)
SPACE = re.compile(r"[ \t\r\f\v]+")
COMMENT = re.compile(r"%[^\n]*")
CONTINUED = re.compile(r"\.\.\.[^\n]*(?:\n|\Z)")
BLOCK = re.compile(r"[ \t]*%([{}])[ \t\r]*(?:\n|\Z)")
NAME = re.compile(r"[A-Za-z]\w*", re.ASCII)
NUMBER = re.compile(r"(?:\d+(?:\.(?![*/^\\'])\d*)?|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
QUOTED = {"'": re.compile(r"'((?:[^'\n]|'')*)'"), '"': re.compile(r'"((?:[^"\n]|"")*)"')}
LINE = re.compile(r"[^\n]*")


@dc.dataclass(frozen=True)
class Token:
    """One word.

    Attributes:
        form: what it is.
        value: the word; of a text what is between its quotes.
        line: its line, counted from 1.
        apart: whether space is before it.
        leans: whether no space is behind it.
    """

    form: Form
    value: str
    line: int
    apart: bool = False
    leans: bool = False

    @property
    def ends_operand(self) -> bool:
        """Whether an operand ends here, so that a quote behind it transposes."""
        return (
            self.form in ("name", "number", "text")
            or self.value in (")", "]", "}", ".'")
            or (self.form == "operator" and self.value == "'")
        )


@dc.dataclass(frozen=True)
class ScriptStatement:
    """The words of one statement and its line; `unread` is why they are not read, else ""."""

    line: int
    tokens: tuple[Token, ...] = ()
    unread: str = ""


def statements(text: str) -> list[ScriptStatement]:
    """Return the statements of a script.

    Raises:
        DocumentError: the script is too long.
    """
    if len(text) > MOST_CHARACTERS:
        raise DocumentError(
            f"has {len(text) / 1e6:.0f} million characters; of a script at most "
            f"{MOST_CHARACTERS // 1_000_000} million are read"
        )
    return _Scanner(text).all()


class _Scanner:
    """The state of the separation of a script into statements."""

    def __init__(self, text: str) -> None:
        self.text = text.replace("\r\n", "\n").replace("\r", "\n")
        self.at, self.line, self.count = 0, 1, 0
        self.statements: list[ScriptStatement] = []
        self.begin()

    def begin(self) -> None:
        """Begin a statement."""
        self.tokens: list[Token] = []
        self.open: list[str] = []
        self.apart = False
        self.first = self.at  # where its first word ends

    def all(self) -> list[ScriptStatement]:
        """Return all statements."""
        text = self.text
        while self.at < len(text) or self.open:
            if self.at >= len(text):
                self.begin_again()
                continue
            if (self.at == 0 or text[self.at - 1] == "\n") and (block := BLOCK.match(text, self.at)):
                self.skip_block(block)
            elif space := SPACE.match(text, self.at):
                self.at, self.apart = space.end(), True
            elif comment := COMMENT.match(text, self.at):
                self.at = comment.end()
            elif continued := CONTINUED.match(text, self.at):
                self.at, self.apart, self.line = continued.end(), True, self.line + 1
            elif text[self.at] == "\n":
                self.end_line()
            else:
                self.word()
        self.finish()
        return self.statements

    def begin_again(self) -> None:
        """Report a statement whose brackets never close, and continue with the line behind its first one."""
        at, first = self.first, self.tokens[0].line
        self.fail(f"a {self.open[-1]!r} is missing")
        self.at, self.line = at, first
        end = LINE.match(self.text, self.at)
        self.at = len(self.text) if end is None else end.end()

    def skip_block(self, opening: re.Match[str]) -> None:
        """Skip a block of comments, which lines with %{ and %} alone enclose."""
        depth = 0
        match: re.Match[str] | None = opening
        while True:
            if match is not None:
                depth += 1 if match.group(1) == "{" else -1
            end = LINE.match(self.text, self.at)
            self.at = len(self.text) if end is None else min(end.end() + 1, len(self.text))
            self.line += 1
            if depth <= 0 or self.at >= len(self.text):
                return
            match = BLOCK.match(self.text, self.at)

    def end_line(self) -> None:
        """Take a new line: it ends a statement, or a row inside brackets."""
        if not self.open:
            self.finish()
        elif self.open[-1] == ")":
            self.fail("its parentheses are not closed on the line, which does not end in ...")
            return
        else:
            self.add("row", "\n")
        self.at, self.line, self.apart = self.at + 1, self.line + 1, True

    def word(self) -> None:
        """Take one word."""
        text, character = self.text, self.text[self.at]
        if character in QUOTED and not (character == "'" and self.transposes()):
            match = QUOTED[character].match(text, self.at)
            if match is None:
                self.fail("a text has no closing quote")
                return
            self.take("text", match.group(1).replace(character * 2, character), match.end())
        elif character == "'":
            self.take("operator", "'", self.at + 1)
        elif name := NAME.match(text, self.at):
            self.take("name", name.group(), name.end())
        elif number := NUMBER.match(text, self.at):
            self.take("number", number.group(), number.end())
        elif operator := next((o for o in OPERATORS if text.startswith(o, self.at)), ""):
            self.operator(operator)
        else:
            self.fail(
                f"{character!r} has no meaning in a script" if character.isprintable() else "it is not text"
            )

    def operator(self, sign: str) -> None:
        """Take an operator; a separator outside brackets ends the statement."""
        if sign in OPENING:
            self.take("operator", sign, self.at + 1)
            self.open.append(OPENING[sign])
        elif sign in OPENING.values():
            if not self.open or self.open[-1] != sign:
                self.fail(f"{sign!r} closes nothing")
                return
            self.open.pop()
            self.take("operator", sign, self.at + 1)
        elif sign in (";", ",") and not self.open:
            self.at += 1
            self.finish()
        else:
            self.take("operator", sign, self.at + len(sign))

    def transposes(self) -> bool:
        """Return whether a quote here transposes what is before it."""
        if not self.tokens:
            return False
        before = self.tokens[-1]
        if not before.ends_operand or (before.value in KEYWORDS and not self.open):
            return False
        between = bool(self.open) and self.open[-1] != ")"
        return not (self.apart and (between or len(self.tokens) == 1))

    def take(self, form: Form, word: str, end: int) -> None:
        """Add a word that ends at a position."""
        self.at = end
        self.add(form, word)

    def add(self, form: Form, word: str) -> None:
        """Add a word."""
        self.count += 1
        if self.count > MOST_TOKENS:
            raise DocumentError(f"is a script of more than {MOST_TOKENS} words")
        if not self.tokens:
            self.first = self.at
        following = self.text[self.at : self.at + 1]
        self.tokens.append(Token(form, word, self.line, self.apart, bool(following.strip())))
        self.apart = False

    def finish(self) -> None:
        """End a statement."""
        if self.tokens:
            self.statements.append(ScriptStatement(self.tokens[0].line, tuple(self.tokens)))
        self.begin()

    def fail(self, why: str) -> None:
        """Report the statement as not read, and skip the rest of its line."""
        first = self.tokens[0].line if self.tokens else self.line
        self.statements.append(ScriptStatement(first, (), why))
        end = LINE.match(self.text, self.at)
        self.at = len(self.text) if end is None else end.end()
        self.begin()
