"""Something to pass on in one file, `NAME.deodar`.

The file is a zip file. That of a document which needs no code of its user contains `NAME.json` and the array
file which the document names. Any other begins with `contents.json`, which says what is in it (`Contents`),
with the size and the SHA-256 of every other entry.

Reading trusts no content: names are plain paths inside the package, and no entry is longer than stated.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import zipfile
import zlib
from collections.abc import Callable, Generator, Mapping
from pathlib import Path, PurePosixPath
from typing import BinaryIO

from deodar import codec, regular_file
from deodar.errors import DocumentError, Fix
from deodar.model.package_contents import CONTENTS, Contents, PackedFile

SUFFIX = ".deodar"
MAGIC = b"PK\x03\x04"
"""First bytes of a package."""

EMPTY = b"PK\x05\x06"
"""First bytes of an empty zip file."""

DATE = (1980, 1, 1, 0, 0, 0)
"""Date of every entry: constant, so that equal contents give the same bytes."""

TEXTS = (".json", ".jsonl", ".csv", ".toml", ".py")
"""Endings of entries that are compressed; arrays and records are so already."""

BLOCK = 2**20
MOST_CONTENTS = 64 * 2**20
"""Largest size of `contents.json` in bytes, enough for some 300,000 entries (a guess)."""


def pack(entries: Mapping[str, bytes]) -> bytes:
    """Return the content of a package of these files."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as z:
        for name, content in entries.items():
            z.writestr(_entry(name), content, _compression(name))
    return buffer.getvalue()


def write(path: Path, contents: Contents, files: Mapping[str, Path | bytes]) -> None:
    """Write a package of files that need not fit into memory; `contents` states them after the call.

    Args:
        path: the file, which is replaced.
        contents: what is in the package; its `files` are those that are written.
        files: content, or place, of each entry.
    """
    stated = {name: stated_entry(content) for name, content in files.items()}
    complete = contents.of(stated)
    with zipfile.ZipFile(path, "w") as z:
        z.writestr(_entry(CONTENTS), codec.text(complete.to_data()) + "\n", zipfile.ZIP_DEFLATED)
        for name, content in files.items():
            if isinstance(content, bytes):
                z.writestr(_entry(name), content, _compression(name))
                continue
            entry = _entry(name)
            entry.compress_type = _compression(name)
            with regular_file.open_binary(content) as source, z.open(entry, "w", force_zip64=True) as target:
                while block := source.read(BLOCK):
                    target.write(block)


def stated_entry(content: Path | bytes) -> PackedFile:
    """Return the size and the SHA-256 of a file or of bytes."""
    if isinstance(content, bytes):
        return PackedFile(len(content), hashlib.sha256(content).hexdigest())
    with regular_file.open_binary(content) as file:
        return PackedFile(content.stat().st_size, hashlib.file_digest(file, "sha256").hexdigest())


def _entry(name: str) -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo(name, DATE)
    entry.create_system, entry.external_attr = 3, 0o644 << 16  # the same bytes on every system
    return entry


def _compression(name: str) -> int:
    return zipfile.ZIP_DEFLATED if name.endswith(TEXTS) else zipfile.ZIP_STORED


def is_package(path: Path) -> bool:
    """Return whether a file is a zip file, by its first bytes."""
    with regular_file.open_binary(path) as file:
        return is_content(file.read(4))


def is_content(content: bytes) -> bool:
    """Return whether content, or its beginning, is that of a zip file."""
    return content[:4] in (MAGIC, EMPTY)


