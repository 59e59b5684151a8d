"""The commands `deodar run FILE` and `deodar run RECORD`."""

from __future__ import annotations

import argparse
from pathlib import Path

from deodar.cli import _live, _long, _machines, _options, _package
from deodar.cli._answer import CommandAnswer
from deodar.importers import examples

HELP = "run a model and record it, or run a record again and compare"
EPILOG = """\
FILE is a document (.json). RECORD is a record (.zarr, .nc), a folder that an earlier run wrote, or a package
of one (.deodar): it is run again as it was, and compared. Both write a new folder with the record and the
model that made it. Look at it with: deodar plot FOLDER"""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    parser.option(
        "file",
        "FILE|RECORD",
        "a document (.json, .deodar) or example:NAME to run, or a record to run again",
        _options.document,
    )
    parser.option(
        "--duration",
        "D",
        "how long, in the document's time unit (needed for a document; of an example as its notes say)",
        float,
    )
    parser.add_argument("--dt", type=float, help="Euler step (default: the document's own, else 1)")
    parser.option(
        "--record",
        "PATH",
        "ports to record, for example u.activation (default: every field, at the end)",
        nargs="+",
        action="extend",
    )
    parser.option("--every", "T", "time between records (default: every step)", float)
    parser.option("--trials", "N", "number of trials; they differ in their noise", _options.whole)
    parser.option(
        "--workers", "N", "share trials and sweep points among N processes of one core each", _options.whole
    )
    _machines.add_devices(parser)
    _machines.add_hosts(parser)
    _machines.add_cluster(parser, "pieces of a large batch")
    parser.option(
        "--sweep",
        "PATH=V1,V2,...",
        "run at each value; several make a grid",
        _options.values,
        action="append",
    )
    parser.option(
        "--points",
        "FILE",
        "run at each point of a list: .csv (a line of paths, then one of numbers each) or .json",
        Path,
    )
    parser.add_argument(
        "--own-noise",
        action="store_true",
        default=None,
        help="with --points: each point has noise of its own",
    )
    _options.add_set(parser)
    parser.add_argument(
        "--format", choices=("zarr", "netcdf", "csv"), default="zarr", help="of the record (default zarr)"
    )
    parser.flag(
        "--resume",
        "continue a RECORD that was killed or stopped, with --cluster on a cluster; with --duration make"
        " a complete one longer",
    )
    parser.option(
        "--snapshots",
        "T",
        "time between two stored states for --resume (default: about every 30 s of wall time)",
        float,
    )
    parser.option("--out -o", "DIR", "folder to write (default: NAME-001, NAME-002, ... here)", Path)
    _options.add_run(parser)
    _long.add_yes(parser)
    _options.add_world(parser)
    _live.add(parser)
    _options.add_force(parser)
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer | int:
    """Run a document, or repeat a record; status 1 if stopped, or if a repetition differs without a
    reason.
    """
    with _package.opened(args.file, args.trust) as args.file:
        return _run(args)


def _run(args: argparse.Namespace) -> CommandAnswer | int:
    # start-up time: these bring JAX
    from deodar.cli import _document_run, _recorded_run
    from deodar.compiler import hosts
    from deodar.importers.opening import require

    if args.file.suffix.lower() not in (".zarr", ".nc"):
        require(args.file)
    if args.duration is None and examples.holds(args.file):
        args.duration = examples.duration(args.file.stem)
    recorded = _recorded_run.is_record(args.file)
    if not recorded:
        _options.use_rounding(args.separate_rounding)
        _options.use_cores(args.cores)
    if args.hosts is not None and (args.live or args.cost):
        args.wrong("--live and --cost run on one host")
    if args.live or args.cost:
        return _live.run(args)
    _live.refuse_alone(args)
    if args.resume:
        return _recorded_run.continued(args)
    if recorded:
        return _recorded_run.repeated(args)
    _machines.join_hosts(args)
    with hosts.together(args.hosts is not None):
        return _document_run.run(args)
