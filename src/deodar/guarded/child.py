"""The child that reads files: `python -m deodar.guarded.child MARK`; it imports what the files need.

It answers requests until its input ends. A request has the name of a function, its values, and limits; the
answer is the function's value, its error, or, of a generator, its items one after another.
"""

from __future__ import annotations

import contextlib
import os
import pkgutil
import signal
import sys
from collections.abc import Generator, Iterator
from io import FileIO
from typing import Any, NamedTuple, cast

from deodar import regular_file
from deodar.errors import DeodarError, first_line
from deodar.guarded.channel import BrokenChannel, Channel, PlainData, error_data

AHEAD = 8
"""Number of items of a generator that are sent before the parent has taken one."""

TAKEN = 4
"""Number of items after which the parent says that it took them: so both processes are resumed less often."""

GRACE = 5
"""Seconds that the child may take more than the limit, at which its parent ends it; it may have none."""


class ChildRequest(NamedTuple):
    """What a parent asks for.

    Attributes:
        function: name of a function, `module:name`.
        values: its arguments.
        memory: bytes that a call may take; the answer has at most as many, too.
        seconds: longest time of a call, and of each item of a generator.
        folder: working folder of the parent, which may have changed.
    """

    function: str
    values: tuple[PlainData, ...]
    memory: int
    seconds: float
    folder: str


def main() -> None:
    """Answer requests until the input ends."""
    source, sink = FileIO(os.dup(0)), os.fdopen(os.dup(1), "wb")
    # what libraries write must not be taken for a message
    os.dup2(os.open(os.devnull, os.O_RDWR), 0)
    os.dup2(0, 1)
    # Ctrl-C reaches all processes of a terminal; the parent decides
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with contextlib.suppress(ImportError, ValueError, OSError):
        # absent on Windows
        import resource

        # a file of the memory of a reader that crashed is of no use
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    sink.write(sys.argv[1].encode())  # what was written before is no message
    channel = Channel(source, sink, sys.argv[1])
    sink.flush()
    with contextlib.suppress(BrokenChannel):
        while True:
            word, content = channel.receive()
            if word == "call":
                _answer(channel, ChildRequest(*cast("Any", content)))


def _answer(channel: Channel, request: ChildRequest) -> None:
    try:
        _enter(request.folder)
        function = pkgutil.resolve_name(request.function)
        with limited(request):
            answer = function(*request.values)
        if isinstance(answer, Iterator):
            _send_items(channel, answer, request)
            answer = None
        channel.send("value", answer)
    except BrokenChannel:
        raise
    except MemoryError:
        channel.send("memory")
    except DeodarError as error:
        channel.send("error", error_data(error))
    except BaseException as error:  # a panic of Rust is no Exception
        channel.send("failed", f"{type(error).__name__}: {first_line(error)}"[:300])


def _enter(folder: str) -> None:
    """Enter the working folder of the parent; one that was removed, or may not be entered, has no files."""
    try:
        if os.getcwd() != folder:
            os.chdir(folder)
    except OSError:
        os.chdir(os.sep)


def _send_items(channel: Channel, items: Iterator[PlainData], request: ChildRequest) -> None:
    for number in range(sys.maxsize):
        with limited(request):
            try:
                sample = next(items)
            except StopIteration:
                return
        channel.send("item", sample)
        if number >= AHEAD - 1 and number % TAKEN == TAKEN - 1 and channel.receive()[0] == "stop":
            if isinstance(items, Generator):
                items.close()
            return


@contextlib.contextmanager
def limited(request: ChildRequest) -> Generator[None]:
    """Limit the time of a call, and the memory that it may take besides what the process has.

    The memory is limited on Linux; elsewhere the system has no such limit, or does not keep it. The alarm
    ends a child without a parent, also inside a library.
    """
    with contextlib.ExitStack() as limits:
        if sys.platform == "linux":
            limits.enter_context(_memory_limit(request.memory))
        if sys.platform != "win32":
            signal.alarm(int(request.seconds) + GRACE)
            limits.callback(signal.alarm, 0)
        yield


@contextlib.contextmanager
def _memory_limit(memory: int) -> Generator[None]:
    # absent on Windows
    import resource

    pages = int(regular_file.read_bytes("/proc/self/statm").split()[0])
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    most = pages * resource.getpagesize() + memory
    resource.setrlimit(resource.RLIMIT_AS, (most if hard < 0 else min(most, hard), hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


if __name__ == "__main__":
    main()
