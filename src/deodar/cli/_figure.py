"""What `deodar plot` and `deodar export` draw: a record with options, or the file of a figure."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from deodar.cli import _options
from deodar.errors import RecordError, did_you_mean

if TYPE_CHECKING:
    import xarray

    from deodar.figures._file import FigureFile, FigurePanel

WORDS = (
    "kind",
    "at",
    "trial",
    "where",
    "axes",
    "reduce",
    "place",
    "time_range",
    "every",
    "value_range",
    "gif",
    "save_as",
)
"""Options that the file of a figure replaces."""


class DrawnFigure(NamedTuple):
    """What a call draws: the figure, its variables, its record, and that record's name."""

    figure: FigureFile
    names: list[str]
    record: xarray.Dataset | Path | None
    stem: str


def add_record(parser: _options.CommandParser, more: str = "") -> None:
    """Add the record and its variables; `more` says what else the first argument may be."""
    parser.option(
        "record",
        "RECORD",
        f"a record (.zarr, .nc), a folder that deodar run wrote, or the file of a figure (.toml){more}",
        Path,
    )
    parser.option(
        "variables",
        "VARIABLE",
        "paths of variables, for example u.activation (default: all); after a .toml file: the record",
        nargs="*",
    )


def add_view(parser: _options.CommandParser) -> None:
    """Add the options that select a part of the variables."""
    parser.option(
        "--kind", "K", "kind of figure, such as time_course, space_time or path, or one of a package"
    )
    parser.option("--at", "T", "times to draw", float, nargs="+", action="extend")
    parser.option("--trial", "N", "trial to draw (default: all as lines; the first as a map)", _options.whole)
    parser.option("--where", "PATH=VALUE", "point of a sweep to draw", _options.pair, action="append")
    parser.option("--axes", "AXIS", "axes onto which a field is projected, one or two", nargs="+")
    parser.add_argument(
        "--reduce", choices=("maximum", "integral"), help="how it is projected (default maximum)"
    )
    parser.option(
        "--place",
        "X[,Y...]",
        "place of a field whose time course is drawn; may be given again",
        action="append",
    )
    parser.option("--time-range", ("FROM", "TO"), "times to draw, in the record's unit", float, nargs=2)
    parser.option(
        "--every",
        "T",
        "time between two samples, or two frames of a video (default: all; of a video at most 600)",
        _options.positive,
    )
    parser.option("--value-range", ("LOW", "HIGH"), "ends of the scale of the values", float, nargs=2)


def drawn(args: argparse.Namespace) -> DrawnFigure:
    """Return what the arguments select."""
    # start-up time: these bring JAX
    from deodar.figures._file import FigureFile
    from deodar.recording import files

    if args.record.suffix.lower() == ".toml":
        figure = _from_file(args)
        record = Path(args.variables[0]) if args.variables else None
        return DrawnFigure(figure, [panel.variable for panel in figure.panels], record, args.record.stem)
    record = files.open_record(args.record)
    names = variables(record, args.variables)
    kind = "path" if getattr(args, "gif", None) is not None else args.kind
    figure = FigureFile(panels(args, record, names, kind), letters="none")
    return DrawnFigure(figure, names, record, f"{stem(args.record)}-plot")


def stem(record: Path) -> str:
    """Return the name of a record, or of the folder of its run."""
    # start-up time: this brings JAX
    from deodar.recording import files

    place = files.locate(record)[0]
    return place.parent.resolve().name if place.stem == "record" else place.stem


def panels(
    args: argparse.Namespace, record: xarray.Dataset, names: Sequence[str], kind: str | None
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
            trial=args.trial if "trial" in record[name].dims or len(names) == 1 else None,
            where=where or None,
            axes=args.axes,
            places=spots or None,
            reduce=args.reduce,
            time_range=args.time_range,
            every=args.every,
            value_range=args.value_range,
        )
        for name in names
    ]


def _from_file(args: argparse.Namespace) -> FigureFile:
    """Read the file of a figure; options that it replaces are an error."""
    # start-up time
    from deodar.figures._file import FigureFile

    for word in WORDS:
        if getattr(args, word, None) is not None:
            option = _options.flags(word)
            args.wrong(f"{option} selects what is drawn of a record; write it into {args.record}")
    if len(args.variables) > 1:
        args.wrong(f"{args.record} names its variables; after it comes at most one record")
    return FigureFile.read(args.record)


def selected(args: argparse.Namespace, record: xarray.Dataset, names: Sequence[str]) -> xarray.Dataset:
    """Return the selected trial, point of a sweep and times of the named variables, without reading them."""
    # start-up time
    import xarray

    views = [panel.view(record) for panel in panels(args, record, names, None)]
    return xarray.Dataset({view.name: view.chosen() for view in views}, attrs=record.attrs)


def variables(record: xarray.Dataset, names: list[str]) -> list[str]:
    """Return the named variables; a path of an element means all of its ports."""
    recorded = list(map(str, record.data_vars))
    if not recorded:
        raise RecordError("the record holds no variable")
    chosen: list[str] = []
    for name in names:
        if name not in recorded:
            of = [n for n in recorded if n.startswith(f"{name}.")]
            if not of:
                raise RecordError(f"the record holds no variable {name!r}", fix=did_you_mean(name, recorded))
            chosen += of
        else:
            chosen.append(name)
    return list(dict.fromkeys(chosen)) if names else recorded


def _number(args: argparse.Namespace, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        args.wrong(f"{text!r} is not a number")
        raise
