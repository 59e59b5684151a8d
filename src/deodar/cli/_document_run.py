"""`deodar run FILE`: a document, simulated and recorded."""

from __future__ import annotations

import argparse
import dataclasses as dc
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from deodar.batch import points_file
from deodar.batch.run_file import Output
from deodar.batch.simulate import simulate
from deodar.cli import _long, _machines, _options, _run_report
from deodar.cli._answer import INTERRUPTED, CommandAnswer
from deodar.cli._run_output import GrownRecord, RunFolder
from deodar.cli._run_report import EndedRun
from deodar.compiler import hosts
from deodar.errors import Interrupted
from deodar.importers.opening import load
from deodar.resources import Resources
from deodar.session import agreement
from deodar.sweep import Points

if TYPE_CHECKING:
    import xarray

    from deodar.model.model import Model
    from deodar.sweep import Sweep
    from deodar.worlds._base import World

WARNINGS = 3
"""Most warnings of the check that are printed before a run."""


def run(args: argparse.Namespace) -> CommandAnswer | int:
    """Simulate a document; status 1 if it was stopped."""
    if args.duration is None and args.file.is_file():
        args.wrong("a document needs --duration, for example --duration 500")
    _once(args, "set")
    _once(args, "sweep")
    model = load(args.file, trust=args.trust)
    _options.apply_set(model, args)
    world = _options.world(args.world)
    if world is not None and world.wall_clock:
        args.wrong(f"the world {args.world} follows the wall clock, so the run needs --live")
    if hosts.first():
        _show_warnings(model, args.file, world)
    sweep: Sweep | None = dict(args.sweep) if args.sweep else None
    if args.points is not None:
        if sweep is not None:
            args.wrong("--points is a list and --sweep a grid; give one of them")
        sweep = Points(points_file.read(args.points), bool(args.own_noise))
    elif args.own_noise:
        args.wrong("--own-noise needs a list of points, --points FILE; trials have noise of their own")
    used = Resources(args.device, args.devices, args.workers, _machines.cluster(args))
    folder = RunFolder(args, model.name) if hosts.first() else None
    step = model.document.step if args.dt is None else args.dt

    def simulated(
        duration: float, progress: bool | None = False, out: Output | None = None
    ) -> xarray.Dataset:
        return simulate(
            model,
            duration,
            dt=args.dt,
            seed=args.seed or 0,
            record=args.record,
            every=args.every,
            trials=args.trials,
            sweep=sweep,
            world=world,
            precision=_options.arithmetic(args),
            out=out,
            on=dc.replace(used, progress=progress),
        )

    record, stopped, out = None, "", Path() if folder is None else folder.path()
    progress = False if folder is None else _options.progress(args)
    try:
        with _run_report.quiet():
            if hosts.count() == 1:  # several have no terminal
                _long.confirm_run(args, args.duration or 0.0, step, simulated)
            record = simulated(args.duration or 0.0, progress, Output(out, args.force, args.snapshots))
    except Interrupted as error:
        record, stopped = error.data, str(error)
    if folder is None:  # the first host writes and reports
        return INTERRUPTED if stopped else 0
    return _run_report.finish(
        args,
        GrownRecord(out, folder.format),
        EndedRun(model.document, record, stopped, resumes=folder.format == "zarr"),
    )


def _show_warnings(model: Model, file: Path, world: World | None) -> None:
    """Print the first warnings of the check and of the world on stderr; they do not prevent the run."""
    warnings = [
        p for p in (*agreement.judge(model.document, world), *model.check()) if p.severity == "warning"
    ]
    for warning in warnings[:WARNINGS]:
        print(f"deodar run: warning: {warning}", file=sys.stderr)
    if len(warnings) > WARNINGS:
        print(
            f"deodar run: warning: {len(warnings) - WARNINGS} more;"
            f" type: deodar check {_options.shown(file)}",
            file=sys.stderr,
        )


def _once(args: argparse.Namespace, name: str) -> None:
    paths = [path for path, _ in getattr(args, name) or ()]
    twice = next((p for p in paths if paths.count(p) > 1), None)
    if twice is not None:
        args.wrong(f"--{name} names {twice} twice")
