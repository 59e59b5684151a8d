"""A package that cannot be used is a line of `deodar doctor` with its name, and all others work."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import deodar as dd
from deodar import plugins, registry
from deodar.cli import main
from deodar.errors import UnknownName
from tests.command_line import typed
from tests.plugins.conftest import Install

KIND = """
from dataclasses import dataclass
import deodar as dd

@dd.register
@dataclass(frozen=True)
class {name}(dd.Coupling):
    pass
"""

BROKEN = [
    (
        "raising",
        KIND.format(name="Odd") + "raise RuntimeError('no licence')",
        "Odd",
        (),
        "raises RuntimeError when it is imported: no licence",
    ),
    ("leaving", "import sys; sys.exit(3)", "Odd", (), "raises SystemExit when it is imported: 3"),
    ("taking", KIND.format(name="Field"), "Field", (), "takes the name 'Field', which deodar has"),
    (
        "later",
        KIND.format(name="Odd"),
        "Odd",
        ("numpy", "deodar>=7"),
        "is made for deodar >=7, and this is " + dd.__version__,
    ),
    (
        "misnaming",
        KIND.format(name="Even") + "Odd = Even",
        "Odd",
        (),
        "names misnaming:Odd as 'Odd', which is not a class of that name",
    ),
]


@pytest.mark.parametrize(
    ("package", "text", "kind", "requires", "problem"), BROKEN, ids=[b[0] for b in BROKEN]
)
def test_a_package_that_cannot_be_used_is_a_line_of_doctor_and_the_rest_works(
    package: str,
    text: str,
    kind: str,
    requires: tuple[str, ...],
    problem: str,
    install: Install,
) -> None:
    install(package, {package: text}, {"deodar.kinds": {kind: f"{package}:{kind}"}}, requires=requires)
    install(
        "whole",
        {"whole": KIND.format(name="Whole")},
        {"deodar.kinds": {"Whole": "whole:Whole"}},
        version="2.5",
        requires=(),
    )
    assert registry.kind("Whole").__module__ == "whole" and registry.kind("Field") is dd.Field
    assert {"Field", "Whole"} <= set(registry.kinds()) and not {"Odd", "Even"} & set(registry.kinds())
    if kind == "Odd":
        with pytest.raises(UnknownName) as caught:
            registry.kind("Odd")
        assert (
            str(caught.value)
            == f"'Odd' cannot be used: the package {package} 0.1.0 {problem}. Type: deodar doctor"
        )
    assert sorted(_doctor()) == sorted(
        [f"plug-in    {package} 0.1.0: PROBLEM: {kind} {problem}", "plug-in    whole 2.5: kinds Whole"]
    )


def test_the_first_of_two_packages_with_one_name_is_used(install: Install) -> None:
    for package in ("second", "first"):
        install(
            package,
            {package: KIND.format(name="Odd")},
            {"deodar.kinds": {"Odd": f"{package}:Odd"}},
            requires=(),
        )
    assert registry.kind("Odd").__module__ == "first"
    named = [registry.take(p) for p in registry.packaged() if p.name == "Odd"]
    assert named == ["", "takes the name 'Odd', which first has"]


def test_a_misspelt_kind_of_a_package_suggests_it_without_importing_it(install: Install) -> None:
    install("raising", {"raising": "raise RuntimeError"}, {"deodar.kinds": {"Detector": "raising:Detector"}})
    with pytest.raises(UnknownName, match=r"Did you mean 'Detector'\?"):
        registry.kind("Detectr")


def test_a_command_of_a_package_that_raises_is_an_error_that_names_it(install: Install) -> None:
    install(
        "raising", {"raising": "raise RuntimeError('no licence')"}, {"deodar.commands": {"solve": "raising"}}
    )
    assert typed("examples").status == 0
    command = typed("solve")
    message = "'solve' cannot be used: the package raising 0.1.0 raises RuntimeError when it is imported"
    assert command.status == 2 and f"{message}: no licence" in command.err


def test_a_paper_and_an_importer_of_a_package_are_found(install: Install) -> None:
    from deodar.importers import opening
    from deodar_papers import papers

    install(
        "extra",
        {"extra": "NAME = 'tool'\ndef sniff(head): return head[:4] == b'TOOL'\ndef read(): ..."},
        {"deodar.importers": {"tool": "extra"}, "deodar.papers": {"study": "extra"}},
    )
    tool = opening.tool_for(b"TOOL 1")
    assert tool is not None and tool.__name__ == "extra"
    assert "study" in papers.PAPERS and papers.PAPERS["study"].NAME == "tool"


MEASURE = """
from dataclasses import dataclass
import deodar as dd

