"""A long computation for the studio: one at a time in a worker process, so that the run is not disturbed."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any, Generic, TypeVar

from deodar.batch.pool import Pool
from deodar.errors import DeodarError, Problem

R = TypeVar("R")

Ended = Callable[[Any, Sequence[Problem]], None]
"""A function that gets the result, or None and the problems."""


class BackgroundTask:
    """Runs a function in a worker process; a new one ends the one before.

    Args:
        name: name of the threads that wait for it.
        keep: whether the process stays for the next function, which then finds its programs compiled.
    """

    def __init__(self, name: str, keep: bool) -> None:
        self._name, self._keep = name, keep
        self._attempt = 0
        self._lock = threading.Lock()
        self._pool: Pool | None = None

    def start(
        self,
        function: Callable[..., Any],
        arguments: Sequence[Any],
        ended: Ended,
        heard: Callable[[Any], None] | None = None,
    ) -> None:
        """Run a function of a module, in a thread that waits for its process.

        Args:
            function: its first argument is a function that sends a message to this process.
            arguments: its further arguments.
            ended: called when it has ended, unless it was stopped.
            heard: called with each message.
        """
        self._attempt += 1
        attempt = self._attempt

        def work() -> None:
            problems: Sequence[Problem] = ()
            found = None
            with self._lock:  # the attempt before ends first
                try:
                    found = self._asked(attempt, function, arguments, heard or (lambda message: None))
                except DeodarError as error:
                    problems = error.problems
                except Exception as error:  # functions that a document names run in the worker
                    problems = [Problem("", f"{type(error).__name__}: {error}")]
            if attempt == self._attempt:
                ended(found, problems)

        threading.Thread(target=work, name=self._name, daemon=True).start()

    def stop(self) -> None:
        """End the function; nothing is called any more."""
        self._attempt += 1

    def end(self) -> None:
        """End the function and its process, and wait until they have ended."""
        self.stop()
        with self._lock:
            self._close()

    def _asked(
        self,
        attempt: int,
        function: Callable[..., Any],
        arguments: Sequence[Any],
        heard: Callable[[Any], None],
    ) -> Any:
        """Return what the function returns; None if it was stopped."""
        if attempt != self._attempt:
            return None
        done = False
        try:
            if self._pool is None:
                self._pool = Pool(1, talks=True).__enter__()
            self._pool.give(0, function, *arguments)
            while attempt == self._attempt:
                for _, result in self._pool.wait(0.2, lambda _, message: heard(message)):
                    done = self._keep
                    return result
            return None
        finally:
            if not done:
                self._close()

    def _close(self) -> None:
        pool, self._pool = self._pool, None
        if pool is not None:
            pool.__exit__(KeyboardInterrupt, None, None)


class FieldTask(Generic[R]):
    """A task about one field at a time, and a report on it; a new request ends the one before.

    Args:
        empty: the report while nothing was asked.
        task: runs the function.
        changed: called from any thread when the report has changed.
    """

    def __init__(self, empty: R, task: BackgroundTask, changed: Callable[[], None]) -> None:
        self.report = self._empty = empty
        self._task, self._changed = task, changed

    def stop(self) -> None:
        """End the task; its result is gone."""
        self._task.stop()
        self.report = self._empty
        self._changed()

    def end(self) -> None:
        """End the task and its process, and wait until they have ended."""
        self._task.end()
