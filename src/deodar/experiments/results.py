"""The results of an experiment: a folder with a row for each trial, which can be resumed, and the table of
the rows.
"""

from __future__ import annotations

import contextlib
import csv
import hashlib
import io
import tempfile
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from deodar import codec, renamed
from deodar.batch.cluster import Cluster
from deodar.batch.on_cluster import ClusterPool
from deodar.batch.packed import require_portable
from deodar.codec import JsonObject
from deodar.compiler.device import find
from deodar.errors import DeodarError, ParameterError, RecordError, WorkerError
from deodar.experiments import packed
from deodar.experiments.comparing import compare
from deodar.experiments.jobs import MACHINE, Job, Progress, run_jobs
from deodar.experiments.migrations import migrate
from deodar.experiments.observations import DIVERGED
from deodar.experiments.rows import ABOUT, Row, Rows, claim
from deodar.experiments.setup import Setup
from deodar.experiments.writing import RECORDS
from deodar.model import files as documents
from deodar.model import output
from deodar.model.document import Document
from deodar.recording import files, provenance, writer_lock
from deodar.worlds._address import masked_data

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
    workers: int | None = None,
    progress: Callable[[Progress], None] | None = None,
    stopped: Callable[[], bool] | None = None,
    cluster: Cluster | str | None = None,
    part: tuple[int, int] | None = None,
) -> xarray.Dataset:
    """Run the trials without a row, write the table, and return it.

    Args:
        setup: the opened experiment.
        out: the folder; None: results are not stored.
        workers: number of processes of one core each; none: this process.
        progress: function that is called with a `Progress` after each piece.
        stopped: function that ends the workers once it returns true (see `run_jobs`).
        cluster: the workers that run the trials, in place of `workers`, or their address.
        part: the first trial and the one after the last, to run a part of the trials; pieces that begin there
            are run whole, so that parts without gaps between them are the whole experiment.

    Raises:
        RecordError: another process runs an experiment in this folder.
    """
    if workers and cluster is not None:
        raise ParameterError("workers and cluster exclude each other", fix="Leave one of them out")
    if part is not None and not 0 <= part[0] < part[1] <= setup.trials:
        raise ParameterError(
            f"the trials {part[0]} to {part[1]} are no part of 0 to {setup.trials}",
            fix=f"For example 0:{max(1, setup.trials // 2)}",
        )
    where = None if cluster is None else Cluster.of(cluster)
    if out is None:
        with tempfile.TemporaryDirectory(prefix="deodar-") as folder:
            return _run_trials(setup, Path(folder), workers, progress, stopped, where, part)
    folder = output.location(out)
    claim(folder, ROWS, "an experiment")
    with writer_lock.locked(folder):
        return _run_trials(setup, folder, workers, progress, stopped, where, part)


def _run_trials(
    setup: Setup,
    out: Path,
    workers: int | None,
    progress: Callable[[Progress], None] | None,
    stopped: Callable[[], bool] | None,
    cluster: Cluster | None,
    part: tuple[int, int] | None,
) -> xarray.Dataset:
    handed = packed.PackedExperiment.of(setup) if workers or cluster else None
    records = (
        out / RECORDS
        if setup.experiment.record or any(type(a).__name__ == "Snapshot" for a in setup.experiment.actions)
        else None
    )
    with _opened(setup, handed, cluster) as pool:
        about = _about(setup, workers, out) if pool is None else _about(setup, 1, out, pool.made_by)
        rows = Rows(out / ROWS, about, read=lambda made: _of_today(made, about, setup.model.document))
        if not (out / MODEL).exists():
            documents.save(setup.model.document, out / MODEL)
        if not (out / EXPERIMENT).exists():
            output.write(out / EXPERIMENT, (codec.text(_plan(setup)) + "\n").encode())
        if pool is not None and records is not None:
            _require_shared(pool, out)
        jobs = list(_jobs(setup, handed, records, part))
        run_jobs(jobs, rows, progress, workers, stopped, pool)
        if pool is not None and pool.cluster.mixed:
            compare(jobs, rows, pool, out)
    data = dataset(list(rows.found.values()), about)
    output.write(out / TABLE, table(data).encode())
    files.save_record(data, out / DATASET, force=True)
    return data


