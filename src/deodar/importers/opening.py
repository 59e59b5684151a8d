"""Load a model from any supported file format: deodar's documents, and files of other tools."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

from deodar import regular_file
from deodar.errors import DocumentError, reading
from deodar.importers import examples
from deodar.importers._beside import in_folder
from deodar.importers.conversion import convert
from deodar.importers.imported import Imported
from deodar.importers.tools import IMPORTERS
from deodar.model import model as models
from deodar.model.document_files import MOST_BYTES
from deodar.model.model import Model

HEAD = 65536
"""Number of bytes by which the format of a file is recognised."""

OWN = b'"deodar":'
"""First bytes of deodar's documents."""


def endings() -> tuple[str, ...]:
    """Return the endings of file names, besides `.json`, that the importers state in `ENDINGS`."""
    found = (ending for tool in IMPORTERS.values() for ending in getattr(tool, "ENDINGS", ()))
    return tuple(dict.fromkeys(found))


def require(path: str | Path) -> Path:
    """Return the path of a file to open; `example:NAME` gives the document of an example.

    Raises:
        DocumentError: the file does not exist; the error suggests an example or a document in the same folder
            with a similar name.
        UnknownName: no example has that name.
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
    """Return the importer for the content of a file; None for deodar's documents and unknown formats."""
    if not isinstance(path, (str, Path)):
        return None
    try:
        if not Path(path).is_file():
            return None
        with regular_file.open_binary(path) as file:
            return tool_for(file.read(HEAD))
    except (OSError, ValueError):
        return None


def tool_for(content: bytes) -> ModuleType | None:
    """Return the importer for the content of a file, or for the beginning of the content."""
    head = content[:HEAD]
    if OWN in head[:200]:
        return None
    return next((tool for tool in IMPORTERS.values() if tool.sniff(head)), None)


def read(path: str | Path, bugs: bool = False) -> Imported:
    """Convert a file of another tool to a model, with a report.

    Args:
        path: the file.
        bugs: whether to reproduce known errors of the tool instead of correcting them.

    Raises:
        DocumentError: no importer recognises the file, or it is broken; no partial model is returned.
    """
    path = require(path)
    with reading(path, DocumentError):
        if not path.is_file():
            raise DocumentError("is not a file")
        tool = tool_of(path)
        if tool is None:
            raise DocumentError(
                "is not a file of a tool that deodar imports",
                fix=f"Tools: {', '.join(IMPORTERS)}. Documents of deodar need no import",
            )
        size = path.stat().st_size
        if size > MOST_BYTES:
            raise DocumentError(f"is {size / 2**20:.0f} MiB; at most {MOST_BYTES // 2**20} are read")
        return convert(tool, regular_file.read_bytes(path), path.name, bugs, in_folder(path.parent))


def load(path: str | Path, trust: bool = False, bugs: bool = False) -> Model:
    """Read a document, or a file of cosivina or dnf-composer; the notes list what was not converted.

    Args:
        path: the file, or `example:NAME` for an example of deodar.
        trust: whether a document may import and run the functions it names.
        bugs: whether to reproduce known errors of the other tool instead of correcting them.

    Raises:
        DocumentError: the file has problems; the error lists all, each with its path.
    """
    if isinstance(path, (str, Path)):
        path = require(path)
    return read(path, bugs).model if tool_of(path) is not None else models.load(path, trust)
