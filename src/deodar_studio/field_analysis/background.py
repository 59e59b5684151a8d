"""A long computation about one field: one at a time in a worker process, so that the run is not disturbed."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any, Generic, TypeVar

import msgspec

from deodar.batch.kept_worker import KeptWorker
from deodar.errors import Problem, problems_of
from deodar_studio.messages.to_page import Regime, Tuning
from deodar_studio.views import view

M = TypeVar("M", Regime, Tuning)


class FieldTask(Generic[M]):
    """A task about one field at a time, and a message on it; a new request ends the one before.

    Args:
        nothing: the message while nothing was asked.
        busy: its field that is true while the task runs.
        keep: whether the process stays for the next request.
        changed: called from any thread when the message has changed.

    Attributes:
        message: what was found so far.
        session: number of the document of the field.
    """

    def __init__(self, nothing: M, busy: str, keep: bool, changed: Callable[[], None]) -> None:
        self.message = self._nothing = nothing
        self.session = 0
        self._busy, self._keep, self._changed = busy, keep, changed
        self._attempt = 0
        self._lock = threading.Lock()
        self._worker = KeptWorker(talks=True)

    def ask(self, session: int, element: str, function: Callable[..., Any], *arguments: Any) -> None:
        """Run a function of a module, in a thread that waits for its process.

        Args:
            session: number of the document.
            element: id of the field.
            function: sends fields of the message by its first argument, and returns further ones.
            arguments: its further arguments.
        """
        self.session, self.message = session, self._nothing
        self._tell({"element": element, self._busy: True})
        self._attempt += 1
        attempt = self._attempt

        def work() -> None:
            found: Mapping[str, Any] | None = None
            problems: tuple[Problem, ...] = ()
            with self._lock:  # the attempt before ends first
                try:
                    found = self._worker.ask(
                        function, arguments, lambda: attempt == self._attempt, self._tell
                    )
                except Exception as error:  # functions that a document names run in the worker
                    problems = problems_of(error)
                if not self._keep:
                    self._worker.end()
            if attempt == self._attempt:
                self._tell({**(found or {}), self._busy: False, "problems": view.problems(problems)})

        threading.Thread(target=work, name=f"deodar-{self._busy}", daemon=True).start()

    def _tell(self, fields: Mapping[str, Any]) -> None:
        self.message = msgspec.structs.replace(self.message, **fields)
        self._changed()

    def stop(self) -> None:
        """End the task; its result is gone."""
        self._attempt += 1
        self.message = self._nothing
        self._changed()

    def end(self) -> None:
        """End the task and its process, and wait until they have ended."""
        self._attempt += 1
        with self._lock:
            self._worker.end()
