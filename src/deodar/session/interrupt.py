"""Handle Ctrl-C between chunks.

Python may raise `KeyboardInterrupt` in a callback of JAX, which ignores it. During a run the first Ctrl-C is
therefore stored and raised at the end of the chunk; a second one stops the run immediately, as usual.
"""

from __future__ import annotations

import contextlib
import signal
import sys
import threading
from collections.abc import Callable, Generator
from types import FrameType


class SecondInterrupt(KeyboardInterrupt):
    """A second Ctrl-C, which stops the run immediately."""


@contextlib.contextmanager
def stoppable(across: bool = False) -> Generator[Callable[[], None]]:
    """Yield a function to call between chunks: it raises KeyboardInterrupt if Ctrl-C was pressed since.

    Outside the main thread, the only one that receives signals, the function does nothing. In a run `across`
    hosts it raises on all of them, whichever was interrupted.
    """
    signals: list[int] = []

    def check() -> None:
        stop = bool(signals)
        if across:
            # start-up time: this brings JAX
            from deodar.compiler import hosts

            stop = hosts.any_of("Ctrl-C", stop, across)
        if stop:
            raise KeyboardInterrupt

    def ask(number: int, frame: FrameType | None) -> None:
        if signals:
            raise SecondInterrupt
        signals.append(number)

    with _handled(signal.SIGINT, ask):
        yield check


def ending_signals() -> list[signal.Signals]:
    """Return the signals that end a process whose user or system wants it to end: SIGTERM, and SIGHUP of a
    terminal that is closed, unless `nohup` has made the process ignore it.
    """
    if sys.platform == "win32" or signal.getsignal(signal.SIGHUP) == signal.SIG_IGN:
        return [signal.SIGTERM]
    return [signal.SIGTERM, signal.SIGHUP]


@contextlib.contextmanager
def interrupted_at_end() -> Generator[list[int]]:
    """Let the signals that end a process interrupt as Ctrl-C does, so that a robot is put to rest; yield the
    list of those received.

    Outside the main thread it does nothing.
    """
    received: list[int] = []

    def end(number: int, frame: FrameType | None) -> None:
        received.append(number)
        handler = signal.getsignal(signal.SIGINT)
        if not callable(handler):  # a script that starts a command with `&` makes it ignore SIGINT
            raise KeyboardInterrupt
        handler(signal.SIGINT, frame)

    with contextlib.ExitStack() as handlers:
        for number in ending_signals():
            handlers.enter_context(_handled(number, end))
        yield received


@contextlib.contextmanager
def _handled(number: int, handler: Callable[[int, FrameType | None], None]) -> Generator[None]:
    """Handle a signal inside the block; outside the main thread nothing is changed."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(number, handler)
    try:
        yield
    finally:
        signal.signal(number, before)
