"""Groups of entry points that make a package look like a part of deodar: exporters, names and examples."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

import deodar as dd
from deodar import plugins
from deodar.cli import main
from deodar.extensions import Extensions
from tests.plugins.conftest import Install

EXPORTER = """
from pathlib import Path

NAME, ENDING, HELP, ABOUT = "plain", ".plain", "the names of the elements", "plain names"

def write(model, name, upper=False):
    from deodar.exporters.exported import Exported
    from deodar.importers.report import ImportReport

    text = ",".join(entry.path for entry in model.document.entries)
    return Exported((text.upper() if upper else text).encode(), ImportReport("plain", name, ()))

def arguments(parser):
    parser.add_argument("--upper", action="store_true", default=None, help="of plain: in capitals")

def options(args):
    return {"upper": bool(args.upper)}
"""

RECORDS = """
NAME, ENDING, HELP = "names", ".names", "the names of the variables"

def save(data, path, force=False):
    path.write_text(",".join(data.data_vars))
    return path
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """Return the file of a model with one element."""
    model = dd.Model("m")
    model.add(dd.Boost("b"))
    dd.save(model, tmp_path / "m.json")
    return tmp_path / "m.json"


def test_an_exporter_of_a_package_writes_a_model_with_its_own_options(
    install: Install, model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    install("plain", {"plain": EXPORTER}, {"deodar.exporters": {"plain": "plain"}})
    dd.export(dd.load(model), tmp_path / "lower.plain", "plain")
    dd.export(dd.load(model), tmp_path / "upper.plain", "plain", upper=True)
    assert (tmp_path / "lower.plain").read_text() == "b" and (tmp_path / "upper.plain").read_text() == "B"
    out = str(tmp_path / "command.plain")
    assert main(["export", "plain", str(model), "--upper", "--out", out]) == 0
    assert Path(out).read_text() == "B"
    with pytest.raises(SystemExit):
        main(["export", "cosivina", str(model), "--upper", "--out", str(tmp_path / "m2.json")])
    assert "--upper is about plain names, and --to cosivina writes none" in capsys.readouterr().err


def test_an_option_that_an_exporter_does_not_have_is_an_error(model: Path, tmp_path: Path) -> None:
    with pytest.raises(dd.errors.UnknownName, match="the exporter 'cosivina' has no option 'upper'"):
        dd.export(dd.load(model), tmp_path / "out.json", upper=True)


def test_an_exporter_of_records_writes_a_record_and_refuses_a_model(
    install: Install, model: Path, tmp_path: Path
) -> None:
    install("named", {"named": RECORDS}, {"deodar.exporters": {"names": "named"}})
    dd.save_record(dd.simulate(dd.load(model), 3, record=["b.output"]), tmp_path / "r.zarr")
    assert main(["export", str(tmp_path / "r.zarr"), "--out", str(tmp_path / "r.names")]) == 0
    assert (tmp_path / "r.names").read_text() == "b.output"
    with pytest.raises(dd.errors.UnknownName, match="the exporter 'names' writes records, not models"):
        dd.export(dd.load(model), tmp_path / "out.names", "names")


def test_a_name_of_a_package_is_a_name_of_the_root(install: Install) -> None:
    install("odd", {"odd": "class Odd: pass"}, {"deodar.names": {"Odd": "odd:Odd"}})
    assert dd.Odd.__module__ == "odd" and "Odd" in dir(dd) and "Odd" not in dd.__all__  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match=r"no attribute 'Odt'. Did you mean 'Odd'\?$"):
        dd.Odt  # type: ignore[attr-defined]  # noqa: B018


def test_a_name_of_a_package_that_raises_is_an_error_that_names_the_package(install: Install) -> None:
    install("odd", {"odd": "raise RuntimeError('no licence')"}, {"deodar.names": {"Odd": "odd:Odd"}})
    message = "the package odd 0.1.0 raises RuntimeError when it is imported: no licence. Type: deodar doctor"
    with pytest.raises(AttributeError, match=re.escape(message)):
        dd.Odd  # type: ignore[attr-defined]  # noqa: B018


def test_examples_of_a_package_are_listed_and_opened(
    install: Install, model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    info = install("odd", {}, {"deodar.examples": {"odd": "odd_examples"}})
    folder = info.parent / "odd_examples"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "lone-boost.json").write_bytes(model.read_bytes())
    (folder / "sweep.py").write_text('"""A sweep of the boost."""\n')
    assert [entry.path for entry in dd.load("example:lone-boost").document.entries] == ["b"]
    assert main(["examples"]) == 0
    text = capsys.readouterr().out
    assert "lone-boost" in text and "A sweep of the boost." in text and "selection" in text


def test_a_group_that_a_package_defines_is_in_the_lines_of_doctor(
    install: Install, capsys: pytest.CaptureFixture[str]
) -> None:
    group = (
        "from deodar.extensions import Extensions\n"
        "BODIES = Extensions('bodies', 'body', dict, lambda plugin, body: '' if body else 'is empty')\n"
        "EMPTY, ARM = '', 'arm'\n"
    )
    entries = {"arm": "odd:ARM", "none": "odd:EMPTY"}
    install("odd", {"odd": group}, {"deodar.groups": {"bodies": "odd:BODIES"}, "deodar.bodies": entries})
    assert main(["doctor"]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("plug-in")]
    assert lines == [
        "plug-in    odd 0.1.0: bodies arm",
        "plug-in    odd 0.1.0: PROBLEM: none is empty",
        "plug-in    odd 0.1.0: groups bodies",
    ]


def test_a_file_names_no_package_for_a_member_that_comes_with_deodar(
    install: Install, monkeypatch: pytest.MonkeyPatch
) -> None:
    bodies = Extensions[Any]("bodies", "body", dict, lambda plugin, body: "")
    install("odd", {"odd": "class Arm: pass"}, {"deodar.bodies": {"Arm": "odd:Arm"}})
    arm = bodies["Arm"]
    assert bodies.package(arm) == "odd 0.1.0" and bodies.first_party() == {}
    monkeypatch.setattr(plugins, "OWN", "odd")
    assert bodies.package(arm) == "" and bodies.first_party() == {"Arm": arm}
