"""Write the entry points of the packages beside the engine into `pyproject.toml`, from their folders.

    python tools/entry_points.py      also a step of tools/generate.py

In each package `src/deodar_*` a file or folder of `commands`, `exporters` or `importers` is a member of the
group of that name; a folder whose `__init__.py` has a function `jobs` is a paper; a class with `@register` is
a world. A member is named as its file, with `-` in place of `_`, and a world as its class. Names that begin
with an underscore are no members. The groups `deodar.groups` and `deodar.names` are written by hand.

If the entry points changed, deodar is installed again into the running Python: installed metadata lists them.
"""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import packages

FILE = packages.ROOT / "pyproject.toml"
FOLDERS = ("commands", "exporters", "importers")
GROUPS = (*FOLDERS, "papers", "worlds")
TABLE = r'(?m)^(\[project\.entry-points\."deodar\.{}"\]\n)((?:\S.*\n)*)'


def entry_points() -> dict[str, dict[str, str]]:
    """Return, for each group, the value of the entry point of each name."""
    found: dict[str, dict[str, str]] = {group: {} for group in GROUPS}
    for package in packages.packages():
        if package != packages.ENGINE:
            for group, name, value in _members(package):
                found[group][name] = value
    return found


def _members(package: str) -> Iterator[tuple[str, str, str]]:
    """Yield group, name and value of the entry points of a package."""
    for path in packages.modules(package):
        module = packages.dotted(path)
        _, *inside = module.split(".")
        last = inside[-1] if inside else ""
        if len(inside) == 2 and inside[0] in FOLDERS and not last.startswith("_"):
            yield inside[0], _name(last), module
        elif len(inside) == 1 and path.name == "__init__.py" and _has_jobs(path):
            yield "papers", _name(last), module
        for world in _registered(path):
            yield "worlds", world, f"{module}:{world}"


def _name(stem: str) -> str:
    return stem.rstrip("_").replace("_", "-")


def _has_jobs(path: Path) -> bool:
    return any(isinstance(node, ast.FunctionDef) and node.name == "jobs" for node in packages.tree(path).body)


def _registered(path: Path) -> Iterator[str]:
    """Yield the names of the classes with the decorator `register`."""
    for node in packages.tree(path).body:
        if isinstance(node, ast.ClassDef) and "register" in map(ast.unparse, node.decorator_list):
            yield node.name


def filled(text: str) -> str:
    """Return the text of `pyproject.toml` with the entry points of the folders."""
    for group, members in entry_points().items():
        lines = "".join(f'{name} = "{value}"\n' for name, value in sorted(members.items()))
        text = re.sub(TABLE.format(group), lambda table, lines=lines: table[1] + lines, text)
    return text


def main() -> int:
    """Write the file, and install deodar again if its entry points changed; return the status."""
    text = FILE.read_text(encoding="utf-8")
    if filled(text) == text:
        return 0
    FILE.write_text(filled(text), encoding="utf-8", newline="\n")
    # the page of the studio does not depend on entry points
    environment = os.environ | {"DEODAR_NO_PAGE": "1"}
    command = [sys.executable, "-m", "pip", "install", "-q", "--no-deps", "-e", str(packages.ROOT)]
    return subprocess.run(command, env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
