"""Problems and warnings of a document after single changes, for which pages are not sent the whole
document.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from deodar.model.check import check
from deodar.model.document import Document
from deodar.server import view
from deodar.server.to_page import Checked
from deodar.server.turns import Turns

SECONDS = 0.2
"""Wall time between single changes and the check of what they led to (a guess: warnings that appear so soon
seem to belong to the change).
"""


class Checker:
    """Checks in a thread and a few times a second: a large document takes 30 ms, and a drag edits more often.

    Attributes:
        found: what the last check found; None: the whole document, which pages were sent last, holds it
            itself.

    Args:
        present: the version and the document that are open.
        turns: holds the task.
        changed: called once something was found.
    """

    def __init__(
        self, present: Callable[[], tuple[int, Document | None]], turns: Turns, changed: Callable[[], None]
    ) -> None:
        self.found: Checked | None = None
        self._present, self._turns, self._changed = present, turns, changed
        self._busy = False

    def start(self) -> None:
        """Check what is open, until it stays as it is."""
        if not self._busy:
            self._busy = True
            self._turns.beside(self._check())

    async def _check(self) -> None:
        try:
            version = -1
            while version != self._present()[0]:
                await asyncio.sleep(SECONDS)
                version, doc = self._present()
                found = [] if doc is None else await asyncio.to_thread(check, doc)
                if doc is not None and version == self._present()[0]:
                    self.found = Checked(version=version, problems=view.problems(found, doc))
                    self._changed()
        finally:
            self._busy = False
