"""The latest versions of the open document as parts of messages, with their problems in the present world."""

from __future__ import annotations

import dataclasses as dc
from collections import deque
from collections.abc import Callable, Sequence

from deodar.errors import Problem
from deodar.model.check import check
from deodar.model.document import Document
from deodar_studio.views import converted
from deodar_studio.views.converted import Converted

Judge = Callable[[Document], tuple[Sequence[Problem], Sequence[Problem]]]
"""Returns the problems of a document of sound structure in the present world, and its warnings there."""


class Conversions:
    """Converts the open document; elements that a change left alone are converted once.

    Args:
        judge: finds problems and warnings with the world; it is called in other threads, too.
    """

    def __init__(self, judge: Judge) -> None:
        self._judge = judge
        self._latest: deque[Converted] = deque(maxlen=3)  # that of the last version, and coming ones

    @property
    def latest(self) -> Converted | None:
        """The last conversion."""
        return self._latest[-1] if self._latest else None

    def of(self, doc: Document) -> Converted:
        """Return a document as parts of messages."""
        found = next((c for c in self._latest if c.document is doc), None)
        if found is None:
            found = self.convert(doc, self.latest)
            self.add(found)
        return found

    def convert(self, doc: Document, before: Converted | None) -> Converted:
        """Convert a document, in any thread; where its structure is sound, its problems are those with the
        world.
        """
        made = converted.convert(doc, before)
        if made.problems:
            return made
        problems, warnings = self._judge(doc)
        return dc.replace(made, problems=problems, warnings=warnings)

    def add(self, made: Converted) -> None:
        """Add a conversion that another thread made."""
        self._latest.append(made)

    def clear(self) -> None:
        """Remove all conversions: another document was opened, or another world was chosen."""
        self._latest.clear()

    def problems(self, doc: Document) -> Sequence[Problem]:
        """Return the problems for which a document cannot run."""
        return self.of(doc).problems

    def check(self, doc: Document) -> Sequence[Problem]:
        """Return the problems of a document, or else all its warnings; in any thread."""
        found = check(doc)
        if any(p.severity == "problem" for p in found):
            return found
        problems, warnings = self._judge(doc)
        return problems or [*warnings, *found]
