"""Formulas as docstrings write them, `tau du/dt = -u + integral k(x - x') g(u(x')) dx'`, read and set in TeX.

A grammar of relations, sums, products and powers. Two factors side by side are multiplied, and what stands before a stroke is
divided as a whole: q sqrt(dt) / tau. `integral`, `sum_k` and `prod_i` take what follows them in their product.
"""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Sequence

from deodar.server.symbols import NAME, extent, symbol, text

FUNCTIONS = {
    "exp": r"\exp",
    "log": r"\log",
    "ln": r"\ln",
    "sin": r"\sin",
    "cos": r"\cos",
    "tan": r"\tan",
    "tanh": r"\tanh",
    "max": r"\max",
    "min": r"\min",
}
BIG = {"integral": r"\int", "sum": r"\sum", "prod": r"\prod"}
RELATIONS = {"=": "=", "<": "<", ">": ">", "<=": r"\le", ">=": r"\ge", "!=": r"\ne"}
CLOSING = {"(": ")", "[": "]", "{": "}"}

DERIVATIVE = re.compile(r"d([A-Za-z]+)/d([a-z]'*)")
DIFFERENTIAL = re.compile(r"d[a-np-z]'*")
_TOKEN = re.compile(
    r"""(?P<space>\s+)
      | (?P<code>`[^`]+`)
      | (?P<derivative>d[A-Za-z]+/d[a-z]'*(?!\w))
      | (?P<number>\d+(?:\.\d+)?)
      | (?P<prose>[A-Za-z]{2,}'s\b | [A-Za-z]{2,}(?:-[A-Za-z]{2,})+)
      | (?P<name>[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*'*)
      | (?P<sign><=|>=|!=|\*\*|[-+*/^=<>|])
      | (?P<mark>[()\[\]{},;:.])
      | (?P<prose_>.)""",
    re.VERBOSE | re.DOTALL,
)


@dc.dataclass(frozen=True)
class Token:
    """A word, number or sign, and whether a space stands before it."""

    form: str
    text: str
    spaced: bool = False


@dc.dataclass(frozen=True)
class Piece:
    """Something set: its TeX, how wide it is in characters, whether it is higher than a line, and what it is without its brackets."""

    tex: str
    width: float
    tall: bool = False
    simple: bool = True
    inner: Piece | None = None


class Unreadable(Exception):
    """It is no formula after all."""


def tokens(source: str) -> list[Token]:
    """The text in words, numbers and signs."""
    found: list[Token] = []
    spaced = False
    for match in _TOKEN.finditer(source):
        form = (match.lastgroup or "").rstrip("_")
        if form != "space":
            found.append(Token(form, match[0], spaced))
        spaced = form == "space"
    return found


def is_big(token: Token) -> bool:
    """Whether it is the sign of an integral, or of a sum or product over an index."""
    return token.text == "integral" or (token.form == "name" and re.match(r"(sum|prod|integral)_\w+$", token.text) is not None)


def formula(found: Sequence[Token]) -> list[Piece]:
    """The formula in pieces that may stand on lines of their own: each but the first begins with a plus or minus."""
    reader = _Reader(found)
    pieces = reader.relation()
    if not reader.ended:
        raise Unreadable
    return pieces


def joined(pieces: Sequence[Piece], between: str = " ") -> Piece:
    """Pieces as one."""
    return Piece(between.join(p.tex for p in pieces), sum(p.width for p in pieces), any(p.tall for p in pieces), simple=False)


