"""The prose of the manual, the code and the studio contains no phrase that `docs/words.toml` forbids."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.house import language
from tests.house.source import ROOT

WORDS = language.words()


def test_no_part_holds_more_phrases_than_known() -> None:
    now, known = language.counts(), language.KNOWN
    sys.stdout.write(f"{sum(now.values())} phrases left: {now}\n")
    more = {part for part, number in now.items() if number > known.get(part, 0)}
    moved = {part for part in more if part.startswith("src/")}
    if sum(now[p] for p in now if p.startswith("src/")) <= sum(
        known[p] for p in known if p.startswith("src/")
    ):
        more -= moved  # a file that moved to another package changes the counts of both
    hits = [str(hit) for hit in language.found() if language.part(hit.path) in more]
    assert not more, "\n".join([f"more phrases than docs/words.toml knows in {sorted(more)}:", *hits])


def test_the_manual_holds_no_phrase_of_the_list() -> None:
    manual = {p for p in language.KNOWN if p.startswith("docs/") or p in {"README.md", "CONTRIBUTING.md"}}
    assert not manual, "pages are revised: they need no number in docs/words.toml"


def test_the_numbers_name_parts_that_exist() -> None:
    parts = {language.part(path) for path in language.checked()}
    assert set(language.KNOWN) <= parts


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("page.md", "The model goes\non."),
        ("module.py", '"""One more.\n\nA run goes\non here."""\n'),
        ("module.py", "x = 1  # it Goes on\n"),
        ("module.py", "raise ValueError('it goes on')\n"),
        ("page.ts", "// it goes on\n"),
        ("page.tsx", "<p>It goes on</p>"),
        ("page.ts", "const text = `it goes on`;\n"),
        ("page.css", "/* it goes on */\n"),
        ("CHANGELOG.md", "# Changelog\n\n## [Unreleased]\n\n- It goes on.\n\n## [0.1.0]\n"),
    ],
)
def test_a_phrase_is_found_in_prose(name: str, text: str) -> None:
    [hit] = language.search(ROOT / name, text, WORDS)
    assert (hit.word.wrong, hit.word.right) == ("goes on", "continues, is resumed")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("page.md", "```python\ngoes on\n```\n"),
        ("page.md", "`goes on` and [a link](goes-on.md)"),
        ("page.md", "It foregoes on purpose; cargoes onward."),
        ("module.py", "goes = on\nif goes in goes: on\n"),
        ("module.py", "old = 'model.document.knobs'\n"),
        ("page.css", ".goes on {}\n"),
        ("CHANGELOG.md", "# Changelog\n\n## [Unreleased]\n\n- New.\n\n## [0.1.0]\n\n- It goes on.\n"),
    ],
)
def test_code_and_other_words_are_not_prose(name: str, text: str) -> None:
    assert not list(language.search(ROOT / name, text, WORDS))


def test_a_phrase_is_reported_with_its_line() -> None:
    hits = list(language.search(ROOT / "page.md", "One\ntwo goes\non.\n", WORDS))
    assert [hit.line for hit in hits] == [2]
    assert str(hits[0]) == "page.md:2: 'goes on': write continues, is resumed"


def test_every_phrase_is_lower_case_and_listed_once() -> None:
    phrases = [word.wrong for word in WORDS]
    assert len(set(phrases)) == len(phrases)
    assert all(phrase == " ".join(phrase.lower().split()) for phrase in phrases)


def test_every_part_of_the_prose_is_checked() -> None:
    parts = {language.part(path) for path in language.checked()}
    packages = {f"src/deodar/{p.parent.name}" for p in (ROOT / "src" / "deodar").glob("*/__init__.py")}
    assert packages | {"README.md", "CHANGELOG.md", "docs/index.md", "examples", "studio"} <= parts
    assert not any(Path(part).parts[:2] == ("docs", "reference") for part in parts)
