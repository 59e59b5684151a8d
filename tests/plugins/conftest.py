"""Packages like installed ones: modules and metadata on the path, in this process."""

from __future__ import annotations

import sys
import tomllib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest

from deodar import plugins, registry
from tests.house.source import ROOT

EXAMPLE = ROOT / "examples" / "package"
Install = Callable[..., Path]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Put a package on the path: its name, the text of its modules, its entry points by group, its version
    and requirements.
    """
    site = tmp_path / "site"
    site.mkdir()
    before = set(sys.modules)
    registry.kinds()
    monkeypatch.setattr(registry, "_kinds", dict(registry._kinds))
    monkeypatch.syspath_prepend(str(site))

    def put(
        name: str,
        modules: Mapping[str, str],
        entries: Mapping[str, Mapping[str, str]],
        version: str = "0.1.0",
        requires: tuple[str, ...] = ("deodar>=0.2,<0.3",),
    ) -> Path:
        for module, text in modules.items():
            (site / f"{module}.py").write_text(text, encoding="utf-8")
        info = site / f"{name.replace('-', '_')}-{version}.dist-info"
        info.mkdir()
        head = [
            f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}",
            *(f"Requires-Dist: {r}" for r in requires),
        ]
        (info / "METADATA").write_text("\n".join(head) + "\n", encoding="utf-8")
        groups = [
            f"[{group}]\n" + "\n".join(f"{k} = {v}" for k, v in found.items())
            for group, found in entries.items()
        ]
        (info / "entry_points.txt").write_text("\n\n".join(groups) + "\n", encoding="utf-8")
        _forget()
        return info

    _forget()
    yield put
    for module in set(sys.modules) - before:
        if not module.startswith("deodar.") and str(getattr(sys.modules[module], "__file__", "")).startswith(
            (str(site), str(EXAMPLE))
        ):
            del sys.modules[module]
    _forget()


@pytest.fixture
def example(install: Install, monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    """Install the package of the repository with the metadata of its pyproject.toml."""
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    install(project["name"], {}, project["entry-points"], project["version"], tuple(project["dependencies"]))
    monkeypatch.syspath_prepend(str(EXAMPLE))
    return project


def _forget() -> None:
    for cached in (plugins._all, plugins._misfit, plugins._load, plugins._import_packages):
        cached.cache_clear()
