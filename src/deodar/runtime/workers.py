"""Worker processes: one for each core, which run pieces of a large batch beside each other.

A worker imports deodar and nothing else. It gets the document as JSON text, so that the script that started it is not run again:
no `if __name__ == "__main__"` is needed, and a notebook or `python -c` will do. Steps done and the wish to stop stand in one
small file that all processes map.
"""

from __future__ import annotations

import concurrent.futures
import contextlib
import dataclasses as dc
import mmap
import multiprocessing
import multiprocessing.connection
import os
import signal
import sys
import tempfile
import threading
import types
from collections.abc import Callable, Generator, Mapping, Sequence
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

import numpy as np

from deodar.errors import Interrupted, ParameterError, WorkerError
from deodar.model.model import Model
from deodar.parameters import show
from deodar.runtime.parcel import Parcel
from deodar.runtime.pieces import Part
from deodar.worlds._base import World

LOOK_EVERY = 0.1
"""Seconds between two looks at what the workers have done."""


@dc.dataclass(frozen=True)
class Job:
    """One piece, as a worker gets it.

    Attributes:
        parcel: the model and its world.
        settings: the arguments of `simulate` for this piece.
        board: the file that all processes map: for each piece the steps done, and at the end whether to stop.
        number: which piece this is.
    """

    parcel: Parcel
    settings: Mapping[str, Any]
    board: str
    number: int


def require_workers(workers: Any) -> int:
    """The number of workers, refused if it is none."""
    if isinstance(workers, bool) or not isinstance(workers, (int, np.integer)) or workers < 1:
        raise ParameterError(f"workers is {show(workers)}; it is a number of processes, at least 1", fix="One for each core is best")
    return int(workers)


def run(model: Model, world: World | None, pieces: Sequence[Mapping[str, Any]], workers: int, between: Callable[[int], None]) -> list[Part | None]:
    """Run the pieces in so many processes; for each its record, or None if it was not begun before the stop.

    Args:
        model: the model, as it now is.
        world: what it senses; every worker has a copy of it.
        pieces: arguments of `simulate` for each piece.
        workers: number of processes.
        between: told now and then how many steps are done in all pieces together; a KeyboardInterrupt from it stops all.

    Raises:
        WorkerError: something cannot be handed to another process, or a process has died.
    """
    parcel = Parcel.of(model, world)
    context = multiprocessing.get_context("spawn")
    with _board(len(pieces) + 1) as (path, board):
        jobs = [Job(parcel, settings, path, k) for k, settings in enumerate(pieces)]
        started: Callable[[], list[Any]] = list
        pool = concurrent.futures.ProcessPoolExecutor(min(workers, len(jobs)), context, begin)
        try:
            with _alone() as started:
                futures = [pool.submit(work, job) for job in jobs]
            with contextlib.suppress(KeyboardInterrupt):
                _follow(futures, lambda: between(sum(board.tolist()[:-1])))
            board[-1] = 1
            pool.shutdown(cancel_futures=True)
            return [future.result() if not future.cancelled() else None for future in futures]
        except KeyboardInterrupt:  # the second one: at once
            for process in started():
                process.kill()
            raise
        except BrokenProcessPool:
            for process in started():  # one that was just being started is not ended with the others, and would be waited for
                process.kill()
            raise WorkerError(
                "a worker process has died; the system may have ended it because memory ran out", fix="Take fewer workers, or a smaller batch"
            ) from None
        finally:
            board[-1] = 1  # whatever happened, nobody goes on
            pool.shutdown(cancel_futures=True)


@contextlib.contextmanager
def _board(size: int) -> Generator[tuple[str, memoryview]]:
    with tempfile.TemporaryDirectory(prefix="deodar-") as folder:
        path = Path(folder) / "board"
        path.write_bytes(bytes(8 * size))
        with _mapped(str(path)) as board:
            yield str(path), board


@contextlib.contextmanager
def _mapped(path: str) -> Generator[memoryview]:
    """The whole numbers of a file, which all processes that map it see change."""
    with open(path, "r+b") as file, mmap.mmap(file.fileno(), 0) as held, memoryview(held) as raw, raw.cast("q") as numbers:
        yield numbers


def _follow(futures: Sequence[concurrent.futures.Future[Part]], look: Callable[[], None]) -> None:
    """Until all are done; what one of them raises is raised here at once."""
    left = set(futures)
    while left:
        done, left = concurrent.futures.wait(left, LOOK_EVERY, concurrent.futures.FIRST_COMPLETED)
        for future in done:
            future.result()
        look()


@contextlib.contextmanager
def _alone() -> Generator[Callable[[], list[Any]]]:
    """Processes started meanwhile, which it gives, neither import the main script nor see Ctrl-C: that is told to them through the board."""
    others = multiprocessing.active_children()
    main = sys.modules["__main__"]
    mine = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGINT, signal.SIG_IGN) if mine else None
    sys.modules["__main__"] = types.ModuleType("__main__")  # a process that starts looks here for what to import
    try:
        yield lambda: [process for process in multiprocessing.active_children() if process not in others]
    finally:
        sys.modules["__main__"] = main
        if mine:
            signal.signal(signal.SIGINT, before)


# ------------------------------------------------------------------------------------------------ in the worker


def begin() -> None:
    """One core, no Ctrl-C, and an end when the parent ends."""
    os.environ["NPROC"] = "1"
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        multiprocessing.connection.wait([parent.sentinel])
        os._exit(1)


def work(job: Job) -> Part:
    """Run one piece."""
    from deodar.runtime.simulate import simulate

    with _mapped(job.board) as board:

        def told(done: int) -> None:
            board[job.number] = done
            if board[-1]:
                raise KeyboardInterrupt

        try:
            return simulate(job.parcel.model, world=job.parcel.world(), progress=told, **job.settings), True
        except Interrupted as error:
            return error.data, False
