"""The content of a file that has no place below the root: it was dropped on the page or chosen elsewhere."""

from __future__ import annotations

from deodar.errors import DocumentError
from deodar.importers import opening
from deodar.model import files
from deodar.model.document import Document


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
