"""The rows of an experiment in a file: appended as trials end, and read again when the experiment is resumed
or extended.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from deodar import codec
from deodar.errors import OutputExists, RecordError
from deodar.model import output
from deodar.recording import places

Row = dict[str, Any]
"""What is kept of one trial, as plain data; `key` tells it from all others."""

ABOUT, KEY = "about", "key"


class Rows:
    """A file of JSON lines: first what makes the experiment, then a row for each trial that has ended.

    An existing file is resumed if it holds the same experiment, or the same experiment with fewer conditions:
    then a second line of what makes the experiment is appended, and the rows of the new conditions follow it.
    A last line that was cut off when a process died is dropped.

    Args:
        path: the file; it is made where there is none.
        about: what makes the experiment, as plain data: rows of another one are never mixed with these.
        by_condition: names of the entries of `about` that map names of conditions to their settings. A
            condition that the file has must have the same settings in all of these entries; a condition that
            the file does not have is an extension. Every other entry must be equal.
        read: makes of the `about` that the file holds the same of the present version.

    Attributes:
        found: rows by their keys.

    Raises:
        OutputExists: the file holds another experiment.
        RecordError: the file holds something else, or a line before the last is broken.
        OutputError: it cannot be written.
    """

    def __init__(
        self,
        path: Path,
        about: Mapping[str, Any],
        by_condition: Sequence[str] = (),
        read: Callable[[dict[str, Any]], dict[str, Any]] = dict,
    ) -> None:
        self.path = path
        self.found: dict[str, Row] = {}
        told = codec.parse(codec.line({ABOUT: about}))
        places.require_parent(path)
        lines = self._lines()
        if not lines:
            output.append(path, (codec.line(told, ascii=True) + "\n").encode())
            return
        if not isinstance(lines[0].get(ABOUT), dict):
            raise RecordError("holds no rows of an experiment", where=str(path), fix="Choose another name")
        made = read([line[ABOUT] for line in lines if KEY not in line][-1])
        changed = different(told[ABOUT], made, by_condition)
        if changed:
            raise OutputExists(
                f"holds runs of another experiment: {', '.join(changed)} differ",
                where=str(path),
                fix="Choose another name",
            )
        if made != told[ABOUT]:
            output.append(path, (codec.line(told, ascii=True) + "\n").encode())
        self.found = {row[KEY]: row for row in lines if KEY in row}

    def append(self, rows: Iterable[Row]) -> None:
        """Keep rows, on the disk when this returns; those of a key that is there already are left out."""
        new = [row for row in rows if row[KEY] not in self.found]
        if new:
            text = "".join(codec.line(row, ascii=True, finite=True) + "\n" for row in new)
            output.append(self.path, text.encode())
            self.found |= {row[KEY]: codec.parse(codec.line(row)) for row in new}

    def _lines(self) -> list[Row]:
        if not self.path.exists():
            return []
        content = self.path.read_bytes()
        whole = content.rfind(b"\n") + 1
        lines: list[Row] = []
        for number, line in enumerate(content[:whole].splitlines(), 1):
            try:
                found = codec.parse(line)
            except ValueError:
                found = None
            if not isinstance(found, dict) or (
                number > 1 and KEY not in found and not isinstance(found.get(ABOUT), dict)
            ):
                raise RecordError(
                    f"line {number} is no row",
                    where=str(self.path),
                    fix="Take that line out, and the trial is run again",
                )
            lines.append(found)
        if whole < len(content):
            if not lines and b'{"' + ABOUT.encode() != content[: 3 + len(ABOUT) - 1]:
                raise RecordError(
                    "holds no rows of an experiment", where=str(self.path), fix="Choose another name"
                )
            with self.path.open("r+b") as file:
                file.truncate(whole)
        return lines


def different(new: Mapping[str, Any], made: Mapping[str, Any], by_condition: Sequence[str] = ()) -> list[str]:
    """The entries in which a design differs from the one that rows were made with; of entries by condition
    those of conditions with rows.

    Args:
        new: what makes the experiment now.
        made: what made it when the rows were run.
        by_condition: names of the entries that map names of conditions to settings.
    """
    changed = [k for k in {*new, *made} - {*by_condition} if new.get(k) != made.get(k)]
    known = {name for k in by_condition for name in made.get(k, {})}
    for k in by_condition:
        now, then = new.get(k, {}), made.get(k, {})
        changed += [
            f"{k} of {name}"
            for name in known
            if (name in now, now.get(name)) != (name in then, then.get(name))
        ]
    return sorted(changed)


def claim(folder: Path, file: str, of: str) -> None:
    """Make the folder in which rows are kept, or take the one that an earlier call began, which holds `file`;
    another one is left alone.

    Raises:
        OutputExists: the folder holds something else; `of` says of what it should be.
    """
    if folder.is_dir() and any(folder.iterdir()) and not (folder / file).is_file():
        raise OutputExists(
            f"is not the folder of {of}, so nothing is written into it",
            where=str(folder),
            fix="Choose another name",
        )
    if not folder.is_dir():
        places.claim_folder(folder)
        folder.mkdir()
