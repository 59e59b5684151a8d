"""A long computation for the studio: one at a time in a worker process, so that the run is not disturbed."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Generic, TypeVar

import msgspec

from deodar.batch.pool import Pool
from deodar.errors import DeodarError, Problem
from deodar_studio.messages.to_page import Regime, Tuning
from deodar_studio.views import view

M = TypeVar("M", Regime, Tuning)

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


class FieldTask(Generic[M]):
    """A task about one field at a time, and a message on it; a new request ends the one before.

    Args:
        nothing: the message while nothing was asked.
        busy: its field that is true while the task runs.
        task: runs the function.
        changed: called from any thread when the message has changed.

    Attributes:
        message: what was found so far.
        session: number of the document of the field.
    """

    def __init__(self, nothing: M, busy: str, task: BackgroundTask, changed: Callable[[], None]) -> None:
        self.message = self._nothing = nothing
        self.session = 0
        self._busy, self._task, self._changed = busy, task, changed

    def ask(self, session: int, element: str, function: Callable[..., Any], arguments: Sequence[Any]) -> None:
        """Run a function, which sends and returns fields of the message, in the worker process."""

        def ended(found: Mapping[str, Any] | None, problems: Sequence[Problem]) -> None:
            self._tell({**(found or {}), self._busy: False, "problems": view.problems(problems)})

        self.session, self.message = session, self._nothing
        self._tell({"element": element, self._busy: True})
        self._task.start(function, arguments, ended, self._tell)

    def _tell(self, fields: Mapping[str, Any]) -> None:
        self.message = msgspec.structs.replace(self.message, **fields)
        self._changed()

    def stop(self) -> None:
        """End the task; its result is gone."""
        self._task.stop()
        self.message = self._nothing
        self._changed()

    def end(self) -> None:
        """End the task and its process, and wait until they have ended."""
        self._task.end()
