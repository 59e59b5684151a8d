"""Packages that commands take in place of what is packed."""

from __future__ import annotations

import contextlib
from collections.abc import Generator
from pathlib import Path

from deodar.model import package


@contextlib.contextmanager
def opened(path: Path, trust: bool = False, runs: bool = True) -> Generator[Path]:
    """Yield the path of what a package holds, unpacked until the command ends; other paths as they are.

    Args:
        path: the file that the command was given.
        trust: whether modules that come with a package may be imported and run.
        runs: whether the command runs it, so that the modules which it needs must be there.
    """
    if not path.is_file() or not package.is_package(path):
        yield path
        return
    # start-up time: this brings JAX
    from deodar.packing.packing import opened

    with opened(path, trust, runs) as inner:
        yield inner
