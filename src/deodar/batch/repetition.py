"""`repeat`: run a record again, and compare."""

from __future__ import annotations

from typing import TYPE_CHECKING

from deodar.batch.simulate import simulate
from deodar.recording import repeat as records
from deodar.recording.repeat import Repetition
from deodar.resources import Resources
from deodar.worlds._base import World

if TYPE_CHECKING:
    import xarray


def repeat(
    record: xarray.Dataset, world: World | None = None, trust: bool = False, on: Resources = Resources()
) -> Repetition:
    """Run a record again as it was, and compare every value.

    With the versions, the machine and the world of the record the repetition has the same bits.

    Args:
        record: the record, as `simulate` returns it or `dd.load_record` reads it.
        world: the world to run it in. None: that of the record, opened again.
        trust: whether functions that its document names may be imported and run.
        on: the device, if it is not that of the record, and the `progress`.

    Raises:
        RecordError: the record does not say what made it, or a session made it.
        WorldError: its world is not known, or its file holds something else.
        Untrusted: its document names a function, and `trust` is not given.
    """
    return records.repeat(record, simulate, world, trust, on)
