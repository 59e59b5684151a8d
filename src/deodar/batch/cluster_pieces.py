"""Pieces of a large batch on the workers of a cluster.

A worker returns a whole piece: its record, or what it would have sent to the process that writes the record,
which is the caller here too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from deodar.batch.compute import compute
from deodar.batch.driven_pieces import pieces_driven
from deodar.batch.driver import PoolTask
from deodar.batch.on_cluster import ClusterPool
from deodar.batch.packed_model import PackedModel, require_portable
from deodar.batch.piece_record import PieceMessage, PieceState, RecordedPiece, RecordPart
from deodar.batch.pieces import PieceResult
from deodar.batch.run_file import RunOutput
from deodar.batch.simulation_request import SimulationRequest
from deodar.cluster import Cluster
from deodar.errors import WorkerError
from deodar.model.model import Model
from deodar.precision import Arithmetic
from deodar.worlds._base import World


def run(
    cluster: Cluster,
    model: Model,
    world: World | None,
    pieces: Sequence[SimulationRequest],
    out: RunOutput | None,
    between: Callable[[int], None],
) -> list[PieceResult | None]:
    """Run the pieces on a cluster, and return their records, as `workers.run` does.

    Args:
        cluster: where the workers are.
        model: the model in its present state.
        world: the world of its sensors; every piece has a copy of it.
        pieces: the simulation of each piece.
        out: the file that receives the samples of all pieces; pieces that it has are not run again.
        between: function that is called from time to time with the number of completed steps of all pieces; a
            KeyboardInterrupt that it raises stops all, after the pieces that were submitted.

    Raises:
        KeyboardInterrupt: on a second Ctrl-C.
        WorkerError: the workers cannot run the pieces.
    """
    require_one_kind(cluster, world)
    with ClusterPool(cluster, Arithmetic.of(pieces[0].precision).precision) as pool:
        return in_pool(pool, model, world, pieces, out, between)


def require_one_kind(cluster: Cluster, world: World | None) -> None:
    """Raise an error unless workers of one kind of machine can run pieces in this world.

    Raises:
        WorkerError: the cluster may be mixed, or the world is bound to this machine.
    """
    require_portable(world)
    if cluster.mixed:
        raise WorkerError(
            "a record states one machine, so the workers of its cluster may not be mixed",
            fix="Leave mixed out",
        )


def in_pool(
    pool: ClusterPool,
    model: Model,
    world: World | None,
    pieces: Sequence[SimulationRequest],
    out: RunOutput | None,
    between: Callable[[int], None],
) -> list[PieceResult | None]:
    """Run the pieces on the workers of a pool that was entered, and return their records, as `run` does."""
    packed = PackedModel.of(model, world)
    steps = [round(piece.duration / (piece.dt or 1.0)) for piece in pieces]

    def task(k: int) -> PoolTask:
        return PoolTask(k, work, (packed, pieces[k], None if out is None else out.part(k)))

    def check(parts: Sequence[PieceResult | None]) -> None:
        between(sum(n for n, part in zip(steps, parts, strict=True) if part is not None))

    return pieces_driven(pool, len(pieces), out, task, check)


# ---------------------------------------------------------------------------------------------- in the worker


def work(
    packed: PackedModel, request: SimulationRequest, part: RecordPart | None
) -> tuple[PieceResult, list[PieceMessage]]:
    """Run one piece; return its record, or without one the messages that write it."""
    messages: list[PieceMessage] = []

    def keep(message: PieceMessage) -> None:
        if not isinstance(message, PieceState):  # of a moment before the end, which the caller never sees
            messages.append(message)

    piece = None if part is None else RecordedPiece(part, keep)
    return compute(packed.model, request, packed.world(), out=piece), messages
