"""Check the document after changes of single parameters, which are sent to pages one by one."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence

from deodar.errors import Problem
from deodar.model.document import Document
from deodar_studio.messages.to_page import Checked
from deodar_studio.project.change_queue import ChangeQueue
from deodar_studio.views import view

SECONDS = 0.2
"""Wall time, in seconds, between a change and the check.

A guess: users still relate a warning to their change after this delay.
"""


class Checker:
    """Checks the open document in a thread, a few times per second.

    The check of a large document takes 30 ms, and the drag of a slider makes more edits than that.

    Attributes:
        found: result of the last check; None: pages have the problems already, as part of the whole document.

    Args:
        present: returns the version and the document that are open.
        check: returns the problems and warnings of a document; it is called in another thread.
        queue: keeps a reference to the task.
        changed: called after each result.
    """

    def __init__(
        self,
        present: Callable[[], tuple[int, Document | None]],
        check: Callable[[Document], Sequence[Problem]],
        queue: ChangeQueue,
        changed: Callable[[], None],
    ) -> None:
        self.found: Checked | None = None
        self._present, self._check, self._queue, self._changed = present, check, queue, changed
        self._busy = False

    def start(self) -> None:
        """Check the open document, and repeat until its version no longer changes."""
        if not self._busy:
            self._busy = True
            self._queue.start_task(self._repeat())

    async def _repeat(self) -> None:
        try:
            version = -1
            while version != self._present()[0]:
                await asyncio.sleep(SECONDS)
                version, doc = self._present()
                found = [] if doc is None else await asyncio.to_thread(self._check, doc)
                if doc is not None and version == self._present()[0]:
                    self.found = Checked(version=version, problems=view.problems(found, doc))
                    self._changed()
        finally:
            self._busy = False
