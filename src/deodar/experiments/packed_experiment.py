"""An experiment as plain data, for a worker process."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from deodar import codec
from deodar.batch import packed_model
from deodar.experiments.design import Design
from deodar.experiments.record_target import RecordTarget
from deodar.experiments.rows import Row
from deodar.experiments.setup import Setup


@dataclass(frozen=True)
class PackedExperiment:
    """An experiment, its model and its world.

    Attributes:
        experiment: the plain data of the experiment, as JSON text.
        setup: the model and the world.
    """

    experiment: str
    setup: packed_model.PackedModel

    @classmethod
    def of(cls, setup: Setup) -> PackedExperiment:
        """Pack a setup.

        Raises:
            WorkerError: a part of it cannot be sent to another process.
        """
        plain = setup.experiment.to_data() | {"model": "packed"}
        return cls(codec.line(plain), packed_model.PackedModel.of(setup.model, setup.world))


def work(handed: PackedExperiment, trials: Sequence[int], records: Path | RecordTarget | None) -> list[Row]:
    """Run some trials in a worker and return their rows."""
    return _opened(handed).rows(trials, records)


def repeat(handed: PackedExperiment, trial: int, watch: Sequence[str], path: Path) -> Row:
    """Run a trial again in a worker, write its record, and return its row."""
    return _opened(handed).repeat(trial, watch, path)


def prepare(handed: PackedExperiment) -> None:
    """Open an experiment in a worker, which has then imported what a repetition needs."""
    _opened(handed)


# the next piece of the same experiment finds the compiled programs that a model keeps
@functools.lru_cache(maxsize=1)
def _opened(handed: PackedExperiment) -> Setup:
    model = handed.setup.model  # first: it imports the modules that the experiment's model needs
    return Setup(Design.from_data(codec.parse(handed.experiment)), model, handed.setup.world())
