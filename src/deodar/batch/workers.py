"""Worker processes: one for each core, which run pieces of a large batch beside each other.

A worker imports deodar and nothing else. It gets the document as JSON text, so that the script that started
it is not run again: no `if __name__ == "__main__"` is needed, and a notebook or `python -c` will do. Steps
done and the wish to stop stand in one small file that all processes map.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
import mmap
import tempfile
from collections.abc import Callable, Generator, Sequence
from pathlib import Path

from deodar.batch.compute import compute
from deodar.batch.packed import PackedModel
from deodar.batch.pieces import PieceResult
from deodar.batch.pool import Pool
from deodar.batch.request import SimulationRequest
from deodar.errors import Interrupted
from deodar.model.model import Model
from deodar.session.interrupt import AtOnce
from deodar.worlds._base import World

LOOK_EVERY = 0.1
"""Seconds between two looks at what the workers have done."""


@dc.dataclass(frozen=True)
class WorkerTask:
    """One piece, as a worker gets it.

    Attributes:
        packed: the model and its world.
        request: the simulation that the piece is.
        board: the file that all processes map: for each piece the steps done, and at the end whether to stop.
        number: which piece this is.
    """

    packed: PackedModel
    request: SimulationRequest
    board: str
    number: int


def run(
    model: Model,
    world: World | None,
    pieces: Sequence[SimulationRequest],
    workers: int,
    between: Callable[[int], None],
) -> list[PieceResult | None]:
    """Run the pieces in `count` processes; return the record of each, or None if the run was stopped before
    the piece began.

    Args:
        model: the model, as it now is.
        world: what it senses; every worker has a copy of it.
        pieces: the simulation that each piece is.
        workers: number of processes.
        between: called from time to time with the number of completed steps of all pieces; a
            KeyboardInterrupt that it raises stops all.

    Raises:
        KeyboardInterrupt: on a second Ctrl-C; the processes are ended at once.
        WorkerError: something cannot be handed to another process, or a process has died.
    """
    packed = PackedModel.of(model, world)
    parts: list[PieceResult | None] = [None] * len(pieces)
    with _board(len(pieces) + 1) as (path, board), Pool(min(workers, len(pieces))) as pool:
        waiting = [WorkerTask(packed, piece, path, k) for k, piece in enumerate(pieces)][::-1]
        while waiting or pool.busy:
            while waiting and pool.idle:
                pool.give(waiting[-1].number, work, waiting.pop())
            for number, part in pool.wait(LOOK_EVERY):
                parts[number] = part
            if not board[-1]:
                try:
                    between(sum(board.tolist()[:-1]))
                except AtOnce:
                    raise
                except KeyboardInterrupt:  # those that run say how far they have come
                    board[-1] = 1
                    waiting.clear()
    return parts


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
    with (
        open(path, "r+b") as file,
        mmap.mmap(file.fileno(), 0) as held,
        memoryview(held) as raw,
        raw.cast("q") as numbers,
    ):
        yield numbers


# ---------------------------------------------------------------------------------------------- in the worker


def work(job: WorkerTask) -> PieceResult:
    """Run one piece."""
    with _mapped(job.board) as board:

        def told(done: int) -> None:
            board[job.number] = done
            if board[-1]:
                raise KeyboardInterrupt

        try:
            return compute(job.packed.model, job.request, job.packed.world(), told)
        except Interrupted as error:
            return PieceResult(error.data, False)
