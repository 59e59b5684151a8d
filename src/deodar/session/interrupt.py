"""Ctrl-C as a request that is met between chunks.

A `KeyboardInterrupt` raised wherever Python happens to be may land in a callback of JAX, which swallows it.
While a run is on, the first Ctrl-C is therefore kept and told at the end of the chunk; a second one stops at
once, as usual.
"""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Callable, Generator
from types import FrameType


class AtOnce(KeyboardInterrupt):
    """A second Ctrl-C: nothing is waited for."""


@contextlib.contextmanager
def stoppable() -> Generator[Callable[[], None]]:
    """A function to call between chunks: it raises KeyboardInterrupt if Ctrl-C was pressed since.

    Outside the main thread, which alone gets signals, nothing is changed.
    """
    asked: list[int] = []

    def check() -> None:
        if asked:
            raise KeyboardInterrupt

    def ask(number: int, frame: FrameType | None) -> None:
        if asked:
            raise AtOnce
        asked.append(number)

    if threading.current_thread() is not threading.main_thread():
        yield check
        return
    before = signal.signal(signal.SIGINT, ask)
    try:
        yield check
    finally:
        signal.signal(signal.SIGINT, before)
