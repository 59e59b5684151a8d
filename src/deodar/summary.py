"""The few lines in which an object shows itself, the same in a console and in a notebook."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from html import escape
from itertools import zip_longest
from typing import Any, NamedTuple

LARGEST = 18_000
"""Most characters of an object in a notebook, which stores each of its outputs; a title and a row may come
on top of them.
"""

OPEN_ROWS = 12
"""Most rows that are shown without a click."""

LONGEST_CELL = 160
"""Most characters of a cell; a longer text is cut."""


class Summary(NamedTuple):
    """What an object is, and its main numbers.

    HTML has no colours of its own, so it follows the theme of the notebook, and escapes all text.

    Attributes:
        title: the kind and name of the object.
        rows: its main numbers, a name and a value in each row, or the columns of `heads`.
        heads: names of the columns; empty for names and values.
        folded: the line above a table that is closed; empty: a table of up to 12 rows is open.
    """

    title: str
    rows: Sequence[Sequence[Any]] = ()
    heads: Sequence[str] = ()
    folded: str = ""

    @property
    def text(self) -> str:
        """The lines for a console."""
        cells = [[_line(content) for content in row] for row in self.rows]
        columns = zip_longest(*(row if len(row) > 1 else [] for row in cells), fillvalue="")
        widths = [max(map(len, column)) for column in columns] or [0]
        lines = ["  ".join(f"{c:{w}}" for c, w in zip(row, widths, strict=False)).rstrip() for row in cells]
        return "<" + "\n  ".join([_line(self.title), *lines]) + ">"

    def html(self, picture: str = "") -> str:
        """Return the lines for a notebook; `picture` is HTML between the title and the table.

        Rows for which there is no room are counted.
        """
        out = [f"<div><b>{_cell(self.title)}</b>{picture}"]
        if self.rows:
            closed = bool(self.folded) or len(self.rows) > OPEN_ROWS
            folded = _cell(self.folded or f"{len(self.rows)} rows")
            out.append(f"<details><summary>{folded}</summary><table>" if closed else "<table>")
            if self.heads:
                out.append(f"<tr>{''.join(f'<th>{_cell(head)}</th>' for head in self.heads)}</tr>")
            room = LARGEST - sum(map(len, out))
            for n, row in enumerate(self.rows):
                out.append(f"<tr>{''.join(f'<td>{_cell(content)}</td>' for content in row)}</tr>")
                room -= len(out[-1])
                if room < 0:
                    out[-1] = f"<tr><td>... and {len(self.rows) - n} more</td></tr>"
                    break
            out.append("</table></details>" if closed else "</table>")
        return "".join([*out, "</div>"])


class Summarised:
    """An object that shows itself in a few lines; a dataclass of this kind is declared with `repr=False`."""

    __slots__ = ()

    @abstractmethod
    def _summary(self) -> Summary:
        """Return what the object is, and its main numbers."""

    def __repr__(self) -> str:
        return self._summary().text

    def _repr_html_(self) -> str:
        return self._summary().html()


def counted(n: int, noun: str) -> str:
    """Return a number with its noun: `1 peak`, `3 peaks`."""
    return f"{n} {noun}{'' if n == 1 else 's'}"


def sized(count: int) -> str:
    """Return a number of bytes with its unit: `12 bytes`, `3.4 MB`."""
    for unit, factor in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if count >= factor:
            return f"{count / factor:.3g} {unit}"
    return counted(count, "byte")


def _line(content: Any) -> str:
    """Return a content as the text of one line; a number has six digits."""
    if content is None:
        return "none"
    if isinstance(content, bool):
        return "yes" if content else "no"
    text = f"{content:.6g}" if isinstance(content, float) else str(content)
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)


def _cell(content: Any) -> str:
    """Return a content as HTML."""
    text = _line(content)
    short = text if len(text) <= LONGEST_CELL else f"{text[: LONGEST_CELL - 1]}\N{HORIZONTAL ELLIPSIS}"
    return escape(short)
