"""Serialise changes of the document that come from several pages."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any, TypeVar

from deodar.errors import DocumentError

T = TypeVar("T")


class ChangeQueue:
    """A lock around every change, in the order of arrival.

    An edit awaits the engine between reading the document and committing it; a second edit that read the same
    document would overwrite the first.

    Attributes:
        session: counter that increases when a document is opened or closed.
    """

    def __init__(self) -> None:
        self.session = 0
        self.lock = asyncio.Lock()
        self._tasks: set[asyncio.Task[Any]] = set()

    async def run(self, change: Callable[[], Awaitable[T]], session: int = 0) -> T:
        """Run a change after all earlier changes.

        A change whose page disconnects runs to its end, so that engine and history never hold different
        documents.

        Args:
            change: function that makes the change.
            session: value of the counter for the document that the change is meant for; 0: any open document.

        Raises:
            DocumentError: another document was opened since.
        """

        async def in_order() -> T:
            async with self.lock:
                if session not in (0, self.session):
                    raise DocumentError("another document was opened since; nothing was changed")
                return await change()

        task = self.start_task(in_order())
        task.add_done_callback(_read_error)
        return await asyncio.shield(task)

    def start_task(self, work: Coroutine[Any, Any, T]) -> asyncio.Task[T]:
        """Run a coroutine in a task, and keep a reference to the task until its end."""
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return task


def _read_error(task: asyncio.Task[Any]) -> None:
    """Read the error of a change whose page disconnected, so that asyncio does not log it."""
    if not task.cancelled():
        task.exception()
