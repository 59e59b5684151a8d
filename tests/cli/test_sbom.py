"""`deodar doctor --sbom`: a bill of materials that other programs read."""

from __future__ import annotations

import importlib.metadata
import json
import re

import pytest

from deodar import __version__
from deodar.cli import _sbom, main
from deodar.server import app

PURL = re.compile(r"pkg:(pypi/[a-z0-9-]+|npm/(%40[\w.-]+/)?[\w.-]+)@[\w.%+-]+")


@pytest.fixture(scope="module")
def bill() -> dict:
    return _sbom.bill()


def test_doctor_prints_the_bill_of_materials_as_cyclonedx(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor", "--sbom"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["bomFormat"], told["specVersion"], told["version"]) == ("CycloneDX", "1.5", 1)
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", told["metadata"]["timestamp"])
    own = told["metadata"]["component"]
    assert (own["type"], own["name"], own["version"]) == ("application", "deodar", __version__)
    assert set(told) == {"bomFormat", "specVersion", "version", "metadata", "components", "dependencies"}


def test_every_component_has_the_fields_of_the_specification(bill: dict) -> None:
    for component in [bill["metadata"]["component"], *bill["components"]]:
        assert set(component) <= {"type", "bom-ref", "name", "version", "purl", "scope", "licenses"}
        assert component["type"] in ("library", "application") and component["scope"] in (
            "required",
            "optional",
        )
        assert PURL.fullmatch(component["purl"]) and component["bom-ref"] == component["purl"]
        licences = component.get("licenses", [])
        assert len(licences) == 1 or all("license" in entry for entry in licences)
        assert all(entry.get("expression") or entry["license"]["name"] for entry in licences)


def test_references_are_unique_and_lead_to_components(bill: dict) -> None:
    known = [c["bom-ref"] for c in [bill["metadata"]["component"], *bill["components"]]]
    assert len(set(known)) == len(known)
    assert sorted(entry["ref"] for entry in bill["dependencies"]) == sorted(known)
    assert {to for entry in bill["dependencies"] for to in entry["dependsOn"]} <= set(known)


def test_the_bill_of_materials_lists_direct_and_indirect_requirements(bill: dict) -> None:
    found = {
        c["purl"].split("/")[1].split("@")[0]: c
        for c in bill["components"]
        if c["purl"].startswith("pkg:pypi/")
    }
    direct = {
        re.split(r"[^\w.-]", r)[0].lower()
        for r in importlib.metadata.requires("deodar") or ()
        if "extra ==" not in r
    }
    assert direct <= set(found) and {"jaxlib", "pandas", "packaging"} <= set(found)
    assert all(
        found[name]["scope"] == "required" and found[name]["version"] == importlib.metadata.version(name)
        for name in (*direct, "jaxlib")
    )
    assert found["pytest"]["scope"] == "optional"
    unknown = [name for name in direct if not found[name].get("licenses")]
    assert not unknown, f"no licence is known of {unknown}"


def test_the_bill_of_materials_lists_the_libraries_of_the_page(bill: dict) -> None:
    page = {c["name"]: c for c in bill["components"] if c["purl"].startswith("pkg:npm/")}
    text = (app.STATIC / "licences.txt").read_text(encoding="utf-8")
    assert {"react", "@mantine/core", "katex"} <= set(page)
    assert all(
        f"{name} {c['version']} ({c['licenses'][0]['expression']})" in text for name, c in page.items()
    )
    assert page["@mantine/core"]["purl"].startswith("pkg:npm/%40mantine/core@")


def test_without_the_page_the_bill_of_materials_lists_no_libraries_of_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path
) -> None:
    monkeypatch.setattr(_sbom, "licences", lambda: tmp_path / "licences.txt")
    assert not [c for c in _sbom.bill()["components"] if c["purl"].startswith("pkg:npm/")]
