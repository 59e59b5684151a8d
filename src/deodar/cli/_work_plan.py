"""What an experiment needs on several workers, printed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from deodar import codec
from deodar.cli import _long

if TYPE_CHECKING:
    from deodar.experiments.setup import Setup


def show(setup: Setup, json: bool) -> int:
    """Measure one piece of an experiment, and print memory, time and stored bytes."""
    # start-up time: these bring JAX
    from deodar.experiments.planning import plan

    found = plan(setup)
    times = {n: found.duration(n) for n in found.counts()}
    if json:
        answer = {"pieces": list(found.pieces), "memory": found.memory, "seconds": found.seconds}
        answer |= {"row": found.row, "record": found.record, "stored": found.stored, "most": found.most}
        print(codec.text({**answer, "times": {str(n): seconds for n, seconds in times.items()}}))
        return 0
    pieces = f"{_number(len(found.pieces), 'piece')} of at most {max(found.pieces)}"
    memory = f"about {found.memory / 2**20:.0f} MB of memory for each worker"
    print(f"{setup.experiment.name}: {_number(sum(found.pieces), 'trial')} in {pieces}; {memory}")
    records = f" and at most {_size(found.record)} of records" if found.record else ""
    print(f"  stored: {_size(found.row)} for a row{records} of each trial, {_size(found.stored)} in total")
    for n, seconds in times.items():
        print(f"  {_number(n, 'worker')}: at most {_long.duration(seconds)}")
    why = "each has one piece" if found.most == len(found.pieces) else "the caller is busy with their pieces"
    print(f"More than {_number(found.most, 'worker')} would not help: {why}.")
    print("Measured on this machine; trials may end earlier.")
    return 0


def _size(count: int) -> str:
    for unit, factor in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if count >= factor:
            return f"{count / factor:.3g} {unit}"
    return f"{count} bytes"


def _number(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"
