"""Stores that are named by an address; the only module that imports fsspec.

Packages of fsspec may raise any exception, also with the address in it: errors state them without
credentials.
"""

from __future__ import annotations

import posixpath
import uuid
from collections.abc import Callable
from typing import IO, Any

from deodar.errors import MissingExtra, ParameterError, first_line
from deodar.recording.record_store import refused, unreadable

WHOLE = frozenset(
    ("abfs", "abfss", "adl", "az", "gcs", "gs", "memory", "oci", "ocilake", "oss", "r2", "s3", "s3a", "tos")
)
"""Protocols of object stores: a file is there whole once the call that puts it has ended, or not at all."""

BLOCK = 2**18
"""Bytes that are read at a time: the directory of a file of 250 trials, or a record (a guess)."""


class RemoteStore:
    """A store that fsspec reaches.

    Args:
        address: the address, with its credentials.
        shown: the address without credentials.
        hidden: function that removes the credentials from a text.

    Raises:
        MissingExtra: fsspec is not installed.
        ParameterError: no installed package reads such addresses.
    """

    def __init__(self, address: str, shown: str, hidden: Callable[[str], str]) -> None:
        try:
            # an extra
            from fsspec.core import url_to_fs
        except ImportError:
            raise MissingExtra("fsspec", "store", "a store of records at an address") from None
        self.shown, self._hidden = shown, hidden
        try:
            file_system, root = url_to_fs(address)
        except ImportError as error:
            raise ParameterError(
                f"the address of the store needs another package ({hidden(first_line(error))})",
                where=shown,
                fix="Install it here, and where workers run",
            ) from None
        except Exception as error:  # packages of fsspec may raise any exception
            raise ParameterError(
                f"is not the address of a store ({hidden(first_line(error))})",
                where=shown,
                fix="Name a folder, or an address such as s3://BUCKET/NAME",
            ) from None
        self._fs: Any = file_system
        self._root = str(root).rstrip("/")
        protocol = self._fs.protocol
        protocols = {protocol} if isinstance(protocol, str) else {*protocol}
        self.fades = not protocols & WHOLE

    def create(self) -> None:
        """Make the folder if there is none; the bucket of an object store must exist."""
        try:
            if self.fades:
                parent = posixpath.dirname(self._root)
                if parent and not self._fs.isdir(parent):
                    raise FileNotFoundError(parent)
                self._fs.makedirs(self._root, exist_ok=True)
        except Exception as error:  # packages of fsspec may raise any exception
            raise refused(self.shown, error, self._hidden(first_line(error))) from None

    def put(self, name: str, content: bytes) -> None:
        """Store a file, under another name first where the store is no object store."""
        path = self._path(name)
        try:
            if not self.fades:
                self._fs.pipe_file(path, content)
                return
            folder, _, last = path.rpartition("/")
            self._fs.makedirs(folder, exist_ok=True)
            beside = f"{folder}/.{last}.{uuid.uuid4().hex}"
            try:
                self._fs.pipe_file(beside, content)
                self._fs.mv(beside, path)
            except BaseException as error:
                self._remove(beside)
                # some file systems, such as SMB, rename a file to no name that exists
                if not isinstance(error, Exception) or not self._holds(path, content):
                    raise
        except Exception as error:  # packages of fsspec may raise any exception
            text = self._hidden(first_line(error))
            raise refused(f"{self.shown}/{name}", error, text) from None

    def get(self, name: str) -> bytes | None:
        """Return the content of a file; None: there is no such file."""
        try:
            return bytes(self._fs.cat_file(self._path(name)))
        except FileNotFoundError:
            return None
        except Exception as error:  # packages of fsspec may raise any exception
            raise self._unreadable(name, error) from None

    def open(self, name: str) -> IO[bytes]:
        """Open a file, which is read in blocks."""
        try:
            return self._fs.open(self._path(name), "rb", block_size=BLOCK)
        except Exception as error:  # packages of fsspec may raise any exception
            raise self._unreadable(name, error) from None

    def sizes(self, name: str = "") -> dict[str, int]:
        """Return the size of each file whose name begins with `name/`."""
        try:
            self._fs.invalidate_cache()  # other processes put files, too
            details = self._fs.find(self._path(name).rstrip("/"), detail=True)
        except FileNotFoundError:
            return {}
        except Exception as error:  # packages of fsspec may raise any exception
            raise self._unreadable(name, error) from None
        first = len(self._root) + 1
        return {
            str(path)[first:]: int(detail["size"] or 0)
            for path, detail in details.items()
            if str(path).startswith(f"{self._root}/")
        }

    def _path(self, name: str) -> str:
        return f"{self._root}/{name}"

    def _holds(self, path: str, content: bytes) -> bool:
        """Return whether a file has this content already."""
        try:
            return self._fs.cat_file(path) == content
        except Exception:  # the store is gone, which the first error states
            return False

    def _remove(self, path: str) -> None:
        try:
            self._fs.rm_file(path)
        except Exception:  # the store is full or gone, which the first error states
            return

    def _unreadable(self, name: str, error: Exception) -> Exception:
        return unreadable(f"{self.shown}/{name}", error, self._hidden(first_line(error)))
