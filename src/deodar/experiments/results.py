"""The results of an experiment: a folder with a row for each trial, which can be resumed, and the table of
the rows.
"""

from __future__ import annotations

import contextlib
import hashlib
import tempfile
from collections.abc import Generator, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, cast

from deodar import codec, file_version, regular_file
from deodar.batch.driver import WorkerWatch
from deodar.batch.on_cluster import ClusterPool
from deodar.batch.packed_model import require_portable
from deodar.cluster import Cluster
from deodar.codec import JsonObject
from deodar.compiler.device import find
from deodar.credentials import masked_data
from deodar.errors import DeodarError, ParameterError, RecordError, WorkerError
from deodar.experiments import packed_experiment, record_index, row_line
from deodar.experiments.comparing import compare
from deodar.experiments.experiment_migrations import migrate
from deodar.experiments.experiment_table import dataset, lacks, read_row, table
from deodar.experiments.jobs import Job, run_jobs
from deodar.experiments.record_target import (
    RecordTarget,
    claimed,
    require_here,
    require_shared,
    require_visible,
    unseen,
)
from deodar.experiments.rows import ABOUT, Row, Rows, claim
from deodar.experiments.setup import Setup
from deodar.experiments.writing import RECORDS
from deodar.model import document_files as documents
from deodar.model import output
from deodar.model.document import Document
from deodar.recording import files, provenance, writer_lock
from deodar.recording.store_address import StoreAddress
from deodar.resources import Resources

if TYPE_CHECKING:
    import xarray

ROWS, TABLE, DATASET, EXPERIMENT, MODEL = (
    "trials.jsonl",
    "trials.csv",
    "trials.nc",
    "experiment.json",
    "model.json",
)


def run_trials(
    setup: Setup,
    out: str | Path | None,
    on: Resources = Resources(),
    part: tuple[int, int] | None = None,
    watch: WorkerWatch | None = None,
) -> xarray.Dataset:
    """Run the trials without a row, write the table, and return it.

    Args:
        setup: the opened experiment.
        out: the folder; None: results are not stored.
        on: workers or a cluster, and how the number of trials that are done is shown.
        part: the first trial and the one after the last, to run a part of the trials; pieces that begin there
            are run whole, so that parts without gaps between them are the whole experiment.
        watch: function that is called several times a second while workers run or are awaited, and ends
            them once it returns true (see `run_jobs`).

    Raises:
        RecordError: another process runs an experiment in this folder.
    """
    if part is not None and not 0 <= part[0] < part[1] <= setup.trials:
        raise ParameterError(
            f"the trials {part[0]} to {part[1]} are no part of 0 to {setup.trials}",
            fix=f"For example 0:{max(1, setup.trials // 2)}",
        )
    if setup.store:
        _require_records(setup, out, on.shared)
    if out is None:
        with tempfile.TemporaryDirectory(prefix="deodar-") as folder:
            return _run_trials(setup, Path(folder), on, part, watch)
    folder = output.location(out)
    claim(folder, ROWS, "an experiment")
    with writer_lock.locked(folder):
        return _run_trials(setup, folder, on, part, watch)


def _run_trials(
    setup: Setup, out: Path, on: Resources, part: tuple[int, int] | None, watch: WorkerWatch | None
) -> xarray.Dataset:
    handed = packed_experiment.PackedExperiment.of(setup) if on.shared else None
    with _opened(setup, handed, on, watch) as pool:
        identity = _about(setup, on.shared, out, None if pool is None else pool.made_by)

        def read(older: JsonObject) -> JsonObject:  # older rows name no packages
            packages = {"packages": identity["packages"]} if "packages" in identity else {}
            return packages | migrate(older, setup.model.document)

        rows = Rows(out / ROWS, identity, read=read)
        if not (out / MODEL).exists():
            documents.save(setup.model.document, out / MODEL)
        if not (out / EXPERIMENT).exists():
            content = _plan(setup) | {file_version.KEY: file_version.HERE}
            output.write(out / EXPERIMENT, (codec.text(content) + "\n").encode())
        records: Path | RecordTarget | None = out / RECORDS if setup.recorded else None
        if setup.store:
            target = records = claimed(StoreAddress.of(setup.store), identity, rows.found, out, read)
            if pool is not None:
                require_visible(target, pool.everywhere(unseen, target))
        elif len(rows.found) < setup.trials:
            require_here(rows.found, out)
            if pool is not None and records is not None:
                _require_shared(pool, out)
        jobs = list(_jobs(setup, handed, records, part))
        run_jobs(jobs, rows, on, pool, watch)
        if pool is not None and pool.cluster.mixed:
            compare(jobs, rows, pool, out)
    trials = dataset(rows.found.values(), identity)
    output.write(out / TABLE, table(trials).encode())
    files.save_record(trials, out / DATASET, force=True)
    if isinstance(records, RecordTarget) and len(rows.found) == setup.trials:
        record_index.write(records, rows.found.values())
    return trials


def _require_records(setup: Setup, out: str | Path | None, workers: bool) -> None:
    """Refuse a store of records for an experiment without records or without a folder of rows, and one that
    workers cannot see.
    """
    if not setup.recorded:
        raise ParameterError(
            "a store of records is named, but the trials record nothing",
            fix="Name ports in watch=[...] of the plan (record in a file), or leave records out",
        )
    if out is None:
        raise ParameterError(
            "a store of records needs a folder of rows, which name the records",
            fix="Name it too: run('results', records=...)",
        )
    address = StoreAddress.of(setup.store)
    address.open()
    if workers:
        require_shared(address)


