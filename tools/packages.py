"""Check that the packages of `src` meet the engine by entry points alone.

    python tools/packages.py            a line for each package; status 1 if a rule is broken
    python tools/packages.py --list     also every import of the engine's modules, by package

The rules: the engine (`src/deodar`) imports no package beside it and names none; a package imports the
engine and what `NEEDS` states, nothing else of deodar; a module name has one meaning inside a package
(`ROLES`, `SUBJECTS`). `tools/measure.py` looks for cycles of imports.
"""

from __future__ import annotations

import argparse
import ast
import collections
import fnmatch
import functools
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SRC = ROOT / "src"
ENGINE = "deodar"

NEEDS: Mapping[str, frozenset[str]] = {"deodar_papers": frozenset({"deodar_robots"})}
"""The packages that a package imports besides the engine."""

WORDS: Mapping[str, str] = {
    "deodar_interop": "cedar|cosivina|dnf.composer|matlab",
    "deodar_papers": "reproduce",
    "deodar_robots": "mujoco|gymnasium|zenoh|ros2|ros.?bag|event.?file|aedat",
    "deodar_spikes": "neuromorphic|nir|norse|spiking",
    "deodar_studio": "studio",
}
"""Words by which code refers to a package, besides its name."""

ROLES: Mapping[str, tuple[str, ...]] = {
    "what the kinds of a folder share": (
        "deodar/numerics/kernels/_base",
        "deodar/worlds/_base",
    ),
    "a part of a measurement of a field in stages": ("deodar/analysis/maps/*", "deodar/analysis/tuning/*"),
    "the tools by name": ("deodar/importers/tools", "deodar/exporters/tools"),
    "a tool": (
        "deodar_interop/compat/*",
        "deodar_interop/exporters/*",
        "deodar_interop/importers/*",
        "deodar_interop/records/*",
    ),
    "a part of an importer": ("deodar_interop/importers/*/*",),
    "the classes of a tool": ("deodar_interop/importers/*/classes", "deodar_interop/exporters/*/classes"),
    "a family of classes": ("deodar_interop/importers/*/classes/*", "deodar_interop/exporters/*/classes/*"),
    "a part of a paper": tuple(
        f"deodar_papers/{paper}/*"
        for paper in ("looking", "pointing", "saliency", "serial_order", "spa", "story")
    ),
    "figures of papers": ("deodar_papers/figures", "deodar_papers/*/figures"),
}
"""Modules that may share a name, by what they are: their places in `src`; `*` is one folder or module."""

SUBJECTS: Mapping[str, str] = {
    "deodar/cli/*": "deodar",
    "deodar/couplings/*": "deodar/numerics",
    "deodar/elements/*": "deodar/numerics",
    "deodar/figures/*": "deodar",
    "deodar/model/checks/*": "deodar/numerics",
    "deodar_papers/commands/*": "deodar_papers",
    "deodar_papers/figures/*": "deodar_papers",
}
"""Places of modules that are named after a subject, and the folder in which the subject may be: a command
runs it, a figure draws it, a check is about it, an element or a coupling applies it.
"""


@dataclass(frozen=True)
class Import:
    """An import of a module of deodar.

    Attributes:
        path: the file with the import.
        line: its line.
        module: dotted name of the importing module.
        target: dotted name of the imported module.
    """

    path: Path
    line: int
    module: str
    target: str

    def __str__(self) -> str:
        return f"{self.path.relative_to(ROOT)}:{self.line} imports {self.target}"


def packages(source: Path | None = None) -> list[str]:
    """Return the names of the import packages in a folder, by default `src`, the engine first."""
    return sorted(p.name for p in (source or SRC).glob(f"{ENGINE}*") if (p / "__init__.py").is_file())


def modules(package: str) -> list[Path]:
    """Return the files of a package."""
    return sorted((SRC / package).rglob("*.py"))


@functools.cache
def tree(path: Path) -> ast.Module:
    """Return the syntax tree of a file."""
    return ast.parse(path.read_text(encoding="utf-8"), str(path))


def dotted(path: Path) -> str:
    """Return the dotted name of a module in `src`."""
    names = list(path.relative_to(SRC).with_suffix("").parts)
    return ".".join(names[:-1] if names[-1] == "__init__" else names)


def is_module(name: str) -> bool:
    """Return whether a dotted name is a module in `src`."""
    path = SRC.joinpath(*name.split("."))
    return path.with_suffix(".py").is_file() or (path / "__init__.py").is_file()


def package_of(name: str) -> str:
    """Return the import package of a dotted name."""
    return name.partition(".")[0]


