"""Run functions that may wait for a disk outside the event loop."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

from deodar.errors import DeodarError, DocumentError

T = TypeVar("T")
SECONDS = 60.0
"""Longest wall time, in seconds, that a request waits for a file system.

A guess: a network folder that does not answer takes longer.
"""


async def in_file_thread(function: Callable[[], T], where: str) -> T:
    """Run a function in a new daemon thread and return its result.

    Raises:
        DocumentError: the call takes longer than `SECONDS`; the thread continues, and its result is dropped.
    """
    try:
        async with asyncio.timeout(SECONDS):
            return await asyncio.wrap_future(started(function))
    except TimeoutError:
        raise DocumentError(
            f"took longer than {SECONDS:g} s to read or write",
            where=where,
            fix="Check its disk or network folder",
        ) from None


def started(function: Callable[[], T]) -> Future[T]:
    """Run a function in a new daemon thread.

    A thread pool would be blocked by a few calls that never return, and would keep the process alive.
    """
    future: Future[T] = Future()

    def work() -> None:
        try:
            result = function()
        except BaseException as error:
            future.set_exception(error)
        else:
            future.set_result(result)

    future.set_running_or_notify_cancel()
    threading.Thread(target=work, name="deodar-file", daemon=True).start()
    return future


async def try_in_file_thread(function: Callable[[], None]) -> None:
    """Run a function as `in_file_thread` does, and ignore a `DeodarError`, also that of the time limit."""
    with contextlib.suppress(DeodarError):
        await in_file_thread(function, "")
