"""The rows of an experiment in a file, appended as trials end and read when the experiment is resumed or
extended.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from deodar import codec
from deodar.codec import Json, JsonObject
from deodar.errors import OutputExists, RecordError
from deodar.model import output
from deodar.recording import places

Row = dict[str, Any]
"""The results of one trial as plain data; `key` identifies the trial."""

ABOUT, KEY = "about", "key"


class Rows:
    """A file of JSON lines: first the identity of the experiment, then a row for each trial that has ended.

    An existing file is resumed if it contains the same experiment, or the same experiment with fewer
    conditions: then a second identity line is appended, and the rows of the new conditions follow it. A last
    line that is incomplete because a process was killed is dropped.

    Args:
        path: the file; it is created if it does not exist.
        about: the identity of the experiment, as plain data: a file never mixes rows of two experiments.
        by_condition: names of the entries of `about` that map names of conditions to their settings. A
            condition that the file has must have the same settings in all of these entries; a condition that
            the file does not have is an extension. Every other entry must be equal.
        read: function that converts the `about` of the file to the present version.

    Attributes:
        found: rows by their keys.

    Raises:
        OutputExists: the file holds another experiment.
        RecordError: the file contains something else, or a line before the last is broken.
        OutputError: the file cannot be written.
    """

    def __init__(
        self,
        path: Path,
        about: Mapping[str, Json],
        by_condition: Sequence[str] = (),
        read: Callable[[JsonObject], JsonObject] = dict,
    ) -> None:
        self.path = path
        self.found: dict[str, Row] = {}
        stored = codec.parse(codec.line({ABOUT: about}))
        places.require_parent(path)
        lines = self._lines()
        if not lines:
            output.append(path, (codec.line(stored, ascii=True) + "\n").encode())
            return
        if not isinstance(lines[0].get(ABOUT), dict):
            raise RecordError("holds no rows of an experiment", where=str(path), fix="Choose another name")
        made = read([line[ABOUT] for line in lines if KEY not in line][-1])
        changed = different(stored[ABOUT], made, by_condition)
        if changed:
            raise OutputExists(
                f"holds runs of another experiment: {', '.join(changed)} differ",
                where=str(path),
                fix="Choose another name",
            )
        if made != stored[ABOUT]:
            output.append(path, (codec.line(stored, ascii=True) + "\n").encode())
        self.found = {row[KEY]: row for row in lines if KEY in row}

    def append(self, rows: Iterable[Row]) -> None:
        """Store rows, on the disk when this returns; a row whose key exists is left out."""
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
                    f"line {number} is not a row",
                    where=str(self.path),
                    fix="Remove that line; the trial is then run again",
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
    """Return the entries in which a design differs from the design of the rows; of entries by condition only
    those of conditions with rows.

    Args:
        new: the identity of the experiment now.
        made: its identity when the rows were run.
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
    """Create the folder of the rows, or accept the folder of an earlier call, which contains `file`; refuse
    any other.

    Raises:
        OutputExists: the folder contains something else; `of` names the expected content.
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
