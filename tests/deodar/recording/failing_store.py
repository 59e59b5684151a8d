"""A file system of fsspec in memory that becomes full, read-only or unreachable, and counts what is read."""

from __future__ import annotations

import errno

import fsspec
from fsspec.implementations.memory import MemoryFile, MemoryFileSystem

MODES = {
    "full": OSError(errno.ENOSPC, "No space left on device"),
    "read-only": OSError(errno.EROFS, "Read-only file system"),
    "forbidden": PermissionError("403: user:top secret may not write"),
    "gone": FileNotFoundError("no such bucket"),
    "silent": ConnectionError("user:top secret@bucket does not answer"),
}
"""Its states, and what it raises in each."""


class _Counted(MemoryFile):
    def read(self, size=-1):
        content = super().read(size)
        FailingFileSystem.bytes_read += len(content)
        return content


class FailingFileSystem(MemoryFileSystem):
    """Files in memory; `mode` is one of `MODES` or empty, `puts` the files that it takes before that."""

    protocol = ("failing",)
    store = {}
    pseudo_dirs = [""]
    mode, puts, bytes_read = "", 0, 0

    @classmethod
    def _strip_protocol(cls, path):
        return super()._strip_protocol(path.replace("failing://", "memory://"))

    @classmethod
    def reset(cls):
        """Remove all files, and take files again."""
        cls.store.clear()
        cls.pseudo_dirs[:] = ["", "/bucket", "/user:top%20secret@bucket"]
        cls.mode, cls.puts, cls.bytes_read = "", 0, 0

    @classmethod
    def become(cls, mode, puts=0):
        """Change the state after `puts` more files."""
        cls.mode, cls.puts = mode, puts

    @classmethod
    def names(cls):
        """Return the names of all files."""
        return sorted(cls.store)

    @classmethod
    def _require(cls):
        """Count a file, or raise the error of the state."""
        if cls.mode and cls.puts <= 0:
            raise MODES[cls.mode]
        cls.puts -= 1

    def pipe_file(self, path, value, *args, **kwargs):
        """Store a file, of which half is written before the store is full."""
        try:
            self._require()
        except OSError:
            if self.mode == "full":
                super().pipe_file(path, value[: len(value) // 2], *args, **kwargs)
            raise
        return super().pipe_file(path, value, *args, **kwargs)

    def cat_file(self, path, start=None, end=None, **kwargs):
        """Return the content of a file, unless the store is unreachable."""
        if self.mode in ("gone", "silent") and self.puts <= 0:
            raise MODES[self.mode]
        return super().cat_file(path, start, end, **kwargs)

    def _open(self, path, mode="rb", **kwargs):
        file = super()._open(path, mode, **kwargs)
        if mode == "rb":
            return _Counted(self, path, file.getvalue())
        return file


def register():
    """Make fsspec know it."""
    fsspec.register_implementation("failing", FailingFileSystem, clobber=True)
    FailingFileSystem.reset()
