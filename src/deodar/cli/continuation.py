"""The command `deodar continuation FILE PARAMETER FIRST LAST`."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from deodar.cli import _options
from deodar.cli._answer import CommandAnswer

if TYPE_CHECKING:
    from deodar.analysis.continuation.branch import SteadyBranch

HELP = "follow the steady states of a model over one parameter, and locate its instabilities"


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    _options.add_document(parser)
    parser.option("parameter", "PARAMETER", "path of the parameter, as s.amplitude")
    parser.option("first", "FIRST", "its first value", float)
    parser.option("last", "LAST", "its last value", float)
    _options.add_set(parser)
    parser.option(
        "--induced-by",
        "PATH=VALUE",
        "value of another parameter at which the model settles first: the input of a peak that remains",
        _options.setting,
        action="append",
    )
    parser.option("--hold", "PATH", "elements that are constant", nargs="+", default=[])
    parser.option("--even", "AXIS", "axes whose two sides are mirror images", nargs="+", default=[])
    parser.option("--at", "T", "time of the stimuli", float, default=0.0)
    parser.option("--show", "PORT", "port to draw (default: the first field)", default="")
    parser.flag("--switch", "follow the branches that leave branch points as well")
    parser.flag("--one-grid", "do not repeat on a grid twice as fine, for the errors")
    parser.option(
        "-o --out",
        "FIGURE",
        "the figure, .png or .svg, or the branch alone, .nc or .zarr"
        " (default: FILE-continuation-001.png, -002, ...)",
        Path,
    )
    parser.option("--save", "BRANCH", "write the branch as well, .nc or .zarr", Path)
    _options.add_force(parser)
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Print the bifurcations, and write the figure."""
    # matrices are small: more threads of BLAS would wait for each other. Read when NumPy is imported
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # start-up time: these bring JAX
    from rich.console import Console

    from deodar.analysis.continuation.continuation import continuation
    from deodar.figures import _files
    from deodar.figures.bifurcation import bifurcation_diagram
    from deodar.importers.opening import load
    from deodar.recording import files

    model = load(args.file)
    _options.apply_set(model, args)
    target, save = _options.targets(args, f"{args.file.stem}-continuation")
    if target is not None:
        _files.claim(target, args.force)
    if save is not None:
        files.claim(save, files.format_of(save), args.force)
    with Console(stderr=True).status("following steady states"):
        branch = continuation(
            model,
            args.parameter,
            (args.first, args.last),
            {path: float(value) for path, value in args.induced_by or ()},
            args.at,
            args.hold,
            args.even,
            finer=not args.one_grid,
        )
        points = [b for b in branch.bifurcations if b.kind == "branch point"] if args.switch else []
        side_branches = [side_branch for b in points for side_branch in branch.switch(b)]
        figure = None if target is None else bifurcation_diagram(branch, *side_branches, shown=args.show)
    if target is not None and figure is not None:
        _files.save_figure(figure, target, args.force)
    written = [] if save is None else _saved([branch, *side_branches], save, args.force)
    fields = branch.data() | {"switched": [side_branch.data() for side_branch in side_branches]}
    fields |= {"figure": None if target is None else str(target), "files": list(map(str, written))}
    lines = [_table(branch)]
    lines += [f"\nA branch that leaves a branch point:\n{_table(side)}" for side in side_branches]
    lines += [] if target is None else [f"\nFigure: {target}"]
    return CommandAnswer(fields, [*lines, *(f"Branch: {path}" for path in written)])


def _saved(branches: Sequence[SteadyBranch], path: Path, force: bool) -> list[Path]:
    """Write branches, those after the first under names with a number."""
    names = [path, *(path.with_name(f"{path.stem}-{k}{path.suffix}") for k in range(2, len(branches) + 1))]
    return [branch.save(name, force) for branch, name in zip(branches, names, strict=True)]


def _table(branch: SteadyBranch) -> str:
    """Return the bifurcations in words, one per line."""
    low, high = float(branch.values.min()), float(branch.values.max())
    lines = [
        f"{len(branch.values)} steady states over {branch.parameter} from {low:.4g} to {high:.4g},"
        f" {int(branch.stable.sum())} of them stable"
    ]
    for b in branch.bifurcations:
        lines.append(f"  {b.value:<12.8g} {b.words}")
        if b.step_value is not None:
            lines.append(
                f"{'':15}with the Euler step {branch.line.right_hand_side.dt:g} at {b.step_value:.6g}"
            )
        if b.fine_value is not None:
            lines.append(f"{'':15}on a grid twice as fine {b.fine_value:.8g}")
        if b.kind == "fold" and b.instability:
            strongest = sorted(b.sensitivity.items(), key=lambda pair: -abs(pair[1]))[:3]
            text = ", ".join(f"{slope:+.3g} per {path}" for path, slope in strongest)
            lines.append(f"{'':15}moves by {text}")
    if not branch.bifurcations:
        lines.append("  no bifurcation")
    if branch.not_refined:
        lines.append(f"Not followed on a finer grid: {branch.not_refined}.")
    if branch.ended[1] in ("points", "lost"):
        lines.append(f"The branch ends inside the span, at {branch.values[-1]:.6g}.")
    return "\n".join(lines)
