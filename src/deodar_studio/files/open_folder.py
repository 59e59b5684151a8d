"""A folder that is kept open: its files are read and written by name, even if its path changes meanwhile."""

from __future__ import annotations

import contextlib
import os
import secrets
import stat
from collections.abc import Generator, Iterable
from io import BufferedReader
from pathlib import Path
from types import TracebackType

from deodar.errors import DocumentError
from deodar.model import output, partial

BY_DESCRIPTOR = hasattr(os, "O_NOFOLLOW") and {os.open, os.unlink, os.rename} <= os.supports_dir_fd
"""Whether this system can open files relative to an open folder.

If not (Windows), the path of the folder is used each time.
"""

READ = (
    os.O_RDONLY
    | getattr(os, "O_NONBLOCK", 0)
    | getattr(os, "O_CLOEXEC", 0)
    | getattr(os, "O_NOCTTY", 0)
    | getattr(os, "O_BINARY", 0)
)
NEW = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)
NO_LINK = getattr(os, "O_NOFOLLOW", 0)
FOLDER = os.O_RDONLY | getattr(os, "O_DIRECTORY", 0) | getattr(os, "O_CLOEXEC", 0)


class OpenFolder:
    """A folder, with methods for the files in it by name.

    Args:
        path: the folder.
        below: names of nested folders below `path`. None of them may be a link: opening fails if one became a
            link since its path was resolved.

    Raises:
        OSError: the folder cannot be opened.
    """

    def __init__(self, path: Path, below: Iterable[str] = ()) -> None:
        self.path = path.joinpath(*below)
        self._descriptor: int | None = None
        if BY_DESCRIPTOR:
            self._descriptor = os.open(path, FOLDER)
            for name in below:
                above = self._descriptor
                try:
                    self._descriptor = os.open(name, FOLDER | NO_LINK, dir_fd=above)
                except OSError:
                    self._descriptor = None
                    raise
                finally:
                    os.close(above)
        elif not self.path.is_dir():
            raise NotADirectoryError(20, "Not a directory", str(self.path))

    def __enter__(self) -> OpenFolder:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None

    @contextlib.contextmanager
    def open(self, name: str, links: bool = False) -> Generator[tuple[BufferedReader, int]]:
        """Open a regular file for reading, without blocking; yield the file and its size in bytes.

        The type of the file is checked after opening, so that a named pipe or a device cannot replace it
        between the check and the opening.

        Args:
            name: name of the file.
            links: whether the name may be a link.

        Raises:
            DocumentError: it is not a regular file.
            OSError: it cannot be opened.
        """
        descriptor = self._open(name, READ if links else READ | NO_LINK)
        try:
            about = os.fstat(descriptor)
            if not stat.S_ISREG(about.st_mode):
                raise DocumentError("is not a regular file")
            with os.fdopen(descriptor, "rb", closefd=False) as file:
                yield file, about.st_size
        finally:
            os.close(descriptor)

    def read(self, name: str, most: int, links: bool = False) -> bytes:
        """Return the content of a regular file of at most `most` bytes."""
        with self.open(name, links) as (file, size):
            content = b"" if size > most else file.read(most + 1)
            if size > most or len(content) > most:
                raise DocumentError(
                    f"is {max(size, len(content)) / 2**20:,.0f} MiB; at most {most // 2**20} are read"
                )
            return content

    def write(self, name: str, content: bytes) -> None:
        """Write a file atomically, as `output.write` does.

        The content is written to a temporary file in the folder, synchronised to the disk, and renamed. A
        link of that name is replaced, never followed.
        """
        at = self._descriptor
        taken = None if at is None else partial.take(name, descriptor=at)
        beside = taken[0] if taken else f".{name[:40]}.{secrets.token_hex(6)}"
        try:
            try:
                descriptor = os.dup(taken[1]) if taken else self._open(beside, NEW | NO_LINK)
                with os.fdopen(descriptor, "wb") as file:
                    file.write(content)
                    file.flush()
                    output.sync_open(file.fileno())
                self._rename(beside, name)
                self._sync()
            finally:
                if taken:
                    partial.drop(*taken, descriptor=at)
                else:
                    self.remove(beside)
        except OSError as error:
            raise output.failed(Path(name), error) from None

    def remove(self, name: str) -> None:
        """Remove a file if it exists."""
        with contextlib.suppress(FileNotFoundError):
            if self._descriptor is None:
                os.unlink(self.path / name)
            else:
                os.unlink(name, dir_fd=self._descriptor)

    def _open(self, name: str, flags: int) -> int:
        if self._descriptor is None:
            return os.open(self.path / name, flags, 0o666)
        return os.open(name, flags, 0o666, dir_fd=self._descriptor)

    def _sync(self) -> None:
        if self._descriptor is None:
            output.sync_folder(self.path)
        else:
            output.sync_open(self._descriptor)

    def _rename(self, old: str, new: str) -> None:
        if self._descriptor is None:
            os.replace(self.path / old, self.path / new)
        else:
            os.rename(old, new, src_dir_fd=self._descriptor, dst_dir_fd=self._descriptor)
