"""Files that belong to an imported file and lie in its folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path, PureWindowsPath

from deodar import regular_file
from deodar.errors import DocumentError
from deodar.model.document_files import MOST_BYTES

Beside = Callable[[str], bytes | None]
"""Return the content of the file of a name; None if there is no such file.

Raises DocumentError for a file that cannot be read.
"""


def nothing(name: str) -> bytes | None:
    """Return None: the content of the imported file has no folder."""
    return None


def is_plain(name: str) -> bool:
    """Return whether a name cannot lead to another folder or device, on any system."""
    return name.isprintable() and bool(name.strip(" .")) and name == PureWindowsPath(name).name


def in_folder(folder: Path) -> Beside:
    """Return the reader of the files in a folder; links out of it are not followed."""

    def read(name: str) -> bytes | None:
        if not is_plain(name):
            raise DocumentError(f"the file name {name!r} leads out of the folder")
        try:
            path = (folder / name).resolve()
            if not path.is_file():
                return None
            if path.parent != folder.resolve():
                raise DocumentError(f"the file {name!r} is a link to another folder")
            size = path.stat().st_size
            if size > MOST_BYTES:
                raise DocumentError(
                    f"the file {name!r} has {size / 2**20:.0f} MiB; at most {MOST_BYTES // 2**20} are read"
                )
            return regular_file.read_bytes(path)
        except (OSError, ValueError, RuntimeError) as error:
            raise DocumentError(
                f"the file {name!r} cannot be read: {getattr(error, 'strerror', None) or error}"
            ) from None

    return read
