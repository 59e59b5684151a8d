"""Where the records of many trials are stored: a folder, or what an address of fsspec names.

A store holds files by names such as `records/0012/00012340-00012359.zarr.zip`. A file is there whole or not
at all, at any moment, for every reader: in a folder it is written under another name, flushed to the disk and
renamed; an object store takes it in one call. Nothing here reads a clock.
"""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import IO, Protocol

from deodar import regular_file
from deodar.errors import OutputError, RecordError, first_line
from deodar.model import output

AGAIN = "Rows that exist are kept, and the same call resumes"
"""What every error of a store promises: rows follow their records."""

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
FORBIDDEN = (errno.EROFS, errno.EACCES, errno.EPERM)
GONE = (errno.ENOENT, errno.ENOTDIR, errno.ESTALE, errno.ENODEV, errno.ENOTCONN, errno.EHOSTDOWN, errno.EIO)
"""Errors of a system, by what can be done about them."""


class RecordStore(Protocol):
    """Files by their names.

    Attributes:
        shown: the folder, or the address without credentials.
        fades: whether the place remains, empty, when the store behind it is gone, as the folder does on which
            a disk of another machine was mounted.
    """

    @property
    def shown(self) -> str:
        """Return the folder, or the address without credentials."""
        ...

    @property
    def fades(self) -> bool:
        """Return whether an empty place may remain of a store that is gone."""
        ...

    def create(self) -> None:
        """Make an empty store if there is none; what contains it must exist.

        Raises:
            OutputError: it cannot be made.
        """
        ...

    def put(self, name: str, content: bytes) -> None:
        """Store a file; an existing one is replaced.

        Raises:
            OutputError: the store is full, read-only or gone; an existing file is unchanged.
        """
        ...

    def get(self, name: str) -> bytes | None:
        """Return the content of a file; None: there is no such file.

        Raises:
            RecordError: the store cannot be read.
        """
        ...

    def open(self, name: str) -> IO[bytes]:
        """Open a file, of which only the parts that are used are read.

        Raises:
            RecordError: it does not exist, or cannot be read.
        """
        ...

    def sizes(self, name: str = "") -> dict[str, int]:
        """Return the size in bytes of each file whose name begins with `name/`; "": of all files.

        Raises:
            RecordError: the store cannot be read.
        """
        ...


class FolderStore:
    """A store in a folder of this machine, or of another one that is mounted.

    Args:
        path: the folder; its parent exists.
    """

    fades = True

    def __init__(self, path: Path) -> None:
        self.path, self.shown = path, str(path)

    def create(self) -> None:
        """Make the folder if there is none."""
        try:
            self.path.mkdir(exist_ok=True)
        except OSError as error:
            raise refused(self.shown, error) from None

    def put(self, name: str, content: bytes) -> None:
        """Write a file beside its name, flush it to the disk, and rename it."""
        path = self.path / name
        try:
            # the folder itself is never made here: where it is missing, the store is gone
            for parent in reversed(Path(name).parents[:-1]):
                if not (folder := self.path / parent).is_dir():
                    folder.mkdir(exist_ok=True)
                    output.sync_folder(folder.parent)
            output.write(path, content)
        except OSError as error:
            raise refused(str(path), error) from None
        except OutputError as error:
            cause = error.__context__
            raise refused(str(path), cause if isinstance(cause, OSError) else error) from None

    def get(self, name: str) -> bytes | None:
        """Return the content of a file; None: there is no such file."""
        try:
            return regular_file.read_bytes(self.path / name)
        except (FileNotFoundError, NotADirectoryError):
            return None
        except OSError as error:
            raise unreadable(str(self.path / name), error) from None

    def open(self, name: str) -> IO[bytes]:
        """Open a file."""
        try:
            return regular_file.open_binary(self.path / name)
        except OSError as error:
            raise unreadable(str(self.path / name), error) from None

    def sizes(self, name: str = "") -> dict[str, int]:
        """Return the size of each file below a folder."""

        def failed(error: OSError) -> None:
            if not isinstance(error, FileNotFoundError):
                raise unreadable(str(error.filename or self.path / name), error) from None

        file_sizes: dict[str, int] = {}
        for folder, _, files in os.walk(self.path / name, onerror=failed):
            for file in files:
                path = Path(folder, file)
                try:
                    file_sizes[path.relative_to(self.path).as_posix()] = path.stat().st_size
                except FileNotFoundError:
                    continue  # a file under its first name, which another process has renamed
                except OSError as error:
                    raise unreadable(str(path), error) from None
        return file_sizes


def refused(where: str, error: BaseException, fault: str = "") -> OutputError:
    """Return the error of a file that a store did not take.

    Args:
        where: the store or the file, without credentials.
        error: the exception of the system or of a package.
        fault: its text without credentials; empty: that of the exception.
    """
    number = getattr(error, "errno", None)
    text = fault or getattr(error, "strerror", None) or first_line(error)
    if number in FULL:
        return OutputError("the store of the records is full", where=where, fix=f"Make room there. {AGAIN}")
    if number in FORBIDDEN or isinstance(error, PermissionError | NotImplementedError):
        fault = f"the store of the records cannot be written ({text})"
        return OutputError(fault, where=where, fix=f"Permit it there. {AGAIN}")
    if number in GONE or isinstance(error, FileNotFoundError):
        fix = f"Connect or create it, or correct its address. {AGAIN}"
        return OutputError("the store of the records is not there", where=where, fix=fix)
    why = f"{type(error).__name__}: {text}"
    return OutputError(f"the store of the records took no file ({why})", where=where, fix=AGAIN)


def unreadable(where: str, error: BaseException, what: str = "") -> RecordError:
    """Return the error of a file that cannot be read; the arguments are those of `refused`."""
    if isinstance(error, FileNotFoundError):
        return RecordError("there is no such file of records", where=where)
    text = f"{type(error).__name__}: {what or first_line(error)}"
    return RecordError(
        f"the store of the records cannot be read ({text})",
        where=where,
        fix="Connect it, or correct its address and its permissions",
    )