@dataclass(frozen=True)
class {name}(dd.BaseMeasure):
    name: str
    of: str
    when: str = ""
"""

FIGURE = """
ACROSS = False
def size(view): return 3, 2
def fill(place, view): place.subplots()
"""

RAISES = "raise RuntimeError('no licence')"

GROUPS = {
    "deodar.kinds": (KIND.format(name="Odd"), "odd:Odd", "Odd", "Field"),
    "deodar.worlds": ("", "odd:Odd", "Odd", "Arena"),
    "deodar.measures": (MEASURE.format(name="Odd"), "odd:Odd", "Odd", "Measure"),
    "deodar.figures": (FIGURE, "odd", "odd", "snapshot"),
    "deodar.plots": ("", "odd", "odd", "heat"),
    "deodar.importers": ("", "odd", "odd", "cosivina"),
    "deodar.commands": ("", "odd", "odd", "run"),
    "deodar.papers": ("", "odd", "odd", "spa"),
    "deodar.exporters": ("", "odd", "odd", "cosivina"),
    "deodar.names": ("", "odd:Odd", "Odd", "Field"),
    "deodar.groups": ("", "odd:ODD", "odd", "papers"),
    "deodar.examples": ("", "odd", "odd", ""),
}
"""For each group a module, the value of its entry point, its name, and a name of deodar, if it has any."""


def _doctor() -> list[str]:
    """Return what `deodar doctor` says of packages."""
    command = typed("doctor")
    assert command.status == 0
    return [line for line in command.out.splitlines() if line.startswith("plug-in")]


def test_a_module_of_any_group_that_raises_is_a_line_of_doctor(
    install: Install, capsys: pytest.CaptureFixture[str]
) -> None:
    defined = [p.name for p in plugins.found("groups")]
    assert {f"deodar.{group}" for group in (*plugins.GROUPS, *defined)} == set(GROUPS)
    for group, (text, value, name, _) in GROUPS.items():
        package = group.replace(".", "-")
        module = group.replace("deodar.", "odd_")
        install(package, {module: text + RAISES}, {group: {name: value.replace("odd", module, 1)}})
    found = _doctor()
    assert sorted(found) == sorted(
        f"plug-in    {group.replace('.', '-')} 0.1.0: PROBLEM: {name} raises RuntimeError when it is"
        " imported: no licence"
        for group, (_, _, name, _) in GROUPS.items()
    )


def test_an_entry_with_a_name_of_deodar_is_a_line_of_doctor(
    install: Install, capsys: pytest.CaptureFixture[str]
) -> None:
    names = {group: taken for group, (_, _, _, taken) in GROUPS.items() if taken}
    for group, taken in names.items():
        install(group.replace(".", "-"), {}, {group: {taken: "nowhere"}})
    assert sorted(_doctor()) == sorted(
        f"plug-in    {group.replace('.', '-')} 0.1.0: PROBLEM: {taken} takes the name {taken!r}, which deodar"
        " has"
        for group, taken in names.items()
    )


def test_a_package_for_another_version_is_a_line_of_doctor_for_each_group(
    install: Install, capsys: pytest.CaptureFixture[str]
) -> None:
    entries = {group: {name: "nowhere"} for group, (_, _, name, _) in GROUPS.items()}
    install("later", {}, entries, requires=("numpy", "deodar>=7"))
    problem = f"is made for deodar >=7, and this is {dd.__version__}"
    assert sorted(_doctor()) == sorted(
        f"plug-in    later 0.1.0: PROBLEM: {name} {problem}" for _, _, name, _ in GROUPS.values()
    )


@pytest.mark.parametrize(
    ("group", "text", "problem"),
    [
        (
            "measures",
            MEASURE.format(name="Even") + "Odd = Even",
            "names odd:Odd as 'Odd', which is not a class of that name",
        ),
        ("measures", "class Odd: pass", "names odd:Odd as 'Odd', which does not derive from dd.BaseMeasure"),
        ("figures", "ACROSS = True\ndef size(view): return 3, 2", "has no fill, paint"),
    ],
    ids=["another name", "no measure", "no figure"],
)
def test_an_entry_that_is_not_a_measure_or_figure_is_a_line_of_doctor(
    group: str, text: str, problem: str, install: Install, capsys: pytest.CaptureFixture[str]
) -> None:
    value = "odd:Odd" if group == "measures" else "odd"
    install("odd", {"odd": text}, {f"deodar.{group}": {"Odd": value}})
    assert _doctor() == [f"plug-in    odd 0.1.0: PROBLEM: Odd {problem}"]


def test_a_broken_measure_is_an_error_only_of_experiments_that_name_it(install: Install) -> None:
    install("odd", {"odd": MEASURE.format(name="Odd") + RAISES}, {"deodar.measures": {"Odd": "odd:Odd"}})
    settings = {"experiment": 3, "name": "e", "model": "m.json", "limit": 1.0, "measures": {"u": {"of": "u"}}}
    assert [m.name for m in dd.Experiment.from_data(settings).plan.measures] == ["u"]
    assert "Odd" not in str(dd.Experiment.schema())
    settings["measures"] = {"u": {"kind": "Odd", "of": "u"}}
    with pytest.raises(dd.errors.DocumentError) as caught:
        dd.Experiment.from_data(settings)
    assert str(caught.value) == (
        "measures.u.kind: 'Odd' cannot be used: the package odd 0.1.0 raises RuntimeError when it is"
        " imported: no licence. Type: deodar doctor"
    )


def test_a_broken_figure_is_an_error_only_of_plots_that_name_it(
    install: Install, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    install("odd", {"odd": RAISES}, {"deodar.figures": {"odd": "odd"}})
    model = dd.Model("m")
    model.add(dd.Boost("b"))
    dd.save_record(dd.simulate(model, 3, record=["b.output"]), tmp_path / "r.zarr")
    arguments = ["plot", str(tmp_path / "r.zarr"), "--out", str(tmp_path / "r.svg")]
    assert main(arguments) == 0
    assert main([*arguments, "--force", "--kind", "odd"]) == 1
    assert "'odd' cannot be used: the package odd 0.1.0 raises RuntimeError" in capsys.readouterr().err


WORLD = """
import deodar as dd

