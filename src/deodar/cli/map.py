"""The command `deodar map FILE PARAMETER LOW HIGH N PARAMETER LOW HIGH N`."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import TYPE_CHECKING

from deodar.cli import _options
from deodar.cli._answer import CommandAnswer

if TYPE_CHECKING:
    from deodar.analysis.continuation.locus import Locus
    from deodar.analysis.maps.map_result import RegimeMap

HELP = "map the regimes of a field over two parameters: silent, input-driven, self-sustained, selective"


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    _options.add_document(parser)
    for side, which, example in (("x", "across", "u.global_inhibition"), ("y", "up", "u.resting_level")):
        name = side.upper()
        parser.option(side, name, f"path of the parameter {which}, as {example}")
        parser.option(f"{side}_low", f"{name}LOW", "its lowest value", float)
        parser.option(f"{side}_high", f"{name}HIGH", "its highest value", float)
        parser.option(f"{side}_number", f"{name}N", "how many values, at least 2", _options.whole)
    parser.option("--field", "PATH", "the field or node (default: the only one)", default="")
    _options.add_set(parser)
    parser.option(
        "--strength",
        "AMPLITUDE",
        "of the inputs (default: 1.2 times the distance between resting level and threshold)",
        _options.positive,
    )
    parser.option("--sigma", "WIDTH", "width of the inputs (default: that of the kernel)", _options.positive)
    parser.option(
        "--input",
        "PATH",
        "stimuli (and couplings) of the document to keep as constant input",
        nargs="+",
        default=[],
    )
    parser.add_argument(
        "--precision",
        choices=("float32", "float64"),
        default="float32",
        help="of the computation (default: float32)",
    )
    parser.flag("--every-cell", "compute every cell, not only those beside another regime")
    parser.option(
        "-o --out",
        "FIGURE",
        "the figure, .png or .svg, or the map alone, .nc or .zarr (default: FILE-map-001.png, -002, ...)",
        Path,
    )
    parser.flag("--loci", "compute the borders that are folds, and draw them as lines")
    parser.option("--save", "MAP", "write the map as well, .nc or .zarr", Path)
    _options.add_force(parser)
    parser.flag("--no-progress", "show no progress bar")
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Print the share of each regime, and write the figure."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    _options.use_cores(None)
    # start-up time: these bring JAX
    from deodar.analysis.maps.borders import regime_loci
    from deodar.analysis.maps.regime_map import regime_map
    from deodar.figures import _files
    from deodar.figures.regime_map import regime_map_figure
    from deodar.importers.opening import load
    from deodar.recording import files
    from deodar.resources import Resources

    model = load(args.file)
    _options.apply_set(model, args)
    target, save = _options.targets(args, f"{args.file.stem}-map")
    if target is not None:
        _files.claim(target, args.force)
    if save is not None:
        files.claim(save, files.format_of(save), args.force)
    if args.x == args.y:
        args.wrong(f"both parameters are {args.x!r}")
    over = {
        args.x: (args.x_low, args.x_high, args.x_number),
        args.y: (args.y_low, args.y_high, args.y_number),
    }
    regimes = regime_map(
        model,
        over,
        args.field,
        args.strength,
        refine=not args.every_cell,
        on=Resources(progress=_options.progress(args)),
        sigma=args.sigma,
        inputs=args.input,
        precision=args.precision,
    )
    loci = regime_loci(regimes) if args.loci else []
    if target is not None:
        _files.save_figure(regime_map_figure(regimes, loci), target, args.force)
    if save is not None:
        regimes.save(save, args.force)
    fields = regimes.data() | ({"loci": [line.data() for line in loci]} if args.loci else {})
    lines = [_table(regimes), *([_lines(regimes, loci)] if args.loci else [])]
    lines += [] if target is None else [f"\nFigure: {target}"]
    return CommandAnswer(fields | {"figure": None if target is None else str(target)}, lines)


def _table(regimes: RegimeMap) -> str:
    """Return the regimes and their shares in words, one per line."""
    measured, (x, y) = regimes.about, regimes.parameters
    rows, columns = regimes.labels.shape
    size = f"{rows} x {columns} cells, {int(regimes.computed.sum())} of them computed"
    lines = [
        f"{measured['field']} over {x} and {y}: {size}",
        f"Measured alone, without noise, with inputs of {measured['strength']:g}.",
        "",
        *(f"  {share:6.1%}  {word}" for word, share in regimes.shares.items()),
    ]
    inside = all(v[0] <= at <= v[-1] for v, at in zip(regimes.values, regimes.at, strict=True))
    if inside:
        lines.append(
            f"\nThe model itself ({x} {regimes.at[0]:g}, {y} {regimes.at[1]:g}): {regimes.word(*regimes.at)}"
        )
    return "\n".join(lines)


def _lines(regimes: RegimeMap, loci: list[Locus]) -> str:
    """Return the borders that are folds in words, one per line, and the distance of the model from each."""
    if not loci:
        return "\nNo border is a fold."
    lines = ["\nBorders that are folds, and the change of both parameters that reaches them from the model:"]
    for name in dict.fromkeys(line.of for line in loci):
        parts = [line for line in loci if line.of == name]
        distance = "-" if 0 in regimes.at else f"{min(line.distance(regimes.at) for line in parts):.1%}"
        lines.append(f"  {distance:>6}  {name}")
        for point in dict.fromkeys(point for line in parts for point in line.points):
            lines.append(f"{'':10}{point.kind} at {point.values[0]:.5g}, {point.values[1]:.5g}")
    return "\n".join(lines)
