"""Documents name the packages that they need; opening one reports a missing package."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import deodar as dd
from deodar import registry
from deodar.cli import main
from deodar.errors import DocumentError
from tests.plugins.conftest import Install

NEEDS = {
    "deodar": 3,
    "elements": {"d": {"kind": "Detector", "tau": 3}},
    "packages": {"Detector": "deodar-detector 1.2"},
}

KIND = """
from dataclasses import dataclass
import deodar as dd

@dd.register
@dataclass(frozen=True)
class Detector(dd.Coupling):
    pass
"""


def _write(path: Path, data: object) -> Path:
    path.write_text(json.dumps(data))
    return path


@pytest.mark.usefixtures("example")
@pytest.mark.parametrize("imported", [False, True], ids=["by its name", "from its module"])
def test_a_document_names_package_and_version_of_its_kinds_and_opens_again(
    imported: bool, tmp_path: Path
) -> None:
    if imported:
        from deodar_change.change import Change  # pyright: ignore[reportMissingImports]
    else:
        Change = registry.kind("Change")
    model = dd.Model("m")
    model.add(dd.Boost("b")) >> model.add(Change("c", tau=30))
    dd.save(model, tmp_path / "m.json")
    assert json.loads((tmp_path / "m.json").read_text())["packages"] == {"Change": "deodar-change 0.1.0"}
    assert dd.load(tmp_path / "m.json").document == model.document


def test_a_document_without_kinds_of_packages_names_no_package(tmp_path: Path) -> None:
    model = dd.Model("m")
    model.add(dd.Boost("b"))
    dd.save(model, tmp_path / "m.json")
    assert "packages" not in json.loads((tmp_path / "m.json").read_text())


def test_a_missing_package_is_the_first_problem_and_a_line_of_doctor(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = _write(tmp_path / "m.json", NEEDS)
    with pytest.raises(DocumentError) as caught:
        dd.load(path)
    first, second = caught.value.problems
    assert first.where == f"{path}: packages.Detector"
    assert first.what == "Detector is of the package deodar-detector 1.2, which is not installed"
    assert first.fix == "If you trust it, type: pip install deodar-detector==1.2"
    assert second.where == f"{path}: d"
    assert main(["doctor", str(path), "example:selection"]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("document")]
    assert lines == [
        f"document   {path}: PROBLEM: {first.what}. {first.fix}",
        "document   example:selection: opens",
    ]


def test_a_document_that_does_not_open_names_the_other_version(install: Install, tmp_path: Path) -> None:
    install(
        "deodar-detector",
        {"detector": KIND},
        {"deodar.kinds": {"Detector": "detector:Detector"}},
        version="2.0",
    )
    with pytest.raises(DocumentError) as caught:
        dd.load(_write(tmp_path / "m.json", NEEDS))
    assert [p.what for p in caught.value.problems] == [
        "was saved with deodar-detector 1.2; Detector is of deodar-detector 2.0 now",
        "Detector has no such parameter",
    ]


@pytest.mark.parametrize("package", [3, "deodar-detector", "x; rm -rf / 1.0", "-r evil.txt 1"])
def test_an_invalid_entry_of_packages_is_a_problem(package: object, tmp_path: Path) -> None:
    path = _write(tmp_path / "m.json", {"deodar": 3, "elements": {}, "packages": {"Detector": package}})
    with pytest.raises(DocumentError, match="needs a package and its version"):
        dd.load(path)
