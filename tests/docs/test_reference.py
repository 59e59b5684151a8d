"""The generated pages agree with the present code."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.docs.source import DOCS, module

reference = module(DOCS / "reference.py")


@pytest.mark.parametrize("page", [p.relative_to(DOCS) for p in reference.pages()], ids=str)
def test_a_generated_page_is_up_to_date(page: Path) -> None:
    made = reference.pages()[DOCS / page]
    assert (DOCS / page).read_text(encoding="utf-8") == made, (
        f"docs/{page} is not what the code says: python tools/generate.py"
    )


def test_the_reference_has_no_other_pages() -> None:
    assert set((DOCS / "reference").glob("*.md")) <= set(reference.pages())


def test_the_reference_describes_every_part_of_a_kind() -> None:
    text = reference.kind_section(reference.kinds.describe(reference.registry.kind("Field")))
    for part in (
        r"\tau \frac{du}{dt}",
        "| `tau` |",
        "at least 1e-06",
        "| live |",
        "| rebuild |",
        "| recompile |",
        "`activation`",
        "eqs. 1, 3",
    ):
        assert part in text, part
