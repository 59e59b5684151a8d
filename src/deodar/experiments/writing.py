"""Records of trials: one file for each trial."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from deodar.codec import Json
from deodar.experiments.trial import Trial
from deodar.model import find
from deodar.model.document import Document
from deodar.model.resolve import resolve
from deodar.recording import files
from deodar.recording.record import dataset

RECORDS = "records"


def write_records(
    folder: Path, key: str, doc: Document, record: Sequence[str], result: Trial, about: Mapping[str, Json]
) -> None:
    """Write the record of a trial as KEY.nc, and each snapshot as KEY-LABEL.nc; files of an earlier attempt
    are replaced.
    """
    if record:
        _write(folder / f"{key}.nc", doc, record, result.recorded, result.values, about)
    for label, (time, values) in result.snapshots.items():
        kept = {path: array[None] for path, array in values.items()}
        _write(
            folder / f"{key}-{label}.nc",
            doc,
            list(kept),
            np.asarray([time]),
            kept,
            {**about, "snapshot": label},
        )


def write_record(
    path: Path, doc: Document, record: Sequence[str], result: Trial, about: Mapping[str, Json]
) -> None:
    """Write the record of a trial to a file; an existing one is replaced."""
    _write(path, doc, record, result.recorded, result.values, about)


def _write(
    path: Path,
    doc: Document,
    names: Sequence[str],
    times: np.ndarray,
    values: Mapping[str, np.ndarray],
    about: Mapping[str, Json],
) -> None:
    nodes = {node.id: node for node in resolve(doc)[0]}
    variables: list[Any] = []
    for name in names:
        entry, port = find.shown(doc, name)
        variables.append((entry, port, nodes[entry.id].axes(port), values[name]))
    path.parent.mkdir(parents=True, exist_ok=True)
    files.save_record(dataset(doc, variables, times, None, {}, about), path, force=True)
