"""Recent changes of the document, for pages that lag behind."""

from __future__ import annotations

from collections import deque

from deodar_studio.messages.to_page import Edited

MOST = 256
"""Number of changes that a page may lag behind before the server sends the whole document."""


class RecentChanges:
    """The newest differences between versions.

    What no difference expresses clears them, and pages then need the whole document.
    """

    def __init__(self) -> None:
        self._changes: deque[Edited] = deque(maxlen=MOST)

    def add(self, change: Edited) -> None:
        """Add a change."""
        self._changes.append(change)

    def clear(self) -> None:
        """Remove all changes."""
        self._changes.clear()

    def between(self, version: int, now: int) -> list[Edited] | None:
        """Return the changes from one version to another; None if these are not sufficient."""
        found = [change for change in self._changes if change.version > version]
        return found if len(found) == now - version else None
