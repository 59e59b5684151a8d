"""The command `deodar plot RECORD`."""

from __future__ import annotations

import argparse
import dataclasses as dc
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from deodar import codec
from deodar.cli import _options
from deodar.errors import FigureError, RecordError, did_you_mean

if TYPE_CHECKING:
    import xarray

    from deodar.figures._file import FigureFile, FigurePanel

HELP = "draw the variables of a record, or the file of a figure, as SVG, PDF or PNG"
EPILOG = """\
Without --kind each variable gets the kind that suits it: time_course (nodes, or fields at places),
space_time (one dimension over time), snapshot (one time), snapshots (several), projection (three
dimensions and more). Several variables become panels of one figure. The file of a figure (.toml) has the
panels, ranges, labels and sizes of a figure for a paper; --save-as writes one to start from."""

WORDS = (
    "kind",
    "at",
    "trial",
    "where",
    "axes",
    "reduce",
    "place",
    "time_range",
    "value_range",
    "gif",
    "save_as",
)
"""Options that the file of a figure replaces."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    parser.add_argument(
        "record",
        type=Path,
        metavar="RECORD",
        help="a record (.zarr, .nc), a folder that deodar run wrote, or the file of a figure (.toml)",
    )
    parser.add_argument(
        "variables",
        nargs="*",
        metavar="VARIABLE",
        help=("paths of variables, for example u.activation (default: all); after a .toml file: the record"),
    )
    add_view(parser)
    parser.add_argument(
        "--gif",
        type=Path,
        metavar="FILE",
        help="also write a video of one variable that is a path (x and y over time), in its arena",
    )
    parser.add_argument(
        "--save-as",
        type=Path,
        metavar="FILE",
        help="also write what is drawn as the file of a figure, .toml",
    )
    parser.add_argument(
        "--out",
        "-o",
        type=Path,
        metavar="FILE",
        help=".png, .svg or .pdf (default: NAME-plot-001.png, ... here; of a .toml file NAME-001.pdf)",
    )
    parser.add_argument(
        "--follow",
        action="store_true",
        help="wait for the record, and draw again while it grows, until it is complete or Ctrl-C is pressed",
    )
    parser.add_argument(
        "--interval",
        type=_options.positive,
        default=1.0,
        metavar="S",
        help="with --follow: seconds between two figures (default 1)",
    )
    _options.add_force(parser)
    _options.add_json(parser)
    _options.wrong(parser)


def add_view(parser: argparse.ArgumentParser) -> None:
    """Add the options that select a part of the variables."""
    parser.add_argument(
        "--kind",
        metavar="K",
        help="time_course, space_time, snapshot, snapshots, projection, path, or one of a package",
    )
    parser.add_argument("--at", nargs="+", action="extend", type=float, metavar="T", help="times to draw")
    parser.add_argument(
        "--trial",
        type=_options.whole,
        metavar="N",
        help="trial to draw (default: all as lines; the first as a map)",
    )
    parser.add_argument(
        "--where", type=_options.pair, action="append", metavar="PATH=VALUE", help="point of a sweep to draw"
    )
    parser.add_argument(
        "--axes", nargs="+", metavar="AXIS", help="axes onto which a field is projected, one or two"
    )
    parser.add_argument(
        "--reduce", choices=("maximum", "integral"), help="how it is projected (default maximum)"
    )
    parser.add_argument(
        "--place",
        action="append",
        metavar="X[,Y...]",
        help="place of a field whose time course is drawn; may be given again",
    )
    parser.add_argument(
        "--time-range",
        nargs=2,
        type=float,
        metavar=("FROM", "TO"),
        help="times to draw, in the record's unit",
    )
    parser.add_argument(
        "--value-range", nargs=2, type=float, metavar=("LOW", "HIGH"), help="ends of the scale of the values"
    )


class DrawnFigure(NamedTuple):
    """What a call draws: the figure, its variables, its record, and that record's name."""

    figure: FigureFile
    names: list[str]
    record: xarray.Dataset | Path | None
    stem: str


def run(args: argparse.Namespace) -> int:
    """Draw the record, write the file and print its path."""
    if args.follow:
        return _followed(args)
    # start-up time: these bring JAX
    from deodar.figures import _files

    drawn = _drawn(args)
    out = _claimed(args, drawn.stem)
    video = None if args.gif is None else _video(args, drawn)
    made = drawn.figure.draw(drawn.record)
    if args.save_as is not None:
        _save_as(args, drawn.figure, [float(n) for n in made.get_size_inches()])
    if video is not None:
        video()
    _files.save_figure(made, out, args.force)
    _say(args, drawn, out)
    return 0


def _drawn(args: argparse.Namespace) -> DrawnFigure:
    """Return what the arguments select."""
    # start-up time: these bring JAX
    from deodar.figures._file import FigureFile
    from deodar.recording import files

    if args.record.suffix.lower() == ".toml":
        figure = _from_file(args)
        record = Path(args.variables[0]) if args.variables else None
        return DrawnFigure(figure, [panel.variable for panel in figure.panels], record, args.record.stem)
    data = files.open_record(args.record)
    names = variables(data, args.variables)
    kind = "path" if args.gif is not None else args.kind
    figure = FigureFile(panels(args, data, names, kind), letters="none")
    place = files.locate(args.record)[0]
    base = place.parent.resolve().name if place.stem == "record" else place.stem
    return DrawnFigure(figure, names, data, f"{base}-plot")


