"""The files of the repository, and the imports of a module, for the tests of this folder."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))
import packages
from packages import ROOT as ROOT
from packages import tree as tree

SRC = ROOT / "src"
ENGINE = SRC / "deodar"
MODULES = [path for package in packages.packages() for path in packages.modules(package)]

NEVER = {
    ".git",
    ".venv",
    ".ruff_cache",
    ".pytest_cache",
    "__pycache__",
    "node_modules",
    "site",
    "dist",
    "shared",
}
TEXT = {
    "",
    ".py",
    ".pyi",
    ".md",
    ".toml",
    ".json",
    ".cff",
    ".txt",
    ".yml",
    ".yaml",
    ".cfg",
    ".ini",
    ".css",
    ".html",
    ".js",
    ".ts",
    ".tsx",
    ".svg",
    ".csv",
    ".sh",
}


def module(path: Path) -> str:
    """Return the dotted name of a module; of the engine without `deodar`: `numerics.axes`."""
    return _short(packages.dotted(path))


def imported(path: Path) -> list[tuple[int, str]]:
    """Return line and module of each import of deodar's packages in a file: at its top, in functions, for
    types; of the engine without `deodar`.
    """
    known = packages.packages()
    return [
        (line, _short(name)) for line, name in packages.imports(path) if packages.package_of(name) in known
    ]


def _short(name: str) -> str:
    return name.removeprefix("deodar.") if name.startswith("deodar.") else name.removesuffix("deodar")


def at(path: Path, line: int) -> str:
    """Return the place of a line, as editors and terminals open it: `src/deodar/errors.py:3`."""
    return f"{path.relative_to(ROOT).as_posix()}:{line}"


def texts() -> list[Path]:
    """Return every text file of the repository that git knows or would add, without built and installed
    files.
    """
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True
    )
    names = (
        [ROOT / line for line in listed.stdout.splitlines()]
        if listed.returncode == 0
        else list(ROOT.rglob("*"))
    )
    paths = [p for p in names if p.is_file() and p.suffix in TEXT and not _left_out(p)]
    return sorted(paths)


def _left_out(path: Path) -> bool:
    """Return whether a file is not a text of the repository: folders of tools, and chunks of records."""
    parts = path.relative_to(ROOT).parts
    return bool(NEVER & set(parts)) or any(part.endswith(".zarr") for part in parts)
