"""Only figures and diagrams draw: they import matplotlib, in one style."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from deodar.diagrams import wires
from deodar.figures import _style
from tests.house.source import MODULES, at, module, tree

DIAGRAMS = {"diagrams.paper", "diagrams.shown_figure", "diagrams.text"}
"""Modules for pictures of architectures: shapes, and widths of names."""


def _for_types(path: Path) -> set[int]:
    """Return the lines under `if TYPE_CHECKING`."""
    blocks = [
        n for n in ast.walk(tree(path)) if isinstance(n, ast.If) and ast.unparse(n.test) == "TYPE_CHECKING"
    ]
    return {
        line for n in blocks for child in n.body for line in range(child.lineno, (child.end_lineno or 0) + 1)
    }


def _matplotlib(path: Path) -> list[int]:
    found = [
        node.lineno
        for node in ast.walk(tree(path))
        if (isinstance(node, ast.Import) and any(a.name.split(".")[0] == "matplotlib" for a in node.names))
        or (isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "matplotlib")
    ]
    return [line for line in found if line not in _for_types(path)]


def test_matplotlib_is_imported_where_figures_are_drawn() -> None:
    found = [
        at(path, line)
        for path in MODULES
        if not {"figure", "figures"} & set(module(path).split(".")) and module(path) not in DIAGRAMS
        for line in _matplotlib(path)
    ]
    assert not found, f"move what draws to the figures of its package: {found}"


def test_imports_of_matplotlib_are_found(tmp_path: Path) -> None:
    bad = tmp_path / "bad.py"
    bad.write_text(
        "if TYPE_CHECKING:\n    import matplotlib\nimport matplotlib.pyplot as plt\n"
        "def f():\n    from matplotlib import figure\n"
    )
    assert _matplotlib(bad) == [3, 5]


def test_colours_are_named_only_in_the_style() -> None:
    """A colour of a figure has a meaning, and a line in `Palette`."""
    allowed = {"_style.py", "animation.py"}  # the video has a palette of its own for the floor of the arena
    named = [
        at(path, n.lineno)
        for path in MODULES
        if {"figure", "figures"} & set(module(path).split(".")) and path.name not in allowed
        for n in ast.walk(tree(path))
        if isinstance(n, ast.Constant) and re.fullmatch("#[0-9a-fA-F]{6}", str(n.value))
    ]
    assert not named, named


def test_signs_have_the_colours_of_pictures_of_models() -> None:
    signs = _style.COLOR.excitation, _style.COLOR.inhibition, _style.COLOR.mixed
    assert tuple(wires.COLORS[sign] for sign in ("+", "-", "±")) == signs
