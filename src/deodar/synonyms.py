"""Names that papers and other tools use for kinds and parameters, and what deodar calls them.

The rows of `synonyms.csv` are read when a name is refused, not before.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

KINDS = "dd"
"""What the column `kind` has for the name of a kind."""

LONGEST = 20
"""Most characters of a value that a proposal repeats."""

TABLE = Path(__file__).with_suffix(".csv")


@dataclass(frozen=True)
class Synonym:
    """A name of a parameter elsewhere, or of a kind.

    Attributes:
        kind: the class that has the parameter; "dd" for the name of a kind.
        word: the name elsewhere.
        path: the parameter inside the kind: `resting_level`, `sigmoid.beta`, `kernel.0.sigma`; or the kind.
        part: the class of the part that a path with dots leads to.
        source: who uses the name.
    """

    kind: str
    word: str
    path: str
    part: str
    source: str

    def keyword(self, written: str = "...") -> str:
        """Return the argument of a call, with its value as it is written.

        >>> Synonym("Field", "beta", "sigmoid.beta", "Logistic", "cosivina").keyword("4")
        'sigmoid=dd.Logistic(beta=4)'
        """
        first, *inner = self.path.split(".")
        if not inner:
            return f"{first}={written}"
        call = f"dd.{self.part}({inner[-1]}={written})"
        return f"{first}=[{call}]" if inner[0].isdigit() else f"{first}={call}"

    def entry(self, written: str = "...") -> str:
        """Return the entry of a document, with its value in JSON.

        >>> Synonym("Field", "beta", "sigmoid.beta", "Logistic", "cosivina").entry("4")
        '"sigmoid": {"kind": "Logistic", "beta": 4}'
        """
        written = written if len(written) <= LONGEST else "..."
        first, *inner = self.path.split(".")
        if not inner:
            return f'"{first}": {written}'
        part = f'{{"kind": "{self.part}", "{inner[-1]}": {written}}}'
        return f'"{first}": [{part}]' if inner[0].isdigit() else f'"{first}": {part}'


def argument(kind: str, word: str, setting: object = ...) -> str:
    """Return the argument that a call of a kind takes for a name from elsewhere, to be written; "" without
    one.

    Args:
        kind: name of the class.
        word: the name from elsewhere.
        setting: its value, which is written if it is a number or a text.
    """
    row = synonym(kind, word)
    if row is None:
        return ""
    plain = isinstance(setting, (bool, int, float, str)) and len(repr(setting)) <= LONGEST
    return f"Write: {row.keyword(repr(setting) if plain else '...')}"


def synonym(kind: str, word: str) -> Synonym | None:
    """Return the row for a name that a kind does not have; None without one.

    Case, hyphens and underscores do not matter: `sigmaExc` is `sigma_exc`.
    """
    return _rows().get((kind, _plain(word)))


def rows() -> tuple[Synonym, ...]:
    """Return the whole table."""
    return tuple(_rows().values())


@functools.cache
def _rows() -> Mapping[tuple[str, str], Synonym]:
    import csv  # start-up time: only a refused name needs it

    with TABLE.open(encoding="utf-8", newline="") as file:
        listed = [Synonym(**row) for row in csv.DictReader(file)]
    return {(s.kind, _plain(s.word)): s for s in listed}


def _plain(word: str) -> str:
    return "".join(c for c in word.casefold() if c not in "_- ")
