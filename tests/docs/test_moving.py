"""The page on moving to the new layout names modules that are there in place of modules that are not."""

from __future__ import annotations

import importlib.util
import re
from collections.abc import Iterator

from tests.docs.source import DOCS

PAGE = (DOCS / "moving.md").read_text(encoding="utf-8")
IMPORTS = PAGE.partition("\n## Imports\n")[2].partition("\n## ")[0]
ROWS = [line.strip("| ").split(" | ") for line in IMPORTS.splitlines() if line.startswith("| `deodar")]


def modules(cell: str, listed: str) -> Iterator[str]:
    """Yield the modules of a cell: `.name` is a sibling of the one before, NAME each listed name."""
    parent = ""
    for name in re.findall(r"`(deodar[\w.]*|\.\w+)`", cell):
        whole = parent + name if name.startswith(".") else name
        parent = whole.rpartition(".")[0]
        names = re.findall(r"`(\w+)`", listed) if "NAME" in whole else [""]
        yield from (whole.replace("NAME", last) for last in names)


def is_there(module: str) -> bool:
    try:
        return importlib.util.find_spec(module) is not None
    except ModuleNotFoundError:
        return False


def moved() -> Iterator[tuple[list[str], list[str]]]:
    for old, new in ROWS:
        with_names = new if re.search(r"NAME`: `", new) else old
        yield list(modules(old, old)), list(modules(new, with_names))


def test_every_new_module_is_there() -> None:
    rows = list(moved())
    assert len(rows) > 90
    assert not [module for _, new in rows for module in new if not is_there(module)]


def test_no_old_module_is_there() -> None:
    assert not [module for old, _ in moved() for module in old if is_there(module)]


def test_modules_that_were_listed_one_by_one_are_as_many_as_their_new_ones() -> None:
    assert not [(old, new) for old, new in moved() if len(new) not in (1, len(old))]
