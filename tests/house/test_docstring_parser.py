"""The parser of docstrings: summary, sections and entries; no other module parses docstrings."""

from __future__ import annotations

import re
from pathlib import Path

from deodar import docstring
from tests.house.source import ROOT, SRC

TEXT = r"""
    A coupling in
    two lines.

    Further text: with a colon.

    Equation:
        y = a
            + b
        z = c

    Parameters:
        b: second
            and more.
        a: first: with a colon.
        c, d: two together.

    Class attributes:
        short: one line.

    Reference: no reference
    """


def test_sections_are_split_at_their_titles() -> None:
    read = docstring.parse(TEXT)
    assert read.summary == "A coupling in two lines."
    assert read.opening == "A coupling in\ntwo lines.\n\nFurther text: with a colon."
    assert list(read.sections) == ["Equation", "Parameters", "Class attributes", "Reference"]
    assert read.line("Reference") == "no reference"
    assert read.line("Ports") == "" and read.lines("Ports") == () and read.entries("Ports") == {}


def test_an_indented_line_continues_the_one_before_it() -> None:
    read = docstring.parse(TEXT)
    assert read.lines("Equation") == ("y = a + b", "z = c")
    assert read.entries("Parameters") == {
        "b": "second and more.",
        "a": "first: with a colon.",
        "c, d": "two together.",
    }
    assert read.blocks("Parameters")["b"] == ["b: second", "    and more."]


def test_a_parsed_docstring_is_written_as_it_was() -> None:
    text = str(docstring.parse(TEXT))
    assert docstring.parse(text) == docstring.parse(TEXT)
    assert text.endswith("\n\nReference:\n    no reference")


def test_an_empty_docstring_has_no_sections() -> None:
    assert docstring.parse("") == docstring.Docstring("", {})
    assert docstring.parse("").summary == "" and str(docstring.parse("")) == ""


def test_the_docstring_of_the_source_is_read_not_that_of_a_base_class() -> None:
    class Base:
        """A base."""

    class Silent(Base):
        pass

    assert docstring.source(Base) == "A base." and docstring.source(Silent) == ""


PATTERN = re.compile(r"""(?x) \b(?:compile|match|fullmatch|search|findall|split)\( \s* r?["'] [^"'\n]*
    (?: \(\[A-Z\]\[ | \\w[^"'\n]{0,6}\)?:\s | (?:Parameters|Equation|Args|Attributes|Ports): )""")
"""A regular expression that splits a docstring into sections or entries."""


def test_no_other_file_parses_docstrings() -> None:
    files = [
        p
        for folder in (SRC, ROOT / "docs", ROOT / "tests")
        for p in folder.rglob("*.py")
        if p != Path(__file__)
    ]
    found = [p.relative_to(ROOT).as_posix() for p in files if PATTERN.search(p.read_text(encoding="utf-8"))]
    assert found == ["src/deodar/docstring.py"]


def test_another_parser_of_docstrings_is_found() -> None:
    assert PATTERN.search('HEAD = re.compile(r"^([A-Z][A-Za-z ]*):\\s*$")')
    assert PATTERN.search('found = re.match(r"^(\\w+): (.*)$", line)')
