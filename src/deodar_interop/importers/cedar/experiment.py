"""Experiments of cedar: sequences of actions, each with a condition, as an `Experiment` of a model."""

from __future__ import annotations

import dataclasses as dc
from pathlib import Path

from deodar import codec, regular_file
from deodar.errors import DocumentError, reading
from deodar.experiments.experiment import Experiment
from deodar.experiments.trial import TrialPlan
from deodar.importers._beside import in_folder
from deodar.importers.opening import require
from deodar.importers.report import ImportReport
from deodar.model.document_files import MOST_BYTES
from deodar.model.model import Model
from deodar.summary import Summarised, Summary
from deodar_interop.importers.cedar import translate
from deodar_interop.importers.cedar.experiment_reading import ExperimentReading
from deodar_interop.importers.cedar.file import members, text


@dc.dataclass(frozen=True, repr=False)
class ImportedExperiment(Summarised):
    """An experiment made from a file of cedar, and the report of the conversion."""

    experiment: Experiment
    report: ImportReport

    def _summary(self) -> Summary:
        return Summary(f"{self.experiment.name!r} from {self.report.file}", [(self.report.summary(),)])


def load_cedar_experiment(path: str | Path, architecture: str | Path) -> ImportedExperiment:
    """Read an experiment of cedar for an architecture of cedar.

    What changes a parameter at the start of trials becomes its value, or a factor with a level for each
    trial. Later actions are carried out at their time, or when their event occurs; those of one trial in this
    trial only. `EndTrial` ends the trial, and stored data become a snapshot. What cannot be carried over is
    in the report.

    Args:
        path: the file of the experiment.
        architecture: the file of the architecture.

    Raises:
        DocumentError: one of the files cannot be read, or the first is no experiment of cedar.
    """
    path, place = require(path), require(architecture)
    body = members(codec.foreign(_content(path)))
    if "ActionSequences" not in body:
        raise DocumentError(
            "is no experiment of cedar", where=str(path), fix='It is an object with "ActionSequences"'
        )
    parts, imported = translate.translated(_content(place), place.name, in_folder(place.parent))
    reading = ExperimentReading(imported.model.document, parts, body)
    experiment = Experiment(
        text(body.get("name")) or path.stem,
        Model(document=reading.doc),
        TrialPlan(reading.limit, events=tuple(reading.events.values()), actions=tuple(reading.actions)),
        trials=1 if reading.factors else reading.repetitions,
        factors=tuple(reading.factors),
    )
    return ImportedExperiment(experiment, ImportReport("cedar", path.name, reading.lines))


def _content(path: Path) -> bytes:
    """Return the content of a file of moderate size."""
    with reading(path, DocumentError):
        if path.stat().st_size > MOST_BYTES:
            raise DocumentError(f"is larger than {MOST_BYTES // 2**20} MiB")
        return regular_file.read_bytes(path)
