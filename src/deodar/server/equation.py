"""Equations of docstrings in TeX: formulas are typeset, the words between them stay words, long lines are broken."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Collection, Sequence

from deodar.server.formula import CLOSING, DIFFERENTIAL, FUNCTIONS, RELATIONS, Piece, Token, Unreadable, formula, is_big, joined, tokens
from deodar.server.symbols import is_letter, text

MOST = 48.0
"""Most characters of a line: what a narrow panel holds."""

CASES = frozenset(("where", "if", "for", "when"))
"""Words between a value and its condition."""

ARTICLES = frozenset(("a", "A", "I"))


@dc.dataclass(frozen=True)
class Run:
    """A stretch of a clause: a formula in pieces, or a single word or mark (`pieces` is empty)."""

    word: str
    pieces: tuple[Piece, ...] = ()
    spaced: bool = True
    whole: bool = False

    @property
    def width(self) -> float:
        """About how many characters it takes."""
        return len(self.word) + sum(p.width for p in self.pieces)


def tex(equation_text: str, names: Collection[str] = ()) -> list[str]:
    """Lines of TeX, each a formula or words (or both). `names` are words that stand for quantities: parameters and ports.

    Words among letters and signs are told apart by how they stand: one that is called, that has a subscript or that is next to a sign
    belongs to a formula. What cannot be read as a formula is shown as it is written.
    """
    found = tokens(equation_text)
    return [line for clause in _clauses(found) for line in _lines(_unmarked(clause, names), names)]


def quantities(equation_text: str, names: Collection[str] = ()) -> set[str]:
    """Names that occur in the formulas, without subscripts and primes, and as they are written."""
    found = tokens(equation_text)
    used = {t.text.strip("`") for t, here in zip(found, _readable(found, names), strict=True) if here and t.form in ("name", "code")}
    return used | {name.rstrip("'").split("_")[0] for name in used}


# ------------------------------------------------------------------------------------------------ clauses


def _clauses(found: Sequence[Token]) -> list[list[Token]]:
    """The text divided at semicolons, colons and the ends of sentences; the mark stays with what stands before it."""
    clauses: list[list[Token]] = [[]]
    depth = 0
    for i, token in enumerate(found):
        clauses[-1].append(token)
        depth += (token.text in CLOSING) - (token.text in CLOSING.values())
        if token.text in (";", ":", ".") and depth <= 0 and (i + 1 == len(found) or found[i + 1].spaced):
            clauses.append([])
    return [c for c in clauses if c]


def _unmarked(clause: list[Token], names: Collection[str]) -> list[Token]:
    """A formula on a line of its own needs no mark behind it; words do."""
    if len(clause) < 2 or clause[-1].text not in (";", ":", "."):
        return clause
    return clause[:-1] if _is_cases(clause) or _runs(clause[:-1], names)[-1].whole else clause


def _lines(clause: list[Token], names: Collection[str]) -> list[str]:
    """A clause on as many lines as it needs."""
    runs = _runs(clause, names)
    cases = _cases(clause, names)
    if cases is not None:
        return [cases]
    if _width(runs) <= MOST:
        return [_set(runs)]
    lines: list[str] = []
    rest: list[Run] = []
    for run in runs:
        if run.whole:
            # a word or two before a formula stay with it: with lambda(x) = ...
            lead = [r for r in rest if r.word != ","]
            if not (len(lead) <= 2 and all(r.word for r in lead)):
                lines += _wrapped(rest)
                lead = []
            lines += _broken(lead, run.pieces)
            rest = []
        elif rest or run.word != ",":
            rest.append(run)
    return lines + _wrapped(rest)


def _wrapped(runs: list[Run]) -> list[str]:
    """Words, with what formulas stand among them, on lines that are not too long; shorter ones where they hold it too, so that none is left alone."""
    wide, narrow = _filled(runs, MOST), _filled(runs, 0.8 * MOST)
    return [_set(line) for line in (narrow if len(narrow) == len(wide) else wide) if line]


def _filled(runs: list[Run], most: float) -> list[list[Run]]:
    lines: list[list[Run]] = [[]]
    width = 0.0
    for run in runs:
        more = run.width + run.spaced
        if lines[-1] and run.spaced and width + more > most:
            lines.append([])
            width = 0.0
        lines[-1].append(run)
        width += more
    return lines


def _broken(lead: list[Run], pieces: Sequence[Piece]) -> list[str]:
    """A formula on lines that are not too long, broken before a plus or minus."""
    before = _set(lead) + r"\ " if lead else ""
    lines = [[Piece(before, sum(r.width + 1 for r in lead)), pieces[0]] if lead else [pieces[0]]]
    for piece in pieces[1:]:
        if sum(p.width for p in lines[-1]) + piece.width > MOST:
            lines.append([Piece(r"\quad {}", 2)])
        lines[-1].append(piece)
    return [joined(line).tex for line in lines]


def _width(runs: Sequence[Run]) -> float:
    return sum(r.width + r.spaced for r in runs)


def _set(runs: Sequence[Run]) -> str:
    """Runs on one line. Among words high formulas are set low, so that lines keep their distance."""
    out, words = "", ""
    alone = any(r.whole for r in runs) or all(r.pieces or len(r.word) == 1 for r in runs)
    before: Run | None = None
    for run in runs:
        related = before is not None and before.pieces and before.pieces[-1].tex.endswith(tuple(RELATIONS.values()))
        words += " " if run.spaced and before is not None and not related else ""
        if run.pieces:
            set_ = joined(run.pieces)
            out += (text(words) if words else " ") + (set_.tex if alone or not set_.tall else rf"{{\textstyle {set_.tex}}}")
            words = ""
        else:
            words += run.word
        before = run
    return (out + (text(words) if words else "")).strip()


# ------------------------------------------------------------------------------------------------ cases


def _is_cases(clause: Sequence[Token]) -> bool:
    words = [t.text for t in clause]
    return "else" in words and any(w in CASES for w in words[: words.index("else")])


def _cases(clause: Sequence[Token], names: Collection[str]) -> str | None:
    """`g(u) = 1 where u > theta, else 0` with a brace; None where it is not of this form."""
    words = [t.text for t in clause]
    if not _is_cases(clause):
        return None
    otherwise = words.index("else")
    condition = next(i for i, w in enumerate(words) if w in CASES)
    equal = next((i for i in range(condition - 1, 0, -1) if words[i] == "="), 0)
    end = otherwise - (words[otherwise - 1] == ",")
    parts = clause[: equal + 1], clause[equal + 1 : condition], clause[condition:end], clause[otherwise + 1 :]
    if not equal or not all(parts):
        return None
    runs = [_runs(part, names) for part in parts]
    left, value, when, other = (_set(r) for r in runs)
    if _width(runs[0]) + max(_width(runs[1]) + _width(runs[2]), _width(runs[3]) + len("else")) + 3 > MOST:
        return None
    return rf"{left} \begin{{cases}} {value} & {when} \\ {other} & {text('else')} \end{{cases}}"


# ------------------------------------------------------------------------------------------------ words and formulas


def _runs(clause: Sequence[Token], names: Collection[str]) -> list[Run]:
    """Formulas and single words, in order."""
    readable = _readable(clause, names)
    runs: list[Run] = []
    i = 0
    while i < len(clause):
        end = i
        while end < len(clause) and readable[end]:
            end += 1
        if end == i:
            runs.append(Run(clause[i].text.strip("`"), spaced=clause[i].spaced))
            i += 1
            continue
        try:
            pieces = tuple(formula(clause[i:end]))
            equated = any(t.text == "=" for t in clause[i:end]) and clause[end - 1].text not in RELATIONS
            runs.append(Run("", pieces, clause[i].spaced, equated))
        except (Unreadable, RecursionError):
            runs += [Run(t.text.strip("`"), spaced=t.spaced) for t in clause[i:end]]
        i = end
    return runs


def _readable(found: Sequence[Token], names: Collection[str]) -> list[bool]:
    """Which tokens belong to formulas."""
    pairs = _pairs(found)
    here = [_word_is_readable(found, i, names) for i in range(len(found))]
    for start, end in sorted(pairs.items(), reverse=True):  # the inner ones first
        called = _is_called(found, start)
        inside = range(start + 1, end)
        if called:
            for i in inside:
                here[i] = here[i] or found[i].form != "prose"
        whole = all(here[i] or found[i].text == "," for i in inside) and end > start + 1
        here[start] = here[end] = whole or called
        if here[start]:
            for i in inside:
                here[i] = True
    for i, token in enumerate(found):
        if token.text == "integral":  # the sign, unless it is the word: its integral decides
            here[i] = i + 1 < len(found) and here[i + 1] and found[i + 1].text not in RELATIONS
        elif token.form == "sign" and not _between(here, i):
            here[i] = False
    return here


def _between(here: Sequence[bool], i: int) -> bool:
    return (i > 0 and here[i - 1]) or (i + 1 < len(here) and here[i + 1])


def _pairs(found: Sequence[Token]) -> dict[int, int]:
    """Places of opening brackets and of those that close them."""
    pairs: dict[int, int] = {}
    open_: list[int] = []
    for i, token in enumerate(found):
        if token.text in CLOSING:
            open_.append(i)
        elif token.text in CLOSING.values() and open_ and CLOSING[found[open_[-1]].text] == token.text:
            pairs[open_.pop()] = i
    return pairs


def _is_called(found: Sequence[Token], start: int) -> bool:
    before = found[start - 1] if start else None
    return before is not None and before.form in ("name", "code") and (not found[start].spaced or before.text in FUNCTIONS)


def _word_is_readable(found: Sequence[Token], i: int, names: Collection[str]) -> bool:
    """Whether a word or sign, by itself and its neighbours, belongs to a formula. Brackets are looked at afterwards."""
    token = found[i]
    before, after = (found[i - 1] if i else None), (found[i + 1] if i + 1 < len(found) else None)
    if token.form in ("number", "derivative", "sign"):
        return True
    if token.form == "code":
        return token.text[1:-1] in names
    if token.form != "name" or token.text in CASES or token.text == "else":
        return False
    if token.text in ARTICLES and after is not None and after.form in ("name", "prose") and not is_letter(after.text):
        return False
    if is_letter(token.text) or is_big(token) or "_" in token.text or DIFFERENTIAL.fullmatch(token.text) or token.text in names:
        return True
    if after is not None and after.text in ("(", "[") and (not after.spaced or token.text in FUNCTIONS):
        return True
    arithmetic = ("+", "-", "*", "/", "^", "**")
    if any(t is not None and t.form == "sign" and t.text in arithmetic for t in (before, after)) or (after is not None and after.text in RELATIONS):
        return True
    ends = after is None or after.text in (";", ".", ",", ":", *CASES)
    return ends and before is not None and before.text in RELATIONS
