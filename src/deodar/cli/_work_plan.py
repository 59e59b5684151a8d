"""What an experiment needs on several workers, printed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from deodar.cli import _long
from deodar.cli._answer import CommandAnswer
from deodar.summary import counted, sized

if TYPE_CHECKING:
    from deodar.experiments.setup import Setup


def answer(setup: Setup) -> CommandAnswer:
    """Measure one piece of an experiment, and return memory, time and stored bytes."""
    # start-up time: these bring JAX
    from deodar.experiments.planning import plan

    work = plan(setup)
    times = {n: work.duration(n) for n in work.counts()}
    fields: dict[str, object] = {"pieces": list(work.pieces), "memory": work.memory, "seconds": work.seconds}
    fields |= {"row": work.row, "record": work.record, "stored": work.stored, "most": work.most}
    fields["times"] = {str(n): seconds for n, seconds in times.items()}
    pieces = f"{counted(len(work.pieces), 'piece')} of at most {max(work.pieces)}"
    memory = f"about {work.memory / 2**20:.0f} MB of memory for each worker"
    records = f" and at most {sized(work.record)} of records" if work.record else ""
    why = "each has one piece" if work.most == len(work.pieces) else "the caller is busy with their pieces"
    lines = (
        f"{setup.experiment.name}: {counted(sum(work.pieces), 'trial')} in {pieces}; {memory}",
        f"  stored: {sized(work.row)} for a row{records} of each trial, {sized(work.stored)} in total",
        *(f"  {counted(n, 'worker')}: at most {_long.duration(seconds)}" for n, seconds in times.items()),
        f"More than {counted(work.most, 'worker')} would not help: {why}.",
        "Measured on this machine; trials may end earlier.",
    )
    return CommandAnswer(fields, lines)
