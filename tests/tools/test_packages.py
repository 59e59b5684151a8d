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
    names = [(line, name) for line, name in packages.imports(bad) if name.startswith("deodar")]
    assert sorted(names) == [(2, "deodar.model.edit"), (4, "deodar.session.run"), (6, "deodar.cli.check")]


def test_names_of_packages_are_found_in_code_and_not_in_docstrings() -> None:
    code = '"""About cedar."""\nx = "cedar"\nwhy = "open it in the studio"\n'
    tree = ast.parse(code + "def f(studio): ...\nclass Cedars: ...\n")
    assert {text for _, text in packages._texts(tree)} == {"cedar", "x", "why", "studio", "f", "Cedars"}


def test_a_module_name_has_one_meaning_inside_a_package() -> None:
    assert packages.ambiguous_names() == []


@pytest.mark.parametrize(
    "names",
    [
        ["deodar/compiler/axes", "deodar/numerics/axes"],
        ["deodar/batch", "deodar/compiler/batch"],
        ["deodar/architectures/plan", "deodar/cli/plan", "deodar/compiler/plan"],
        ["deodar/compiler/gain", "deodar/couplings/gain"],
        ["deodar/worlds/arena/camera", "deodar/worlds/camera"],
        ["deodar_interop/exporters/cosivina/layout", "deodar_interop/importers/cedar/layout"],
    ],
    ids=lambda names: names[0],
)
def test_two_unrelated_modules_of_one_name_are_found(names: list[str]) -> None:
    assert packages.ambiguous({"name": names}) == {"name": names}


@pytest.mark.parametrize(
    "names",
    [
        ["deodar/numerics/axes"],
        ["deodar/cli/plan", "deodar/compiler/plan", "deodar/figures/plan"],
        ["deodar/model/checks/kernels", "deodar/numerics/kernels"],
        ["deodar_interop/importers/cedar/translate", "deodar_interop/importers/cosivina/translate"],
        ["deodar_interop/exporters/cosivina/classes/fields", "deodar_interop/importers/cedar/classes/fields"],
        ["deodar_papers/commands/demo", "deodar_papers/looking/demo", "deodar_papers/spa/demo"],
    ],
    ids=lambda names: names[0],
)
def test_siblings_of_one_role_and_modules_of_one_subject_share_a_name(names: list[str]) -> None:
    assert packages.ambiguous({"name": names}) == {}


def test_places_count_folders_and_leave_out_the_file_that_a_folder_is_named_after() -> None:
    robots = packages.places("deodar_robots")
    assert robots["eye"] == ["deodar_robots/eye"]
    assert robots["event_camera"] == ["deodar_robots/eye/event_camera"]
    assert not {"__init__", "deodar_robots"} & set(robots)


def test_every_role_and_every_subject_is_that_of_some_module() -> None:
    places = [
        p for package in packages.packages() for names in packages.places(package).values() for p in names
    ]
    patterns = [*(p for patterns in packages.ROLES.values() for p in patterns), *packages.SUBJECTS]
    assert [p for p in patterns if not any(packages.matches(place, p) for place in places)] == []


def test_every_role_is_that_of_modules_of_one_name() -> None:
    shared = [names for package in packages.packages() for names in packages.places(package).values()]
    for role, patterns in packages.ROLES.items():
        having = [
            [p for p in names if any(packages.matches(p, form) for form in patterns)] for names in shared
        ]
        assert max(map(len, having)) > 1, role


def test_the_exit_status_is_1_if_a_name_has_several_meanings(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    names = ["deodar/batch", "deodar/compiler/batch"]
    monkeypatch.setattr(packages, "places", lambda package: {"batch": names} if package == "deodar" else {})
    assert packages.main([]) == 1
    assert "1 module names with several meanings\n  batch: deodar/batch, deodar/c" in capsys.readouterr().out