class _Reader:
    def __init__(self, found: Sequence[Token]) -> None:
        self.found = found
        self.at = 0
        self.barred = False  # inside | |, where the next bar closes

    @property
    def ended(self) -> bool:
        return self.at == len(self.found)

    def sees(self, *texts: str) -> bool:
        return not self.ended and self.found[self.at].form in ("sign", "mark") and self.found[self.at].text in texts

    def take(self, *texts: str) -> Token:
        if self.ended or (texts and not self.sees(*texts)):
            raise Unreadable
        self.at += 1
        return self.found[self.at - 1]

    # ---------------------------------------------------------------------------------------- relations and sums

    def relation(self) -> list[Piece]:
        """Sides of equations; the last may be missing, where words follow. Only the sum after the last sign may be broken."""
        pieces = [] if self.sees(*RELATIONS) else self.sum()
        while self.sees(*RELATIONS):
            sign = self.take().text
            side = [] if self.ended else self.sum()
            head = joined([*pieces, Piece(RELATIONS[sign], 3), *side[:1]])
            pieces = [head, *side[1:]]
        return pieces

    def whole(self) -> Piece:
        pieces = self.relation()
        return pieces[0] if len(pieces) == 1 else joined(pieces)

    def sum(self) -> list[Piece]:
        pieces: list[Piece] = []
        while True:
            sign = self.take().text if self.sees("+", "-") else ""
            term = self.term()
            if sign:
                term = Piece(f"{sign} {term.tex}" if pieces else sign + term.tex, term.width + (3 if pieces else 1), term.tall, simple=False)
            pieces.append(term)
            if not self.sees("+", "-"):
                return pieces

    # ---------------------------------------------------------------------------------------- products

    def term(self) -> Piece:
        done: list[Piece] = []  # what later strokes do not divide
        open_: list[Piece] = []
        while not self.ended and not self.sees("+", "-", ",", ")", "]", "}", *RELATIONS) and not (self.barred and self.sees("|")):
            if is_big(self.found[self.at]):
                done += [*open_, self.big()]
                open_ = []
            elif self.sees("*"):
                self.take()
                if not open_ and not done:
                    raise Unreadable
                named = not self.ended and (is_big(self.found[self.at]) or self.found[self.at].text in FUNCTIONS)
                done += [*open_, Piece(r"\," if named else r"\cdot", 1)]
                open_ = []
            elif self.sees("/"):
                spaced = self.take().spaced
                if not open_:
                    raise Unreadable
                if not self.ended and is_big(self.found[self.at]):
                    done += [*open_, Piece("/", 1)]
                    open_ = []
                else:
                    open_ = [_divided(open_, self.factor(), spaced)]
            else:
                open_.append(self.factor())
        parts = [*done, *open_]
        if not parts:
            raise Unreadable
        return parts[0] if len(parts) == 1 else _product(parts)

    def big(self) -> Piece:
        name, _, below = self.take().text.partition("_")
        under = f"_{{{symbol(below)}}}" if below else ""
        if self.sees("^"):
            self.take()
            power = self.atom()
            under += f"^{{{(power.inner or power).tex}}}"
        return Piece(BIG[name] + under, 2.5 if name == "integral" else 3.4, tall=True)

    def factor(self) -> Piece:
        if self.sees("-"):
            self.take()
            inner = self.factor()
            return Piece(f"-{inner.tex}", inner.width + 1, inner.tall, simple=False)
        base = self.atom()
        while self.sees("^"):
            self.take()
            power = self.factor()
            power = power.inner or power
            base = Piece(
                f"{{{base.tex}}}^{{{power.tex}}}" if "^" in base.tex else f"{base.tex}^{{{power.tex}}}", base.width + 0.7 * power.width, base.tall
            )
        return base

    # ---------------------------------------------------------------------------------------- atoms

    def atom(self) -> Piece:
        token = self.take()
        if token.form == "number":
            return Piece(token.text, len(token.text))
        if token.form == "derivative":
            top, bottom = (symbol(part) for part in DERIVATIVE.fullmatch(token.text).groups())  # type: ignore[union-attr]
            return Piece(rf"\frac{{d{top}}}{{d{bottom}}}", 2.4, tall=True)
        if token.form == "code":
            return self.called(_code(token.text[1:-1]))
        if token.form == "name":
            return self.name(token.text)
        if token.text in ("(", "["):
            return self.bracket(token.text)
        if token.text == "|":
            self.barred = True
            inner = self.whole()
            self.take("|")
            self.barred = False
            return _enclosed("|", inner, "|")
        raise Unreadable

    def name(self, name: str) -> Piece:
        if name in (*FUNCTIONS, "sqrt") and self.sees("("):
            self.take()
            return self.function(name)
        if DIFFERENTIAL.fullmatch(name):
            return Piece(name, 2.4)
        return self.called(Piece(symbol(name), extent(name)))

    def function(self, name: str) -> Piece:
        inner = self.arguments(")")
        if name == "sqrt":
            return Piece(rf"\sqrt{{{inner.tex}}}", inner.width + 1, inner.tall)
        if name == "exp" and not inner.tall:
            return Piece(f"e^{{{inner.tex}}}", 1 + 0.7 * inner.width)
        held = _enclosed("(", inner, ")")
        return Piece(FUNCTIONS[name] + (r"\!" if inner.tall else "") + held.tex, len(name) + held.width, inner.tall)

    def called(self, head: Piece) -> Piece:
        """A name with the arguments or places that follow it without a space."""
        while self.sees("(", "[") and not self.found[self.at].spaced:
            sign = self.take().text
            held = _enclosed(sign, self.arguments(CLOSING[sign]), CLOSING[sign])
            head = Piece(head.tex + held.tex, head.width + held.width, head.tall or held.tall)
        return head

    def arguments(self, closing: str) -> Piece:
        pieces: list[Piece] = []
        while not self.sees(closing):
            if self.sees("**"):
                self.take()
                inner = self.whole()
                pieces.append(Piece(rf"{{*}}{{*}}{inner.tex}", inner.width + 2, inner.tall))
            else:
                pieces.append(self.whole())
            if not self.sees(closing):
                self.take(",")
        self.take(closing)
        made = joined(pieces, r",\, ") if len(pieces) != 1 else pieces[0]
        return dc.replace(made, width=made.width + max(0, len(pieces) - 1) * 1.5)

    def bracket(self, sign: str) -> Piece:
        inner = self.arguments(CLOSING[sign])
        return dc.replace(_enclosed(sign, inner, CLOSING[sign]), simple=False, inner=inner)


