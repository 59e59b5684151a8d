"""The child processes of this process: started when a file is read, kept, and used again."""

from __future__ import annotations

import contextlib
import functools
import os
import secrets
import signal
import subprocess
import sys
import sysconfig
import time
import weakref
from collections import deque
from collections.abc import Generator
from io import BufferedReader, FileIO
from typing import BinaryIO, cast

from deodar.errors import DeodarError
from deodar.guarded.channel import (
    BrokenChannel,
    Channel,
    ChildMessage,
    LateChannel,
    ParentFunction,
    PlainData,
    error_data,
)
from deodar.guarded.child import ChildRequest

MOST_IDLE = 2
"""Most children that are kept without work."""

PIPE_BYTES = 2**20
"""Size of the pipes, where the system can change it: pictures of a video pass faster."""


DAMAGED = "It is damaged, or larger than what is read; use another file"
"""What to do where the cause is not known."""


class EndedChild(Exception):
    """Raised if a child ended before it answered, or is that of another process; the message says by what.

    Attributes:
        fix: what to do.
    """

    def __init__(self, why: str, fix: str = DAMAGED) -> None:
        super().__init__(why)
        self.fix = fix


class Child:
    """One child, which one thread of the process that started it uses at a time.

    A fork of this process has the same pipes. It neither writes to them nor reads from them, because both
    would get a part of each message.

    Attributes:
        functions: names of the functions that it has called.
        yields: whether it is inside a generator.
        useful: whether it waits for another request. After an exception that is none of deodar, or for want
            of memory, a library may be in any state, such as holding a lock, and the child is not used again.
        end: ends it; it is also called when this object is deleted, and at the end of this process.
    """

    def __init__(self) -> None:
        mark = secrets.token_hex(8)
        self.functions: set[str] = set()
        self.yields, self.useful = False, True
        self._seconds = 0.0
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", "deodar.guarded.child", mark],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={
                **os.environ,
                "PYTHONPATH": _search_path(),
                "JAX_PLATFORMS": "cpu",
                "OPENBLAS_NUM_THREADS": "1",
                "RUST_BACKTRACE": "0",
            },
        )
        source = cast(FileIO, cast(BufferedReader, self._process.stdout).raw)
        sink = cast(BinaryIO, self._process.stdin)
        for pipe in (source, sink):
            _enlarge(pipe.fileno())
        self._lent: list[ParentFunction] = []
        self._channel = Channel(source, sink, mark, self._lent)
        self._parent = os.getpid()
        self.end = weakref.finalize(self, _end, self._process, self._parent)

    def request(self, request: ChildRequest) -> None:
        """Ask the child to call a function."""
        self.yields = self.useful = False
        self.functions.add(request.function)
        self._lent.clear()
        self._channel.longest, self._seconds = request.memory, request.seconds
        self.say("call", request)

    def say(self, word: str, content: PlainData = None) -> None:
        """Send a message; that a child has ended is found when its answer is read."""
        if os.getpid() == self._parent:
            with contextlib.suppress(BrokenChannel):
                self._channel.send(word, content)

    def answer(self) -> ChildMessage:
        """Return the next item, or what the function returned or raised.

        Raises:
            EndedChild: the child ended, or was ended after the longest time.
        """
        self.yields = False
        if os.getpid() != self._parent:
            raise EndedChild("the process was forked after it was opened", "Open it again in the new process")
        self._channel.deadline = time.monotonic() + self._seconds
        try:
            word, content = self._channel.receive()
            while word == "ask":
                self._reply(*cast("tuple[int, list[PlainData]]", content))
                word, content = self._channel.receive()
        except BrokenChannel as broken:
            late = isinstance(broken, LateChannel)
            if not late:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    self._process.wait(1)
            self._process.kill()
            status = self._process.wait()
            raise EndedChild(_ended_by(status, self._seconds if late else None)) from None
        self.yields, self.useful = word == "item", word in ("value", "error")
        return word, content

    def stop(self) -> None:
        """Let the child leave the generator that it reads."""
        self.say("stop")
        with contextlib.suppress(EndedChild):
            while self.yields:
                self.answer()

    def _reply(self, number: int, values: list[PlainData]) -> None:
        try:
            self.say("value", self._lent[number](*values))
        except DeodarError as error:
            self.say("error", error_data(error))


class Children:
    """The children of one process that wait for work; several threads may take one each.

    There is no lock: the garbage collector may delete a generator that holds a child, and so bring the child
    back, while this thread is inside any of these lines. Each operation on the queue is one by itself, and it
    drops, and so ends, the child that has waited longest if there are too many.
    """

    def __init__(self) -> None:
        self._waiting: deque[Child] = deque(maxlen=MOST_IDLE)

    @contextlib.contextmanager
    def child(self, function: str) -> Generator[Child]:
        """Return a child, preferably one that has called a function; it is kept if it is still useful."""
        child = self._take(function) or Child()
        try:
            yield child
        finally:
            if child.useful:
                self._waiting.append(child)
            else:
                child.end()

    def _take(self, function: str) -> Child | None:
        """Return a child that waits, preferably one that has called a function; None: none waits."""
        others: list[Child] = []
        with contextlib.suppress(IndexError):
            while function not in (child := self._waiting.pop()).functions:
                others.append(child)
            self._waiting.extendleft(others)
            return child
        child = others.pop(0) if others else None
        self._waiting.extendleft(others)
        return child


def children() -> Children:
    """Return the children of this process; a process that was forked has others than its parent."""
    return _children(os.getpid())


@functools.cache
def _children(pid: int) -> Children:
    return Children()


def _end(process: subprocess.Popen[bytes], parent: int) -> None:
    """End a child, unless this process is a fork of its parent."""
    if os.getpid() == parent:
        process.kill()
        process.communicate()


def _search_path() -> str:
    """Return where the child finds modules: those of Python first, so that no file of a user hides one."""
    python = {sysconfig.get_path(name) for name in ("stdlib", "platstdlib")}
    python |= {os.path.join(folder, "lib-dynload") for folder in python}
    folders = [
        str(path) for path in sys.path if isinstance(path, (str, os.PathLike)) and str(path) not in ("", ".")
    ]
    if "" in sys.path:
        with contextlib.suppress(FileNotFoundError):
            folders.append(os.getcwd())
    return os.pathsep.join(sorted(folders, key=lambda path: path not in python))


def _enlarge(descriptor: int) -> None:
    with contextlib.suppress(ImportError, AttributeError, OSError):
        # absent on Windows
        import fcntl

        fcntl.fcntl(descriptor, fcntl.F_SETPIPE_SZ, PIPE_BYTES)


def _ended_by(status: int, longest: float | None) -> str:
    if longest is not None:
        return f"it takes longer than {longest:g} s"
    if status < 0:
        with contextlib.suppress(ValueError):
            return f"its reader ended by {signal.Signals(-status).name}"
    return f"its reader ended with status {status}"
