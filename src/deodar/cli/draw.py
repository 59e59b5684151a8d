"""The command `deodar draw FILE`."""

from __future__ import annotations

import argparse
from pathlib import Path

from deodar.cli import _options
from deodar.cli._answer import CommandAnswer
from deodar.recording import places

HELP = "draw the architecture in a file as SVG, PDF or PNG"


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    _options.add_document(parser)
    parser.option(
        "--out -o", "FILE", ".svg, .pdf or .png (default: NAME-architecture-001.svg, ... here)", Path
    )
    parser.option("--width", "INCHES", "width of the picture (default: names 7.5 points high)", float)
    parser.option(
        "--depth",
        "N",
        "draw N levels of groups open, each group below as one box (default: all)",
        _options.whole,
    )
    parser.flag("--no-legend", "omit the legend")
    _options.add_force(parser)
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Draw the model, write the file and print its path."""
    # start-up time: these bring JAX
    from deodar.importers.opening import load
    from deodar.model.draw import draw

    drawing = draw(load(args.file), legend=not args.no_legend, depth=args.depth)
    out: Path = args.out or places.free(Path(), f"{args.file.stem}-architecture", ".svg")
    drawing.save(out, args.width, args.force)
    width = drawing.size[0] if args.width is None else args.width
    size = [round(width, 2), round(width * drawing.size[1] / drawing.size[0], 2)]
    drew = f"Drew {_options.shown(args.file)} into {_options.shown(out)}, {size[0]:g} x {size[1]:g} inches"
    return CommandAnswer({"out": str(out), "inches": size}, [drew])
