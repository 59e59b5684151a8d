"""The statements of a script by blocks: loops, choices, functions."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping

from deodar.errors import DocumentError
from deodar_interop.importers.cosivina.launchers.tokens import KEYWORDS, ScriptStatement, Token, statements
from deodar_interop.importers.cosivina.launchers.tree import (
    Attempt,
    Jump,
    Plain,
    ScriptBody,
    ScriptChoice,
    ScriptFunction,
    ScriptLoop,
    ScriptRepetition,
    ScriptStep,
    Switch,
    Unread,
)

DEEPEST = 40
"""Largest depth of blocks inside blocks."""

Words = tuple[Token, ...]


@dc.dataclass(frozen=True)
class Script:
    """The statements of a script, and the functions that it defines by name, in their order."""

    body: ScriptBody
    functions: Mapping[str, ScriptFunction]


def script(text: str) -> Script:
    """Return the blocks of a script.

    Raises:
        DocumentError: the script is too long, or nested too deeply.
    """
    return _Blocks(statements(text)).script()


class _Blocks:
    """The state of the reading of blocks."""

    def __init__(self, listed: list[ScriptStatement]) -> None:
        self.statements = listed
        self.at = 0
        self.functions: dict[str, ScriptFunction] = {}

    def script(self) -> Script:
        """Return all blocks."""
        body: list[ScriptStep] = []
        while self.at < len(self.statements):
            body += self.body((), 0)
            if self.at < len(self.statements):
                line, word = self.statements[self.at].line, self.word()
                if word == "function":
                    self.function()
                    continue
                body.append(Unread(line, f"{word!r} belongs to no block"))
                self.at += 1
        return Script(tuple(body), self.functions)

    def word(self) -> str:
        """Return the keyword that the next statement begins with, or ""."""
        tokens = self.statements[self.at].tokens
        first = tokens[0] if tokens else None
        return first.value if first is not None and first.form == "name" and first.value in KEYWORDS else ""

    def body(self, ends: tuple[str, ...], depth: int) -> list[ScriptStep]:
        """Return the steps up to a keyword that ends the block, which is not taken."""
        if depth > DEEPEST:
            raise DocumentError(
                f"has blocks nested deeper than {DEEPEST}, in line {self.statements[self.at - 1].line}"
            )
        steps: list[ScriptStep] = []
        while self.at < len(self.statements):
            statement, word = self.statements[self.at], self.word()
            if word in ends or word in ("end", "else", "elseif", "case", "otherwise", "catch", "function"):
                break
            self.at += 1
            if statement.unread:
                steps.append(Unread(statement.line, statement.unread))
            elif word:
                steps += self.block(word, statement, depth)
            else:
                steps.append(Plain(statement.line, statement.tokens))
        return steps

    def block(self, word: str, statement: ScriptStatement, depth: int) -> list[ScriptStep]:
        """Return a block whose first statement was taken."""
        line, words = statement.line, statement.tokens[1:]
        match word:
            case "for" | "parfor":
                step: ScriptStep = ScriptLoop(line, words, tuple(self.closed(depth)))
            case "while":
                step = ScriptRepetition(line, words, tuple(self.closed(depth)))
            case "if":
                step = self.choice(line, words, depth)
            case "switch":
                step = self.switch(line, words, depth)
            case "try":
                body = self.body(("catch",), depth + 1)
                if self.at < len(self.statements) and self.word() == "catch":
                    self.at += 1
                    self.body((), depth + 1)
                self.close()
                step = Attempt(line, tuple(body))
            case "spmd" | "classdef":
                self.closed(depth)
                why = "it is computed in several processes" if word == "spmd" else "a class is not read"
                step = Unread(line, why)
            case "break" | "continue" | "return":
                step = Jump(line, word)
            case _:
                return []  # global, persistent: names of variables
        return [step]

    def closed(self, depth: int) -> list[ScriptStep]:
        """Return the steps of a block up to its `end`, which is taken."""
        body = self.body((), depth + 1)
        self.close()
        return body

    def close(self) -> None:
        """Take the `end` of a block, if it is there."""
        while self.at < len(self.statements) and self.word() not in ("end", "function"):
            self.at += 1  # a keyword of another block
            self.body((), 1)
        if self.at < len(self.statements) and self.word() == "end":
            self.at += 1

    def choice(self, line: int, head: Words, depth: int) -> ScriptChoice:
        """Return an `if`, whose condition was taken."""
        branches: list[tuple[Words, ScriptBody]] = [(head, tuple(self.body((), depth + 1)))]
        while self.at < len(self.statements) and self.word() in ("elseif", "else"):
            statement = self.statements[self.at]
            self.at += 1
            condition = statement.tokens[1:] if statement.tokens[0].value == "elseif" else ()
            branches.append((condition, tuple(self.body((), depth + 1))))
        self.close()
        return ScriptChoice(line, tuple(branches))

    def switch(self, line: int, subject: Words, depth: int) -> Switch:
        """Return a `switch`, whose subject was taken."""
        self.body((), depth + 1)
        cases: list[tuple[Words, ScriptBody]] = []
        while self.at < len(self.statements) and self.word() in ("case", "otherwise"):
            statement = self.statements[self.at]
            self.at += 1
            case = statement.tokens[1:] if statement.tokens[0].value == "case" else ()
            cases.append((case, tuple(self.body((), depth + 1))))
        self.close()
        return Switch(line, subject, tuple(cases))

    def function(self) -> None:
        """Take a function: `function [results] = name(arguments)`, with or without an `end`."""
        statement = self.statements[self.at]
        self.at += 1
        words = [t for t in statement.tokens[1:] if t.form == "name" or t.value in ("=", "(")]
        names = [t.value for t in words]
        split = names.index("=") if "=" in names else -1
        results, signature = names[: max(split, 0)], names[split + 1 :]
        body = tuple(self.body((), 0))
        if self.at < len(self.statements) and self.word() == "end":
            self.at += 1
        if signature and signature[0] not in ("=", "("):
            arguments = [name for name in signature[1:] if name not in ("=", "(")]
            function = ScriptFunction(statement.line, signature[0], tuple(arguments), tuple(results), body)
            self.functions.setdefault(function.name, function)
