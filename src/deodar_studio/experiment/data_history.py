"""Undo and redo of plain data, such as those of an experiment."""

from __future__ import annotations

from collections import deque

from deodar.codec import JsonObject

MOST_STEPS = 1000
"""Largest number of changes that can be undone."""


class DataHistory:
    """The data before each change, and after each undone one."""

    def __init__(self) -> None:
        self._before: deque[JsonObject] = deque(maxlen=MOST_STEPS)
        self._after: list[JsonObject] = []

    @property
    def undo_steps(self) -> int:
        """Number of changes that can be undone."""
        return len(self._before)

    @property
    def redo_steps(self) -> int:
        """Number of changes that can be redone."""
        return len(self._after)

    def add(self, before: JsonObject) -> None:
        """Add a change of these data; undone changes cannot be redone any more."""
        self._before.append(before)
        self._after.clear()

    def undo(self, data: JsonObject) -> JsonObject:
        """Return the data before the last change; the same data without a change."""
        if not self._before:
            return data
        self._after.append(data)
        return self._before.pop()

    def redo(self, data: JsonObject) -> JsonObject:
        """Return the data after the change that was undone last; the same data without one."""
        if not self._after:
            return data
        self._before.append(data)
        return self._after.pop()

    def clear(self) -> None:
        """Forget all changes."""
        self._before.clear()
        self._after.clear()
