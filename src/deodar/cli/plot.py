"""The command `deodar plot RECORD`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from deodar import codec
from deodar.cli import _options
from deodar.errors import RecordError, did_you_mean

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray
    from matplotlib.figure import Figure

    from deodar.figures._view import View

HELP = "draw the variables of a record as SVG, PDF or PNG"
EPILOG = """\
Without --kind each variable gets the kind that suits it: time_course (nodes, or fields at places),
space_time (one dimension over time), snapshot (one time), snapshots (several), projection (three
dimensions and more). Several variables become panels of one figure."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    parser.add_argument(
        "record", type=Path, metavar="RECORD", help="a record (.zarr, .nc), or a folder that deodar run wrote"
    )
    parser.add_argument(
        "variables",
        nargs="*",
        metavar="VARIABLE",
        help="paths of variables, for example u.activation (default: all)",
    )
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
        "--reduce",
        choices=("maximum", "integral"),
        default="maximum",
        help="how it is projected (default maximum)",
    )
    parser.add_argument(
        "--place",
        action="append",
        metavar="X[,Y...]",
        help="place of a field whose time course is drawn; may be given again",
    )
    parser.add_argument(
        "--gif",
        type=Path,
        metavar="FILE",
        help="also write a video of one variable that is a path (x and y over time), in its arena",
    )
    parser.add_argument(
        "--out",
        "-o",
        type=Path,
        metavar="FILE",
        help=".png, .svg or .pdf (default: NAME-plot-001.png, ... here)",
    )
    _options.add_force(parser)
    _options.add_json(parser)
    _options.wrong(parser)


def run(args: argparse.Namespace) -> int:
    """Draw the record, write the file and print its path."""
    # start-up time: these bring JAX
    from deodar.recording import files, places

    where = {path: _number(args, value) for path, value in args.where or ()}
    spots = [[_number(args, n) for n in place.split(",")] for place in args.place or ()] or None
    data = files.load_record(args.record)
    names = _variables(data, args.variables)

    # start-up time: these bring JAX
    from deodar.figures import _files, _panels
    from deodar.figures._view import View

    name = files.locate(args.record)[0]
    base = name.parent.resolve().name if name.stem == "record" else name.stem
    out: Path = args.out or places.free(Path(), f"{base}-plot", ".png")
    _files.claim(out, args.force)
    views = [
        View(
            data[n],
            at=args.at,
            trial=args.trial if "trial" in data[n].dims or len(names) == 1 else None,
            where=where or None,
            axes=args.axes,
            places=spots,
            reduce=args.reduce,
        )
        for n in names
    ]
    if args.gif is not None or (args.kind == "path" and len(views) == 1):
        figure = _path(args, data, views)
    else:
        figure = _panels.draw(views, args.kind)
    _files.save_figure(figure, out, args.force)
    if args.json:
        kinds = {view.name: _panels.kind(view, args.kind).__name__.rpartition(".")[2] for view in views}
        film = {} if args.gif is None else {"gif": str(args.gif)}
        print(codec.text({"out": str(out), "kinds": kinds, **film}))
    else:
        print(
            f"Drew {', '.join(names)} into {_options.shown(out)}"
            + (f" and {_options.shown(args.gif)}" if args.gif is not None else "")
        )
    return 0


def _path(args: argparse.Namespace, data: xarray.Dataset, views: Sequence[View]) -> Figure:
    """Draw the path in the arena of the record, and write its video if requested."""
    # start-up time: these bring JAX
    from deodar.figures import path
    from deodar.recording.repeat import world_of

    if len(views) != 1:
        raise RecordError(
            f"a video shows one variable, not {len(views)}",
            where="--gif",
            fix="Name the one that holds x and y, for example pose.output",
        )
    world, variable = world_of(data), data[views[0].name]
    trial, where = views[0].trial, views[0].where
    if args.gif is not None:
        if world is None:
            raise RecordError(
                "the record was made without a world, so there is no arena to draw the path in",
                where="--gif",
                fix="Leave out --gif",
            )
        times = variable.sizes.get("time", 0)
        path.animate_path(
            views[0],
            args.gif,
            world,
            stride=max(1, -(-times // path.MOST_FRAMES)),
            force=args.force,
        )
    return path.path_figure(variable, world, trial=trial, where=where)


def _variables(data: xarray.Dataset, names: list[str]) -> list[str]:

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
