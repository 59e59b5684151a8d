"""The lock file of Python contains every direct dependency, within its bounds and with hashes."""

from __future__ import annotations

import re
import tomllib

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.house.source import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
DIRECT = [
    *PROJECT["dependencies"],
    *(r for extra in PROJECT["optional-dependencies"].values() for r in extra),
]
ENTRY = re.compile(
    r"^([\w.-]+)==(\S+)(?: ; (.+?))? \\\n((?:    --hash=sha256:[0-9a-f]{64}(?: \\)?\n)+)", re.MULTILINE
)
TEXT = (ROOT / "requirements.lock").read_text(encoding="utf-8")


def locked() -> dict[str, list[str]]:
    """Return versions by name; a package may have one for each Python."""
    found: dict[str, list[str]] = {}
    for name, version, _, _ in ENTRY.findall(TEXT):
        found.setdefault(canonicalize_name(name), []).append(version)
    return found


def _unmet(texts: list[str], versions: dict[str, list[str]]) -> list[str]:
    """Return the requirements that no version, or a version outside of their bounds, is locked for."""
    unmet: list[str] = []
    for text in texts:
        requirement = Requirement(text)
        found = versions.get(canonicalize_name(requirement.name), [])
        if not found or not all(requirement.specifier.contains(v) for v in found):
            unmet.append(f"{text} is locked at {', '.join(found) or 'no version'}")
    return unmet


def test_every_direct_dependency_is_locked_within_its_bounds() -> None:
    unmet = _unmet(DIRECT, locked())
    assert not unmet, f"type `make lock`: {unmet}"


def test_a_dependency_that_is_not_locked_is_found() -> None:
    assert len(_unmet(["numpy>=2", "scipy<1", "absent"], {"numpy": ["2.1"], "scipy": ["0.9", "1.2"]})) == 2


def test_every_entry_has_hashes() -> None:
    entries = [line for line in TEXT.splitlines() if line and not line.startswith((" ", "#"))]
    assert len(ENTRY.findall(TEXT)) == len(entries) > len(DIRECT)


def test_the_lock_file_names_no_index() -> None:
    assert "://" not in TEXT and "--index" not in TEXT and "--extra-index" not in TEXT


def test_the_lowest_versions_are_installed_as_the_project_states_them() -> None:
    """CI takes the lower bounds from pyproject.toml, and every test that it names exists."""
    script = (ROOT / ".ci" / "lowest").read_text(encoding="utf-8")
    assert "--resolution lowest-direct" in script
    tests = re.findall(r"tests/[\w/]+(?:\.py)?", script)
    assert len(tests) > 5 and all((ROOT / t).exists() for t in tests)
    unbounded = [text for text in DIRECT if not Requirement(text).specifier]
    assert not unbounded