class Odd(dd.World):
    sensors = {"light": dd.Signal("brightness", ())}

    def sense(self, sensor, axes, time):
        return {}["lamp"]

    @classmethod
    def open(cls, argument):
        float(argument)
        return cls()
"""


@pytest.mark.parametrize(
    ("argument", "message"),
    [
        (
            "x",
            "raised ValueError in open (odd.py, line 12): could not convert string to float: 'x'. Check the"
            " argument 'x'; if it is right, report this to the authors of odd",
        ),
        ("1", "raised KeyError in sense (odd.py, line 8): 'lamp'. Report this to the authors of odd"),
    ],
    ids=["open", "sense"],
)
def test_a_world_that_raises_is_an_error_that_names_it_and_its_package(
    argument: str, message: str, install: Install, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    install("odd", {"odd": WORLD}, {"deodar.worlds": {"Odd": "odd:Odd"}})
    model = dd.Model("m")
    model.add(dd.Sensor("eye", sensor="light"))
    dd.save(model, tmp_path / "m.json")
    experiment = {"experiment": 3, "name": "e", "model": "m.json", "limit": 2.0, "world": f"odd:{argument}"}
    (tmp_path / "e.json").write_text(json.dumps(experiment))
    calls = [
        [
            "run",
            str(tmp_path / "m.json"),
            "--duration",
            "2",
            "--record",
            "eye.output",
            "--world",
            f"odd:{argument}",
        ],
        ["experiment", str(tmp_path / "e.json"), "--out", str(tmp_path / "out"), "--no-progress"],
    ]
    for call in calls:
        assert main(call) == 1
        assert (
            capsys.readouterr().err.strip()
            == f"deodar {call[0]}: the world Odd of the package odd 0.1.0 {message}"
        )
