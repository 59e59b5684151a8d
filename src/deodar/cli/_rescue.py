"""A result that cannot be written where it was asked for: it is kept in memory until a second place has taken
it.
"""

from __future__ import annotations

import contextlib
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TypeVar

import platformdirs

from deodar.errors import DeodarError, OutputError, OutputExists, Problem
from deodar.recording import places

Done = TypeVar("Done")


def rescue(error: DeodarError, write: Callable[[Path], Done], first: Sequence[Path], ask: bool) -> Done:
    """Write to the first folder that takes it, and return what `write` returns.

    On a terminal a person is asked for folders, until one takes it or the answer is empty. Then come the
    folder that the system keeps for data of the user, and the one for temporary files.

    Args:
        error: why the result could not be written where it was asked for.
        write: writes the result into a folder.
        first: folders that are tried before anybody is asked.
        ask: whether a person may be asked.

    Raises:
        OutputError: no folder takes it; every folder that was tried is named.
    """
    tried = [error]
    for folder in _folders(tried, first, ask and sys.stdin.isatty() and sys.stderr.isatty()):
        try:
            places.require_parent(folder / "result")
            return write(folder)
        except DeodarError as again:
            tried.append(again)
    lost = Problem("", "no place could take the result, so that it is lost", "Make room and run it again")
    raise OutputError([*(p for e in tried for p in e.problems), lost]) from None


def elsewhere(error: DeodarError, out: Path, fill: Callable[[Path], None], ask: bool) -> Path:
    """Write a whole folder to a second place, under the name that it was to have and a number.

    Args:
        error: why it could not be written to `out`; where that has come to exist meanwhile, the second place
            is beside it.
        out: where it was asked for.
        fill: fills a folder.
        ask: whether a person may be asked.

    Raises:
        OutputError: no folder takes it.
    """

    def write(parent: Path) -> Path:
        second = places.free(parent, out.name)
        places.write_folder(second, fill)
        return second

    return rescue(error, write, [out.parent] if isinstance(error, OutputExists) else [], ask)


def _folders(tried: list[DeodarError], first: Sequence[Path], ask: bool) -> Iterator[Path]:
    yield from first
    while ask:
        print(
            f"{tried[-1]}\nThe result is still in memory. Another folder for it (empty: a folder of yours is"
            " chosen): ",
            end="",
            file=sys.stderr,
        )
        sys.stderr.flush()
        answer = sys.stdin.readline().strip()
        if not answer:
            break
        yield Path(answer).expanduser()
    yield from _own()


def _own() -> Iterator[Path]:
    """The folders of the user and of the system; one that cannot be made is passed over by whoever writes
    into it.
    """
    data = platformdirs.user_data_path("deodar", appauthor=False) / "results"
    with contextlib.suppress(OSError):
        data.mkdir(parents=True, exist_ok=True)
    yield data
    yield Path(tempfile.gettempdir())
