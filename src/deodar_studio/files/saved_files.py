"""Snapshots and presets of the open document: files in two folders below the root.

`snapshots/DOCUMENT/NAME.npz` is what `save_snapshot` writes, `presets/DOCUMENT/NAME.json` a document, which
`apply_preset` reads.
"""

from __future__ import annotations

import contextlib
import datetime
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

from deodar import regular_file
from deodar.errors import DeodarError, OutputError, OutputExists, UnknownName
from deodar.model import output
from deodar.model.document import Document
from deodar.model.document_files import own_array_file
from deodar.recording import stored
from deodar.session.clock import Clock
from deodar.session.session_snapshot import SessionSnapshot
from deodar.session.snapshot_file import load_snapshot, save_snapshot
from deodar_studio.files.workspace import Workspace
from deodar_studio.messages.to_page import PresetView, SavedFiles, SnapshotView

Sort = Literal["snapshot", "preset"]
ENDINGS: dict[Sort, str] = {"snapshot": ".npz", "preset": ".json"}

MOST_LISTED = 200
"""Largest number of files of each sort that are listed, the newest ones."""

NOTHING = SavedFiles(snapshots=[], presets=[])


class SavedFolder:
    """The snapshots and presets of one document.

    Args:
        workspace: the root folder.
        title: name of the document.
    """

    def __init__(self, workspace: Workspace, title: str) -> None:
        self._workspace = workspace
        self._title = _plain(title) or "document"

    def listed(self) -> SavedFiles:
        """Return all snapshots and presets, the newest first; files that cannot be read are left out."""
        snapshots: list[SnapshotView] = []
        for path, saved, size in self._files("snapshot"):
            try:
                about: Any = stored.header(path)
                time = Clock(**about["clock"]).time
            except (DeodarError, KeyError, TypeError, ValueError):
                continue
            snapshots.append(SnapshotView(name=path.stem, time=time, saved=saved, size=size))
        presets = [
            PresetView(name=path.stem, path=self._workspace.shown(path), saved=saved, size=size)
            for path, saved, size in self._files("preset")
        ]
        return SavedFiles(snapshots=snapshots, presets=presets)

    def save_snapshot(self, name: str, snapshot: SessionSnapshot) -> Path:
        """Write a snapshot under a new name."""
        return self._write("snapshot", name, lambda path: save_snapshot(snapshot, path))

    def save_preset(self, name: str, doc: Document) -> Path:
        """Write the values of a document under a new name."""
        return self._write("preset", name, lambda path: self._workspace.save(doc, path))

    def snapshot(self, name: str, trust: bool) -> SessionSnapshot:
        """Read a snapshot."""
        return load_snapshot(self._existing("snapshot", name), trust)

    def remove(self, sort: Sort, name: str) -> None:
        """Delete a snapshot or preset; a preset that cannot be read without its arrays."""
        path = self._existing(sort, name)
        arrays = _array_file(sort, path)
        try:
            path.unlink()
            if arrays:
                path.with_name(arrays).unlink(missing_ok=True)
        except OSError as error:
            raise output.failed(path, error) from None

    def move(self, title: str) -> None:
        """Move all files to the folders of another title; one whose name is taken there stays.

        Raises:
            OSError: a file cannot be moved; the others may have been.
        """
        new = SavedFolder(self._workspace, title)
        for sort in ENDINGS:
            for path, _, _ in self._files(sort):
                new._folder(sort).mkdir(parents=True, exist_ok=True)
                place = new._folder(sort) / path.name
                if place.exists() or place.is_symlink():
                    continue
                if arrays := _array_file(sort, path):
                    path.with_name(arrays).rename(place.with_name(arrays))
                path.rename(place)

    def _folder(self, sort: Sort) -> Path:
        return self._workspace.inside(f"{sort}s/{self._title}")

    def _files(self, sort: Sort) -> list[tuple[Path, str, int]]:
        """Return path, time of saving (ISO 8601) and bytes of each file, the newest first."""
        found: list[tuple[float, Path, int]] = []
        try:
            for path in self._folder(sort).glob(f"*{ENDINGS[sort]}"):
                if path.is_file() and not path.is_symlink():
                    about = path.stat()
                    found.append((about.st_mtime, path, about.st_size))
        except (OSError, DeodarError):
            return []
        newest = sorted(found, reverse=True)[:MOST_LISTED]
        return [(path, _iso(at), size) for at, path, size in newest]

    def _write(self, sort: Sort, name: str, write: Callable[[Path], object]) -> Path:
        plain = _plain(name)
        if not plain:
            raise OutputError("needs a name", where=sort)
        folder = self._folder(sort)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise output.failed(folder, error) from None
        path = self._folder(sort) / f"{plain}{ENDINGS[sort]}"  # resolved again: it exists now
        if path.exists() or path.is_symlink():
            raise OutputExists(
                f"there is a {sort} of this name already",
                where=plain,
                fix="Choose another name, or delete that one first",
            )
        write(path)
        return path

    def _existing(self, sort: Sort, name: str) -> Path:
        path = self._folder(sort) / f"{name}{ENDINGS[sort]}"
        if _plain(name) != name or path.is_symlink() or not path.is_file():
            raise UnknownName(f"no {sort} is called {name!r}")
        return path


def _array_file(sort: Sort, path: Path) -> str:
    """Return the name of the array file of a preset; empty: it has none, or cannot be read."""
    content = b""
    if sort == "preset":
        with contextlib.suppress(OSError):
            content = regular_file.read_bytes(path)
    return own_array_file(content, path.stem)


def _plain(name: str) -> str:
    """Return a name as a name of files: other characters than letters, digits and ` _.+-` become `_`."""
    return re.sub(r"[^\w.+ -]+", "_", name).strip("._ ")[:80].strip("._ ")


def _iso(seconds: float) -> str:
    return datetime.datetime.fromtimestamp(seconds).astimezone().isoformat(timespec="seconds")