@contextlib.contextmanager
def _opened(
    setup: Setup, handed: packed_experiment.PackedExperiment | None, on: Resources, watch: WorkerWatch | None
) -> Generator[ClusterPool | None]:
    """Connect to a cluster whose workers can run the experiment; None without a cluster.

    Raises:
        WorkerError: they cannot; no trial has been run.
    """
    if on.cluster is None or handed is None:
        yield None
        return
    require_portable(setup.world)
    with ClusterPool(Cluster.of(on.cluster), setup.experiment.precision, watch) as pool:
        pool.everywhere(packed_experiment.prepare, handed)
        yield pool


def _require_shared(pool: ClusterPool, out: Path) -> None:
    """Raise an error unless every worker sees the folder into which trials write their records."""
    if not all(pool.everywhere(_sees, out / EXPERIMENT, regular_file.read_bytes(out / EXPERIMENT))):
        raise WorkerError(
            "trials write records, but a worker does not see the folder of the results",
            where=str(out),
            fix="Use a folder that all machines share, or an experiment without records and snapshots",
        )


def _sees(file: Path, content: bytes) -> bool:
    """Return whether a worker sees a file with this content."""
    try:
        return regular_file.read_bytes(file) == content
    except OSError:
        return False


def _jobs(
    setup: Setup,
    handed: packed_experiment.PackedExperiment | None,
    records: Path | RecordTarget | None,
    part: tuple[int, int] | None,
) -> Iterator[Job]:
    for piece in setup.pieces():
        if part is not None and not part[0] <= piece[0] < part[1]:
            continue
        keys, arguments = tuple(f"{k:06}" for k in piece), {"trials": piece, "records": records}
        if handed is None:
            yield Job(keys, setup.rows, arguments, len(piece))
        else:
            yield Job(keys, packed_experiment.work, {"handed": handed, **arguments}, len(piece))


def _about(setup: Setup, workers: bool, folder: Path, made: Mapping[str, str] | None = None) -> JsonObject:
    """Return the identity of the experiment: a file never mixes rows of two experiments.

    Args:
        setup: the opened experiment.
        workers: whether workers of one core run it.
        folder: the folder of the results.
        made: versions and machine of the workers of a cluster.
    """
    digest = _digest_in(folder, setup.model.document) or _digest(*documents.dumps(setup.model.document))
    made_here = provenance.made_by(find(), setup.experiment.precision) | ({"cores": "1"} if workers else {})
    unit = setup.model.document.time_unit
    return {
        **_plan(setup),
        "model": digest,
        "world": provenance.described(setup.world),
        "time_unit": unit,
        "made_by": made_here if made is None else dict(made),
    }


def _digest(text: str, arrays: bytes | None) -> str:
    return hashlib.sha256(text.encode() + (arrays or b"")).hexdigest()


def _digest_in(folder: Path, doc: Document) -> str:
    """The digest of the model file in the folder, if it holds the same document, or "".

    An older version of deodar wrote the same document as a different text.
    """
    try:
        if documents.load(folder / MODEL) != doc:
            return ""
        document = codec.parse(regular_file.read_text(folder / MODEL))
        arrays = None
        if "arrays" in document:
            arrays = regular_file.read_bytes(folder / document["arrays"]["file"])
            document["arrays"]["file"] = ""
    except (DeodarError, OSError, ValueError):
        return ""
    return _digest(codec.text(document) + "\n", arrays)


def _plan(setup: Setup) -> JsonObject:
    """Return the plain data of an experiment whose model is beside it, without credentials of a camera."""
    plain = codec.parse(codec.line({**setup.experiment.to_data(), "model": MODEL}))
    return cast("JsonObject", masked_data(plain))


# -------------------------------------------------------------------------------------------------- the table


def load_results(path: str | Path) -> xarray.Dataset:
    """Read the table of an experiment from its folder; of an incomplete experiment the existing trials.

    Raises:
        RecordError: it is not the folder of an experiment.
    """
    folder = output.location(path)
    try:
        with regular_file.open_binary(folder / ROWS) as file:
            identity, checked = row_line.read_first(file.readline(), ABOUT, folder / ROWS)
            rows = (row_line.read(line, checked) for line in file if line.endswith(b"\n"))
            return dataset(rows, identity)
    except (OSError, ValueError, LookupError, TypeError, OverflowError):
        stored(folder)  # names a line that is not a row
        raise _no_results(folder) from None


def stored(folder: Path) -> tuple[JsonObject, list[Row]]:
    """Return the identity of the experiment of a folder, and its rows; an incomplete last line is left out.

    Raises:
        RecordError: it is not the folder of an experiment, or a line is not a row of it; the line is named.
    """
    try:
        with regular_file.open_binary(folder / ROWS) as file:
            identity, checked = row_line.read_first(file.readline(), ABOUT, folder / ROWS)
            lacking = lacks(identity)
            lines = (line for line in file if line.endswith(b"\n"))
            return identity, [
                read_row(line, number, file.name, lacking, checked) for number, line in enumerate(lines, 2)
            ]
    except (OSError, ValueError, LookupError, TypeError):
        raise _no_results(folder) from None


def _no_results(folder: Path) -> RecordError:
    return RecordError(
        "is not the folder of an experiment",
        where=str(folder),
        fix="Name a folder that deodar experiment wrote",
    )
