"""What is opened: files below the root, and the content of a file that has no place there because it was dropped on the page."""

from __future__ import annotations

from pathlib import Path

from deodar.errors import DocumentError
from deodar.importers import examples, opening
from deodar.model import files
from deodar.model.document import Document
from deodar.server.workspace import Workspace


def read(text: str, title: str) -> Document:
    """A document of our own, or a file of another tool, given as text; arrays in a file beside it are refused."""
    tool = opening.tool_for(text.encode())
    if tool is not None:
        return tool.read(text.encode(), title).model.document
    data = files.parse(text)
    if isinstance(data, dict) and "arrays" in data:
        fix = "Put both files below the studio's folder and open the document by its name"
        raise DocumentError("has its arrays in a file beside it, which was not dropped with it", where=title, fix=fix)
    return files.from_data(data, {})


def load(space: Workspace, place: Path) -> Document:
    """A document of our own, or a file of another tool, at a place that the workspace gave."""
    _require(space, place)
    return opening.load(place).document


def is_foreign(space: Workspace, place: Path) -> bool:
    """Whether a file is of another tool; what cannot be read is not."""
    try:
        _require(space, place)
    except DocumentError:
        return False  # what is wrong with it, reading it says
    return opening.tool_of(place) is not None


def _require(space: Workspace, place: Path) -> None:
    if space.holds(place) or not examples.holds(place):  # an example may have been named on the command line
        space.require_file(place)
