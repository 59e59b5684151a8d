"""The manual leaves nothing out: every kind and every command has a heading of its own."""

from __future__ import annotations

import re

import pytest

from deodar import cli, registry
from tests.house.source import ROOT

HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*\s*$", re.MULTILINE)


def _headings() -> set[str]:
    """Words of all headings of the manual, without the marks of code."""
    found: set[str] = set()
    for page in (ROOT / "docs").rglob("*.md"):
        for heading in HEADING.findall(page.read_text(encoding="utf-8")):
            text = re.sub(r"\{[^}]*\}", "", heading).replace("`", "").strip()
            found |= {text, text.removeprefix("deodar ")}
    return found


@pytest.mark.parametrize("kind", [name for room in registry.ROOMS for name in registry.kinds(room)])
def test_every_kind_has_a_heading(kind: str) -> None:
    assert kind in _headings(), f"no page under docs/ has the heading {kind}: build the reference anew"


@pytest.mark.parametrize("command", cli.commands())
def test_every_command_has_a_heading(command: str) -> None:
    assert command in _headings(), f"no page under docs/ has the heading deodar {command}: build the reference anew"
