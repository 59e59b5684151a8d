"""Single changes of parameters, kept for pages that lag behind."""

from __future__ import annotations

from collections import deque

from deodar.server.to_page import Changed

MOST = 256
"""Changes that a page may lag behind before it is sent the whole document."""


class RecentChanges:
    """The newest changes. A change of another sort clears them: every page then needs the whole document."""

    def __init__(self) -> None:
        self._changes: deque[Changed] = deque(maxlen=MOST)

    def add(self, change: Changed) -> None:
        """Keep one more change."""
        self._changes.append(change)

    def clear(self) -> None:
        """Forget all changes."""
        self._changes.clear()

    def between(self, version: int, now: int) -> list[Changed] | None:
        """The changes that bring a page from one version to another; None if single changes do not
        suffice.
        """
        found = [change for change in self._changes if change.version > version]
        return found if len(found) == now - version else None
