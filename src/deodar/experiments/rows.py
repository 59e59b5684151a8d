"""The rows of an experiment in a file, appended as trials end and read when the experiment is resumed or
extended.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, ValuesView
from pathlib import Path
from typing import IO, Any, cast

from deodar import codec, regular_file
from deodar.codec import Json, JsonObject
from deodar.errors import DamagedFile, OutputExists, RecordError, first_line
from deodar.experiments import row_line
from deodar.model import output
from deodar.recording import places
from deodar.summary import Summarised, Summary, counted

Row = dict[str, Any]
"""The results of one trial as plain data; `key` identifies the trial."""

ABOUT, KEY = "about", "key"


class StoredRows(Mapping[str, Row]):
    """The rows of a file by their keys; memory holds the keys and where each row begins.

    Reading one row opens the file; `values` reads it once, from the beginning.

    Args:
        path: the file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._places: dict[str, int] = {}

    def __getitem__(self, key: str) -> Row:
        place = self._places[key]
        with regular_file.open_binary(self._path) as file:
            file.seek(place)
            return row_line.read(file.readline(), False)

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)

    def __contains__(self, key: object) -> bool:
        return key in self._places

    def values(self) -> ValuesView[Row]:
        return _InOneReading(self._path, self._places)

    def place(self, key: str, at: int) -> None:
        """State at which byte of the file the row of a key begins."""
        self._places[key] = at


class _InOneReading(ValuesView[Row]):
    """The rows of a file in their order, read from its beginning; of two rows with one key the last one."""

    def __init__(self, path: Path, places: Mapping[str, int]) -> None:
        super().__init__(places)  # pyright: ignore[reportArgumentType]
        self._path, self._places = path, places

    def __iter__(self) -> Iterator[Row]:
        if not self._places:
            return
        with regular_file.open_binary(self._path) as file:
            for at, line in _places(file):
                row = row_line.read(line, False)
                if self._places.get(row.get(KEY)) == at:
                    yield row


def _places(file: IO[bytes]) -> Iterator[tuple[int, bytes]]:
    """Yield each line that is complete, after the byte at which it begins."""
    at = 0
    for line in file:
        if not line.endswith(b"\n"):
            return
        yield at, line
        at += len(line)


class Rows(Summarised):
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
        found: rows by their keys, read from the file when they are asked for.

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
        self.found = StoredRows(path)
        self._checked = True
        stored = codec.parse(codec.line({ABOUT: about}))
        places.require_parent(path)
        identity = self._identity()
        if identity is None:
            output.append(path, row_line.write(stored, self._checked))
            return
        stored_identity = read(identity)
        changed = different(stored[ABOUT], stored_identity, by_condition)
        if changed:
            raise OutputExists(
                f"holds runs of another experiment: {', '.join(changed)} differ",
                where=str(path),
                fix="Choose another name",
            )
        if stored_identity != stored[ABOUT]:
            output.append(path, row_line.write(stored, self._checked))

    def append(self, rows: Iterable[Row]) -> list[Row]:
        """Store rows, on the disk when this returns, and return them as they are read from the file; a row
        whose key exists is left out.
        """
        new: dict[str, bytes] = {}
        for row in rows:
            if row[KEY] not in self.found and row[KEY] not in new:
                new[row[KEY]] = row_line.write(row, self._checked)
        if not new:
            return []
        at = self.path.stat().st_size
        output.append(self.path, b"".join(new.values()))
        for key, line in new.items():
            self.found.place(key, at)
            at += len(line)
        return [row_line.read(line, self._checked) for line in new.values()]

    def _identity(self) -> JsonObject | None:
        """Note where the rows of an existing file begin, and return its last identity; None: it has none yet.

        An incomplete last line is removed.
        """
        if not self.path.exists():
            return None
        identity: JsonObject | None = None
        whole, number = 0, 0
        with regular_file.open_binary(self.path) as file:
            for at, line in _places(file):
                whole, number = at + len(line), number + 1
                row = self._line(line, number)
                if KEY in row and number > 1:
                    self.found.place(row[KEY], at)
                else:
                    identity = row[ABOUT]
            file.seek(whole)
            partial = file.read(3 + len(ABOUT))
        if partial:
            if not whole and b'{"' + ABOUT.encode() != partial[: 3 + len(ABOUT) - 1]:
                raise self._no_rows()
            with self.path.open("r+b") as file:
                file.truncate(whole)
        return identity

    def _line(self, line: bytes, number: int) -> Row:
        if number == 1:
            try:
                identity, self._checked = row_line.read_first(line, ABOUT, self.path)
            except ValueError:
                raise self._no_rows() from None
            return {ABOUT: identity}
        try:
            row = row_line.read(line, self._checked)
            reason = "" if isinstance(row, dict) and (KEY in row or ABOUT in row) else "it has no key"
        except ValueError as error:
            row, reason = None, first_line(error)
        if reason:
            raise DamagedFile(
                f"line {number} is not a row: {reason}",
                where=str(self.path),
                fix="Remove that line; the trial is then run again",
            )
        return cast("Row", row)

    def _no_rows(self) -> RecordError:
        return RecordError("holds no rows of an experiment", where=str(self.path), fix="Choose another name")

    def _summary(self) -> Summary:
        return Summary(f"Rows in {self.path}: {counted(len(self.found), 'row')}")


def different(new: Mapping[str, Any], old: Mapping[str, Any], by_condition: Sequence[str] = ()) -> list[str]:
    """Return the entries in which a design differs from the design of the rows; of entries by condition only
    those of conditions with rows.

    Args:
        new: the identity of the experiment now.
        old: its identity when the rows were run.
        by_condition: names of the entries that map names of conditions to settings.
    """
    changed = [k for k in {*new, *old} - {*by_condition} if new.get(k) != old.get(k)]
    names = {name for k in by_condition for name in old.get(k, {})}
    for k in by_condition:
        new_entries, then = new.get(k, {}), old.get(k, {})
        changed += [
            f"{k} of {name}"
            for name in names
            if (name in new_entries, new_entries.get(name)) != (name in then, then.get(name))
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
