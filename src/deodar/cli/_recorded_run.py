"""`deodar run RECORD`: a recorded run, repeated and compared, or continued."""

from __future__ import annotations

import argparse
import dataclasses as dc
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar.batch.resume import resume
from deodar.batch.simulate import simulate
from deodar.cli import _long, _machines, _options, _question, _run_report
from deodar.cli._answer import CommandAnswer
from deodar.cli._run_output import GrownRecord, RunFolder
from deodar.cli._run_report import EndedRun
from deodar.errors import Interrupted
from deodar.recording import files, provenance
from deodar.recording.record import about
from deodar.recording.repeat import compare, repeat
from deodar.resources import Resources

if TYPE_CHECKING:
    import xarray

    from deodar.model.model import Model
    from deodar.recording.repeat import Difference

STORED = (
    "duration",
    "dt",
    "seed",
    "record",
    "every",
    "trials",
    "sweep",
    "points",
    "own_noise",
    "set",
    "precision",
    "workers",
    "devices",
    "hosts",
    "cluster",
    "accuracy",
    "snapshots",
)
"""Options whose values a record contains."""


def is_record(path: Path) -> bool:
    """Return whether a path is that of a record, or of a folder that a run wrote."""
    if path.suffix.lower() == ".json" and not path.is_dir():
        return False
    return (
        path.is_dir()
        or not path.exists()
        or path.suffix.lower() in files.SUFFIXES.values()
        or files.is_record(path)
    )


def continued(args: argparse.Namespace) -> CommandAnswer | int:
    """Continue a run that was killed or stopped; status 1 if it was stopped again."""
    names = [
        *_with_value(args, (name for name in STORED if name not in ("duration", "cluster"))),
        *(name for name in ("out", "force") if getattr(args, name)),
    ]
    if names:
        flags = _options.flags(*names)
        args.wrong(f"a run is resumed as it began, in its folder, so {flags} cannot be given")
    old = files.open_record(args.file)
    doc = provenance.document(about(old))
    _compute_as(args, old)
    old.close()
    stopped = ""
    try:
        with _run_report.quiet():
            record = resume(
                args.file,
                args.duration,
                _options.world(args.world),
                args.trust,
                lambda differences: _accepts(args, differences),
                Resources(cluster=_machines.cluster(args), progress=_options.progress(args)),
            )
    except Interrupted as error:
        record, stopped = error.data, str(error)
    return _run_report.finish(args, GrownRecord(args.file), EndedRun(doc, record, stopped, resumes=True))


def repeated(args: argparse.Namespace) -> CommandAnswer | int:
    """Run a record again and compare; status 1 if it was stopped, or differs without a reason."""
    if names := _with_value(args, STORED):
        flags = _options.flags(*names)
        args.wrong(f"a record is run again as it was, so {flags} cannot be given; run its model.json instead")
    old = files.load_record(args.file)
    _compute_as(args, old)
    folder = RunFolder(args, str(old.attrs.get("title") or "record"))
    stopped = ""

    def simulated(model: Model, duration: float, *, on: Resources, **settings: Any) -> xarray.Dataset:
        silent = dc.replace(on, progress=False)
        _long.confirm_run(
            args, duration, settings["dt"], lambda time: simulate(model, time, on=silent, **settings)
        )
        return simulate(model, duration, on=on, **settings)

    try:
        with _run_report.quiet():
            on = Resources(args.device, progress=_options.progress(args))
            repetition = repeat(old, simulated, _options.world(args.world), args.trust, on)
    except Interrupted as error:
        repetition, stopped = compare(old, error.data), str(error)
    doc = provenance.document(about(old))
    return _run_report.finish(args, folder, EndedRun(doc, repetition.data, stopped, repetition))


def _with_value(args: argparse.Namespace, names: Iterable[str]) -> list[str]:
    return [name for name in names if getattr(args, name) is not None]


def _compute_as(args: argparse.Namespace, record: xarray.Dataset) -> None:
    """Use the rounding and the number of cores of a record, unless options name others."""
    origin = about(record)
    _options.use_rounding(args.separate_rounding or provenance.rounds_separately(origin))
    _options.use_cores(args.cores, provenance.cores_of(origin))


def _accepts(args: argparse.Namespace, differences: Sequence[Difference]) -> bool:
    """Print what differs from the machine of the record, and ask whether to continue."""
    listed = "; ".join(map(str, differences))
    print(f"deodar run: the rest of the run will not have the same bits: {listed}", file=sys.stderr)
    if args.yes or not _question.on_terminal():
        return bool(args.yes)
    return _question.confirmed("Continue?")
