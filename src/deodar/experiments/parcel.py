"""An experiment as a worker process gets it, as plain data."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from deodar import codec
from deodar.batch import parcel
from deodar.experiments.bench import Bench
from deodar.experiments.design import Design
from deodar.experiments.rows import Row


@dataclass(frozen=True)
class Parcel:
    """An experiment, its model and its world.

    Attributes:
        experiment: its plain data, as JSON text.
        bench: the model and the world.
    """

    experiment: str
    bench: parcel.PackedModel

    @classmethod
    def of(cls, bench: Bench) -> Parcel:
        """A bench, packed.

        Raises:
            WorkerError: something of it cannot be handed to another process.
        """
        plain = bench.experiment.to_data() | {"model": "as handed over"}
        return cls(codec.line(plain), parcel.PackedModel.of(bench.model, bench.world))

    def open(self) -> Bench:
        """The bench again."""
        model = self.bench.model  # first: it imports what the experiment's model is made of
        return Bench(Design.from_data(codec.parse(self.experiment)), model, self.bench.world())


def work(handed: Parcel, trials: Sequence[int], records: Path | None) -> list[Row]:
    """The rows of some trials, in a worker."""
    return _opened(handed).rows(trials, records)


@functools.lru_cache(
    maxsize=1
)  # the next piece of the same experiment finds the compiled programs that a model keeps
def _opened(handed: Parcel) -> Bench:
    return handed.open()