class Package:
    """A package that is open for reading.

    Args:
        file: the path of the file, or the open file.

    Attributes:
        contents: what is in it.

    Raises:
        DocumentError: the file is damaged, or no package of deodar.
    """

    def __init__(self, file: Path | BinaryIO) -> None:
        try:
            self._zip = zipfile.ZipFile(file)
        except (zipfile.BadZipFile, ValueError, NotImplementedError) as error:
            raise DocumentError(f"is damaged: it cannot be read as a package ({error})") from None
        self._entries = {entry.filename: entry for entry in self._zip.infolist()}
        if len(self._entries) < len(self._zip.infolist()):
            raise DocumentError("holds a file twice")
        for name, entry in self._entries.items():
            if not is_inside(name) or "\\" in entry.orig_filename:
                raise DocumentError(f"holds {name!r}, which lies outside the package")
            if entry.flag_bits & 1:
                raise DocumentError(f"holds {name!r}, which is encrypted")
            if entry.header_offset < 0:
                raise DocumentError(f"is damaged: the table of contents places {name!r} before its beginning")
        self.contents = self._stated() if CONTENTS in self._entries else self._of_document()

    def __enter__(self) -> Package:
        return self

    def __exit__(self, *_: object) -> None:
        self._zip.close()

    def _stated(self) -> Contents:
        entry = self._entries[CONTENTS]
        if entry.file_size > MOST_CONTENTS:
            raise DocumentError(f"{CONTENTS} has {entry.file_size / 2**20:.0f} MiB")
        contents = Contents.from_data(codec.read(self._content(entry)))
        for name in [name for name in (contents.path, *contents.files) if not is_inside(name)]:
            raise DocumentError(f"{name!r} lies outside the package", where=CONTENTS)
        for name in sorted({*self._entries, *contents.files} - {CONTENTS}):
            stated, present = contents.files.get(name), self._entries.get(name)
            if stated is None:
                raise DocumentError(f"holds {name!r}, which {CONTENTS} does not name")
            if present is None:
                raise DocumentError(f"lacks {name!r}, which {CONTENTS} names")
            if present.file_size != stated.size:
                raise DocumentError(f"is damaged: {name!r} is not as long as {CONTENTS} says")
        return contents

    def _of_document(self) -> Contents:
        """Return the contents of the package of a document alone."""
        documents = [name for name in self._entries if name.endswith(".json")]
        strange = [name for name in self._entries if "/" in name]
        if strange:
            raise DocumentError(f"holds {strange[0]!r}, which the document does not name")
        if len(documents) != 1:
            raise DocumentError(
                f"holds {len(documents)} documents" if documents else "holds no document",
                fix=Fix("A package is made by dd.pack(PATH)", "A package is made by: deodar pack FILE"),
            )
        return Contents("document", documents[0])

    @property
    def names(self) -> list[str]:
        """Names of the entries other than the contents."""
        return [name for name in self._entries if name != CONTENTS]

    @property
    def size(self) -> int:
        """Bytes that the entries have together when they are unpacked."""
        return sum(self._entries[name].file_size for name in self.names)

    def document(self, most: int) -> bytes:
        """Return the text of the document that is packed.

        Args:
            most: largest size in bytes.

        Raises:
            DocumentError: something else is packed, or the document is larger or damaged.
        """
        name = self.contents.path
        if self.contents.kind != "document" or name not in self._entries:
            raise DocumentError(
                f"is a package that holds {self.contents.noun}, not a model",
                fix=Fix(
                    "Unpack it: dd.unpack(FILE)",
                    "See what is inside: deodar open FILE",
                    "Open it by its name",
                ),
            )
        size = self._entries[name].file_size
        if size > most:
            raise DocumentError(
                f"holds a document of {size / 2**20:.0f} MiB; a document has at most {most // 2**20}"
            )
        return self.read(name, lambda *_: None) or b""

    def require_only(self, arrays: str) -> None:
        """Refuse a package without contents that has a file other than the document and its array file."""
        stated = self.contents.files
        strange = [n for n in self.names if n not in stated and n not in (self.contents.path, arrays)]
        if strange:
            raise DocumentError(f"holds {strange[0]!r}, which the document does not name")

    def read(self, name: str, require_room: Callable[[int, str], None]) -> bytes | None:
        """Return the content of an entry; None if the package has no entry of that name.

        Args:
            name: the name of the entry.
            require_room: called with its size in bytes and its name; raises if it does not fit into memory.
        """
        entry = self._entries.get(name)
        if entry is None:
            return None
        require_room(entry.file_size, name)
        content = self._content(entry)
        stated = self.contents.files.get(name)
        if stated is not None and stated_entry(content) != stated:
            raise _changed(name)
        return content

    def extract(self, name: str, target: Path) -> None:
        """Write an entry into a new file, and compare it with what the contents state."""
        entry, digest = self._entries[name], hashlib.sha256()
        with _reading(name), self._zip.open(entry) as source, target.open("xb") as file:
            missing = entry.file_size
            while block := source.read(min(BLOCK, missing + 1)):
                missing -= len(block)
                if missing < 0:
                    break
                digest.update(block)
                file.write(block)
        stated = self.contents.files.get(name)
        if missing or (stated is not None and digest.hexdigest() != stated.sha256):
            raise _changed(name)

    def _content(self, entry: zipfile.ZipInfo) -> bytes:
        with _reading(entry.filename), self._zip.open(entry) as file:
            content = file.read(entry.file_size + 1)
        if len(content) != entry.file_size:
            raise DocumentError(f"is damaged: {entry.filename!r} is not as long as the package says")
        return content


def is_inside(name: str) -> bool:
    """Return whether the name of an entry is a plain path below the folder of the package."""
    parts = name.split("/")
    return not (
        "\\" in name
        or ":" in name
        or "\0" in name
        or PurePosixPath(name).is_absolute()
        or any(part in ("", ".", "..") for part in parts)
    )


@contextlib.contextmanager
def _reading(name: str) -> Generator[None]:
    """Name the entry in errors of reading it."""
    try:
        yield
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, ValueError) as error:
        raise DocumentError(f"is damaged: {name!r} cannot be read ({error})") from None


def _changed(name: str) -> DocumentError:
    return DocumentError(
        f"is damaged: {name!r} is not what was packed: its hash differs", fix="Ask for another copy"
    )
