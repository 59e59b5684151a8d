"""The command `deodar export RECORD`."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

from deodar import codec
from deodar.cli import _figure, _options
from deodar.cli._bar import Bar

HELP = "write a record in another format, or what deodar plot draws of it as a video"
EPILOG = """\
netcdf, csv and zarr hold the values; cedar is a folder with one CSV file for each variable, as cedar's
recorder writes it. gif, mp4 (extra video) and png (a folder of numbered files) show what deodar plot draws,
frame by frame: a line moves over panels of time, and snapshots, projections and paths show each time."""

DATA = {"netcdf": ".nc", "csv": ".csv", "zarr": ".zarr", "cedar": ""}
VIDEOS = {"gif": ".gif", "mp4": ".mp4", "png": ""}
"""Formats, and the endings of their names; the others are folders."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    _figure.add_record(parser)
    parser.add_argument(
        "--to",
        choices=(*DATA, *VIDEOS),
        metavar="FORMAT",
        help="netcdf, csv, zarr, cedar, gif, mp4 or png (default: given by the ending of --out)",
    )
    parser.add_argument(
        "--out", "-o", type=Path, metavar="PATH", help="file or folder (default: NAME-export-001, ... here)"
    )
    _figure.add_view(parser)
    parser.add_argument(
        "--speed",
        type=_options.positive,
        metavar="S",
        help="of a video: time of the record by time of the video (default: 25 frames in a second)",
    )
    parser.add_argument(
        "--width",
        type=_options.whole,
        default=960,
        metavar="PIXELS",
        help="of a video: width in pixels (default 960)",
    )
    parser.add_argument("--no-progress", action="store_true", help="show no progress bar")
    _options.add_force(parser)
    _options.add_json(parser)
    _options.wrong(parser)


def run(args: argparse.Namespace) -> int:
    """Write the file and print its path."""
    format, out = _target(args)
    if format in VIDEOS:
        every, args.every = args.every, None  # of the frames, not of the samples in a panel
        drawn = _figure.drawn(args)
        names = drawn.names
        with Bar(args.no_progress or not sys.stderr.isatty(), "frames") as bar:
            drawn.figure.animate(
                out, drawn.record, every, args.speed, args.width, args.force, progress=_shown(bar)
            )
    else:
        names = _convert(args, format, out)
    if args.json:
        print(codec.text({"out": str(out), "format": format, "variables": names}))
    else:
        print(f"Wrote {', '.join(dict.fromkeys(names))} to {_options.shown(out)}")
    return 0


def _target(args: argparse.Namespace) -> tuple[str, Path]:
    """Return the format and the path."""
    # start-up time: this brings JAX
    from deodar.recording import places

    endings = DATA | VIDEOS
    format, out = args.to, args.out
    if format is None:
        ending = "" if out is None else out.suffix.lower()
        found = [name for name, known in endings.items() if known and known == ending]
        if not found:
            args.wrong("the format is missing: end --out in .nc, .csv, .zarr, .gif or .mp4, or give --to")
        format = found[0]
    if out is not None and format in VIDEOS and out.suffix.lower() != endings[format]:
        what = f"a name that ends in {endings[format]}" if endings[format] else "the name of a folder"
        args.wrong(f"--to {format} needs {what}, not {out}")
    if out is None:
        figure = args.record.suffix.lower() == ".toml"
        name = args.record.stem if figure else _figure.stem(args.record)
        out = places.free(Path(), f"{name}-export", endings[format])
    return format, out


def _shown(bar: Bar) -> Callable[[int, int], None]:
    """Return the function that draws the progress of a video."""
    # start-up time: this brings JAX
    from deodar.experiments.jobs import Progress

    began = time.monotonic()

    def show(done: int, of: int) -> None:
        left = (time.monotonic() - began) / done * (of - done)
        bar.show(Progress(done, of, done / of, left))

    return show


def _convert(args: argparse.Namespace, format: str, out: Path) -> list[str]:
    """Write the values of the selected part of a record; return the names of its variables."""
    # start-up time: these bring JAX
    from deodar.recording import cedar, files

    if args.record.suffix.lower() == ".toml":
        args.wrong(f"{args.record} describes a figure, and --to {format} writes the values of a record")
    for option in ("kind", "at", "axes", "reduce", "place", "value_range", "speed"):
        if getattr(args, option) is not None:
            args.wrong(f"--{option.replace('_', '-')} selects what is drawn, and --to {format} writes values")
    data = files.open_record(args.record)
    names = _figure.variables(data, args.variables)
    part = _figure.selected(args, data, names)
    if format == "cedar":
        cedar.save(part, out, args.force)
    else:
        files.save_record(part, out, format, args.force)
    return names
