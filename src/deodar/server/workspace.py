"""The folder that the studio may read and write, and nothing beside it."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable
from pathlib import Path

from deodar.errors import DocumentError, OutputError
from deodar.server.to_page import Folder

DOCUMENTS = (".json", ".deodar")
PICTURES = (".png", ".jpg", ".jpeg", ".bmp", ".gif", ".webp", ".tif", ".tiff")
MOST_NAMES = 2000
"""Names of one folder that are listed."""


class Workspace:
    """A root folder; every path is taken below it, after links are resolved."""

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()

    def inside(self, path: str) -> Path:
        """The place that a path of the page's names: relative to the root, or absolute and below it. Everything else is refused."""
        if "\0" in path:
            raise DocumentError("is no path", where=repr(path))
        try:
            place = (self.root / path).resolve()
        except (OSError, RuntimeError, ValueError) as error:
            raise DocumentError(f"is no path ({error})", where=path) from None
        if place != self.root and self.root not in place.parents:
            fix = "Start the studio in the folder you want to work in"
            raise DocumentError(f"lies outside the folder {self.root} that this studio may read and write", where=path, fix=fix)
        return place

    def shown(self, path: Path) -> str:
        """A path below the root as the page writes it."""
        return path.resolve().relative_to(self.root).as_posix()

    def holds(self, path: Path) -> bool:
        """Whether a path lies below the root."""
        return self.root in path.resolve().parents

    def listed(self, request: int, path: str) -> Folder:
        """Folders, documents and pictures in a folder; hidden ones are left out, and links that lead outside."""
        place = self.inside(path)
        if not place.is_dir():
            raise DocumentError("there is no such folder", where=path)
        try:
            found = sorted((e for e in os.scandir(place) if not e.name.startswith(".")), key=lambda e: e.name.casefold())[:MOST_NAMES]
        except OSError as error:
            raise DocumentError(f"cannot be read: {error.strerror}", where=path) from None
        inside = [e for e in found if self.holds(Path(e.path))]
        return Folder(
            request=request,
            path="" if place == self.root else self.shown(place),
            folders=[e.name for e in inside if e.is_dir()],
            files=_ending(inside, DOCUMENTS),
            pictures=_ending(inside, PICTURES),
        )

    def target(self, path: str) -> Path:
        """Where a document is to be written; the name ends in .json or .deodar."""
        if not path.strip() or path.endswith(("/", "\\")):
            raise OutputError("needs a name", where="save as")
        place = self.inside(path if path.lower().endswith(DOCUMENTS) else f"{path}.json")
        if place.is_dir():
            raise OutputError("is a folder", where=path)
        if not place.parent.is_dir():
            raise OutputError("the folder is not there", where=path)
        return place


def _ending(entries: Iterable[os.DirEntry[str]], suffixes: tuple[str, ...]) -> list[str]:
    return [e.name for e in entries if e.name.lower().endswith(suffixes) and e.is_file()]


def digest(path: Path) -> str:
    """A hash of a file's content; empty where it cannot be read."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return ""
