"""The packages of `src` meet the engine by entry points alone."""

from __future__ import annotations

import ast
import sys
import tomllib
from pathlib import Path

import pytest

from tests.house.source import ROOT

sys.path.insert(0, str(ROOT / "tools"))
import packages

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_no_import_points_the_wrong_way() -> None:
    assert [str(arrow) for arrow in packages.wrong_arrows()] == []


def test_the_engine_names_no_package_beside_it() -> None:
    assert packages.mentions() == []


def test_every_package_is_in_the_wheel() -> None:
    listed = PROJECT["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]
    assert listed == [f"src/{package}" for package in packages.packages()]


def test_every_package_is_typed_for_those_who_import_it() -> None:
    assert [name for name in packages.packages() if not (packages.SRC / name / "py.typed").is_file()] == []


def test_every_package_states_its_words() -> None:
    assert set(packages.WORDS) == set(packages.packages()) - {"deodar"}


@pytest.mark.parametrize(
    ("package", "target", "holds"),
    [
        ("deodar", "deodar.model.edit", True),
        ("deodar", "deodar_robots.eye", False),
        ("deodar_papers", "deodar.model.edit", True),
        ("deodar_papers", "deodar_robots.eye", True),
        ("deodar_robots", "deodar_papers.spa", False),
    ],
)
def test_an_arrow_is_judged_by_its_packages(package: str, target: str, holds: bool) -> None:
    assert packages.allowed(package, target) is holds


def test_imports_are_found_at_the_top_in_functions_and_for_types(tmp_path: Path) -> None:
    bad = tmp_path / "bad.py"
    bad.write_text(
        "from typing import TYPE_CHECKING\nfrom deodar.model import edit\nif TYPE_CHECKING:\n    from"
        " deodar.session.run import Run\ndef f():\n    import deodar.cli.check\n"
    )
    found = [(line, name) for line, name in packages.imports(bad) if name.startswith("deodar")]
    assert sorted(found) == [(2, "deodar.model.edit"), (4, "deodar.session.run"), (6, "deodar.cli.check")]


def test_names_of_packages_are_found_in_code_and_not_in_docstrings() -> None:
    code = '"""About cedar."""\nx = "cedar"\nwhy = "open it in the studio"\n'
    tree = ast.parse(code + "def f(studio): ...\nclass Cedars: ...\n")
    assert {text for _, text in packages._texts(tree)} == {"cedar", "x", "why", "studio", "f", "Cedars"}
