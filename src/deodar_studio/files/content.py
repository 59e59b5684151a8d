"""Read documents: from files below the root, and from the content of files that were dropped on the page.

Files are read through an open folder (`OpenFolder`), so that a path that becomes a link after its check is
not followed.
"""

from __future__ import annotations

import base64
import binascii
import re
from collections.abc import Callable
from pathlib import Path

from deodar.errors import DeodarError, DocumentError, did_you_mean, reading
from deodar.importers import conversion, examples, opening, stored_report
from deodar.importers.imported import Imported
from deodar.model import document_files, package
from deodar.model.document import Document
from deodar.model.document_files import MOST_BYTES
from deodar_studio.files.open_folder import OpenFolder
from deodar_studio.files.workspace import DOCUMENTS, Workspace

_EXPERIMENT = re.compile(rb'\s*\{\s*"experiment"\s*:')


def read(text: str, title: str) -> Document:
    """Read a document of deodar or a file of another tool, given as text.

    Raises:
        DocumentError: the text is invalid, or its arrays are in a second file.
    """
    return _document(text.encode(), title, _nothing)


def read_package(content: str, title: str) -> Document:
    """Read a package (`NAME.deodar`), given as base64."""
    try:
        data = base64.b64decode(content, validate=True)
    except (binascii.Error, ValueError):
        raise DocumentError("the content is not base64", where=title) from None
    if not package.is_content(data):
        raise DocumentError(
            "is not a package",
            where=title,
            fix="deodar pack FILE makes one; a document without arrays ends in .json",
        )
    return document_files.loads(data, lambda name: None)


def load(space: Workspace, place: Path) -> Document:
    """Read a document of deodar or a file of another tool, at a path that the workspace returned.

    The document of an imported file contains the report (`stored_report`).
    """
    if _is_example(space, place):
        return opening.load(place).document if opening.tool_of(place) is None else _kept(opening.read(place))
    with reading(place, DocumentError):
        try:
            with space.folder(place) as folder:
                return _document(_content(folder, place.name), place.name, lambda name: _beside(folder, name))
        except FileNotFoundError:
            raise DocumentError("there is no such file", fix=_near(place)) from None


def is_foreign(space: Workspace, place: Path) -> bool:
    """Return whether a file is of another tool; False if it cannot be read."""
    if _is_example(space, place):
        return opening.tool_of(place) is not None
    try:
        with space.folder(place) as folder, folder.open(place.name) as (file, _):
            return opening.tool_for(file.read(opening.HEAD)) is not None
    except (OSError, DeodarError):
        return False  # `load` raises the error


def is_experiment(space: Workspace, place: Path) -> bool:
    """Return whether a file is an experiment, by its first key; False if it cannot be read."""
    try:
        with space.folder(place) as folder, folder.open(place.name) as (file, _):
            return _EXPERIMENT.match(file.read(opening.HEAD)) is not None
    except (OSError, DeodarError):
        return False  # `load` raises the error


def _is_example(space: Workspace, place: Path) -> bool:
    """Return whether a path is an example outside the workspace, as the command line may name one."""
    return not space.holds(place) and examples.holds(place)


def _document(content: bytes, title: str, beside: Callable[[str], bytes | None]) -> Document:
    tool = opening.tool_for(content)
    if tool is None:
        return document_files.loads(content, beside)
    return _kept(conversion.convert(tool, content, title, False, beside))


def _kept(done: Imported) -> Document:
    """Return an imported document with its report."""
    return stored_report.with_report(done.model.document, done.report)


def _content(folder: OpenFolder, name: str) -> bytes:
    """Return the content of a document or package."""
    with folder.open(name) as (file, size):
        head = file.read(4)
        if package.is_content(head):
            document_files.require_room(size, name)
        elif size > MOST_BYTES:
            raise DocumentError(f"is {size / 2**20:.0f} MiB; a document has at most {MOST_BYTES // 2**20}")
        return head + file.read(size)


def _beside(folder: OpenFolder, name: str) -> bytes | None:
    """Return the content of the array file of a document; None if the file does not exist."""
    try:
        with folder.open(name) as (file, size):
            document_files.require_room(size, name)
            return file.read(size)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise DocumentError(
            f"the array file {name!r} cannot be read: {error.strerror}", where="arrays"
        ) from None


def _nothing(name: str) -> bytes | None:
    fix = (
        "Put both files below the studio's folder and open the document by its name, or drop a package"
        " (deodar pack FILE)"
    )
    raise DocumentError(
        "has its arrays in a file beside it, which was not dropped with it", where=name, fix=fix
    )


def _near(place: Path) -> str:
    """Return a hint at a file of the same folder with a similar name."""
    try:
        return did_you_mean(
            place.name, [path.name for path in place.parent.iterdir() if path.suffix.lower() in DOCUMENTS]
        )
    except OSError:
        return ""
