"""Writing files so that nothing is lost: beside and renamed, and never over what this run did not write."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from deodar.errors import OutputError, OutputExists


def location(path: Any) -> Path:
    """A path from what a script gave; what cannot be one is an error."""
    try:
        found = Path(path)
        os.fsencode(found)
    except (TypeError, ValueError):
        raise OutputError(f"needs the path of a file, not {path!r}") from None
    if "\0" in str(found):
        raise OutputError(f"{path!r} cannot be the path of a file")
    return found


def claim(path: str | Path, force: bool = False) -> Path:
    """The path, if it may be written: free, or a regular file that `force` allows to be replaced."""
    path = location(path)
    try:
        taken = path.is_symlink() or path.exists()
    except OSError as error:
        raise OutputError(f"cannot be written: {error.strerror}", where=str(path)) from None
    if taken:
        if not path.is_file() or path.is_symlink():
            raise OutputExists("exists and is not a regular file", where=str(path), fix="Choose another name")
        if not force:
            raise OutputExists("exists already", where=str(path), fix="Choose another name, or replace it with --force (force=True)")
    parent = path.parent
    if not parent.is_dir():
        raise OutputError(f"there is no folder {str(parent)!r} to write into", where=str(path))
    if not os.access(parent, os.W_OK):
        raise OutputError(f"the folder {str(parent)!r} cannot be written to", where=str(path))
    return path


def write(path: Path, content: bytes | Callable[[Path], None]) -> None:
    """Write beside the final place and rename: the file is there whole, or not at all."""
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.name[:40]}.", suffix=path.suffix, dir=path.parent)
        os.close(handle)
    except OSError as error:
        raise OutputError(f"cannot be written: {error.strerror}", where=str(path)) from None
    beside = Path(name)
    try:
        if callable(content):
            content(beside)
        else:
            beside.write_bytes(content)
        beside.chmod(0o666 & ~_umask())
        beside.replace(path)
    except OSError as error:
        raise OutputError(f"cannot be written: {error.strerror}", where=str(path)) from None
    finally:
        beside.unlink(missing_ok=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
