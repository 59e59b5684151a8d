"""Conversion of files of other tools in a child process: importers read what others wrote.

The child returns the document as its file would have it, its arrays, and the report.
"""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType
from typing import TYPE_CHECKING, TypeAlias, TypedDict

from deodar.codec import JsonObject
from deodar.errors import DocumentError
from deodar.guarded.guarded_file import GuardedFile
from deodar.importers._beside import Beside
from deodar.importers.imported import Imported
from deodar.importers.report import ImportReport, Line, Verdict
from deodar.importers.tools import IMPORTERS
from deodar.model import document_files
from deodar.model.model import Model
from deodar.parameters import FrozenArray

if TYPE_CHECKING:
    import numpy as np

SECONDS = 300.0
"""Longest time of a conversion (a guess, many times that of the largest known architecture)."""

MOST_LINES = 50_000
"""Largest number of lines of a report (a guess, many times that of the largest known architecture)."""

LineFields: TypeAlias = "tuple[str, str, str, Verdict, str, str, Sequence[str]]"


class PlainImport(TypedDict):
    """A converted file as plain data.

    Attributes:
        document: the document, without its arrays.
        arrays: its arrays by key.
        tool, file, bugs: those of the report.
        lines: the fields of each `Line` of the report.
    """

    document: JsonObject
    arrays: dict[str, np.ndarray]
    tool: str
    file: str
    bugs: list[str]
    lines: list[LineFields]


def convert(tool: ModuleType, content: bytes, name: str, bugs: bool, beside: Beside) -> Imported:
    """Convert a file of another tool to a model, with a report.

    Args:
        tool: the importer, one of `IMPORTERS`.
        content: content of the file.
        name: its name.
        bugs: whether to reproduce known errors of the tool instead of correcting them.
        beside: returns the content of a file of the same folder.

    Raises:
        DocumentError: the file is broken, or needs too much memory or time; no partial model is returned.
    """
    guard = GuardedFile(DocumentError, "", seconds=SECONDS)
    plain = guard.call(converted, tool.NAME, content, name, bugs, beside)
    arrays = {key: FrozenArray(array) for key, array in plain["arrays"].items()}
    doc = document_files.from_data(plain["document"], arrays)
    trusted = not any(entry.element.external_code() for entry in doc.entries)
    lines = [Line(*fields[:6], tuple(fields[6])) for fields in plain["lines"]]
    report = ImportReport(plain["tool"], plain["file"], lines, plain["bugs"])
    return Imported(Model(document=doc, trusted=trusted), report)


def converted(tool: str, content: bytes, name: str, bugs: bool, beside: Beside) -> PlainImport:
    """Return what the importer of a name makes of a file; in the child."""
    imported = IMPORTERS[tool].read(content, name, bugs, beside)
    lines = imported.report.lines
    if len(lines) > MOST_LINES:
        example = lines[len(lines) // 2]
        raise DocumentError(
            f"its report has {len(lines):,} lines, more than {MOST_LINES:,}; one of them: {example}"
        )
    document, arrays = document_files.to_data(imported.model.document)
    return {
        "document": document,
        "arrays": {key: array.data for key, array in arrays.items()},
        "tool": imported.report.tool,
        "file": imported.report.file,
        "bugs": list(imported.report.bugs),
        "lines": [tuple(vars(line).values()) for line in lines],
    }
