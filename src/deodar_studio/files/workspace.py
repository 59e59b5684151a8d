"""The root folder: the only folder that the studio may read and write.

Paths are resolved first and used later. A path that becomes a link in between is not followed when a document
is read or written: nested folders are opened one by one, without links (`OpenFolder`); a file is read through
the open folder, or written to a temporary file there and renamed. Windows has no such calls, so there only
the check protects; the same holds on all systems for the files of worlds, which are read by their paths.
"""

from __future__ import annotations

import contextlib
import hashlib
import itertools
import os
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

from deodar import regular_file
from deodar.errors import DeodarError, DocumentError, OutputError
from deodar.importers import opening
from deodar.model import document_files, output
from deodar.model.document import Document
from deodar.model.document_files import MOST_BYTES
from deodar.worlds.picture import Picture
from deodar_studio.files.open_folder import OpenFolder
from deodar_studio.messages.to_page import Folder

DOCUMENTS = (".json", ".deodar")
PICTURES = Picture.opens
MOST_NAMES = 2000
"""Largest number of names of one folder that are listed."""

MOST_SEEN = 100_000
"""Largest number of entries of one folder that are read."""

MOST_HASHED = 2**32
"""Largest file, in bytes, that is hashed (a guess: seconds of reading)."""

UNREADABLE = "unreadable"
"""Value used instead of the hash of a file that exists and cannot be read."""


class Workspace:
    """A root folder, with methods that accept only paths below it, after links are resolved."""

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()

    def inside(self, path: str) -> Path:
        """Resolve a path from the page: relative to the root, or absolute and below it.

        Raises:
            DocumentError: the path is invalid, or lies outside the root.
        """
        if "\0" in path:
            raise DocumentError("is not a path", where=repr(path))
        try:
            place = (self.root / path).resolve()
        except (OSError, RuntimeError, ValueError) as error:
            raise DocumentError(f"is not a path ({error})", where=path) from None
        if place != self.root and self.root not in place.parents:
            fix = "Start the studio in the folder you want to work in"
            raise DocumentError(
                f"lies outside the folder {self.root} that this studio may read and write",
                where=path,
                fix=fix,
            )
        return place

    def shown(self, path: Path) -> str:
        """Return a path below the root in the form that the page uses."""
        return path.resolve().relative_to(self.root).as_posix()

    def holds(self, path: Path) -> bool:
        """Return whether a path lies below the root; False for a link to itself."""
        try:
            return self.root in path.resolve().parents
        except (OSError, RuntimeError, ValueError):
            return False

    def folder(self, place: Path) -> OpenFolder:
        """Open the folder of a path that `inside` returned, without following links."""
        if not place.is_relative_to(self.root):
            raise DocumentError(
                f"lies outside the folder {self.root} that this studio may read and write", where=str(place)
            )
        try:
            return OpenFolder(self.root, place.relative_to(self.root).parts[:-1])
        except OSError as error:
            raise DocumentError(
                f"the folder cannot be opened: {error.strerror}", where=self._named(place)
            ) from None

    def require_file(self, place: Path) -> None:
        """Raise DocumentError for a path whose reading could block: a named pipe, a device or a new link.

        A link is new if it appeared since the path was resolved. Folders and missing files are accepted.
        """
        try:
            if place.is_dir():
                return
            with self.folder(place) as folder, folder.open(place.name):
                return
        except DeodarError as error:
            raise DocumentError(error.problems[0].what, where=self._named(place)) from None
        except FileNotFoundError:
            return
        except OSError as error:
            raise DocumentError(f"cannot be read: {error.strerror}", where=self._named(place)) from None

    def digest(self, place: Path) -> str:
        """Return a hash of a file's content; empty if it is missing, `UNREADABLE` if it cannot be read."""
        try:
            with self.folder(place) as folder, folder.open(place.name) as (file, size):
                return hashlib.file_digest(file, "sha256").hexdigest() if size <= MOST_HASHED else UNREADABLE
        except FileNotFoundError:
            return ""
        except (OSError, DeodarError):
            return UNREADABLE

    def save(self, doc: Document, place: Path) -> None:
        """Write a document to a path that `target` returned, in the format of `document_files.save`."""
        output.claim(place, True)
        with tempfile.TemporaryDirectory(prefix="deodar-") as private, self.folder(place) as folder:
            document_files.save(doc, Path(private) / place.name)
            made = {path.name: regular_file.read_bytes(path) for path in Path(private).iterdir()}
            old = _array_file(folder, place)
            # the document last, because it refers to the other files
            with contextlib.ExitStack() as undo:
                for name in sorted(made, key=lambda name: name == place.name):
                    folder.write(name, made[name])
                    if name not in (place.name, old):
                        undo.callback(folder.remove, name)
                undo.pop_all()
            arrays = next((name for name in made if name != place.name), "")
            left = document_files.left_arrays(place.parent, place.stem, arrays)
            for name in {old, *(path.name for path in left)} - {"", *made}:
                folder.remove(name)

    def _named(self, place: Path) -> str:
        return place.relative_to(self.root).as_posix() if place.is_relative_to(self.root) else str(place)

    def listed(self, path: str) -> Folder:
        """List folders, documents and pictures in a folder, without hidden ones and links to the outside."""
        place = self.inside(path)
        if not place.is_dir():
            raise DocumentError("there is no such folder", where=path)
        try:
            with os.scandir(place) as entries:
                seen = [e for e in itertools.islice(entries, MOST_SEEN) if not e.name.startswith(".")]
            found = sorted(seen, key=lambda e: e.name.casefold())[:MOST_NAMES]
        except OSError as error:
            raise DocumentError(f"cannot be read: {error.strerror}", where=path) from None
        inside = [e for e in found if self.holds(Path(e.path))]
        records = [e.name for e in inside if _is(lambda e=e: _is_record(Path(e.path)))]
        return Folder(
            request=0,
            path="" if place == self.root else self.shown(place),
            facts=_facts(inside),
            folders=[e.name for e in inside if _is(e.is_dir) and e.name not in records],
            files=_ending(inside, (*DOCUMENTS, *opening.endings())),
            pictures=_ending(inside, PICTURES),
            records=records,
            others=_others(inside, records),
        )

    def target(self, path: str) -> Path:
        """Resolve the path for writing a document; `.json` is added unless it ends in .json or .deodar."""
        if not path.strip() or path.endswith(("/", "\\")):
            raise OutputError("needs a name", where="save as")
        place = self.inside(path if path.lower().endswith(DOCUMENTS) else f"{path}.json")
        if place.is_dir():
            raise OutputError("is a folder", where=path)
        if not place.parent.is_dir():
            raise OutputError("the folder does not exist", where=path)
        return place


