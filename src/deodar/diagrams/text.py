"""Width of text, and line breaks."""

from __future__ import annotations

import functools
import re
import unicodedata
from collections.abc import Sequence

FAMILY = "DejaVu Sans"
"""Font of the measured widths.

It is wider than the fonts that replace it, so that text fits in these too.
"""

CUT = "…"


@functools.cache
def _font(bold: bool):
    # start-up time: matplotlib is needed for figures only
    from matplotlib import font_manager, ft2font

    found = font_manager.findfont(
        font_manager.FontProperties(family=FAMILY, weight="bold" if bold else "normal")
    )
    font = ft2font.FT2Font(found)
    return font, font.get_charmap()


@functools.cache
def _advance(char: str, bold: bool) -> float:
    """Return the width of one character, for a font of size 1."""
    font, known = _font(bold)
    if ord(char) not in known:
        return (
            1.0 if unicodedata.east_asian_width(char) in "WF" else 0.0 if unicodedata.combining(char) else 0.8
        )
    font.set_size(100, 72)
    return float(font.load_char(ord(char)).linearHoriAdvance) / 65536 / 100


def width(text: str, size: float, bold: bool = False) -> float:
    """Return the width of one line of text."""
    return size * sum(_advance(c, bold) for c in text)


def wrap(text: str, size: float, room: float, most: int, bold: bool = False) -> list[str]:
    """Break text into lines no wider than `room`; text beyond the last allowed line is cut with an ellipsis.

    Lines break at spaces and after signs that join words; a longer word is broken anywhere.
    """
    lines: list[str] = []
    line = ""
    for word in re.findall(r"\S+?[_\-./>:]+(?=\S)|\S+|\s+", plain(text)):
        if width(line + word.rstrip(), size, bold) <= room:
            line += word
            continue
        if line.strip():
            lines.append(line.strip())
        line = word.lstrip()
        while width(line, size, bold) > room:
            n = max(
                1,
                next((k for k in range(1, len(line) + 1) if width(line[:k], size, bold) > room), len(line))
                - 1,
            )
            lines.append(line[:n])
            line = line[n:]
    if line.strip() or not lines:
        lines.append(line.strip())
    if len(lines) > most:
        last = lines[most - 1]
        while last and width(last + CUT, size, bold) > room:
            last = last[:-1]
        lines = [*lines[: most - 1], last + CUT]
    return lines


def plain(text: str) -> str:
    """Return the text on one line, without characters that files cannot contain."""
    return "".join(
        " " if c.isspace() else c
        for c in text
        if c.isspace() or unicodedata.category(c) not in ("Cc", "Cs", "Co", "Cn")
    )


def widest(lines: Sequence[str], size: float, bold: bool = False) -> float:
    """Return the width of the widest line."""
    return max((width(line, size, bold) for line in lines), default=0.0)
