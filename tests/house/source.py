"""The files of the repository, and the imports of a module, for the tests of this folder."""

from __future__ import annotations

import ast
import functools
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]
SRC = ROOT / "src" / "deodar"
MODULES = sorted(SRC.rglob("*.py"))

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


@functools.cache
def tree(path: Path) -> ast.Module:
    """Return the syntax tree of a file."""
    return ast.parse(path.read_text(encoding="utf-8"), str(path))


def module(path: Path) -> str:
    """Return the dotted name of a file of the package, without the package: `numerics.axes`."""
    names = list(path.relative_to(SRC).with_suffix("").parts)
    return ".".join(names[:-1] if names[-1] == "__init__" else names)


def imported(path: Path) -> list[tuple[int, str]]:
    """Return (line, module of the package) of each import of deodar in a file: at its top, in functions,
    for types.
    """
    found: list[tuple[int, str]] = []
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            found += [(node.lineno, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            # `from deodar.model import edit` imports deodar.model.edit; a plain name of a module counts as
            # the module
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                found.append((node.lineno, whole if _is_module(whole) else node.module))
    return [
        (line, name.removeprefix("deodar").removeprefix("."))
        for line, name in found
        if name.split(".")[0] == "deodar"
    ]


def _is_module(name: str) -> bool:
    parts = name.split(".")
    if parts[0] != "deodar":
        return False
    path = SRC.joinpath(*parts[1:])
    return path.with_suffix(".py").is_file() or path.is_dir()


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
    kept = [p for p in names if p.is_file() and p.suffix in TEXT and not _left_out(p)]
    return sorted(kept)


def _left_out(path: Path) -> bool:
    """Return whether a file is not a text of the repository: folders of tools, and chunks of records."""
    parts = path.relative_to(ROOT).parts
    return bool(NEVER & set(parts)) or any(part.endswith(".zarr") for part in parts)
