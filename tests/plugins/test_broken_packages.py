"""A package that cannot be used is one named line of `deodar doctor`, and the rest works."""

from __future__ import annotations

import pytest

import deodar as dd
from deodar import registry
from deodar.cli import main
from deodar.errors import UnknownName
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
        (
            "numpy",
            "deodar>=7",
        ),
        "is made for deodar >=7, and this is " + dd.__version__,
    ),
    (
        "misnaming",
        KIND.format(name="Even") + "Odd = Even",
        "Odd",
        (),
        "names misnaming:Odd as 'Odd', which is no class of that name",
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
    capsys: pytest.CaptureFixture[str],
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
    assert main(["doctor"]) == 0
    page = [line for line in capsys.readouterr().out.splitlines() if line.startswith("plug-in")]
    assert sorted(page) == sorted(
        [f"plug-in    {package} 0.1.0: PROBLEM: {kind} {problem}", "plug-in    whole 2.5: kinds Whole"]
    )


def test_of_two_packages_with_one_name_the_first_has_it(install: Install) -> None:
    for package in ("second", "first"):
        install(
            package,
            {package: KIND.format(name="Odd")},
            {"deodar.kinds": {"Odd": f"{package}:Odd"}},
            requires=(),
        )
    assert registry.kind("Odd").__module__ == "first"
    assert [registry.take(p) for p in registry.packaged()] == ["", "takes the name 'Odd', which first has"]


def test_a_misspelt_kind_of_a_package_suggests_it_without_importing_it(install: Install) -> None:
    install("raising", {"raising": "raise RuntimeError"}, {"deodar.kinds": {"Detector": "raising:Detector"}})
    with pytest.raises(UnknownName, match=r"Did you mean 'Detector'\?"):
        registry.kind("Detectr")


def test_a_command_of_a_package_that_raises_says_so(
    install: Install, capsys: pytest.CaptureFixture[str]
) -> None:
    install(
        "raising", {"raising": "raise RuntimeError('no licence')"}, {"deodar.commands": {"solve": "raising"}}
    )
    assert main(["examples"]) == 0
    assert main(["solve"]) == 2
    assert (
        "'solve' cannot be used: the package raising 0.1.0 raises RuntimeError when it is imported: no"
        " licence" in capsys.readouterr().err
    )


def test_a_paper_and_an_importer_of_a_package_are_found(install: Install) -> None:
    from deodar import papers
    from deodar.importers import opening

    install(
        "extra",
        {"extra": "NAME = 'tool'\ndef sniff(head): return head[:4] == b'TOOL'"},
        {"deodar.importers": {"tool": "extra"}, "deodar.papers": {"study": "extra"}},
    )
    tool = opening.tool_for(b"TOOL 1")
    assert tool is not None and tool.__name__ == "extra"
    assert "study" in papers.names() and papers.paper("study").NAME == "tool"
