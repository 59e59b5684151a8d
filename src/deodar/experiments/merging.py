"""Merge the folders of one experiment whose trials were divided among machines that do not see each other."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from deodar.errors import OutputExists, RecordError
from deodar.experiments import results
from deodar.experiments.design import Design
from deodar.experiments.experiment_table import dataset, table
from deodar.experiments.jobs import MACHINE
from deodar.experiments.record_target import PLACE, RECORD, stored_place
from deodar.experiments.rows import KEY, Row, Rows, claim, different
from deodar.model import output
from deodar.recording import files, writer_lock
from deodar.summary import Summarised, Summary, counted

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, repr=False)
class MergedResults(Summarised):
    """The rows of several folders.

    Attributes:
        data: the table, as of an experiment.
        gaps: the ranges of trials without a row, each with its first trial and the one after its last.
    """

    data: xarray.Dataset
    gaps: tuple[tuple[int, int], ...]

    def _summary(self) -> Summary:
        gaps = [(f"{first} to {after - 1}",) for first, after in self.gaps]
        return Summary(f"{self.data.sizes['trial']} merged trials, {counted(len(gaps), 'gap')}", gaps)


def merge_results(folders: Sequence[str | Path], out: str | Path) -> MergedResults:
    """Write the rows of several folders of the same experiment into a new folder.

    Each folder has a part of the trials, as `experiment.run(part=(A, B))` or `--trials A:B` runs it. A trial
    that is in several folders must have the same row in each. Records of trials stay where they are. If all
    parts wrote them into one store, `experiment.run(OUT, records=STORE)` writes its index.

    Args:
        folders: the folders.
        out: the new folder.

    Raises:
        RecordError: a folder has no experiment, another one, or another row of the same trial.
        OutputExists: `out` exists.
    """
    places = [output.location(folder) for folder in folders]
    if not places:
        raise RecordError("no folder is named", fix="Name the folders that deodar experiment wrote")
    stored = [results.stored(place) for place in places]
    identity, rows_by_key = stored[0][0], dict[str, tuple[Row, Path]]()
    for place, (other_identity, rows) in zip(places, stored, strict=True):
        changed = different(other_identity, identity)
        if changed:
            raise RecordError(
                f"holds another experiment than {places[0]}: {', '.join(changed)} differ",
                where=str(place),
                fix="Merge folders of one experiment, version and kind of machine",
            )
        for row in rows:
            first, where = rows_by_key.setdefault(row[KEY], (row, place))
            if computed(first) != computed(row):
                raise RecordError(
                    f"has another row of trial {row['trial']} than {where}",
                    where=str(place),
                    fix="Run this trial again on one machine, and find out which one computes wrongly",
                )
    folder = output.location(out)
    if folder.exists():
        raise OutputExists("exists", where=str(folder), fix="Choose another name")
    claim(folder, results.ROWS, "an experiment")
    with writer_lock.locked(folder):
        merged = Rows(folder / results.ROWS, identity)
        merged.append(
            row for row, _ in sorted(rows_by_key.values(), key=lambda placed_row: placed_row[0]["trial"])
        )
        stores = {stored_place(place) for place in places}
        for name in (results.EXPERIMENT, results.MODEL, *((PLACE,) if len(stores) == 1 else ())):
            _copy(places[0], folder, name)
        merged_table = dataset(merged.found.values(), identity)
        output.write(folder / results.TABLE, table(merged_table).encode())
        files.save_record(merged_table, folder / results.DATASET, force=True)
    trials = set(merged_table["trial"].values.tolist())
    return MergedResults(merged_table, gaps(trials, len(Design.load(folder / results.EXPERIMENT).cells)))


def gaps(trials: set[int], of: int) -> tuple[tuple[int, int], ...]:
    """Return the ranges of numbers below `of` that are not among some, each as first and one after the
    last.
    """
    exists = [*(k in trials for k in range(of)), True]
    first = [k for k in range(of) if not exists[k] and (k == 0 or exists[k - 1])]
    return tuple((k, exists.index(True, k)) for k in first)


def computed(row: Row) -> Row:
    """Return what a trial alone determines: without the machine that ran it and the place of its record."""
    return {key: value for key, value in row.items() if key not in (MACHINE, RECORD)}


def _copy(source: Path, folder: Path, name: str) -> None:
    """Copy a file, and the arrays of a model beside it."""
    for file in [source / name, *source.glob(f"{Path(name).stem}.*.npz")]:
        if file.is_file():
            shutil.copyfile(file, folder / file.name)