@contextlib.contextmanager
def _opened(
    setup: Setup, handed: packed.PackedExperiment | None, cluster: Cluster | None
) -> Generator[ClusterPool | None]:
    """Connect to a cluster whose workers can run the experiment; None without a cluster.

    Raises:
        WorkerError: they cannot; no trial has been run.
    """
    if cluster is None or handed is None:
        yield None
        return
    require_portable(setup.world)
    with ClusterPool(cluster, setup.experiment.precision) as pool:
        pool.everywhere(packed.prepare, handed)
        yield pool


def _require_shared(pool: ClusterPool, out: Path) -> None:
    """Raise an error unless every worker sees the folder into which trials write their records."""
    if not all(pool.everywhere(_sees, out / EXPERIMENT, (out / EXPERIMENT).read_bytes())):
        raise WorkerError(
            "trials write records, but a worker does not see the folder of the results",
            where=str(out),
            fix="Use a folder that all machines share, or an experiment without records and snapshots",
        )


def _sees(file: Path, content: bytes) -> bool:
    """Return whether a worker sees a file with this content."""
    try:
        return file.read_bytes() == content
    except OSError:
        return False


def _jobs(
    setup: Setup,
    handed: packed.PackedExperiment | None,
    records: Path | None,
    part: tuple[int, int] | None,
) -> Iterator[Job]:
    for piece in setup.pieces():
        if part is not None and not part[0] <= piece[0] < part[1]:
            continue
        keys, given = tuple(f"{k:06}" for k in piece), {"trials": piece, "records": records}
        if handed is None:
            yield Job(keys, setup.rows, given, len(piece))
        else:
            yield Job(keys, packed.work, {"handed": handed, **given}, len(piece))


def _about(
    setup: Setup, workers: int | None, folder: Path, made: Mapping[str, str] | None = None
) -> JsonObject:
    """Return the identity of the experiment: a file never mixes rows of two experiments.

    Args:
        setup: the opened experiment.
        workers: whether worker processes of one core run it.
        folder: the folder of the results.
        made: versions and machine of the workers of a cluster.
    """
    digest = _digest_in(folder, setup.model.document) or _digest(*documents.dumps(setup.model.document))
    here = provenance.made_by(find(), setup.experiment.precision) | ({"cores": "1"} if workers else {})
    unit = setup.model.document.time_unit
    return {
        **_plan(setup),
        "model": digest,
        "world": provenance.described(setup.world),
        "time_unit": unit,
        "made_by": here if made is None else dict(made),
    }


def _of_today(made: JsonObject, about: Mapping[str, Any], doc: Document) -> JsonObject:
    """Convert the identity of existing rows to the present version; older rows name no packages."""
    packages = {"packages": about["packages"]} if "packages" in about else {}
    return packages | migrate(made, doc)


def _digest(text: str, arrays: bytes | None) -> str:
    return hashlib.sha256(text.encode() + (arrays or b"")).hexdigest()


def _digest_in(folder: Path, doc: Document) -> str:
    """The digest of the model file in the folder, if it holds the same document, or "".

    An older version of deodar wrote the same document as a different text.
    """
    try:
        if documents.load(folder / MODEL) != doc:
            return ""
        data = codec.parse((folder / MODEL).read_text(encoding="utf-8"))
        arrays = None
        if "arrays" in data:
            arrays = (folder / data["arrays"]["file"]).read_bytes()
            data["arrays"]["file"] = ""
    except (DeodarError, OSError, ValueError):
        return ""
    return _digest(codec.text(data) + "\n", arrays)


def _plan(setup: Setup) -> JsonObject:
    """Return the plain data of an experiment whose model is beside it, without credentials of a camera."""
    plain = codec.parse(codec.line({**setup.experiment.to_data(), "model": MODEL}))
    return cast("JsonObject", masked_data(plain))


# -------------------------------------------------------------------------------------------------- the table


def stored_rows(folder: Path) -> list[Row]:
    """Return the rows in the folder of an experiment; an incomplete last line is left out.

    Raises:
        RecordError: it is not the folder of an experiment.
    """
    return stored(folder)[1]


def load_results(path: str | Path) -> xarray.Dataset:
    """Read the table of an experiment from its folder; of an incomplete experiment the existing trials.

    Raises:
        RecordError: it is not the folder of an experiment.
    """
    folder = output.location(path)
    about, rows = stored(folder)
    try:
        return dataset(rows, about)
    except (ValueError, LookupError, TypeError):
        raise _no_results(folder) from None


