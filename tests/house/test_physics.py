"""Elements and couplings state equations; the compiler alone decides and names how sums are computed."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from tests.house.source import ENGINE, ROOT, at, imported

sys.path.insert(0, str(ROOT / "tools"))
from measure import OPTIMISER

FILES = [
    *sorted((ENGINE / "elements").glob("*.py")),
    *sorted((ENGINE / "couplings").glob("*.py")),
    ENGINE / "element.py",
]
ROOMS = ("compiler", "numerics.choice", "numerics.waves")
"""Modules that decide how kernels are applied."""


def _named(path: Path) -> Iterator[int]:
    """Yield the lines of a file that name or import the compiler."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if OPTIMISER.search(line):
            yield number
    yield from (line for line, name in imported(path) if name.startswith(ROOMS))


def test_elements_do_not_name_the_compiler() -> None:
    assert not [at(path, line) for path in FILES for line in _named(path)]


def test_an_import_of_the_compiler_is_found(tmp_path: Path) -> None:
    bad = tmp_path / "bad.py"
    bad.write_text("import numpy\nfrom deodar.compiler import program\nfrom deodar.numerics import choice\n")
    assert list(_named(bad)) == [2, 3]


def test_the_words_are_found_where_they_occur() -> None:
    for line in ("if not at.shared:", 'out["output" + WAVES] = y', "sharing: ClassVar[str]", "y in waves"):
        assert OPTIMISER.search(line), line
    assert not OPTIMISER.search("what shares no axis with the rest")