def imports(path: Path) -> list[tuple[int, str]]:
    """Return line and module of each import in a file: at its top, in functions, for types.

    `from deodar.model import edit` imports `deodar.model.edit`; a name that is not a module counts as the
    module that holds it.
    """
    rows: list[tuple[int, str]] = []
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            rows += [(node.lineno, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                rows.append((node.lineno, whole if is_module(whole) else node.module))
    return rows


def imports_of_deodar(package: str) -> Iterator[Import]:
    """Yield the imports of deodar's modules in a package."""
    known = set(packages())
    for path in modules(package):
        for line, target in imports(path):
            if package_of(target) in known:
                yield Import(path, line, dotted(path), target)


def allowed(package: str, target: str) -> bool:
    """Return whether a package may import a module of deodar."""
    other = package_of(target)
    return other == package or (
        package != ENGINE and (other == ENGINE or other in NEEDS.get(package, frozenset()))
    )


def wrong_arrows() -> list[Import]:
    """Return the imports that point the wrong way."""
    return [i for package in packages() for i in imports_of_deodar(package) if not allowed(package, i.target)]


def _docstrings(module: ast.Module) -> set[int]:
    """Return the ids of the strings that stand alone: docstrings, of attributes too."""
    return {
        id(node.value)
        for node in ast.walk(module)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }


def _texts(module: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield line and text of each name and one-word string in the code of a module.

    Sentences are left out: a message says what to do in a script, in the shell and in the studio.
    """
    docstrings = _docstrings(module)
    for node in ast.walk(module):
        match node:
            case ast.Constant(value=str(text)) if id(node) not in docstrings and " " not in text:
                yield node.lineno, text
            case ast.Name(id=text) | ast.Attribute(attr=text) | ast.arg(arg=text):
                yield node.lineno, text
            case ast.FunctionDef(name=text) | ast.AsyncFunctionDef(name=text) | ast.ClassDef(name=text):
                yield node.lineno, text
            case ast.keyword(arg=str(text)):
                yield node.value.lineno, text
            case _:
                pass


def mentions() -> list[str]:
    """Return a line for each name of a package in the code of the engine; imports are arrows."""
    words = "|".join(f"{package}|{words}" for package, words in WORDS.items())
    pattern = re.compile(rf"(?<![a-z])(?:{words})(?![a-z])", re.IGNORECASE)
    return [
        f"{path.relative_to(ROOT)}:{line}: {text.strip().splitlines()[0][:60]!r}"
        for path in modules(ENGINE)
        for line, text in _texts(tree(path))
        if pattern.search(text)
    ]


def places(package: str) -> dict[str, list[str]]:
    """Return the places of each module name of a package, folders too: `axes`: [`deodar/numerics/axes`, ...].

    A file that its folder is named after (`eye/eye.py`) counts as the folder.
    """
    out: dict[str, list[str]] = {}
    for path in modules(package):
        place = path.relative_to(SRC).with_suffix("")
        if place.name == "__init__":
            place = place.parent
        elif place.name == place.parent.name:
            continue
        if place.name == package:
            continue
        out.setdefault(place.name, []).append(place.as_posix())
    return out


def matches(place: str, pattern: str) -> bool:
    """Return whether a place has the form of a pattern, folder by folder."""
    parts, forms = place.split("/"), pattern.split("/")
    return len(parts) == len(forms) and all(map(fnmatch.fnmatchcase, parts, forms))


def _roles(place: str) -> set[str]:
    return {role for role, patterns in ROLES.items() if any(matches(place, p) for p in patterns)}


def _has_its_subject(place: str, among: Sequence[str]) -> bool:
    """Return whether a module is named after one of other modules, the places of its name."""
    folders = [folder for pattern, folder in SUBJECTS.items() if matches(place, pattern)]
    return any(other.startswith(f"{f}/") for f in folders for other in among if other != place)


def ambiguous(named: Mapping[str, Sequence[str]]) -> dict[str, list[str]]:
    """Return the names whose places neither have one role nor are named after one subject.

    Args:
        named: places by name, as `places` returns them.
    """
    out: dict[str, list[str]] = {}
    for name, found in named.items():
        subjects = [place for place in found if not _has_its_subject(place, found)]
        if len(subjects) > 1 and not set.intersection(*map(_roles, subjects)):
            out[name] = sorted(found)
    return out


def ambiguous_names() -> list[str]:
    """Return a line for each module name with several meanings in its package."""
    return [
        f"{name}: {', '.join(found)}"
        for package in packages()
        for name, found in sorted(ambiguous(places(package)).items())
    ]


def report(names: Sequence[str]) -> Iterator[str]:
    """Yield a line for each package: files, lines, and the engine's modules that it imports."""
    for package in names:
        files = modules(package)
        lines = sum(path.read_text(encoding="utf-8").count("\n") for path in files)
        targets = collections.Counter(package_of(i.target) for i in imports_of_deodar(package))
        engine = {i.target for i in imports_of_deodar(package) if package_of(i.target) == ENGINE}
        others = ", ".join(name for name in targets if name not in (package, ENGINE))
        about = f", imports {len(engine)} modules of the engine" if package != ENGINE else ""
        yield f"{package:16}{len(files):4} files{lines:8} lines{about}{f' and {others}' if others else ''}"


def main(argv: Sequence[str] | None = None) -> int:
    """Print the report; status 1 if a rule is broken."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--list", action="store_true", help="list the imports of the engine's modules")
    args = parser.parse_args(argv)
    for line in report(packages()):
        print(line)
    if args.list:
        for package in packages()[1:]:
            for target in sorted({i.target for i in imports_of_deodar(package)}):
                print(f"  {package} -> {target}")
    arrows, named, several = wrong_arrows(), mentions(), ambiguous_names()
    print(f"{len(arrows)} wrong arrows", *(f"  {arrow}" for arrow in arrows), sep="\n")
    print(f"{len(named)} names of packages in the engine", *(f"  {line}" for line in named), sep="\n")
    print(f"{len(several)} module names with several meanings", *(f"  {line}" for line in several), sep="\n")
    return int(bool(arrows or named or several))


if __name__ == "__main__":
    sys.exit(main())
