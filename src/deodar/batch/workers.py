"""Worker processes, one per core, which run pieces of a large batch in parallel.

A worker imports only deodar. It receives the document as JSON text, so that the calling script is not run
again: no `if __name__ == "__main__"` is needed, and a notebook or `python -c` works. One small file that all
processes map holds the completed steps and the request to stop.
"""

from __future__ import annotations

import contextlib
import dataclasses as dc
import mmap
import tempfile
from collections.abc import Callable, Generator, Sequence
from pathlib import Path

from deodar.batch.compute import compute, watching
from deodar.batch.driven_pieces import pieces_driven
from deodar.batch.driver import PoolTask
from deodar.batch.packed_model import PackedModel
from deodar.batch.piece_record import PieceMessage, RecordedPiece, RecordPart
from deodar.batch.pieces import PieceResult
from deodar.batch.pool import Pool
from deodar.batch.run_file import RunOutput
from deodar.batch.simulation_request import SimulationRequest
from deodar.errors import Interrupted
from deodar.model.model import Model
from deodar.worlds._base import World


@dc.dataclass(frozen=True)
class WorkerTask:
    """One piece, as a worker receives it.

    Attributes:
        packed: the model and its world.
        request: the simulation of the piece.
        board: the file that all processes map: for each piece the completed steps, and at the end whether to
            stop.
        number: number of the piece.
        part: the part of the record that the piece reports, and the parent writes; None: the result has the
            samples.
    """

    packed: PackedModel
    request: SimulationRequest
    board: str
    number: int
    part: RecordPart | None = None


def run(
    workers: int,
    model: Model,
    world: World | None,
    pieces: Sequence[SimulationRequest],
    out: RunOutput | None,
    between: Callable[[int], None],
) -> list[PieceResult | None]:
    """Run the pieces in `workers` processes, and return their records.

    The record is None if the run was stopped before the piece began.

    Args:
        workers: number of processes.
        model: the model in its present state.
        world: the world of its sensors; every worker has a copy of it.
        pieces: the simulation of each piece.
        out: the file that receives the samples of all pieces; pieces that it has are not run again.
        between: function that is called from time to time with the number of completed steps of all pieces; a
            KeyboardInterrupt that it raises stops all.

    Raises:
        KeyboardInterrupt: on a second Ctrl-C; the processes end immediately.
        WorkerError: a part of the model cannot be sent to another process, or a process has died.
    """
    packed = PackedModel.of(model, world)
    with _board(len(pieces) + 1) as (path, board), Pool(min(workers, len(pieces)), talks=True) as pool:

        def task(k: int) -> PoolTask:
            part = None if out is None else out.part(k)
            return PoolTask(k, work, (WorkerTask(packed, pieces[k], path, k, part),))

        def check(parts: object) -> None:
            try:
                between(sum(board.tolist()[:-1]))
            except KeyboardInterrupt:  # running pieces report how far they have come
                board[-1] = 1
                raise

        return pieces_driven(pool, len(pieces), out, task, check)


@contextlib.contextmanager
def _board(size: int) -> Generator[tuple[str, memoryview]]:
    with tempfile.TemporaryDirectory(prefix="deodar-") as folder:
        path = Path(folder) / "board"
        path.write_bytes(bytes(8 * size))
        with _mapped(str(path)) as board:
            yield str(path), board


@contextlib.contextmanager
def _mapped(path: str) -> Generator[memoryview]:
    """Map a file as whole numbers that all processes share."""
    with (
        open(path, "r+b") as file,
        mmap.mmap(file.fileno(), 0) as mapped,
        memoryview(mapped) as raw,
        raw.cast("q") as numbers,
    ):
        yield numbers


# ---------------------------------------------------------------------------------------------- in the worker


def work(send: Callable[[PieceMessage], None], job: WorkerTask) -> tuple[PieceResult, list[PieceMessage]]:
    """Run one piece; `send` sends what it records to the process that writes it."""
    with _mapped(job.board) as board:

        def report(done: int) -> None:
            board[job.number] = done
            if board[-1]:
                raise KeyboardInterrupt

        piece = None if job.part is None else RecordedPiece(job.part, send)
        try:
            done = compute(job.packed.model, watching(job.request, report), job.packed.world(), out=piece)
            return done, []
        except Interrupted as error:
            return PieceResult(error.data, False), []
