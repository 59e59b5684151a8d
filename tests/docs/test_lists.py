"""The lists of pages and terms are complete and name nothing else."""

from __future__ import annotations

import re
import tomllib

from tests.docs.source import DOCS, ROOT

NAV = re.findall(r": ([\w/-]+\.md)$", (ROOT / "mkdocs.yml").read_text(encoding="utf-8"), re.MULTILINE)
GLOSSARY = (DOCS / "glossary.md").read_text(encoding="utf-8")
ENTRIES = re.findall(r"^## (.*)$", GLOSSARY, re.MULTILINE)
TERMS: list[str] = tomllib.loads((DOCS / "words.toml").read_text(encoding="utf-8"))["terms"]


def test_the_first_page_links_every_page_of_the_manual() -> None:
    text = (DOCS / "index.md").read_text(encoding="utf-8")
    missing = [name for name in NAV if f"]({name})" not in text and name != "index.md"]
    assert NAV and not missing, f"docs/index.md has no link to {missing}"


def test_the_entries_of_the_glossary_are_in_alphabetical_order() -> None:
    assert sorted(ENTRIES, key=str.lower) == ENTRIES


def test_the_glossary_explains_every_term_of_the_manual() -> None:
    entries = {entry.lower() for entry in ENTRIES}
    missing = [term for term in TERMS if term.lower() not in entries]
    assert TERMS and not missing, f"docs/glossary.md has no entries {missing}"