def _claimed(args: argparse.Namespace, stem: str) -> Path:
    """Return the path of the figure, which may be written."""
    # start-up time: these bring JAX
    from deodar.figures import _files
    from deodar.recording import places

    ending = ".pdf" if args.record.suffix.lower() == ".toml" else ".png"
    out: Path = args.out or places.free(Path(), stem, ending)
    _files.claim(out, args.force)
    return out


def _say(args: argparse.Namespace, drawn: DrawnFigure, out: Path) -> None:
    """Print what was drawn into which files."""
    also = {"gif": args.gif, "figure": args.save_as}
    if args.json:
        kinds = dict(zip(drawn.names, drawn.figure.kinds(drawn.record), strict=True))
        rest = {key: str(path) for key, path in also.items() if path is not None}
        print(codec.text({"out": str(out), "kinds": kinds, **rest}))
    else:
        written = [out, *(path for path in also.values() if path is not None)]
        names = ", ".join(dict.fromkeys(drawn.names))
        print(f"Drew {names} into {' and '.join(map(_options.shown, written))}")


def _followed(args: argparse.Namespace) -> int:
    """Draw again whenever the record has grown, until it is complete or Ctrl-C is pressed."""
    # start-up time: these bring JAX
    from deodar.figures import _files
    from deodar.recording.record import about

    if args.gif is not None or args.save_as is not None:
        args.wrong("--follow writes one figure again and again; leave out --gif and --save-as")
    drawn = out = seen = None
    try:
        while not args.record.exists():
            time.sleep(args.interval)
        while True:
            drawn = _drawn(args)
            opened = drawn.figure.records(drawn.record)
            complete = all(about(data).get("complete", True) for data in opened)
            sizes = [dict(data.sizes) for data in opened]
            if sizes != seen and (complete or all(min(size.values(), default=0) for size in sizes)):
                if out is None:
                    out = _claimed(args, drawn.stem)
                    print(f"Drawing into {_options.shown(out)}; Ctrl-C ends", file=sys.stderr, flush=True)
                _files.save_figure(drawn.figure.draw(drawn.record), out, force=args.force or seen is not None)
                seen = sizes
            if complete:
                break
            time.sleep(args.interval)
    except KeyboardInterrupt:
        pass
    if drawn is None or out is None or seen is None:
        print("Stopped before the record held a sample")
    else:
        _say(args, drawn, out)
    return 0


def panels(
    args: argparse.Namespace, data: xarray.Dataset, names: Sequence[str], kind: str | None
) -> list[FigurePanel]:
    """Return one panel for each variable, with the part that the options select."""
    # start-up time
    from deodar.figures._file import FigurePanel

    where = {path: _number(args, value) for path, value in args.where or ()}
    spots = [[_number(args, n) for n in place.split(",")] for place in args.place or ()]
    return [
        FigurePanel(
            name,
            kind,
            at=args.at,
            trial=args.trial if "trial" in data[name].dims or len(names) == 1 else None,
            where=where or None,
            axes=args.axes,
            places=spots or None,
            reduce=args.reduce,
            time_range=args.time_range,
            value_range=args.value_range,
        )
        for name in names
    ]


def _from_file(args: argparse.Namespace) -> FigureFile:
    """Read the file of a figure; options that it replaces are an error."""
    # start-up time
    from deodar.figures._file import FigureFile

    for word in WORDS:
        if getattr(args, word) is not None:
            option = f"--{word.replace('_', '-')}"
            args.wrong(f"{option} selects what is drawn of a record; write it into {args.record}")
    if len(args.variables) > 1:
        args.wrong(f"{args.record} names its variables; after it comes at most one record")
    return FigureFile.read(args.record)


def _save_as(args: argparse.Namespace, figure: FigureFile, inches: Sequence[float]) -> None:
    """Write the file of a figure, with the size that was drawn."""
    if args.save_as.suffix.lower() != ".toml":
        raise FigureError(
            f"the name ends in {args.save_as.suffix!r}", where="--save-as", fix="End it in .toml"
        )
    width, height = (round(25.4 * size, 1) for size in inches)
    dc.replace(figure, record=str(args.record), width=width, height=height).save(args.save_as, args.force)


def _video(args: argparse.Namespace, drawn: DrawnFigure) -> Callable[[], object]:
    """Return the function that writes the video of a path in the arena of its record."""
    # start-up time: these bring JAX
    from deodar.figures import path
    from deodar.recording.repeat import world_of

    data = drawn.figure.records(drawn.record)[0]
    if len(drawn.names) != 1:
        raise RecordError(
            f"a video shows one variable, not {len(drawn.names)}",
            where="--gif",
            fix="Name the one that holds x and y, for example pose.output",
        )
    world = world_of(data)
    if world is None:
        raise RecordError(
            "the record was made without a world, so there is no arena to draw the path in",
            where="--gif",
            fix="Leave out --gif",
        )
    view = drawn.figure.panels[0].view(data)
    stride = max(1, -(-len(view.times) // path.MOST_FRAMES))
    return lambda: path.animate_path(view, args.gif, world, stride=stride, force=args.force)


def variables(data: xarray.Dataset, names: list[str]) -> list[str]:
    """Return the named variables; a path of an element means all of its ports."""
    known = list(map(str, data.data_vars))
    if not known:
        raise RecordError("the record holds no variable")
    found: list[str] = []
    for name in names:
        if name not in known:
            of = [n for n in known if n.startswith(f"{name}.")]
            if not of:
                raise RecordError(f"the record holds no variable {name!r}", fix=did_you_mean(name, known))
            found += of
        else:
            found.append(name)
    return list(dict.fromkeys(found)) if names else known


def _number(args: argparse.Namespace, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        args.wrong(f"{text!r} is not a number")
        raise
