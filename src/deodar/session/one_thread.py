"""One thread at a time changes a session."""

from __future__ import annotations

import threading

from deodar.errors import ThreadError


class OneThread:
    """A block that one thread at a time may enter, as often as it wants; another one gets an error."""

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._inside = ""

    def __enter__(self) -> None:
        thread = threading.current_thread().name
        if not self._lock.acquire(blocking=False):
            raise ThreadError(
                f"the thread {thread!r} called the session while the thread {self._inside!r} is in it;"
                " nothing has changed",
                fix="Use a session in one thread, or let threads take turns with a threading.Lock",
            )
        self._inside = thread

    def __exit__(self, *_: object) -> None:
        self._lock.release()