def _facts(entries: Iterable[os.DirEntry[str]]) -> dict[str, tuple[int, float]]:
    facts: dict[str, tuple[int, float]] = {}
    for e in entries:
        with contextlib.suppress(OSError):
            if e.is_file():
                facts[e.name] = (e.stat().st_size, e.stat().st_mtime)
    return facts


def _ending(entries: Iterable[os.DirEntry[str]], suffixes: tuple[str, ...]) -> list[str]:
    return [e.name for e in entries if e.name.lower().endswith(suffixes) and _is(e.is_file)]


def _others(entries: Iterable[os.DirEntry[str]], records: list[str]) -> list[str]:
    known = (*DOCUMENTS, *opening.endings(), *PICTURES)
    others = [e for e in entries if not e.name.lower().endswith(known) and e.name not in records]
    return [e.name for e in others if _is(e.is_file)]


def _is_record(path: Path) -> bool:
    """Return whether a file or folder looks like a record, by the names in it."""
    if path.is_dir():
        inner = (path / "zarr.json", path / "record.zarr" / "zarr.json", path / "record.nc")
        return any(file.is_file() for file in inner)
    return path.suffix.lower() == ".nc" and path.is_file()


def _is(question: Callable[[], bool]) -> bool:
    """Call a test of a directory entry; False if it fails, as for a broken link."""
    try:
        return question()
    except OSError:
        return False


def _array_file(folder: OpenFolder, place: Path) -> str:
    """Return the array file of the document to be replaced, if its name has the form that deodar writes."""
    try:
        return document_files.own_array_file(folder.read(place.name, MOST_BYTES), place.stem)
    except (OSError, DeodarError):
        return ""
