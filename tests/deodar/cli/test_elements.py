"""`deodar elements [KIND]`."""

from __future__ import annotations

import json

import pytest

from deodar import cli, registry
from deodar.parameters import Part, parameters

KINDS = [name for room in registry.ROOMS for name in registry.kinds(room)]


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
    assert sorted(name for found in listed.values() for name in found) == sorted(KINDS)


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_is_printed_with_equation_and_reference(
    kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["elements", kind]) == 0
    out = capsys.readouterr().out
    assert out.startswith(kind)
    assert "Equation:" in out and "Reference:" in out


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_shows_default_range_and_unit_of_every_parameter(
    kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    cls = registry.kind(kind)
    if not issubclass(cls, Part):
        return
    cli.main(["elements", kind])
    table = capsys.readouterr().out.split("Values:")[-1].splitlines()
    rows = {line.split()[0]: line for line in table if line.strip()}
    for p in parameters(cls):
        if p.name == "name":
            continue
        assert p.cost in rows[p.name]
        if p.unit:
            assert p.unit in rows[p.name]
        if p.lower is not None:
            assert f"{p.lower:g}" in rows[p.name]
        assert not p.choices or all(choice in rows[p.name] for choice in p.choices)


@pytest.mark.parametrize("kind", [k for k in KINDS if issubclass(registry.kind(k), Part)])
def test_a_kind_as_json_is_its_schema(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["elements", kind, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["title"] == kind
    assert found["properties"]["kind"] == {"const": kind}


@pytest.mark.parametrize("kind", ["Picture"])
def test_worlds_and_other_kinds_outside_of_documents_have_a_schema(
    kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["elements", kind, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["title"] == kind


def test_an_unknown_kind_is_an_error_with_a_suggestion(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["elements", "Feild"]) == 1
    out, err = capsys.readouterr()
    assert not out
    assert (
        err == "deodar elements: no element, coupling, kernel or sigmoid is called 'Feild'. Did you mean"
        " 'Field'?\n"
    )
