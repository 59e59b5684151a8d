"""Elements and couplings state equations; the compiler alone decides and names how sums are computed."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

import pytest

from tests.house.source import ENGINE, ROOT, SRC, tree

sys.path.insert(0, str(ROOT / "tools"))
from measure import OPTIMISER

FILES = [
    *sorted((ENGINE / "elements").glob("*.py")),
    *sorted((ENGINE / "couplings").glob("*.py")),
    ENGINE / "element.py",
]
ROOMS = ("deodar.compiler", "deodar.numerics.choice", "deodar.numerics.waves")
"""Modules that decide how kernels are applied."""


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(SRC)))
def test_elements_do_not_name_the_compiler(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert not [line for line in text.splitlines() if OPTIMISER.search(line)]
    imported = [
        name
        for node in ast.walk(tree(path))
        for name in (
            [node.module or ""]
            if isinstance(node, ast.ImportFrom)
            else [alias.name for alias in node.names]
            if isinstance(node, ast.Import)
            else []
        )
    ]
    assert not [name for name in imported if name.startswith(ROOMS)]


def test_the_words_are_found_where_they_occur() -> None:
    for line in ("if not at.shared:", 'out["output" + WAVES] = y', "sharing: ClassVar[str]", "y in waves"):
        assert OPTIMISER.search(line), line
    assert not OPTIMISER.search("what shares no axis with the rest")