def stored(folder: Path) -> tuple[JsonObject, list[Row]]:
    """Return the identity of the experiment of a folder, and its rows.

    Raises:
        RecordError: it is not the folder of an experiment.
    """
    try:
        lines = [codec.parse(line) for line in (folder / ROWS).read_text(encoding="utf-8").split("\n")[:-1]]
        return lines[0][ABOUT], lines[1:]
    except (OSError, ValueError, LookupError, TypeError):
        raise _no_results(folder) from None


def _no_results(folder: Path) -> RecordError:
    return RecordError(
        "is not the folder of an experiment",
        where=str(folder),
        fix="Name a folder that deodar experiment wrote",
    )


def dataset(rows: Sequence[Row], about: Mapping[str, Any]) -> xarray.Dataset:
    """Return rows as a Dataset over `trial`.

    Levels are coordinates; `outcome`, `awaited` (the conditions that the limit cut off), `duration`, the time
    of each condition and the measures are variables. A condition that did not occur is NaN. Measures of
    several numbers have a dimension of their own. If trials diverged, the variable `diverged` gives the
    reason of each (empty: it did not diverge), and the attribute of this name counts them.
    """
    # start-up time
    import xarray

    rows = sorted(rows, key=lambda row: row["trial"])
    unit = {"units": about["time_unit"]}
    conditions, measures = list(about.get("conditions", {})), list(about.get("measures", {}))
    coords: dict[str, Any] = {"trial": ("trial", np.asarray([r["trial"] for r in rows], np.int64))}
    for name in about.get("factors", {}):
        coords[name] = ("trial", _column([r["levels"][name] for r in rows]))
    out: dict[str, Any] = {
        key: ("trial", np.asarray([r[key] for r in rows], dtype=str)) for key in ("outcome", "awaited")
    }
    reasons = [r.get(DIVERGED, "") for r in rows]
    attributes = {provenance.KEY: codec.line(about), "title": about["name"]}
    if any(reasons):
        out[DIVERGED] = ("trial", np.asarray(reasons, dtype=str))
        bad = [text for text in reasons if text]
        where = f"the variable {DIVERGED!r} gives the reasons, the first is: {bad[0]}"
        attributes[DIVERGED] = f"{len(bad)} of {len(rows)} trials diverged; {where}"
    if any(MACHINE in r for r in rows):
        out[MACHINE] = ("trial", np.asarray([r.get(MACHINE, "") for r in rows], dtype=str))
    out["duration"] = ("trial", np.asarray([r["duration"] for r in rows], float), unit)
    for name in conditions:
        out[name] = (
            "trial",
            _column([_or_nan(r["events"][name]) for r in rows]),
            {**unit, "long_name": f"time of {name}"},
        )
    for name in measures:
        found = [r["measures"][name] for r in rows]
        count = max((len(v) for v in found if isinstance(v, list)), default=0)
        if count:
            values = np.asarray([[np.nan] * count if v is None else v for v in found], float)
            out[name] = (("trial", f"{name}.axis"), values)
        else:
            out[name] = ("trial", np.asarray([_or_nan(v) for v in found], float))
    return xarray.Dataset(out, coords, attributes)


def table(data: xarray.Dataset) -> str:
    """Return the table as CSV, one line per trial; a cell is empty if the condition did not occur."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    columns: list[tuple[str, np.ndarray]] = []
    for name in [*data.coords, *data.data_vars]:
        values = data[name].values
        if values.ndim == 1:
            columns.append((str(name), values))
        else:
            columns += [(f"{name}.{k}", values[:, k]) for k in range(values.shape[1])]
    writer.writerow([name for name, _ in columns])
    for k in range(data.sizes["trial"]):
        writer.writerow([_cell(values[k]) for _, values in columns])
    return text.getvalue()


def _cell(value: Any) -> str:
    if isinstance(value, (float, np.floating)):
        return "" if np.isnan(value) else repr(float(value)).removesuffix(".0")
    return str(value)


def _column(values: Sequence[Any]) -> np.ndarray:
    """Return numbers if all values are numbers, else text."""
    return (
        np.asarray(values, float)
        if not any(isinstance(v, str) for v in values)
        else np.asarray([str(v) for v in values], dtype=str)
    )


def _or_nan(value: Any) -> Any:
    return np.nan if value is None else value


if not TYPE_CHECKING:
    __getattr__ = renamed.left(__name__)
