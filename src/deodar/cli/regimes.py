"""The command `deodar regimes FILE ELEMENT`."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from deodar.cli import _options
from deodar.cli._answer import CommandAnswer

if TYPE_CHECKING:
    from deodar.analysis.continuation.confirmation import Confirmation
    from deodar.analysis.continuation.grid_errors import GridError
    from deodar.analysis.regimes import Regimes

HELP = (
    "measure the instabilities of one field or node: detection, reverse detection, working memory, selection"
)


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    _options.add_document(parser)
    parser.option("element", "ELEMENT", "path of the field or node; it is measured alone and without noise")
    parser.option(
        "-o --out", "FIGURE", "the figure, .png or .svg (default: FILE-regimes-001.png, -002, ...)", Path
    )
    parser.flag("--force", "replace the figure if it exists")
    parser.flag(
        "--resolution",
        "also compute by how much the grid changes each threshold, with the field's quadrature and with cell",
    )
    _options.add_json(parser)
    parser.add_argument(
        "--precision",
        choices=("float32", "float64"),
        default="float32",
        help="of the computation (default: float32)",
    )
    _options.add_cores(parser)
    parser.option(
        "--sigma", "WIDTH", "width of the localised input (default: that of the kernel)", float, nargs="+"
    )
    parser.option(
        "--input",
        "PATH",
        "stimuli (and couplings) of the document to keep as constant input",
        nargs="+",
        default=[],
    )


def run(args: argparse.Namespace) -> CommandAnswer:
    """Print the table, and write the figure."""
    # start-up time: these bring JAX
    from deodar.importers.opening import load

    _options.use_cores(args.cores)
    model = load(args.file)
    target = _options.figure(args.out, f"{args.file.stem}-regimes")
    # start-up time: these bring JAX
    from rich.console import Console

    from deodar.analysis.continuation.confirmation import confirmed
    from deodar.analysis.continuation.grid_errors import grid_errors
    from deodar.analysis.regimes import regimes
    from deodar.figures import _files
    from deodar.figures.regimes import regimes_figure
    from deodar.resources import Resources

    _files.claim(target, args.force)
    sigma = args.sigma[0] if args.sigma is not None and len(args.sigma) == 1 else args.sigma
    with Console(stderr=True).status("compiling") as status:
        measured = regimes(
            model,
            args.element,
            sigma=sigma,
            precision=args.precision,
            inputs=args.input,
            finer=True,
            on=Resources(progress=lambda done: status.update(done.stage)),
        )
        status.update("folds")
        folds = confirmed(measured)
        status.update("grids")
        errors = grid_errors(measured) if args.resolution and not measured.coarse_alone else None
    _files.save_figure(regimes_figure(measured), target, args.force)
    computed = {name: fold.data() for name, fold in folds.items()}
    fields = measured.data() | {
        "folds": computed,
        "resolution": None if errors is None else [e.data() for e in errors],
        "figure": str(target),
    }
    rows = [_table(measured), _folds(folds), *map(_grid_error, errors or [])]
    if args.resolution and errors is None:
        rows.append(f"  {'the grid':26}not compared: {measured.coarse_alone}")
    return CommandAnswer(fields, [*rows, f"\nFigure: {target}"])


def _table(measured: Regimes) -> str:
    """Return the measurements in words, one per line."""
    # start-up time: this brings JAX
    from deodar.analysis import regime_words

    rows = [f"  {label:26}{text}" for label, text in regime_words.rows(measured)]
    return "\n".join([*regime_words.heading(measured), "", *rows])


def _folds(folds: Mapping[str, Confirmation]) -> str:
    """Return the thresholds that were computed as folds, and whether both methods agree."""
    if not folds:
        return f"  {'computed as folds':26}none: no threshold is an instability"
    parts: list[str] = []
    for name, fold in folds.items():
        threshold = f"not found ({fold.why})" if fold.value is None else f"{fold.value:.6g}"
        outside = fold.value is not None and not fold.inside
        parts.append(f"{NAMES[name]} {threshold}{', OUTSIDE the interval above' if outside else ''}")
    return f"  {'computed as folds':26}{'; '.join(parts)}"


def _grid_error(error: GridError) -> str:
    """Return what the grid changes with one quadrature, at one position of the input."""
    place = f"{error.quadrature}, {'between samples' if error.between else 'on a sample'}"
    parts = [
        f"{NAMES[name]} {'not found' if percent is None else f'{percent:+.2f} %'}"
        for name, percent in error.percent.items()
    ]
    return f"  {place:26}{'; '.join(parts) or 'no threshold is a fold'}"


NAMES = {"detection": "detection", "reverse": "reverse detection", "forgetting": "forgetting"}
