"""The bill of materials of deodar on this machine, as CycloneDX 1.5.

Python packages are the installed ones that deodar, or one of its extras, requires, directly or indirectly.
The libraries of the studio's page are those in `licences.txt`, which its build writes.

Reference:
    OWASP CycloneDX Specification 1.5 (ECMA-424, 2024).
"""

from __future__ import annotations

import datetime
import importlib.metadata
import re
import urllib.parse
from pathlib import Path
from typing import Any

SPECIFICATION = "1.5"
LONGEST_NAME = 100
"""Most characters of the name of a licence; longer text is the licence itself."""

LIBRARY = re.compile(r"(?m)^(@?[\w./-]+) (\d[\w.+-]*) \((.+)\)$")
"""The first line of a library in `licences.txt`: name, version, licence."""

Component = dict[str, Any]


def bill() -> dict[str, Any]:
    """Return the bill of materials as plain data."""
    found, needs = _python("deodar")
    own = found.pop("deodar")
    page = _page()
    own["type"] = "application"
    root = own["bom-ref"]
    depends = [{"ref": refs, "dependsOn": sorted(to)} for refs, to in sorted(needs.items())]
    for entry in depends:
        if entry["ref"] == root:
            entry["dependsOn"] = [*entry["dependsOn"], *(c["bom-ref"] for c in page)]
    return {
        "bomFormat": "CycloneDX",
        "specVersion": SPECIFICATION,
        "version": 1,
        "metadata": {
            "timestamp": datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
            "component": own,
        },
        "components": [*(found[name] for name in sorted(found)), *page],
        "dependencies": [*depends, *({"ref": c["bom-ref"], "dependsOn": []} for c in page)],
    }


def _python(root: str) -> tuple[dict[str, Component], dict[str, set[str]]]:
    """Return the installed direct and indirect requirements of a distribution by name, and the dependencies
    by reference.
    """
    # start-up time
    from packaging.requirements import Requirement
    from packaging.utils import canonicalize_name

    found: dict[str, Component] = {}
    needs: dict[str, set[str]] = {}
    extras_of_root = importlib.metadata.metadata(root).get_all("Provides-Extra") or []
    waiting = [
        (root, frozenset[str](), True),
        *((root, frozenset([extra]), False) for extra in extras_of_root),
    ]
    seen: set[tuple[str, frozenset[str], bool]] = set()
    while waiting:
        name, extras, required = one = waiting.pop(0)
        if one in seen:
            continue
        seen.add(one)
        about = importlib.metadata.distribution(name)
        mine = found.setdefault(canonicalize_name(name), _component(about, required))
        for text in about.requires or ():
            requirement = Requirement(text)
            if not _wanted(requirement, extras, name == root and not required):
                continue
            child = canonicalize_name(requirement.name)
            try:
                version = importlib.metadata.version(child)
            except importlib.metadata.PackageNotFoundError:
                continue
            needs.setdefault(mine["bom-ref"], set()).add(_reference("pypi", child, version))
            waiting.append((child, frozenset(requirement.extras), required))
    for component in found.values():
        needs.setdefault(component["bom-ref"], set())
    return found, needs


def _wanted(requirement: Any, extras: frozenset[str], extra_only: bool) -> bool:
    """Return whether a requirement applies on this machine with these extras; `extra_only`: only because of
    them.
    """
    if requirement.marker is None:
        return not extra_only
    plain = requirement.marker.evaluate({"extra": ""})
    return (plain and not extra_only) or (
        not plain and any(requirement.marker.evaluate({"extra": extra}) for extra in extras)
    )


def _component(about: importlib.metadata.Distribution, required: bool) -> Component:
    reference = _reference("pypi", about.name, about.version)
    made: Component = {
        "type": "library",
        "bom-ref": reference,
        "name": about.name,
        "version": about.version,
        "purl": reference,
    }
    made["scope"] = "required" if required else "optional"
    licences = _licences(about)
    return made | ({"licenses": licences} if licences else {})


def _licences(about: importlib.metadata.Distribution) -> list[dict[str, Any]]:
    """Return the licences of a distribution: an SPDX expression, else the names in its classifiers, else its
    licence field.
    """
    if "License-Expression" in about.metadata:
        return [{"expression": about.metadata["License-Expression"]}]
    named = [
        c.rpartition(" :: ")[2]
        for c in about.metadata.get_all("Classifier") or ()
        if c.startswith("License :: ")
    ]
    if (
        not named
        and "License" in about.metadata
        and (own := about.metadata["License"].strip())
        and "\n" not in own
        and len(own) <= LONGEST_NAME
    ):
        named = [own]
    return [{"license": {"name": name}} for name in named]


def licences() -> Path:
    """Return the path of the file that the build of the page writes."""
    return Path(__file__).parents[1] / "server" / "static" / "licences.txt"


def _page() -> list[Component]:
    """Return the libraries in the built page; none without a built page."""
    text = licences().read_text(encoding="utf-8") if licences().is_file() else ""
    out: list[Component] = []
    for name, version, licence in sorted(LIBRARY.findall(text)):
        reference = _reference("npm", name, version)
        out.append(
            {
                "type": "library",
                "bom-ref": reference,
                "name": name,
                "version": version,
                "purl": reference,
                "scope": "required",
                "licenses": [{"expression": licence}],
            }
        )
    return out


def _reference(kind: str, name: str, version: str) -> str:
    """Return the package URL of a package."""
    plain = re.sub(r"[-_.]+", "-", name).lower() if kind == "pypi" else urllib.parse.quote(name, safe="/")
    return f"pkg:{kind}/{plain}@{urllib.parse.quote(version, safe='')}"
