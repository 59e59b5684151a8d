"""One worker process that stays for the next function, which finds its imports and compiled programs."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

from deodar.batch.pool import Pool

WAIT = 0.2
"""Longest wall time between two calls of `needed`, in seconds."""


class KeptWorker:
    """A process that starts when it is first asked, and runs one function after the other.

    Args:
        main, talks: as those of `Pool`.
    """

    def __init__(self, main: bool = False, talks: bool = False) -> None:
        self._main, self._talks = main, talks
        self._pool: Pool | None = None

    @property
    def started(self) -> bool:
        """Whether the process runs."""
        return self._pool is not None

    def ask(
        self,
        function: Callable[..., Any],
        arguments: tuple[Any, ...],
        needed: Callable[[], bool],
        heard: Callable[[Any], None] = lambda message: None,
    ) -> Any:
        """Return what a function of a module returns; None as soon as it is not needed, without the process.

        Args:
            function: with `talks`, its first argument is a function that sends a message.
            arguments: its further arguments.
            needed: whether the result is still needed; it is called several times a second.
            heard: called with each message.

        Raises:
            WorkerError: the process has died, as it has after any error.
            Exception: the exception that the function has raised.
        """
        with contextlib.ExitStack() as otherwise:
            otherwise.callback(self.end)
            if needed():
                pool = self._pool = self._pool or Pool(1, self._main, self._talks).__enter__()
                pool.give(0, function, *arguments)
                while needed():
                    for _, answer in pool.wait(WAIT, lambda _, message: heard(message)):
                        otherwise.pop_all()
                        return answer

    def end(self) -> None:
        """End the process at once."""
        pool, self._pool = self._pool, None
        if pool is not None:
            with contextlib.suppress(OSError):
                pool.__exit__(KeyboardInterrupt, None, None)
