"""The command `deodar plot RECORD`."""

from __future__ import annotations

import argparse
import dataclasses as dc
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from deodar.cli import _analysis, _figure, _options, _package
from deodar.cli._answer import CommandAnswer
from deodar.errors import FigureError, RecordError

if TYPE_CHECKING:
    import xarray

    from deodar.figures._file import FigureFile
    from deodar.recording.writer_lock import WriterWatch

HELP = (
    "draw the variables of a record, an analysis that was saved, or the file of a figure, as SVG, PDF or PNG"
)
EPILOG = """\
Without --kind each variable gets the kind that suits it: time_course (nodes, or fields at places),
space_time (one dimension over time), snapshot (one time), snapshots (several), projection (three
dimensions and more). Several variables become panels of one figure. The file of a figure (.toml) has the
panels, ranges, labels and sizes of a figure for a paper; --save-as writes one to start from.

A branch or a map that `deodar continuation` or `deodar map` saved, and a locus, are drawn as these commands
draw them. Further branches, or loci over a map, are drawn into the same figure; a port, such as u.output,
replaces the activation of a branch."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    _figure.add_record(parser)
    _figure.add_view(parser)
    parser.option(
        "--gif",
        "FILE",
        "also write a video of one variable that is a path (x and y over time), in its arena",
        Path,
    )
    parser.option("--save-as", "FILE", "also write what is drawn as the file of a figure, .toml", Path)
    parser.option(
        "--out -o",
        "FILE",
        ".png, .svg or .pdf (default: NAME-plot-001.png, ... here; of a .toml file NAME-001.pdf)",
        Path,
    )
    parser.flag(
        "--follow",
        "wait for the record, and draw again while it grows, until its run ends or Ctrl-C is pressed",
    )
    parser.option(
        "--interval",
        "S",
        "with --follow: seconds between two figures (default 1)",
        _options.positive,
        default=1.0,
    )
    _options.add_force(parser)
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer | int:
    """Draw the record, write the file and print its path."""
    with _package.opened(args.record, runs=False) as args.record:
        return _run(args)


def _run(args: argparse.Namespace) -> CommandAnswer | int:
    if args.follow:
        return _followed(args)
    analysis = _analysis.drawn(args)
    if analysis is not None:
        return _drawn_analysis(args, analysis)
    # start-up time: these bring JAX
    from deodar.figures import _files

    drawn = _figure.drawn(args)
    out = _claimed(args, drawn.stem)
    video = None if args.gif is None else _video(args, drawn)
    drawing = drawn.figure.draw(drawn.record)
    if args.save_as is not None:
        _save_as(args, drawn.figure, [float(n) for n in drawing.get_size_inches()])
    if video is not None:
        video()
    _files.save_figure(drawing, out, args.force)
    return _answer(args, drawn, out)


def _drawn_analysis(args: argparse.Namespace, drawn: _analysis.AnalysisDrawing) -> CommandAnswer:
    """Write the figure of files of analyses and print its path."""
    # start-up time: these bring matplotlib
    from deodar.figures import _files

    out = _claimed(args, f"{_figure.stem(args.record)}-plot")
    _files.save_figure(drawn.figure, out, args.force)
    words = " and ".join(f"the {kind} of {_options.shown(path)}" for path, kind in drawn.files)
    fields = {"out": str(out), "kinds": {str(path): kind for path, kind in drawn.files}}
    return CommandAnswer(fields, [f"Drew {words} into {_options.shown(out)}"])


def _claimed(args: argparse.Namespace, stem: str) -> Path:
    """Return the path of the figure, which may be written."""
    # start-up time: these bring JAX
    from deodar.figures import _files
    from deodar.recording import places

    ending = ".pdf" if args.record.suffix.lower() == ".toml" else ".png"
    out: Path = args.out or places.free(Path(), stem, ending)
    _files.claim(out, args.force)
    return out


def _answer(args: argparse.Namespace, drawn: _figure.DrawnFigure, out: Path) -> CommandAnswer:
    """Return what was drawn into which files."""
    also = {key: path for key, path in (("gif", args.gif), ("figure", args.save_as)) if path is not None}
    kinds = dict(zip(drawn.names, drawn.figure.kinds(drawn.record), strict=True))
    names = ", ".join(dict.fromkeys(drawn.names))
    files = " and ".join(map(_options.shown, [out, *also.values()]))
    fields = {"out": str(out), "kinds": kinds, **{key: str(path) for key, path in also.items()}}
    return CommandAnswer(fields, [f"Drew {names} into {files}"])


def _followed(args: argparse.Namespace) -> CommandAnswer | int:
    """Draw again whenever the record has grown, until it is complete, or its run or this command is stopped.

    Raises:
        RecordError: the run was stopped before the record held a sample.
    """
    # start-up time: these bring JAX
    from deodar.figures import _files
    from deodar.recording.record import about

    if args.gif is not None or args.save_as is not None:
        args.wrong("--follow writes one figure again and again; leave out --gif and --save-as")
    drawn = out = seen = answer = None
    stopped: list[Path] = []
    watches: dict[Path, WriterWatch] = {}
    try:
        while not args.record.exists():
            time.sleep(args.interval)
        while True:
            drawn = _figure.drawn(args)
            opened = drawn.figure.records(drawn.record)
            growing = [record for record in opened if not about(record).get("complete", True)]
            sizes = [dict(record.sizes) for record in opened]
            filled = all(min(size.values(), default=0) for size in sizes)
            if sizes != seen and (not growing or filled):
                if out is None:
                    out = _claimed(args, drawn.stem)
                    print(f"Drawing into {_options.shown(out)}; Ctrl-C ends", file=sys.stderr, flush=True)
                _files.save_figure(drawn.figure.draw(drawn.record), out, force=args.force or seen is not None)
                seen = sizes
            stopped = _stopped(growing, watches)
            if len(stopped) == len(growing):
                break
            time.sleep(args.interval)
    except KeyboardInterrupt:
        pass
    if drawn is not None and out is not None and seen is not None:
        answer = _answer(args, drawn, out)
    elif stopped:
        raise RecordError(
            "the run was stopped before the record held a sample", where=str(stopped[0]), fix="Run it again"
        )
    else:
        print("Stopped before the record held a sample")
    for path in stopped:
        print(_continuation(path), file=sys.stderr)
    return answer or 0


def _stopped(growing: Sequence[xarray.Dataset], watches: dict[Path, WriterWatch]) -> list[Path]:
    """Return the incomplete records that no process writes any more."""
    # start-up time: this brings JAX
    from deodar.recording.writer_lock import WriterWatch

    paths = [Path(record.encoding["source"]) for record in growing]
    return [path for path in paths if watches.setdefault(path, WriterWatch(path)).ended()]


def _continuation(record: Path) -> str:
    """Return a sentence on a record whose run was stopped, and the command that continues the run."""
    # start-up time: this brings JAX
    from deodar.batch.run_file import CHECKPOINT

    name = record.parent if record.name == "record.zarr" else record
    text = f"{_options.shown(name)} is incomplete, and no process writes it any more"
    resumable = (record / CHECKPOINT).exists()
    return f"{text}: deodar run {_options.shown(name)} --resume continues it" if resumable else text


def _save_as(args: argparse.Namespace, figure: FigureFile, inches: Sequence[float]) -> None:
    """Write the file of a figure, with the size that was drawn."""
    if args.save_as.suffix.lower() != ".toml":
        raise FigureError(
            f"the name ends in {args.save_as.suffix!r}", where="--save-as", fix="End it in .toml"
        )
    width, height = (round(25.4 * size, 1) for size in inches)
    dc.replace(figure, record=str(args.record), width=width, height=height).save(args.save_as, args.force)


def _video(args: argparse.Namespace, drawn: _figure.DrawnFigure) -> Callable[[], object]:
    """Return the function that writes the video of a path in the arena of its record."""
    # start-up time: these bring JAX
    from deodar.figures import path
    from deodar.recording.repeat import world_of

    record = drawn.figure.records(drawn.record)[0]
    if len(drawn.names) != 1:
        raise RecordError(
            f"a video shows one variable, not {len(drawn.names)}",
            where="--gif",
            fix="Name the one that holds x and y, for example pose.output",
        )
    world = world_of(record)
    if world is None:
        raise RecordError(
            "the record was made without a world, so there is no arena to draw the path in",
            where="--gif",
            fix="Leave out --gif",
        )
    view = drawn.figure.panels[0].view(record)
    stride = max(1, -(-len(view.times) // path.MOST_FRAMES))
    return lambda: path.animate_path(view, args.gif, world, stride=stride, force=args.force)
