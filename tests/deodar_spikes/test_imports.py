"""Packages of spiking networks are imported in `deodar_spikes` alone, inside functions."""

from __future__ import annotations

import ast
from pathlib import Path

from tests.house.source import MODULES, SRC, tree

PACKAGES = {"nir", "norse", "torch", "nirtorch"}


def _imported(path: Path, inside_functions: bool) -> set[str]:
    """Return the packages of spiking networks that a module imports."""
    nodes = ast.walk(tree(path)) if inside_functions else tree(path).body
    names: set[str] = set()
    for node in nodes:
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add(node.module or "")
    return {name.split(".")[0] for name in names} & PACKAGES


def test_no_other_package_imports_nir() -> None:
    found = {path.relative_to(SRC).parts[0] for path in MODULES if _imported(path, inside_functions=True)}
    assert found == {"deodar_spikes"}


def test_they_are_not_needed_at_import() -> None:
    """But by the program of the process that runs norse, which nothing imports."""
    top = {path.name for path in MODULES if _imported(path, inside_functions=False)}
    assert top <= {"norse_process.py"}
