"""A pool of worker processes that one thread drives.

The pool has no threads of its own, so that no part of it outlives the call that uses it.

Each worker has a pipe. It receives a task, may send messages during it, sends the result back, and ends when
its pipe is closed. The
parent waits for pipes and for the end of processes at the same time; a result that it has not received then
is not read later.
"""

from __future__ import annotations

import contextlib
import ctypes
import multiprocessing
import multiprocessing.connection
import os
import pickle
import platform
import signal
import sys
import threading
import time
import traceback
import types
from collections.abc import Callable, Generator, Hashable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from typing import Any, Self

from deodar.errors import DeodarError, WorkerError

Task = tuple[Callable[..., Any], tuple[Any, ...]]
"""A function of a module and its arguments."""


LONGEST = 600.0
"""Seconds of work after which a worker is replaced by a new one.

The memory maps of compiled programs accumulate in a process, and Linux allows 65530: after an hour of
programs with worlds, of several thousand maps each, XLA finds no memory and ends the process.
"""


_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
"""Numbers of two options of `mallopt`, from malloc.h."""


@dataclass
class _Worker:
    """A process, its pipe, the seconds that it has worked, and when it began its task."""

    process: SpawnProcess
    pipe: Connection
    worked: float = 0.0
    began: float = 0.0

    def end(self, now: bool = False) -> None:
        if now:
            self.process.kill()
        self.pipe.close()


class Pool:
    """Worker processes of one core each, as a context: leaving it ends them, immediately after an exception.

    Args:
        count: number of processes.
        main: whether they import the main script, as functions that it defines need.
        talks: whether the first argument of each task is a function that sends a message to this process.
    """

    def __init__(self, count: int, main: bool = False, talks: bool = False) -> None:
        self._count, self._main, self._talks = count, main, talks
        self._idle: list[_Worker] = []
        self._busy: dict[Connection, tuple[_Worker, Hashable]] = {}

    def __enter__(self) -> Self:
        with quiet(self._main):
            for _ in range(self._count):
                self._idle.append(_started(self._talks))
        return self

    def __exit__(self, kind: type[BaseException] | None, *others: object) -> None:
        workers = [*self._idle, *(worker for worker, _ in self._busy.values())]
        for worker in workers:
            worker.end(now=kind is not None)
        for worker in workers:
            worker.process.join()

    @property
    def workers(self) -> int:
        """Number of workers."""
        return self._count

    @property
    def idle(self) -> int:
        """Number of workers without a task."""
        return len(self._idle)

    @property
    def busy(self) -> int:
        """Number of workers with a task."""
        return len(self._busy)

    def give(self, key: Hashable, function: Callable[..., Any], *arguments: Any) -> None:
        """Send a task to an idle worker; `wait` returns its result under the key."""
        worker = self._idle.pop()
        if worker.worked > LONGEST:
            worker.end()
            worker.process.join()
            with quiet(self._main):
                worker = _started(self._talks)
        worker.began = time.monotonic()
        self._busy[worker.pipe] = worker, key
        # `wait` reports a worker that has died
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            worker.pipe.send((function, arguments))

    def wait(self, seconds: float, heard: Callable[[Any, Any], None] | None = None) -> list[tuple[Any, Any]]:
        """Return keys and results of completed tasks, after waiting at most `seconds` for a message.

        Args:
            seconds: the longest wait.
            heard: called with the key of a task and each message that it sends.

        Raises:
            WorkerError: a process has died, or a result cannot be sent between processes.
            Exception: the exception that a task has raised.
        """
        ends = {worker.process.sentinel: pipe for pipe, (worker, _) in self._busy.items()}
        ready = multiprocessing.connection.wait([*self._busy, *ends], seconds)
        out: list[tuple[Any, Any]] = []
        for pipe in dict.fromkeys(ends.get(source, source) for source in ready):  # type: ignore[call-overload]
            worker, key = self._busy[pipe]
            try:
                good, message = pickle.loads(pipe.recv_bytes())
            except (EOFError, OSError):
                raise self._ended(worker) from None
            if good is None:
                assert heard is not None
                heard(key, message)
                continue
            if not good:
                raise message
            del self._busy[pipe]
            worker.worked += time.monotonic() - worker.began
            self._idle.append(worker)
            out.append((key, message))
        return out

    def _ended(self, worker: _Worker) -> WorkerError:
        """Return why a worker may have ended."""
        if self._main and not worker.worked:
            return WorkerError(
                "a worker process ended before its first task: it imports the script, which defines what the"
                " task uses, and so must not run it again",
                fix='Write the calls of the script below if __name__ == "__main__":, or move its classes and'
                " functions into a module",
            )
        return WorkerError(
            "a worker process ended unexpectedly; the system may have stopped it for lack of memory",
            fix="Use fewer workers, or a smaller batch",
        )


