"""An experiment as a worker process gets it, as plain data."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from deodar import codec
from deodar.batch import packed
from deodar.experiments.design import Design
from deodar.experiments.rows import Row
from deodar.experiments.setup import Setup


@dataclass(frozen=True)
class PackedExperiment:
    """An experiment, its model and its world.

    Attributes:
        experiment: its plain data, as JSON text.
        setup: the model and the world.
    """

    experiment: str
    setup: packed.PackedModel

    @classmethod
    def of(cls, setup: Setup) -> PackedExperiment:
        """A setup, packed.

        Raises:
            WorkerError: something of it cannot be handed to another process.
        """
        plain = setup.experiment.to_data() | {"model": "as handed over"}
        return cls(codec.line(plain), packed.PackedModel.of(setup.model, setup.world))

    def open(self) -> Setup:
        """The setup again."""
        model = self.setup.model  # first: it imports what the experiment's model is made of
        return Setup(Design.from_data(codec.parse(self.experiment)), model, self.setup.world())


def work(handed: PackedExperiment, trials: Sequence[int], records: Path | None) -> list[Row]:
    """The rows of some trials, in a worker."""
    return _opened(handed).rows(trials, records)


@functools.lru_cache(
    maxsize=1
)  # the next piece of the same experiment finds the compiled programs that a model keeps
def _opened(handed: PackedExperiment) -> Setup:
    return handed.open()
