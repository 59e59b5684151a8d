"""Pieces of a batch that a pool of workers computes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from deodar.batch.driver import PoolTask, WorkerPool, driven
from deodar.batch.pieces import EMPTY, PieceResult
from deodar.batch.run_file import RunOutput
from deodar.session.interrupt import SecondInterrupt


def pieces_driven(
    pool: WorkerPool,
    count: int,
    out: RunOutput | None,
    task: Callable[[int], PoolTask],
    check: Callable[[Sequence[PieceResult | None]], None],
    wait: Callable[[float], list[tuple[Any, Any]]],
) -> list[PieceResult | None]:
    """Run the pieces of a batch in a pool; return their records, None for those that did not begin.

    Args:
        pool: the workers.
        count: number of pieces.
        out: the file that receives the samples; pieces that it has are not run again.
        task: the task of a piece; its key is the number of the piece.
        check: as in `driven`, with the records until then.
        wait: as in `driven`, with the record of a piece as its result.
    """
    known = set() if out is None else set(out.done)
    parts: list[PieceResult | None] = [EMPTY if k in known else None for k in range(count)]
    tasks = (task(k) for k in range(count) if k not in known)
    try:
        for number, part in driven(pool, tasks, lambda: check(parts), wait=wait):
            parts[number] = part
    except SecondInterrupt:
        raise
    except KeyboardInterrupt:
        pass  # the record states which pieces are complete
    return parts
