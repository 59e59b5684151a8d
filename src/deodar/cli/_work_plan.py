"""What an experiment needs on several workers, printed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from deodar import codec
from deodar.cli import _long
from deodar.summary import counted, sized

if TYPE_CHECKING:
    from deodar.experiments.setup import Setup


def show(setup: Setup, json: bool) -> int:
    """Measure one piece of an experiment, and print memory, time and stored bytes."""
    # start-up time: these bring JAX
    from deodar.experiments.planning import plan

    work = plan(setup)
    times = {n: work.duration(n) for n in work.counts()}
    if json:
        answer = {"pieces": list(work.pieces), "memory": work.memory, "seconds": work.seconds}
        answer |= {"row": work.row, "record": work.record, "stored": work.stored, "most": work.most}
        print(codec.text({**answer, "times": {str(n): seconds for n, seconds in times.items()}}))
        return 0
    pieces = f"{counted(len(work.pieces), 'piece')} of at most {max(work.pieces)}"
    memory = f"about {work.memory / 2**20:.0f} MB of memory for each worker"
    print(f"{setup.experiment.name}: {counted(sum(work.pieces), 'trial')} in {pieces}; {memory}")
    records = f" and at most {sized(work.record)} of records" if work.record else ""
    print(f"  stored: {sized(work.row)} for a row{records} of each trial, {sized(work.stored)} in total")
    for n, seconds in times.items():
        print(f"  {counted(n, 'worker')}: at most {_long.duration(seconds)}")
    why = "each has one piece" if work.most == len(work.pieces) else "the caller is busy with their pieces"
    print(f"More than {counted(work.most, 'worker')} would not help: {why}.")
    print("Measured on this machine; trials may end earlier.")
    return 0
