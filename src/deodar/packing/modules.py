"""Modules of the user that a model or a world needs: which they are, and their files.

Modules of deodar and of installed packages are not among them: a document names the packages that it needs.
"""

from __future__ import annotations

import ast
import importlib
import importlib.metadata
import importlib.util
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from deodar import plugins, registry, regular_file
from deodar.errors import DocumentError, Fix, UnknownName, first_line
from deodar.model import document_files
from deodar.model.document import Document
from deodar.model.package_contents import Contents, Module
from deodar.model.parts import foreign_kinds
from deodar.worlds._base import World

CODE = "code"
"""The folder of modules in a package."""


def of_document(doc: Document) -> dict[str, tuple[str, ...]]:
    """Return for each module of the user the classes and functions that a document needs of it."""
    needs: dict[str, dict[str, None]] = {}
    for cls in foreign_kinds(document_files.to_data(doc)[0]):
        if not registry.package(cls.__name__):
            needs.setdefault(cls.__module__, {})[cls.__name__] = None
    for entry in doc.entries:
        module, _, name = entry.element.external_code().partition(":")
        if name and not plugins.is_own(module):
            needs.setdefault(module, {})[name] = None
    return {module: tuple(names) for module, names in needs.items()}


def of_world(world: type[World] | Mapping[str, Any] | None) -> dict[str, tuple[str, ...]]:
    """Return the module of the user that defines a world, given by its class or as a record describes it."""
    if isinstance(world, type):
        module, name = world.__module__, world.__name__
    else:
        module, name = (str((world or {}).get(key, "")) for key in ("module", "world"))
    return {} if not module or plugins.is_own(module) or registry.package(name) else {module: (name,)}


def located(name: str, defines: tuple[str, ...], included: bool) -> tuple[Module, dict[str, Path]]:
    """Return a module of the user, and its files by their names in a package, with those of the modules
    beside it that it imports.

    Args:
        name: the module.
        defines: the names that are needed of it.
        included: whether its files are to be packed.

    Raises:
        DocumentError: it is the script that runs, or its files are not found.
    """
    if name == "__main__":
        raise DocumentError(
            f"{', '.join(defines)} is written in the script itself, which others cannot import",
            fix="Put it into a module of its own and import it",
        )
    installed = _distribution(name)
    if installed or not included:
        return Module(name, defines, (), installed), {}
    top = name.partition(".")[0]
    source = _source(top)
    if source is None:
        raise DocumentError(
            f"the source of the module {name} is not found, so it cannot be included",
            fix=Fix(
                "Import it first, or leave out with_code",
                f"Name it first: deodar --import {name} pack FILE --with-code",
            ),
        )
    root = source.parent
    files = {
        f"{CODE}/{path.relative_to(root).as_posix()}": path for path in sorted(_local(source, root, set()))
    }
    return Module(name, defines, tuple(files)), files


def _distribution(name: str) -> str:
    """Return name and version of the installed distribution of a module; "": it is of none."""
    owners = importlib.metadata.packages_distributions().get(name.partition(".")[0], [])
    return f"{owners[0]} {importlib.metadata.version(owners[0])}" if owners else ""


def _source(top: str) -> Path | None:
    """Return the file of a module, or the folder of a package; None: there is none."""
    try:
        spec = importlib.util.find_spec(top)
    except (ImportError, ValueError):
        return None
    if spec is None or spec.origin is None or not spec.origin.endswith(".py"):
        return None
    file = Path(spec.origin)
    return file.parent if file.name == "__init__.py" else file


def _local(source: Path, root: Path, seen: set[Path]) -> set[Path]:
    """Return the files of a module, and of the modules in the same folder that it imports."""
    for path in sorted(source.rglob("*.py")) if source.is_dir() else [source]:
        if path in seen:
            continue
        seen.add(path)
        for top in _imported(path):
            for beside in (root / f"{top}.py", root / top):
                if beside.is_file() or (beside / "__init__.py").is_file():
                    _local(beside, root, seen)
    return seen


def _imported(path: Path) -> Iterator[str]:
    """Yield the top names of the modules that a file imports."""
    try:
        tree = ast.parse(regular_file.read_bytes(path))
    except (SyntaxError, ValueError):
        return
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module.partition(".")[0]


# -------------------------------------------------------------------------------------------------------- in


def require(contents: Contents, folder: Path, trust: bool) -> None:
    """Make the modules that a package needs importable, or say which are missing.

    Modules of the package are imported only if the user trusts them; others must have been imported.

    Args:
        contents: what the package states.
        folder: the folder of the unpacked package.
        trust: whether the modules in it may be imported and run.

    Raises:
        DocumentError: modules are missing, or not trusted; the error lists all.
    """
    missing = [module for module in contents.modules if module.name not in sys.modules]
    included = [module for module in missing if module.files]
    others = [module for module in missing if not module.files]
    if others:
        listed = ", ".join(f"{m.name} ({', '.join(m.defines)})" for m in others)
        installed = [m.distribution for m in others if m.distribution]
        name = others[0].name
        raise DocumentError(
            f"needs {listed}, which the package does not include",
            fix=Fix(f"Import it first: import {name}", f"Name it: deodar --import {name} ...")
            if not installed
            else f"If you trust it, type: pip install {installed[0].replace(' ', '==')}",
        )
    if not included:
        return
    if not trust:
        listed = ", ".join(file for module in included for file in module.files)
        raise DocumentError(
            f"needs {', '.join(m.name for m in included)}, which comes with it and is not run unasked",
            fix=Fix(
                f"Read {listed}; if you trust it: trust=True", f"Read {listed}; if you trust it, add --trust"
            ),
        )
    sys.path.insert(0, str((folder / CODE).resolve()))
    for module in included:
        try:
            importlib.import_module(module.name)
        except Exception as error:  # a module may raise any exception
            raise UnknownName(
                f"the module {module.name} of the package cannot be imported ({type(error).__name__}:"
                f" {first_line(error)})"
            ) from None
