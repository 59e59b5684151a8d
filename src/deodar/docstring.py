"""The parser of docstrings: summary, sections, and the entries of a section.

Help, the manual, the studio, the command line and the tests read docstrings with it.
"""

from __future__ import annotations

import dataclasses as dc
import functools
import inspect
import re
from collections.abc import Mapping, Sequence

_TITLE = re.compile(r"([A-Z][A-Za-z ]*):[ ]*")
_TITLE_AND_TEXT = re.compile(r"(Equation|Parameters|Ports|Shapes|Reference):[ ]+(.+)")
_ENTRY = re.compile(r"([\w.*]+(?:, [\w.*]+)*): (.*)")


@dc.dataclass(frozen=True)
class Docstring:
    """A parsed docstring; `str` writes it again.

    Attributes:
        opening: the text before the first section.
        sections: the text of each section by its title, without indentation.
    """

    opening: str
    sections: Mapping[str, str]

    @property
    def summary(self) -> str:
        """The first paragraph in one line."""
        return _joined(self.opening.partition("\n\n")[0])

    def line(self, title: str) -> str:
        """Return a section in one line; "" without that section."""
        return _joined(self.sections.get(title, ""))

    def lines(self, title: str) -> tuple[str, ...]:
        """Return the lines of a section; an indented line continues the one before it."""
        return tuple(re.sub(r"\n +", " ", self.sections.get(title, "")).splitlines())

    def entries(self, title: str) -> dict[str, str]:
        """Return the entries `name: text` of a section, each text in one line."""
        return {name: _text(name, block) for name, block in self.blocks(title).items()}

    def blocks(self, title: str) -> dict[str, list[str]]:
        """Return the entries of a section with their line breaks: for each name its lines."""
        out: dict[str, list[str]] = {}
        for line in self.sections.get(title, "").splitlines():
            if found := _ENTRY.fullmatch(line):
                out[found[1]] = [line]
            elif line and out:
                out[next(reversed(out))].append(line)
        return out

    def __str__(self) -> str:
        sections = [
            f"{title}:\n" + "\n".join(f"    {line}" if line else "" for line in text.splitlines())
            for title, text in self.sections.items()
        ]
        return "\n\n".join([*([self.opening] if self.opening else []), *sections])


def parse(text: str) -> Docstring:
    """Parse a docstring.

    A section begins with its title and a colon, alone on a line that is not indented. The sections of a kind
    (Equation, Parameters, Ports, Shapes, Reference) may begin with text on that line.
    """
    opening: list[str] = []
    sections: dict[str, list[str]] = {}
    into = opening
    for line in inspect.cleandoc(text).splitlines():
        if found := _TITLE.fullmatch(line):
            into = sections.setdefault(found[1], [])
        elif found := _TITLE_AND_TEXT.fullmatch(line):
            into = sections.setdefault(found[1], [])
            into.append(found[2])
        else:
            into.append(line)
    return Docstring(
        "\n".join(opening).strip(),
        {title: inspect.cleandoc("\n" + "\n".join(lines)).strip() for title, lines in sections.items()},
    )


def source(cls: type) -> str:
    """Return the docstring in the source of a class, without its indentation; "" without one."""
    return inspect.cleandoc(vars(cls).get("__doc__") or "")


@functools.cache
def described(cls: type) -> Mapping[str, Sequence[str]]:
    """Return the lines of the entry of each parameter that a class or one of its bases describes; that of the
    nearest class.
    """
    read = [parse(source(base)) for base in reversed(cls.__mro__[:-1])]
    return dict(
        entry
        for each in read
        for title in ("Parameters", "Attributes")
        for entry in each.blocks(title).items()
    )


def descriptions(cls: type) -> dict[str, str]:
    """Return for each parameter that a class or one of its bases describes what it says, in one line."""
    return {name: _text(name, lines) for name, lines in described(cls).items()}


def _text(name: str, lines: Sequence[str]) -> str:
    return " ".join(line.strip() for line in lines)[len(name) + 2 :]


def _joined(text: str) -> str:
    return " ".join(text.split())
