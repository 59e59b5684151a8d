"""Records of trials, and their files: one for each trial."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from deodar.codec import Json
from deodar.experiments.trial import Trial
from deodar.model import find
from deodar.model.document import Document
from deodar.model.document_graph import graph
from deodar.recording import files
from deodar.recording.record import dataset

RECORDS = "records"


def trial_records(
    doc: Document, record: Sequence[str], trial: Trial, description: Mapping[str, Json]
) -> dict[str, xarray.Dataset]:
    """Return the records of a trial: under "" what was recorded in it, if anything, and each snapshot under
    its label.
    """
    out: dict[str, xarray.Dataset] = {}
    if record:
        out[""] = _labelled(doc, record, trial.recorded, trial.values, description)
    for label, (time, values) in trial.snapshots.items():
        sample = {path: array[None] for path, array in values.items()}
        out[label] = _labelled(
            doc, list(sample), np.asarray([time]), sample, {**description, "snapshot": label}
        )
    return out


def write_records(folder: Path, key: str, records: Mapping[str, xarray.Dataset]) -> None:
    """Write the record of a trial as KEY.nc, and each snapshot as KEY-LABEL.nc; files of an earlier attempt
    are replaced.
    """
    for label, record in records.items():
        _write(folder / (f"{key}-{label}.nc" if label else f"{key}.nc"), record)


def write_record(
    path: Path, doc: Document, record: Sequence[str], trial: Trial, description: Mapping[str, Json]
) -> None:
    """Write the record of a trial to a file; an existing one is replaced."""
    _write(path, _labelled(doc, record, trial.recorded, trial.values, description))


def _labelled(
    doc: Document,
    names: Sequence[str],
    times: np.ndarray,
    values: Mapping[str, np.ndarray],
    description: Mapping[str, Json],
) -> xarray.Dataset:
    nodes = {node.id: node for node in graph(doc).nodes}
    variables: list[Any] = []
    for name in names:
        entry, port = find.shown(doc, name)
        variables.append((entry, port, nodes[entry.id].axes(port), values[name]))
    return dataset(doc, variables, times, None, {}, description)


def _write(path: Path, record: xarray.Dataset) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    files.save_record(record, path, force=True)
