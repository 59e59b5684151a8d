"""The lists of features, pages and terms are complete and name nothing else."""

from __future__ import annotations

import inspect
import re
import tomllib

import pytest

import deodar as dd
from deodar import cli, registry
from deodar.importers.tools import IMPORTERS
from deodar_papers import papers
from tests.docs.source import DOCS, ROOT

NAV = re.findall(r": ([\w/-]+\.md)$", (ROOT / "mkdocs.yml").read_text(encoding="utf-8"), re.MULTILINE)
README = (ROOT / "README.md").read_text(encoding="utf-8")
GLOSSARY = (DOCS / "glossary.md").read_text(encoding="utf-8")
ENTRIES = re.findall(r"^## (.*)$", GLOSSARY, re.MULTILINE)
TERMS: list[str] = tomllib.loads((DOCS / "words.toml").read_text(encoding="utf-8"))["terms"]


def _models() -> list[str]:
    """Return the functions of `dd.architectures` that return a whole model."""
    functions = ((name, getattr(dd.architectures, name)) for name in dd.architectures.__all__)
    return sorted(
        name
        for name, function in functions
        if inspect.isfunction(function)
        and inspect.signature(function).return_annotation in ("Model", dd.Model)
    )


LISTS = {
    "Elements": sorted(registry.kinds("elements")),
    "Couplings": sorted(registry.kinds("couplings")),
    "Interaction kernels": sorted(registry.kinds("numerics.kernels")),
    "Sigmoids": sorted(registry.kinds("numerics.sigmoids")),
    "Worlds": sorted(registry.kinds("worlds")),
    "Published models": _models(),
    "Reproduced papers": list(papers.PAPERS.first_party()),
    "Importers": list(IMPORTERS.first_party()),
    "Commands": list(cli.COMMANDS.first_party()),
}
"""The rows of the table of features in README.md, and the existing names."""


def listed(text: str, row: str) -> list[str]:
    """Return the names in code of a row of a table."""
    found = re.search(rf"^\| {row} \|(.*)\|$", text, re.MULTILINE)
    return re.findall(r"`([^`]+)`", found[1]) if found else []


@pytest.mark.parametrize("row", LISTS)
def test_the_readme_lists_what_exists(row: str) -> None:
    names = ", ".join(f"`{name}`" for name in LISTS[row])
    assert listed(README, row) == LISTS[row], f"write the row of README.md:\n| {row} | {names} |"


def test_a_list_that_leaves_a_name_out_is_noticed() -> None:
    text = README.replace("`MemoryTrace`, ", "")
    assert listed(text, "Elements") != LISTS["Elements"]


@pytest.mark.parametrize(("page", "prefix"), [("README.md", "docs/"), ("docs/index.md", "")])
def test_the_first_pages_link_every_page_of_the_manual(page: str, prefix: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    missing = [
        name for name in NAV if f"]({prefix}{name})" not in text and name != page.removeprefix("docs/")
    ]
    assert NAV and not missing, f"{page} has no link to {missing}"


def test_the_entries_of_the_glossary_are_in_alphabetical_order() -> None:
    assert sorted(ENTRIES, key=str.lower) == ENTRIES


@pytest.mark.parametrize("term", TERMS)
def test_the_glossary_explains_every_term_of_the_manual(term: str) -> None:
    assert term.lower() in {entry.lower() for entry in ENTRIES}, f"docs/glossary.md has no entry '{term}'"
