"""The last error of deodar itself, kept for a fault report.

A file of the user's folder of states holds it, which other users cannot read. It has the traceback, without
paths and names of the user's files: of a module outside of the installed packages nothing is kept but the
number of the line.
"""

from __future__ import annotations

import contextlib
import datetime
import getpass
import platform
import re
import sysconfig
import tempfile
import traceback
from collections.abc import Iterable, Iterator
from pathlib import Path

import deodar
from deodar import codec, regular_file
from deodar.model import output, written

MOST_FRAMES = 40
"""Largest number of lines of a traceback, the last ones."""

MOST_MESSAGE = 2000
"""Largest number of characters of a message."""

MOST_CAUSES = 5
"""Largest number of errors that led to one another."""

SHORTEST = 3
"""Shortest name that is left out: a shorter one is part of other words."""

ENDINGS = (
    "json jsonl deodar zarr nc npz npy csv tsv txt log py ipynb toml yaml yml xml png jpg jpeg gif svg pdf"
    " mp4 avi mov mat m bag mcap aedat aedat4 zip html"
)
FILE = rf"(?:[\w.+-]+[/\\]+)*[^\s'\"/\\]+\.(?:{ENDINGS.replace(' ', '|')})"

UNQUOTED = r"[^\s'\"()\[\],;]*(?: [^'\"()\[\],;:\n]*[/\\][^\s'\"()\[\],;]*)?"
"""The rest of a path without quotation marks: spaces belong to it up to its last separator."""

HIDDEN = (
    (re.compile(r"'[^'\n]*[/\\][^'\n]*'|\"[^\"\n]*[/\\][^\"\n]*\""), "'PATH'"),
    (re.compile(r"(?:(?<![\w.])(?:~|[A-Za-z]:)?[/\\]+|\bPATH[/\\]+)[\w.~-]" + UNQUOTED), "PATH"),
    (re.compile(rf"'[^'\n]*{FILE}'|\"[^\"\n]*{FILE}\"|\b{FILE}\b"), "FILE"),
)
"""What shows a path or the name of a file, and what replaces it."""


def note(error: BaseException, task: str, names: Iterable[object] = ()) -> None:
    """Keep an error; one that cannot be kept is let go.

    Args:
        error: the error.
        task: what was done, for example `deodar run`.
        names: names of documents and paths of files that may be in its message.
    """
    with contextlib.suppress(Exception):
        moment = datetime.datetime.now().astimezone().isoformat(timespec="seconds")
        content = {"deodar": deodar.__version__, "when": moment, "task": task}
        content["error"] = "\n".join(_lines(error, [str(name) for name in names]))
        place = _place()
        place.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        output.write(place, codec.text(content).encode(), durable=False, private=True)


def stated() -> str:
    """Return the last error that was kept, as a paragraph of a report; "": there is none."""
    try:
        stored = codec.parse(regular_file.read_text(_place()))
        return f"{stored['task']}, deodar {stored['deodar']}, {stored['when']}\n{stored['error']}"
    except (OSError, ValueError, LookupError, TypeError):
        return ""


def without_names(text: str, names: Iterable[str] = ()) -> str:
    """Return a text without paths, names of files, the user and this machine, and without other names.

    >>> without_names("[Errno 2] No such file or directory: '/home/ann/plan a.json'; x in night.nc")
    "[Errno 2] No such file or directory: 'PATH'; x in FILE"
    """
    folders = (Path.home(), Path.cwd(), Path(tempfile.gettempdir()))
    for folder in sorted(map(str, folders), key=len, reverse=True):
        if len(folder) > 1:
            text = text.replace(folder, "PATH")
    parts = {part for name in names for part in (name, Path(name).name, Path(name).stem)}
    for part in sorted(parts, key=len, reverse=True):
        if len(part) >= SHORTEST:
            text = re.sub(rf"(?<!\w){re.escape(part)}(?!\w)", "NAME", text)
    for pattern, mark in HIDDEN:
        text = pattern.sub(mark, text)
    for name, mark in ((_user(), "USER"), (platform.node(), "HOST")):
        if len(name) >= SHORTEST:
            text = re.sub(rf"\b{re.escape(name)}\b", mark, text)
    return text


def _place() -> Path:
    return written.states() / "last_error.json"


def _lines(error: BaseException, names: list[str], causes: int = 0) -> Iterator[str]:
    """Yield the lines of the traceback of an error, after those of the error that led to it."""
    cause = error.__cause__ or (None if error.__suppress_context__ else error.__context__)
    if cause is not None and causes < MOST_CAUSES:
        yield from _lines(cause, names, causes + 1)
        yield "which led to:"
    for frame in traceback.extract_tb(error.__traceback__)[-MOST_FRAMES:]:
        module = _module(frame.filename)
        if not module:
            yield f"  a file of the user, line {frame.lineno}"
            continue
        yield f"  {module}, line {frame.lineno}, in {frame.name}"
        yield f"    {frame.line}"
    yield f"{type(error).__name__}: {without_names(str(error)[:MOST_MESSAGE], names)}"


def _module(file: str) -> str:
    """Return a module of an installed package or of Python, relative to its folder; "": it is of the user."""
    if file.startswith("<frozen"):
        return file
    sources = Path(deodar.__file__).parents[1]
    installed = [Path(sysconfig.get_path(key)) for key in ("purelib", "platlib", "stdlib")]
    for root in (sources, *installed):
        if Path(file).is_relative_to(root):
            name = Path(file).relative_to(root).as_posix()
            if root != sources or name.startswith("deodar"):  # a copy of the sources has other folders beside
                return name
    return ""


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):  # the system does not know it
        return ""
