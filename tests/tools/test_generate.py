"""The entry points follow from the folders, and one command writes every generated file."""

from __future__ import annotations

import importlib.metadata
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.house.source import ROOT

sys.path.insert(0, str(ROOT / "tools"))
import entry_points
import generate
import own_plots
import packages

SAY = "type: python tools/generate.py"


def test_the_entry_points_are_up_to_date() -> None:
    text = entry_points.FILE.read_text(encoding="utf-8")
    assert entry_points.filled(text) == text, SAY


def test_the_installed_entry_points_are_those_of_the_project() -> None:
    project = tomllib.loads(entry_points.FILE.read_text(encoding="utf-8"))["project"]
    listed = {(g, name, value) for g, rows in project["entry-points"].items() for name, value in rows.items()}
    installed = importlib.metadata.distribution("deodar").entry_points
    found = {(e.group, e.name, e.value) for e in installed if e.group != "console_scripts"}
    assert found == listed, "type: python -m pip install --no-deps -e ."


def test_the_names_of_the_plots_of_the_page_are_up_to_date() -> None:
    assert own_plots.FILE.read_text(encoding="utf-8") == own_plots.names(), SAY
    assert "course" in own_plots.names().split()


@pytest.fixture
def source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package beside the engine with a file of each group, and the engine with files of the same names."""
    for package in ("deodar", "deodar_beside"):
        for name, text in {
            "__init__.py": "",
            "commands/__init__.py": "",
            "commands/look_at_.py": "HELP = 'look'",
            "commands/_shared.py": "",
            "exporters/__init__.py": "",
            "exporters/sheet/__init__.py": "NAME = 'sheet'",
            "exporters/sheet/cells.py": "",
            "green_trees/__init__.py": "def jobs(quick): ...",
            "green_trees/trials.py": "def jobs(quick): ...",
            "pond/__init__.py": "",
            "pond/pond.py": "@register\nclass Pond(World): ...\n@MESSAGES.register\nclass Wet: ...\n",
        }.items():
            path = tmp_path / package / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
    monkeypatch.setattr(packages, "SRC", tmp_path)
    return tmp_path


def test_the_members_of_a_package_are_found_by_folder_and_those_of_the_engine_are_left_out(
    source: Path,
) -> None:
    assert entry_points.entry_points() == {
        "commands": {"look-at": "deodar_beside.commands.look_at_"},
        "exporters": {"sheet": "deodar_beside.exporters.sheet"},
        "importers": {},
        "papers": {"green-trees": "deodar_beside.green_trees"},
        "worlds": {"Pond": "deodar_beside.pond.pond:Pond"},
    }


def test_tables_are_replaced_and_other_lines_stay(source: Path) -> None:
    text = (
        '[project.entry-points."deodar.names"]\ngone = "deodar_gone"\n\n'
        '[project.entry-points."deodar.papers"]\nold = "deodar_old"\n\n[tool.x]\na = 1\n'
    )
    assert entry_points.filled(text) == text.replace(
        'old = "deodar_old"', 'green-trees = "deodar_beside.green_trees"'
    )


def test_deodar_is_installed_again_only_if_its_entry_points_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    called: list[list[str]] = []

    def run(command: list[str], **options: object) -> subprocess.CompletedProcess[str]:
        called.append(command)
        return subprocess.CompletedProcess(command, 0)

    file = tmp_path / "pyproject.toml"
    text = entry_points.FILE.read_text(encoding="utf-8")
    file.write_text(text.replace('spa = "deodar_papers.spa"\n', ""), encoding="utf-8")
    monkeypatch.setattr(entry_points, "FILE", file)
    monkeypatch.setattr(subprocess, "run", run)
    assert entry_points.main() == 0 and len(called) == 1 and "install" in called[0]
    assert file.read_text(encoding="utf-8") == text
    assert entry_points.main() == 0 and len(called) == 1


def test_every_step_exists_and_writes_files_that_exist() -> None:
    for command, patterns in generate.STEPS.items():
        file = (
            ROOT / "src" / f"{command[1].replace('.', '/')}.py" if command[0] == "-m" else ROOT / command[0]
        )
        assert file.is_file(), command
        for pattern in patterns:
            assert list(ROOT.glob(pattern)), pattern


def test_changed_files_are_printed_and_a_failure_ends_the_steps(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "same.txt").write_text("1")
    (tmp_path / "other.txt").write_text("1")
    write = "import pathlib; pathlib.Path('{}').write_text('{}')".format
    steps = {
        ("-c", write("same.txt", 1)): ["same.txt"],
        ("-c", write("other.txt", 2)): ["other.txt"],
        ("-c", write("new.txt", 1)): ["new.*"],
    }
    monkeypatch.setattr(generate, "ROOT", tmp_path)
    monkeypatch.setattr(generate, "STEPS", steps)
    assert generate.main() == 0
    assert capsys.readouterr().out.splitlines() == ["new.txt", "other.txt", "2 files changed"]
    monkeypatch.setattr(generate, "STEPS", {("-c", "raise SystemExit(3)"): [], **steps})
    assert generate.main() == 3
    assert "failed" in capsys.readouterr().out
