"""What the docstring of a kind says: its equation, its parameters and ports, its source.

Kinds from outside may say nothing.
"""

from __future__ import annotations

import dataclasses as dc
import inspect
import re
from collections.abc import Mapping, Sequence
from typing import Any

from deodar.part_type import source_doc

_SECTION = re.compile(r"([A-Z][a-z]+):[ ]*(.*)")
_ENTRY = re.compile(r"([\w.*]+): (.*)")


@dc.dataclass(frozen=True)
class Docstring:
    """The sections that are shown; empty where there are none.

    Attributes:
        equation: lines of TeX, each shown on a line of its own.
        reference: where the equation comes from.
        parameters: what each parameter is.
        ports: what each port carries.
    """

    equation: Sequence[str]
    reference: str
    parameters: Mapping[str, str]
    ports: Mapping[str, str]


def docstring(cls: type[Any]) -> Docstring:
    """A class's own docstring, read."""
    found = _sections(source_doc(cls))
    reference = " ".join(found.get("Reference", "").split())
    return Docstring(
        equation=_lines(found.get("Equation", "")),
        reference="" if reference == "no reference" else reference,
        parameters=_entries(found.get("Parameters", "")),
        ports=_entries(found.get("Ports", "")),
    )


def _sections(text: str) -> dict[str, str]:
    """Sections by title; what stands before the first is under ""."""
    out: dict[str, list[str]] = {"": []}
    title = ""
    for line in inspect.cleandoc(text).splitlines():
        found = _SECTION.fullmatch(line)
        if found:
            title = found[1]
            out[title] = [found[2]]
        else:
            out[title].append(line)
    return {title: inspect.cleandoc("\n" + "\n".join(lines)).strip() for title, lines in out.items()}


def _lines(text: str) -> tuple[str, ...]:
    """The lines of an equation; a line that is indented continues the one before it."""
    return tuple(re.sub(r"\n +", " ", text).splitlines())


def _entries(text: str) -> dict[str, str]:
    """`name: what it is`, with the lines that go on below it."""
    out: dict[str, str] = {}
    name = ""
    for line in text.splitlines():
        found = _ENTRY.fullmatch(line)
        if found:
            name = found[1]
            out[name] = found[2]
        elif name:
            out[name] += " " + line.strip()
    return out