def _started(talks: bool) -> _Worker:
    context = multiprocessing.get_context("spawn")
    parent, child = context.Pipe()
    process = context.Process(target=_serve, args=(child, talks))
    process.start()
    child.close()  # so that the worker's end is the only one, and its death is detected
    return _Worker(process, parent)


@contextlib.contextmanager
def quiet(main: bool, signals: bool = True) -> Generator[None]:
    """Start processes that ignore Ctrl-C: the parent stops them.

    Args:
        main: whether they import the main script.
        signals: whether they ignore Ctrl-C.
    """
    script = sys.modules["__main__"]
    mine = signals and threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGINT, signal.SIG_IGN) if mine else None
    if not main:
        # a process that starts looks here for what to import
        sys.modules["__main__"] = types.ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = script
        if mine:
            signal.signal(signal.SIGINT, before)


# ---------------------------------------------------------------------------------------------- in the worker


def _serve(pipe: Connection, talks: bool) -> None:
    """Run tasks until the pipe is closed: on one core, without Ctrl-C, and at most until the parent ends."""
    os.environ["NPROC"] = "1"
    use_processor()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()

    def send(message: object) -> None:  # it waits while the parent has many unread messages
        pipe.send_bytes(pickle.dumps((None, message)))

    with contextlib.suppress(EOFError, BrokenPipeError, ConnectionResetError):
        while True:
            function, arguments = pipe.recv()
            pipe.send_bytes(done(function, (send, *arguments) if talks else arguments))


def use_processor() -> None:
    """Let this process, a worker, compute on the CPU alone, and keep freed memory."""
    import jax  # start-up time of the parent

    # workers are cores of the CPU; otherwise each of them would take most of a graphics processor's memory
    jax.config.update("jax_platforms", "cpu")
    _keep_freed_memory()


def _keep_freed_memory() -> None:
    """Let the GNU C library keep the memory of freed arrays for the next ones.

    By default it returns those above 32 MB to the system, which clears each page again. A large batch in a
    world with a camera allocates such arrays at each step of the camera.
    """
    if platform.libc_ver()[0] == "glibc":
        libc, most = ctypes.CDLL(None), 2**31 - 1
        libc.mallopt(_TRIM_THRESHOLD, most)
        libc.mallopt(_MMAP_THRESHOLD, most)


def done(function: Callable[..., Any], arguments: tuple[Any, ...]) -> bytes:
    """Return whether the task succeeded, and its result or error, pickled."""
    try:
        outcome = function(*arguments)
    except Exception as error:
        if not isinstance(error, DeodarError):  # the messages of deodar's own errors are sufficient
            error.add_note(f"In a worker process:\n{traceback.format_exc()}")
        return _failed(error, f"the error {type(error).__name__} ({error})")
    try:
        return pickle.dumps((True, outcome))
    except Exception as error:  # a class may raise any exception
        return _failed(_unsendable("the result", error), "the result")


def _failed(error: Exception, part: str) -> bytes:
    try:
        packed = pickle.dumps((False, error))
        pickle.loads(packed)  # an error may need more arguments to be restored than it stores
    except Exception as reason:
        return pickle.dumps((False, _unsendable(part, reason)))
    return packed


def _unsendable(part: str, reason: Exception) -> WorkerError:
    return WorkerError(
        f"{part} of a worker cannot be sent to another process ({type(reason).__name__}: {reason})",
        fix="Run without workers",
    )


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        multiprocessing.connection.wait([parent.sentinel])
        os._exit(1)