def _enclosed(left: str, inner: Piece, right: str) -> Piece:
    tex = rf"\left{left} {inner.tex} \right{right}" if inner.tall else f"{left}{inner.tex}{right}"
    return Piece(tex, inner.width + 1.8, inner.tall)


def _divided(over: list[Piece], under: Piece, spaced: bool) -> Piece:
    """Numbers and what is composed as a fraction; two names side by side with a stroke."""
    top = (over[0].inner or over[0]) if len(over) == 1 else _product(over)
    if len(over) == 1 and over[0].simple and under.simple and spaced and not under.tall and not top.tall:
        return Piece(f"{top.tex} / {under.tex}", top.width + under.width + 1, simple=False)
    bottom = under.inner or under
    small = top.tex.isdigit() and bottom.tex.isdigit()
    return Piece(rf"\{'tfrac' if small else 'frac'}{{{top.tex}}}{{{bottom.tex}}}", max(top.width, bottom.width) + 0.3, tall=not small)


def _product(parts: list[Piece]) -> Piece:
    """Factors side by side: a thin space between them, but none after a number and around signs."""
    tex, width, before = "", 0.0, ""
    for part in parts:
        sign = part.tex in (r"\,", r"\cdot", "/") or before in (r"\,", r"\cdot", "/") or before.startswith((r"\int", r"\sum", r"\prod"))
        if tex:
            tight = sign or re.fullmatch(r"[\d.]+", before)
            tex += " " if tight else r"\, "
            width += 0 if tight else 0.4
        tex += part.tex
        width += part.width
        before = part.tex
    return Piece(tex, width, any(p.tall for p in parts), simple=False)


def _code(source: str) -> Piece:
    """What stands between backticks: a name as a symbol, everything else as it is."""
    if NAME.fullmatch(source):
        return Piece(symbol(source), extent(source))
    return Piece(text(source), len(source))
