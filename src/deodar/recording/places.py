"""Output paths: whole folders that appear complete, and unused names."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Callable
from pathlib import Path

from deodar.errors import OutputError, OutputExists, Problem, option
from deodar.model import output, partial, written

MOST_NUMBERED = 100_000


def claim_folder(path: Path, force: bool = False) -> Path:
    """Return the path if a folder may be written there: a new one, or one that may be replaced, because of
    `force` or because the running script wrote it.
    """
    if path.is_symlink() or path.exists():
        if path.is_symlink() or not path.is_dir():
            raise OutputExists("exists and is not a folder", where=str(path), fix="Choose another name")
        output.require_replaceable(path, force)
    require_parent(path)
    return path


def require_parent(path: Path) -> None:
    """Refuse a path whose parent folder is missing or cannot be written."""
    parent = path.parent
    if not parent.is_dir():
        raise OutputError(f"the folder {str(parent)!r} does not exist", where=str(path))
    if not os.access(parent, os.W_OK | os.X_OK):
        raise OutputError(f"the folder {str(parent)!r} cannot be written to", where=str(path))


def clear(path: Path) -> None:
    """Remove an existing folder or file that may be replaced.

    Raises:
        OutputError: the system refused.
    """
    try:
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
    except OSError as error:
        raise output.failed(path, error) from None


def write_folder(path: Path, fill: Callable[[Path], None], replace: bool = False) -> None:
    """Fill a folder beside its final path, flush it to the disk, and rename it: it is complete or absent.

    An existing one is replaced with `replace`, or if the running script wrote it.
    """
    unfinished = str(path)
    try:
        with partial.folder(path) as beside:
            inner, old = beside / "new", beside / partial.OLD
            unfinished = str(inner)
            inner.mkdir()
            fill(inner)
            output.sync_tree(inner)
            if path.is_dir() and (replace or written.owned(path)):
                path.rename(old)
            if path.exists():
                raise OutputExists("was created meanwhile", where=str(path), fix="Choose another name")
            try:
                inner.rename(path)
                output.sync_folder(path.parent)
            except OSError:
                if old.exists():
                    old.rename(path)
                raise
            output.note(path)
    except OutputError as error:
        raise type(error)(
            [Problem(p.where.replace(unfinished, str(path)), p.what, p.fix) for p in error.problems]
        ) from None
    except OSError as error:
        raise output.failed(path, error) from None


def free(parent: Path, name: str, suffix: str = "") -> Path:
    """Return the first of NAME-001, NAME-002, ... that does not exist; invalid characters of file names
    become `_`.
    """
    plain = re.sub(r"[^\w.+-]+", "_", name).strip("._")[:80] or "record"
    for n in range(1, MOST_NUMBERED):
        path = parent / f"{plain}-{n:03}{suffix}"
        if not (path.exists() or path.is_symlink()):
            return path
    raise OutputError(
        f"the folder {str(parent)!r} holds {MOST_NUMBERED} results called {plain}",
        fix=option("Choose a name:", "out", "NAME", "..."),
    )
