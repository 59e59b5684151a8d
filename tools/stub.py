"""Write the list of public names, `src/deodar/__init__.pyi`.

    python tools/stub.py      also a step of tools/generate.py

It also writes the kinds of figures into the list of `src/deodar/figures/__init__.py`. The lines of kinds
follow from the registry, and those of the packages beside the engine from the entry points of deodar
(`deodar.worlds`, `deodar.names`). All other lines of the engine stay as they are.
"""

from __future__ import annotations

import ast
import importlib.metadata
import re
from collections.abc import Iterator
from pathlib import Path

import packages

from deodar import registry

ENGINE = packages.SRC / packages.ENGINE
STUB = ENGINE / "__init__.pyi"
FIGURES = ENGINE / "figures" / "__init__.py"
IMPORT = r"from deodar\.figures\.[a-z]"
ENTRY = r'    "[a-z]'
HEAD = """\
# Every public name, one line each. Editors and pyright read the names here, and so does `__init__.py`, which
# imports a name when it is first used. `python tools/generate.py` writes the lines of kinds and of the
# packages beside the engine; the others are written by hand.

"""
TAIL = "\n__version__: str\n"


def _kinds() -> Iterator[str]:
    """Yield the lines of the engine's kinds."""
    for name, cls in registry.kinds().items():
        if cls.__module__.startswith("deodar."):
            yield f"from {cls.__module__} import {name} as {name}"


def _packages() -> Iterator[str]:
    """Yield the lines of the packages beside the engine."""
    for entry in importlib.metadata.distribution("deodar").entry_points:
        if entry.group in ("deodar.worlds", "deodar.names"):
            home, attribute = (entry.module, entry.attr) if entry.attr else entry.module.rsplit(".", 1)
            yield f"from {home} import {attribute} as {entry.name}"


def _figures() -> list[str]:
    """Return the kinds of figures: the files with a function `suits` and one of the name of the file."""
    files = (path for path in FIGURES.parent.glob("[a-z]*.py"))
    return sorted(path.stem for path in files if {"suits", path.stem} <= _functions(path))


def _functions(path: Path) -> set[str]:
    return {node.name for node in packages.tree(path).body if isinstance(node, ast.FunctionDef)}


def figures(text: str) -> str:
    """Return the list of `deodar.figures`, given its present text, with every kind of figure."""
    for name in _figures():
        line = f"from deodar.figures.{name} import {name}"
        text = _with(_with(text, IMPORT, line), ENTRY, f'    "{name}",')
    return text


def _with(text: str, pattern: str, line: str) -> str:
    """Return the text with a line among those of a pattern, which are sorted."""
    lines = text.splitlines(keepends=True)
    places = [k for k, each in enumerate(lines) if re.match(pattern, each)]
    if line + "\n" not in lines:
        after = [k for k in places if lines[k] < line]
        lines.insert(after[-1] + 1 if after else places[0], line + "\n")
    return "".join(lines)


def _by_hand(text: str) -> Iterator[str]:
    """Yield the other lines of a stub: those of the engine that name no kind."""
    kinds = registry.kinds()
    for line in text.splitlines():
        words = line.split()
        if line.startswith(("from deodar ", "from deodar.")) and words[-1] not in kinds:
            yield line


def stub(text: str) -> str:
    """Return the whole stub, given its present text."""
    drawn = {f"from deodar.figures.{name} import {name} as {name}" for name in _figures()}
    lines = {*_kinds(), *_packages(), *drawn, *_by_hand(text)}
    ordered = sorted(lines, key=lambda line: (line.split()[1], line.split()[-1]))
    return HEAD + "\n".join(ordered) + "\n" + TAIL


if __name__ == "__main__":
    FIGURES.write_text(figures(FIGURES.read_text(encoding="utf-8")), encoding="utf-8")
    STUB.write_text(stub(STUB.read_text(encoding="utf-8")), encoding="utf-8")
