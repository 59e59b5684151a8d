"""The command `deodar export`: a record in another format, a video, or a model for another tool."""

from __future__ import annotations

import argparse
from pathlib import Path

from deodar.cli import _figure, _options, _report
from deodar.cli._answer import CommandAnswer
from deodar.exporters.tools import EXPORTERS, of_models, of_records
from deodar.resources import Resources

HELP = (
    "write a record in another format, what deodar plot draws of it as a video, or a model as a file of"
    " another tool"
)
EPILOG = """\
netcdf, csv and zarr hold the values.
gif, mp4 (extra video) and png (a folder of numbered files) show what deodar plot draws, frame by frame: a
line moves over panels of time, and snapshots, projections and paths show each time. Formats of other tools:
{records}. These formats take a model instead of a record, with a report of what was carried, approximated
or dropped: {models}. `deodar export TOOL MODEL` means `deodar export MODEL --to TOOL`. Status 1 with
--strict if anything was not carried."""

DATA = {"netcdf": ".nc", "csv": ".csv", "zarr": ".zarr"}
VIDEOS = {"gif": ".gif", "mp4": ".mp4", "png": ""}
"""Formats, and the endings of their names; the others are folders."""

DRAWN = ("kind", "at", "axes", "reduce", "place", "value_range", "speed")
SELECTED = ("trial", "where", "time_range", "every")
"""Options that select what is drawn, and what of a record is written."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    records, models = of_records(), of_models()
    parser.epilog = EPILOG.format(
        records="; ".join(f"{name}, {exporter.HELP}" for name, exporter in records.items()),
        models="; ".join(f"{name}, {exporter.HELP}" for name, exporter in models.items()),
    )
    formats = [*DATA, *records, *VIDEOS, *models]
    _figure.add_record(parser, f"; with --to {' or '.join(models) or 'TOOL'} a model")
    parser.option(
        "--to", "FORMAT", f"{', '.join(formats)} (default: given by the ending of --out)", choices=formats
    )
    parser.option("--out -o", "PATH", "file or folder (default: NAME-export-001, ... here)", Path)
    _figure.add_view(parser)
    parser.option(
        "--speed",
        "S",
        "of a video: time of the record by time of the video (default: 25 frames in a second)",
        _options.positive,
    )
    parser.option(
        "--width", "PIXELS", "of a video: width in pixels (default 960)", _options.whole, default=960
    )
    parser.flag("--strict", "of a model: fail, and write nothing, if anything is approximated or dropped")
    parser.set_defaults(exporter_of_option=_options.add_each(parser, models))
    parser.flag("--no-progress", "show no progress bar")
    _options.add_force(parser)
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Write the file and print its path; status 1 if `--strict` prevents that."""
    _named_first(args)
    format, out = _target(args)
    if format in of_models():
        return _write_model(args, format, out)
    if args.strict:
        args.wrong(f"--strict is about a model, and --to {format} writes a record")
    _require_options(args, format)
    if format in VIDEOS:
        every, args.every = args.every, None  # of the frames, not of the samples in a panel
        drawn = _figure.drawn(args)
        names = drawn.names
        on = Resources(progress=_options.progress(args))
        drawn.figure.animate(out, drawn.record, every, args.speed, args.width, args.force, on)
    else:
        names = _convert(args, format, out)
    written = f"Wrote {', '.join(dict.fromkeys(names))} to {_options.shown(out)}"
    return CommandAnswer({"out": str(out), "format": format, "variables": names}, [written])


def _target(args: argparse.Namespace) -> tuple[str, Path]:
    """Return the format and the path."""
    # start-up time: this brings JAX
    from deodar.recording import places

    endings = DATA | VIDEOS | ({args.to: EXPORTERS[args.to].ENDING} if args.to in EXPORTERS else {})
    format, out = args.to, args.out
    if format is None:
        ending = "" if out is None else out.suffix.lower()
        endings |= {name: exporter.ENDING for name, exporter in of_records().items()}
        formats = [name for name, suffix in endings.items() if suffix and suffix == ending]
        if not formats:
            args.wrong("the format is missing: end --out in .nc, .csv, .zarr, .gif or .mp4, or give --to")
        format = formats[0]
    if out is not None and format in VIDEOS and out.suffix.lower() != endings[format]:
        expected = f"a name that ends in {endings[format]}" if endings[format] else "the name of a folder"
        args.wrong(f"--to {format} needs {expected}, not {out}")
    if out is None:
        figure = args.record.suffix.lower() == ".toml" or format in of_models()
        name = args.record.stem.rpartition(":")[2] if figure else _figure.stem(args.record)
        out = places.free(Path(), f"{name}-export", endings[format])
    return format, out


def _named_first(args: argparse.Namespace) -> None:
    """Read `export TOOL MODEL` as `export MODEL --to TOOL`."""
    name = str(args.record)
    if (
        name in of_models()
        and len(args.variables) == 1
        and args.to in (None, name)
        and not args.record.exists()
    ):
        args.to, args.record, args.variables = name, Path(args.variables[0]), []


def _write_model(args: argparse.Namespace, format: str, out: Path) -> CommandAnswer:
    """Write a model as a file of another tool, and show the report."""
    # start-up time: these bring JAX
    from deodar.exporters.exporting import exported
    from deodar.importers.opening import load
    from deodar.model import output

    if args.variables:
        args.wrong(f"--to {format} writes a whole model, not {', '.join(args.variables)}")
    drawing_options = [name for name in (*DRAWN, *SELECTED) if getattr(args, name) is not None]
    if drawing_options:
        args.wrong(
            f"--{drawing_options[0].replace('_', '-')} is about a record, and --to {format} writes a model"
        )
    output.claim(out, args.force)
    _require_options(args, format)
    exporter = EXPORTERS[format]
    options = exporter.options(args) if hasattr(exporter, "options") else {}
    done = exported(load(args.record), out.name, format, **options)
    failed = args.strict and not done.report.faithful
    if not failed:
        output.write(out, done.content)
    fields = {**done.report.data(), "out": None if failed else str(out)}
    end = "Nothing was written: --strict." if failed else f"Written: {_options.shown(out)}"
    return CommandAnswer(fields, _report.told(done.report, [end]), int(failed))


def _require_options(args: argparse.Namespace, format: str) -> None:
    """Refuse options of other exporters."""
    for option, name in args.exporter_of_option.items():
        if name != format and getattr(args, option) is not None:
            args.wrong(f"--{option} is about {EXPORTERS[name].ABOUT}, and --to {format} writes none")


def _convert(args: argparse.Namespace, format: str, out: Path) -> list[str]:
    """Write the values of the selected part of a record; return the names of its variables."""
    # start-up time: this brings JAX
    from deodar.recording import files

    if args.record.suffix.lower() == ".toml":
        args.wrong(f"{args.record} describes a figure, and --to {format} writes the values of a record")
    for option in DRAWN:
        if getattr(args, option) is not None:
            args.wrong(f"--{option.replace('_', '-')} selects what is drawn, and --to {format} writes values")
    record = files.open_record(args.record)
    names = _figure.variables(record, args.variables)
    part = _figure.selected(args, record, names)
    if format in EXPORTERS:
        EXPORTERS[format].save(part, out, args.force)
    else:
        files.save_record(part, out, format, args.force)
    return names
