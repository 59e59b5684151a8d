"""A hundred silent mistakes: small documents that load, each with one mistake of a user."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from deodar.model.check import check
from deodar.model.document import Document
from deodar.model.reader import from_data
from deodar.parameters import FrozenArray

KINDS = {
    path.stem: json.loads(path.read_text(encoding="utf-8"))
    for path in sorted((Path(__file__).parent / "mistakes").glob("*.json"))
}
CASES = [
    pytest.param(case, id=f"{kind}: {case['document']['name']}")
    for kind, group in KINDS.items()
    for case in group["cases"]
]


def document(case: dict[str, Any]) -> Document:
    """Return the document of a case; its arrays are lists in the case."""
    arrays = {name: FrozenArray(values) for name, values in case.get("arrays", {}).items()}
    return from_data(case["document"], arrays)


def test_there_are_100_documents_of_at_least_40_kinds_of_mistake() -> None:
    assert len(CASES) == 100 and len(KINDS) >= 40
    assert all(1 <= len(group["cases"]) <= 5 and group["mistake"] for group in KINDS.values())
    names = {case["document"]["name"] for group in KINDS.values() for case in group["cases"]}
    assert len(names) == 100, "every document says in its name what is wrong with it"


@pytest.mark.parametrize("case", CASES)
def test_every_document_loads_and_states_the_expected_problem(case: dict[str, Any]) -> None:
    doc = document(case)
    assert case["where"] in [*(e.path for e in doc.entries), *(k.name for k in doc.parameters)]
    assert case["severity"] in ("problem", "warning") and case["words"]


@pytest.mark.parametrize("case", CASES)
def test_every_mistake_is_reported_at_its_path_with_a_fix(case: dict[str, Any]) -> None:
    problems = check(document(case))
    matching = [p for p in problems if p.where == case["where"] and p.severity == case["severity"]]
    assert any(
        all(word in f"{p.what} {p.fix}" for word in case["words"]) and (p.fix or "Give " in p.what)
        for p in matching
    ), problems


def test_the_manual_lists_every_kind_of_mistake() -> None:
    page = (Path(__file__).parents[3] / "docs" / "check.md").read_text(encoding="utf-8")
    assert [group["mistake"] for group in KINDS.values() if f"- {group['mistake']}.\n" not in page] == []
    assert page.count("\n- ") == len(KINDS)
