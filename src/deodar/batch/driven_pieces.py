"""Pieces of a batch that a pool of workers computes."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence

from deodar.batch.driver import PoolTask, driven
from deodar.batch.on_cluster import ClusterPool
from deodar.batch.piece_record import PieceMessage
from deodar.batch.pieces import EMPTY, PieceResult
from deodar.batch.pool import Pool
from deodar.batch.run_file import RunOutput
from deodar.session.interrupt import SecondInterrupt


def pieces_driven(
    pool: Pool | ClusterPool,
    count: int,
    out: RunOutput | None,
    task: Callable[[int], PoolTask],
    check: Callable[[Sequence[PieceResult | None]], None],
) -> list[PieceResult | None]:
    """Run the pieces of a batch in a pool; return their records, None for those that did not begin.

    Args:
        pool: the workers.
        count: number of pieces.
        out: the file that receives the samples; pieces that it has are not run again.
        task: the task of a piece; its key is the number of the piece, its result the record and the messages
            that the piece has not told yet.
        check: as in `driven`, with the records until then.
    """
    complete = set() if out is None else set(out.done)
    parts: list[PieceResult | None] = [EMPTY if k in complete else None for k in range(count)]
    tasks = (task(k) for k in range(count) if k not in complete)

    def heard(number: int, message: PieceMessage) -> None:
        assert out is not None
        out.receive(number, message, beside=True)

    wait = functools.partial(pool.wait, heard=heard) if isinstance(pool, Pool) else pool.wait
    try:
        for number, (part, messages) in driven(pool, tasks, lambda: check(parts), wait=wait):
            for message in messages:
                heard(number, message)
            parts[number] = part
    except SecondInterrupt:
        raise
    except KeyboardInterrupt:
        pass  # the record states which pieces are complete
    return parts
