"""The open record, what it is compared with, and the document in whose place it is shown."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable
from pathlib import Path

from deodar.errors import DocumentError
from deodar.model.model import Model
from deodar.recording.replay import RecordReader
from deodar.session.session import Session
from deodar.worlds._scene import Scene
from deodar_studio.files.file_thread import in_file_thread, try_in_file_thread
from deodar_studio.messages.to_page import Comparison
from deodar_studio.project import comparison
from deodar_studio.project.comparison import RecordComparison
from deodar_studio.project.file_state import FileState


@dc.dataclass(frozen=True)
class SetAside:
    """An open document in whose place the record of a trial is shown.

    Attributes:
        model: the document, with its history.
        file: its file.
        session: its run, paused; None: it was not compiled.
    """

    model: Model
    file: FileState
    session: Session | None = None

    @property
    def unsaved(self) -> bool:
        """Whether the document has edits that are not saved to a file."""
        return self.file.differs(self.model.document)


class OpenRecord:
    """The open record, if any: its reader, its scene, its comparison, and the document set aside for it.

    Args:
        shown: returns a path as the page names it.
        changed: called when pages may have something new to show.
        outdated: called when pages need the whole document again.

    Attributes:
        reader: the record, whose document is the open one; None: no record is open.
        scene: the view of the record's world at its start, and a sentence on what it does not contain.
        comparison: the comparison with another record.
        aside: the document in whose place the record is shown; None: the record is not that of a trial.
    """

    def __init__(
        self, shown: Callable[[Path], str], changed: Callable[[], None], outdated: Callable[[], None]
    ) -> None:
        self._shown, self._changed, self._outdated = shown, changed, outdated
        self.reader: RecordReader | None = None
        self.scene: tuple[Scene | None, str] = (None, "")
        self.comparison: RecordComparison | None = None
        self.aside: SetAside | None = None

    def open(
        self, reader: RecordReader, scene: tuple[Scene | None, str], aside: SetAside | None = None
    ) -> None:
        """Show a record, in the place of a document that is set aside."""
        self.reader, self.scene, self.aside = reader, scene, aside

    def close(self) -> None:
        """Show no record; the document set aside is forgotten."""
        self.reader, self.scene, self.aside = None, (None, ""), None
        self.end_comparison()

    def require(self) -> RecordReader:
        """Return the open record; raise DocumentError if none is open."""
        if self.reader is None:
            raise DocumentError("no record is open")
        return self.reader

    async def compare(self, path: Path, changed: Callable[[], None]) -> None:
        """Compare the open record with another one; `changed` is called in another thread."""
        reader = self.reader
        if reader is None:
            raise DocumentError("no record is open", fix="Open one, then compare it with another one")
        found = await in_file_thread(lambda: RecordComparison(reader, path, changed), str(path))
        self.end_comparison()
        self.comparison = found
        self._changed()

    def end_comparison(self) -> None:
        """Show the open record alone."""
        if self.comparison is not None:
            self.comparison.end()
        self.comparison = None
        self._changed()

    def compared(self) -> Comparison:
        """Return the comparison as a message."""
        found = self.comparison
        return (
            comparison.NO_COMPARISON
            if found is None
            else comparison.shown(found, self._shown(found.other.path))
        )

    async def refresh(self) -> bool:
        """Read what was added to a record that grows; return whether something was."""
        reader = self.reader
        if reader is None or reader.complete:
            return False
        grew: list[bool] = []
        known = reader.notes
        await try_in_file_thread(lambda: grew.append(reader.refresh()))
        if reader is self.reader and reader.notes != known:
            self._outdated()
        return any(grew)
