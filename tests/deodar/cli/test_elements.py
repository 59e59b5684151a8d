"""`deodar elements [KIND]`."""

from __future__ import annotations

import json

import pytest

from deodar import cli, registry
from deodar.parameters import Part, parameters

KINDS = {name: cls for room in registry.ROOMS for name, cls in registry.kinds(room).items()}
PARTS = {name: cls for name, cls in KINDS.items() if issubclass(cls, Part)}


def test_the_list_names_every_kind_by_package(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["elements"]) == 0
    out, err = capsys.readouterr()
    assert not err
    lines = out.splitlines()
    assert [line for line in lines if not line.startswith(" ")] == [
        "sigmoids",
        "kernels",
        "elements",
        "couplings",
        "worlds",
    ]
    assert sorted(line.split()[0] for line in lines if line.startswith("  ")) == sorted(KINDS)
    assert all(line.rstrip().endswith(".") for line in lines if line.startswith("  "))


def test_the_list_is_printed_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["elements", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert list(listed) == list(registry.ROOMS)
    assert sorted(name for kinds in listed.values() for name in kinds) == sorted(KINDS)


def test_each_kind_is_printed_with_equation_and_reference(capsys: pytest.CaptureFixture[str]) -> None:
    for kind in KINDS:
        assert cli.main(["elements", kind]) == 0
        out = capsys.readouterr().out
        assert out.startswith(kind) and "Equation:" in out and "Reference:" in out, out


def test_the_page_shows_default_range_and_unit_of_every_parameter(capsys: pytest.CaptureFixture[str]) -> None:
    missing: list[str] = []
    for kind, cls in PARTS.items():
        cli.main(["elements", kind])
        table = capsys.readouterr().out.split("Values:")[-1].splitlines()
        rows = {line.split()[0]: line for line in table if line.strip()}
        for p in (p for p in parameters(cls) if p.name != "name"):
            expected = (p.cost, p.unit, "" if p.lower is None else f"{p.lower:g}", *p.choices)
            missing += [f"{kind}.{p.name}: {word}" for word in expected if word not in rows[p.name]]
    assert len(PARTS) > 60 and not missing, missing


def test_a_kind_as_json_is_its_schema(capsys: pytest.CaptureFixture[str]) -> None:
    for kind in PARTS:
        assert cli.main(["elements", kind, "--json"]) == 0
        answer = json.loads(capsys.readouterr().out)
        assert (answer["title"], answer["properties"]["kind"]) == (kind, {"const": kind})


def test_worlds_and_other_kinds_outside_of_documents_have_a_schema(
    capsys: pytest.CaptureFixture[str],
) -> None:
    for kind in set(KINDS) - set(PARTS):
        assert cli.main(["elements", kind, "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["title"] == kind
    assert "Picture" not in PARTS


def test_an_unknown_kind_is_an_error_with_a_suggestion(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["elements", "Feild"]) == 1
    out, err = capsys.readouterr()
    assert not out
    assert (
        err == "deodar elements: no element, coupling, kernel or sigmoid is called 'Feild'. Did you mean"
        " 'Field'?\n"
    )
