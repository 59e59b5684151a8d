"""Packages of spiking networks are imported in `deodar_spikes` alone, inside functions."""

from __future__ import annotations

import ast

from tests.house.source import MODULES, SRC, tree

PACKAGES = {"nir", "norse", "torch", "nirtorch"}


def test_no_other_package_imports_nir() -> None:
    found = {
        path.relative_to(SRC)
        for path in MODULES
        for node in ast.walk(tree(path))
        for name in (
            [a.name for a in node.names]
            if isinstance(node, ast.Import)
            else [node.module or ""]
            if isinstance(node, ast.ImportFrom)
            else []
        )
        if name.split(".")[0] in PACKAGES
    }
    assert found and {p.parts[0] for p in found} == {"deodar_spikes"}


def test_they_are_not_needed_at_import() -> None:
    for path in (SRC / "deodar_spikes").glob("*.py"):
        top = [n for n in tree(path).body if isinstance(n, (ast.Import, ast.ImportFrom))]
        names = {a.name.split(".")[0] for n in top if isinstance(n, ast.Import) for a in n.names}
        names |= {(n.module or "").split(".")[0] for n in top if isinstance(n, ast.ImportFrom)}
        assert not names & PACKAGES, path.name
