"""A document and its arrays in one file, `NAME.deodar`.

The file is a zip file that contains `NAME.json` and the array file which the document names.

Reading trusts no content: a package contains these two files only, under plain names, and no more bytes than
its table of contents states.
"""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import BinaryIO

from deodar.errors import DocumentError

SUFFIX = ".deodar"
MAGIC = b"PK\x03\x04"
"""First bytes of a package."""

EMPTY = b"PK\x05\x06"
"""First bytes of an empty zip file."""

DATE = (1980, 1, 1, 0, 0, 0)
"""Date of every entry: constant, so that the same document gives the same bytes."""


def pack(entries: Mapping[str, bytes]) -> bytes:
    """Return the content of a package that contains these files."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as z:
        for name, content in entries.items():
            z.writestr(
                zipfile.ZipInfo(name, DATE),
                content,
                zipfile.ZIP_DEFLATED if name.endswith(".json") else zipfile.ZIP_STORED,
            )
    return buffer.getvalue()


def is_package(path: Path) -> bool:
    """Return whether a file is a zip file, by its first bytes."""
    with path.open("rb") as file:
        return is_content(file.read(4))


def is_content(content: bytes) -> bool:
    """Return whether content, or its beginning, is that of a zip file."""
    return content[:4] in (MAGIC, EMPTY)


class Package:
    """A package that is open for reading.

    Args:
        file: the path of the file, or the open file.
        most: largest size of the document in bytes.
        require_room: called with the size in bytes and the name of each entry; raises if it does not fit into
            memory.

    Attributes:
        document: name of the document in the package.

    Raises:
        DocumentError: the file is damaged, or contains something else than a document.
    """

    def __init__(self, file: Path | BinaryIO, most: int, require_room: Callable[[int, str], None]) -> None:
        try:
            self._zip = zipfile.ZipFile(file)
        except (zipfile.BadZipFile, ValueError, NotImplementedError) as error:
            raise DocumentError(f"is damaged: it cannot be read as a package ({error})") from None
        self._entries = {entry.filename: entry for entry in self._zip.infolist()}
        self._require_room = require_room
        if len(self._entries) < len(self._zip.infolist()):
            raise DocumentError("holds a file twice")
        for name, entry in self._entries.items():
            if (
                "/" in entry.orig_filename
                or "\\" in entry.orig_filename
                or ":" in name
                or name != Path(name).name
            ):
                raise DocumentError(f"holds {name!r}, which lies outside the folder of the document")
            if entry.flag_bits & 1:
                raise DocumentError(f"holds {name!r}, which is encrypted")
        documents = [name for name in self._entries if name.endswith(".json")]
        if len(documents) != 1:
            raise DocumentError(
                f"holds {len(documents)} documents" if documents else "holds no document",
                fix="A package holds one: deodar pack FILE",
            )
        self.document = documents[0]
        size = self._entries[self.document].file_size
        if size > most:
            raise DocumentError(
                f"holds a document of {size / 2**20:.0f} MiB; a document has at most {most // 2**20}"
            )

    def __enter__(self) -> Package:
        return self

    def __exit__(self, *_: object) -> None:
        self._zip.close()

    def require_only(self, arrays: str) -> None:
        """Refuse a package that contains a file other than the document and its array file."""
        strange = [name for name in self._entries if name not in (self.document, arrays)]
        if strange:
            raise DocumentError(f"holds {strange[0]!r}, which the document does not name")

    def read(self, name: str) -> bytes | None:
        """Return the content of a file in the package; None if the package has no file of that name."""
        entry = self._entries.get(name)
        if entry is None:
            return None
        self._require_room(entry.file_size, name)
        try:
            with self._zip.open(entry) as file:
                content = file.read(entry.file_size + 1)
        except (
            zipfile.BadZipFile,
            zlib.error,
            EOFError,
            NotImplementedError,
            RuntimeError,
            ValueError,
        ) as error:
            raise DocumentError(f"is damaged: {name!r} cannot be read ({error})") from None
        if len(content) != entry.file_size:
            raise DocumentError(f"is damaged: {name!r} is not as long as the package says")
        return content
