"""Imports point one way: a module may import modules of an earlier floor, or of its own folder."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from tests.house.source import ENGINE, MODULES, at, imported, module, packages, tree

# The floors of ARCHITECTURE.md, from the lowest. Packages of one floor do not import each other; a file may
# import its own folder. `registry` is below `parameters`, which looks up kinds in it; `recording` is below
# `session`, whose runs it labels; the root package resolves its names lazily and is above all, like
# `__main__`.
FLOORS: tuple[frozenset[str], ...] = tuple(
    frozenset(floor.split())
    for floor in (
        "short_traceback summary",
        "proposed_edit synonyms similar",
        "errors",
        "plugins docstring declarations file_version",
        "names registry extensions part_type family codec",
        "credentials sealed npz regular_file private_file kind_errors",
        "parameters guarded user_key",
        "leaves part_data",
        "numerics",
        "element",
        "elements couplings worlds",
        "diagrams",
        "model",
        "kinds last_error",
        "compiler",
        "cores cluster precision progress sweep",
        "resources",
        "recording",
        "session",
        "gradients",
        "batch",
        "analysis",
        "experiments",
        "importers architectures kind_rules",
        "exporters",
        "figures",
        "packing",
        "cli",
        "__main__",
    )
)


def _floor(name: str) -> int:
    room = name.split(".")[0]
    for level, rooms in enumerate(FLOORS):
        if room in rooms:
            return level
    raise AssertionError(f"deodar.{room} has no floor: name it in FLOORS")


def _wrong(path: Path, name: str) -> Iterator[tuple[int, str]]:
    """Yield line and module of each import of another folder that is on no earlier floor.

    The root is no floor: it imports nothing when it is imported.
    """
    for line, other in imported(path):
        if not other or other.startswith("deodar_") or other.split(".")[0] == name.split(".")[0]:
            continue
        if _floor(other) >= _floor(name):
            yield line, other


def test_imports_follow_the_levels_of_packages() -> None:
    """`tools/packages.py` compares the imports of packages beside the engine."""
    wrong = [
        f"{at(path, line)} imports deodar.{other}"
        for path in packages.modules("deodar")
        if module(path)
        for line, other in _wrong(path, module(path))
    ]
    assert not wrong, wrong


def test_every_package_has_a_level_and_every_level_exists() -> None:
    rooms = {module(p).split(".")[0] for p in packages.modules("deodar")} - {""}
    for room in rooms:
        _floor(room)
    assert {
        "errors",
        "parameters",
        "registry",
        "numerics",
        "element",
        "elements",
        "couplings",
        "worlds",
        "model",
        "cli",
    } <= rooms


def test_the_root_package_imports_no_other_package_at_import() -> None:
    top = tree(ENGINE / "__init__.py")
    names = [n for n in top.body if isinstance(n, (ast.Import, ast.ImportFrom))]
    assert not [n for n in names if isinstance(n, ast.ImportFrom) and (n.module or "").startswith("deodar")]


def test_one_place_asks_for_programs() -> None:
    """Sessions, records, trials and gradients have the programs of `Dynamics.compiled`."""
    calls = {
        module(path)
        for path in MODULES
        if module(path) != "compiler.executable"  # where it is declared
        for n in ast.walk(tree(path))
        if isinstance(n, ast.Call)
        and "executable" in (getattr(n.func, "id", ""), getattr(n.func, "attr", ""))
    }
    assert calls == {"compiler.dynamics"}


def test_forbidden_imports_are_found(tmp_path: Path) -> None:
    """The reader finds imports at the top, inside functions, and for types only."""
    bad = tmp_path / "bad.py"
    bad.write_text(
        "from typing import TYPE_CHECKING\nfrom deodar.model import edit\nif TYPE_CHECKING:\n    from"
        " deodar.session.run import Run\ndef f():\n    import deodar.cli.check\n    from deodar.errors import"
        " DeodarError\n"
    )
    assert sorted(imported(bad)) == [(2, "model.edit"), (4, "session.run"), (6, "cli.check"), (7, "errors")]
    assert list(_wrong(bad, "session.seeds")) == [(6, "cli.check")]
    assert [line for line, _ in _wrong(bad, "model.check")] == [4, 6]
