"""Experiment files name the packages of their measures; opening a file names a missing one."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import deodar as dd
from deodar.cli import main
from deodar.errors import DocumentError, OutputExists
from deodar.experiments import row_line
from deodar.experiments.results import EXPERIMENT, ROWS
from tests.plugins.conftest import Install

MEASURE = """
from dataclasses import dataclass
import deodar as dd

@dataclass(frozen=True)
class Spread(dd.BaseMeasure):
    name: str
    of: str
    when: str = ""

    def value(self, samples, axes):
        return float(samples.max())
"""


def _install(install: Install, version: str) -> None:
    entries = {"deodar.measures": {"Spread": "spread:Spread"}}
    install("deodar-spread", {"spread": MEASURE}, entries, version=version)


def _data(kind: str = "Spread", **others: object) -> dict[str, object]:
    measures = {"u": {"kind": kind, "of": "u.output"}}
    return {"experiment": 3, "name": "e", "model": "m.json", "limit": 3.0, "measures": measures, **others}


def _experiment(folder: Path) -> dd.Experiment:
    model = dd.Model("m")
    model.add(dd.Boost("u"))
    dd.save(model, folder / "m.json")
    return dd.Experiment.from_data(_data(), folder)


def test_an_experiment_names_package_and_version_of_its_measures_and_opens_again(
    install: Install, tmp_path: Path
) -> None:
    _install(install, "1.2")
    experiment = dd.Experiment.from_data(_data())
    experiment.save(tmp_path / "e.json")
    assert json.loads((tmp_path / "e.json").read_text())["packages"] == {"Spread": "deodar-spread 1.2"}
    assert dd.Experiment.load(tmp_path / "e.json").plan.measures == experiment.plan.measures
    assert dd.Experiment.schema()["properties"]["packages"]["type"] == "object"


def test_an_experiment_without_measures_of_packages_names_no_package(install: Install) -> None:
    _install(install, "1.2")
    assert "packages" not in dd.Experiment.from_data(_data("Measure")).to_data()


def test_a_missing_package_of_a_measure_is_the_first_problem_and_a_line_of_doctor(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "e.json"
    path.write_text(json.dumps(_data(packages={"Spread": "deodar-spread 1.2"})))
    with pytest.raises(DocumentError) as caught:
        dd.Experiment.load(path)
    first, second = caught.value.problems
    assert first.where == f"{path}: packages.Spread"
    assert first.what == "Spread is of the package deodar-spread 1.2, which is not installed"
    assert first.fix == "If you trust it, type: pip install deodar-spread==1.2"
    assert second.where == f"{path}: measures.u.kind"
    assert main(["doctor", str(path)]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("document")]
    assert lines == [f"document   {path}: PROBLEM: {first.what}. {first.fix}"]


def test_doctor_examines_the_model_of_an_experiment(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "e.json"
    path.write_text(json.dumps(_data("Measure")))
    elements = {"d": {"kind": "Detector"}}
    model = {"deodar": 3, "elements": elements, "packages": {"Detector": "deodar-detector 1.2"}}
    (tmp_path / "m.json").write_text(json.dumps(model))
    assert main(["doctor", str(path)]) == 0
    assert f"document   {path}: PROBLEM: Detector is of the package deodar-detector 1.2" in (
        capsys.readouterr().out
    )
    (tmp_path / "m.json").write_text("{}")
    assert main(["doctor", str(path)]) == 0
    assert f"no package is missing, but it does not open. Type: deodar experiment {path} --check" in (
        capsys.readouterr().out
    )


def test_an_experiment_that_does_not_open_names_the_other_version(install: Install) -> None:
    _install(install, "2.0")
    data = _data(packages={"Spread": "deodar-spread 1.2"})
    assert [m.name for m in dd.Experiment.from_data(data).plan.measures] == ["u"]
    data["measures"] = {"u": {"kind": "Spread", "of": "u.output", "wide": 3}}
    with pytest.raises(DocumentError) as caught:
        dd.Experiment.from_data(data)
    assert [p.what for p in caught.value.problems] == [
        "was saved with deodar-spread 1.2; Spread is of deodar-spread 2.0 now",
        "Spread has no such parameter",
    ]


@pytest.mark.parametrize("packages", [3, {"Spread": 3}, {"Spread": "-r evil.txt 1"}])
def test_an_invalid_entry_of_packages_is_a_problem_of_an_experiment(packages: object) -> None:
    with pytest.raises(DocumentError, match=r"needs an object|needs a package and its version"):
        dd.Experiment.from_data(_data("Measure", packages=packages))


def test_a_folder_whose_rows_name_no_package_is_resumed(install: Install, tmp_path: Path) -> None:
    _install(install, "1.2")
    experiment, out = _experiment(tmp_path), tmp_path / "out"
    experiment.run(out)
    assert json.loads((out / EXPERIMENT).read_text())["packages"] == {"Spread": "deodar-spread 1.2"}
    first, *rows = (out / ROWS).read_bytes().splitlines(keepends=True)
    document = row_line.read(first, True)
    del document["about"]["packages"]
    (out / ROWS).write_bytes(b"".join([row_line.write(document, True), *rows]))
    assert experiment.run(out).sizes["trial"] == 1


def test_a_folder_of_another_version_of_a_measure_is_not_resumed(install: Install, tmp_path: Path) -> None:
    _install(install, "1.2")
    experiment, out = _experiment(tmp_path), tmp_path / "out"
    experiment.run(out)
    first, *rows = (out / ROWS).read_bytes().splitlines(keepends=True)
    document = row_line.read(first, True)
    document["about"]["packages"] = {"Spread": "deodar-spread 1.1"}
    (out / ROWS).write_bytes(b"".join([row_line.write(document, True), *rows]))
    with pytest.raises(OutputExists, match="packages differ"):
        experiment.run(out)
