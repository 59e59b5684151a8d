"""The manual is complete: every kind and every command has a heading of its own."""

from __future__ import annotations

import re
import sys

import pytest

import deodar
from deodar import cli, registry
from tests.house.source import ROOT, SRC

sys.path.insert(0, str(ROOT / "tools"))
from measure import DEEP

MOST_DEEP = 5
"""Number of distinct lines in the scripts of the manual that import from deodar in another way than
`import deodar as dd`.
"""
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*\s*$", re.MULTILINE)


def _headings() -> set[str]:
    """Return the words of all headings of the manual, without the marks of code."""
    found: set[str] = set()
    for page in (ROOT / "docs").rglob("*.md"):
        for heading in HEADING.findall(page.read_text(encoding="utf-8")):
            text = re.sub(r"\{[^}]*\}", "", heading).replace("`", "").strip()
            found |= {text, text.removeprefix("deodar ")}
    return found


def test_every_kind_and_every_command_has_a_heading() -> None:
    kinds = {name for room in registry.ROOMS for name in registry.kinds(room)}
    commands = set(cli.COMMANDS.first_party())
    missing = (kinds | commands) - _headings()
    assert kinds and commands and not missing, (
        f"no page has these headings: python tools/generate.py: {missing}"
    )


def test_every_public_name_is_in_the_reference() -> None:
    text = "\n".join(page.read_text(encoding="utf-8") for page in (ROOT / "docs/reference").glob("*.md"))
    matches = re.findall(r"^## dd\.(\w+)$|^`dd\.(\w+)`$|^\| `dd\.(\w+)` \|", text, re.MULTILINE)
    named = {name for names in matches for name in names}
    public = {n for n in deodar.__all__ if not isinstance(getattr(deodar, n), type(re))}
    assert not public - named, f"name it in docs/reference.py: {public - named}"


def test_the_manual_and_the_examples_use_the_flat_names() -> None:
    docs, examples = ROOT / "docs", ROOT / "examples"
    pages = [
        ROOT / "README.md",
        *docs.rglob("*.md"),
        *docs.rglob("*.ipynb"),
        *examples.rglob("*.py"),
        *examples.rglob("*.ipynb"),
    ]
    docstrings = [
        "\n".join(re.findall(r"^\s*(?:>>>|\.\.\.) .*$", p.read_text(encoding="utf-8"), re.MULTILINE))
        for p in SRC.rglob("*.py")
    ]
    read = {
        line.strip()
        for text in [*(p.read_text(encoding="utf-8") for p in pages), *docstrings]
        for line in DEEP.findall(text)
    }
    made = {
        line.strip() for page in docs.glob("*.py") for line in DEEP.findall(page.read_text(encoding="utf-8"))
    }
    assert not read, "the manual, the examples and docstrings use `import deodar as dd`"
    assert len(made) <= MOST_DEEP, f"scripts that make the manual import from deep modules: {made}"


@pytest.mark.parametrize(
    "line",
    [
        "from deodar.elements.field import Field",
        "    >>> from deodar import registry",
        "import deodar.model.edit as edit",
    ],
)
def test_deep_imports_are_found(line: str) -> None:
    assert DEEP.findall(f"import deodar as dd\n{line}  # a comment\n")
