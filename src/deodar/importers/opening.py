"""Opening a file, whosever it is: our own documents, and the files of other tools by what they hold."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

from deodar import plugins, registry
from deodar.errors import DeodarError, DocumentError, Problem
from deodar.importers import examples
from deodar.importers.imported import Imported
from deodar.model import model as models
from deodar.model.files import MOST_BYTES
from deodar.model.model import Model
from deodar.plugins import Plugin

HEAD = 65536
"""Bytes by which a file is told."""

OWN = b'"deodar":'
"""What our own documents begin with."""


def tools() -> dict[str, ModuleType]:
    """The importers by name: every folder beside this file, and those of installed packages.

    Each has `NAME`, `sniff(head) -> bool` and `read(content, name, bugs) -> Imported`.
    """
    outside = {p.name: p.load() for p in packaged() if not p.problem}
    return own() | {name: module for name, (module, problem) in outside.items() if not problem}


def own() -> dict[str, ModuleType]:
    """The importers that come with deodar."""
    found = [importlib.import_module(name) for name in registry.modules("importers")]
    return {module.NAME: module for module in found if hasattr(module, "sniff")}


def packaged() -> list[Plugin]:
    """The importers that installed packages name, without importing them."""
    return plugins.found("importers", list(own()))


def require(path: str | Path) -> Path:
    """Return the path of a file that is to be opened; `example:NAME` stands for an example.

    Raises:
        DocumentError: there is no such file; an example or a document in its folder with a similar name is
            suggested.
        UnknownName: there is no example of that name.
    """
    path = examples.named(path)
    try:
        missing = not path.exists()
    except (OSError, ValueError) as error:
        raise DocumentError(
            f"cannot be read: {getattr(error, 'strerror', None) or error}", where=str(path)
        ) from None
    if missing:
        raise DocumentError("there is no such file", where=str(path), fix=examples.near(path))
    return path


def tool_of(path: str | Path) -> ModuleType | None:
    """The importer that knows a file, by what it holds; None for our own documents and for what nobody
    knows.
    """
    if not isinstance(path, (str, Path)):
        return None
    try:
        if not Path(path).is_file():
            return None
        with open(path, "rb") as file:
            return tool_for(file.read(HEAD))
    except (OSError, ValueError):
        return None


def tool_for(content: bytes) -> ModuleType | None:
    """The importer that knows a file by its content, or by the beginning of it."""
    head = content[:HEAD]
    if OWN in head[:200]:
        return None
    return next((tool for tool in tools().values() if tool.sniff(head)), None)


def read(path: str | Path, bugs: bool = False) -> Imported:
    """A file of another tool as a model, with a report.

    Args:
        path: the file.
        bugs: whether known errors of the tool are reproduced instead of corrected.

    Raises:
        DocumentError: if no importer knows the file, or if it is broken; nothing is half-read.
    """
    path = require(path)
    try:
        if not path.is_file():
            raise DocumentError("is not a file")
        tool = tool_of(path)
        if tool is None:
            raise DocumentError(
                "is of no tool that can be imported",
                fix=f"There is: {', '.join(tools())}. Our own documents need no import",
            )
        size = path.stat().st_size
        if size > MOST_BYTES:
            raise DocumentError(f"is {size / 2**20:.0f} MiB; at most {MOST_BYTES // 2**20} are read")
        return tool.read(path.read_bytes(), path.name, bugs)
    except DeodarError as error:
        raise DocumentError(
            [Problem(f"{path}: {p.where}" if p.where else str(path), p.what, p.fix) for p in error.problems]
        ) from None
    except OSError as error:
        raise DocumentError(f"cannot be read: {error.strerror}", where=str(path)) from None


def load(path: str | Path, trust: bool = False, bugs: bool = False) -> Model:
    """Read a document, or a file of another tool (cosivina); what could not be carried stands in the model's
    notes.

    Args:
        path: the file, or `example:NAME` for an example that comes with deodar.
        trust: whether a document may import and run the functions it names.
        bugs: whether known errors of the other tool are reproduced instead of corrected.

    Raises:
        DocumentError: with every problem found, each with its path.
    """
    if isinstance(path, (str, Path)):
        path = require(path)
    return read(path, bugs).model if tool_of(path) is not None else models.load(path, trust)
