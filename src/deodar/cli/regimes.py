"""The command `deodar regimes FILE ELEMENT`."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from deodar import codec
from deodar.cli import _options

if TYPE_CHECKING:
    from deodar.analysis.continuation.confirmation import Confirmation
    from deodar.analysis.peaks import Peak
    from deodar.analysis.preshape import Boosted
    from deodar.analysis.regimes import Regimes

HELP = (
    "measure the instabilities of one field or node: detection, reverse detection, working memory, selection"
)


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    _options.add_document(parser)
    parser.add_argument(
        "element", metavar="ELEMENT", help="path of the field or node; it is measured alone and without noise"
    )
    parser.add_argument(
        "-o",
        "--out",
        type=Path,
        metavar="FIGURE",
        help="the figure, .png or .svg (default: FILE-regimes-001.png, -002, ...)",
    )
    parser.add_argument("--force", action="store_true", help="replace the figure if it exists")
    parser.add_argument("--json", action="store_true", help="print the answer as JSON")
    parser.add_argument(
        "--precision",
        choices=("float32", "float64"),
        default="float32",
        help="of the computation (default: float32)",
    )
    _options.add_cores(parser)
    parser.add_argument(
        "--sigma",
        type=float,
        nargs="+",
        metavar="WIDTH",
        help="width of the localised input (default: that of the kernel)",
    )
    parser.add_argument(
        "--input",
        nargs="+",
        default=[],
        metavar="PATH",
        help="stimuli (and couplings) of the document to keep as constant input",
    )


def run(args: argparse.Namespace) -> int:
    """Print the table, and write the figure."""
    # start-up time: these bring JAX
    from deodar.importers.opening import load

    _options.use_cores(args.cores)
    model = load(args.file)
    target = _options.figure(args.out, f"{args.file.stem}-regimes")
    # start-up time: these bring JAX
    from rich.console import Console

    from deodar.analysis.continuation.confirmation import confirmed
    from deodar.analysis.regimes import regimes
    from deodar.figures import _files
    from deodar.figures.regimes import regimes_figure

    _files.claim(target, args.force)
    sigma = args.sigma[0] if args.sigma is not None and len(args.sigma) == 1 else args.sigma
    with Console(stderr=True).status("compiling") as status:
        found = regimes(
            model,
            args.element,
            sigma=sigma,
            precision=args.precision,
            inputs=args.input,
            finer=True,
            progress=status.update,
        )
        status.update("folds")
        folds = confirmed(found)
    _files.save_figure(regimes_figure(found), target, args.force)
    if args.json:
        computed = {name: fold.data() for name, fold in folds.items()}
        print(codec.text(found.data() | {"folds": computed, "figure": str(target)}))
    else:
        print(_table(found))
        print(_folds(folds))
        print(f"\nFigure: {target}")
    return 0


def _table(found: Regimes) -> str:
    """Return the measurements in words, one per line."""
    isolated, up, down = found.isolated, found.thresholds.detection, found.thresholds.reverse
    field = isolated.field
    axes = ", ".join(str(a) for a in isolated.axes)
    lines = [
        f"{isolated.path}: {f'a field over {axes}' if axes else 'a node'}; tau {field.tau:g}"
        f" {isolated.time_unit}, resting level"
    ]
    lines[0] += f" {field.resting_level:g}"
    if isolated.axes:
        at = ", ".join(
            f"{a.name} = {c:g}{_unit(a.unit)}" for a, c in zip(isolated.axes, isolated.center, strict=True)
        )
        wide = ", ".join(
            f"{s:.3g}{_unit(a.unit)}" for a, s in zip(isolated.axes, isolated.sigma, strict=True)
        )
        lines.append(f"Measured alone, without noise, with a Gaussian input at {at} of width {wide}.")
    else:
        lines.append("Measured alone, without noise, with a constant input.")
    if isolated.background:
        lines.append(f"Kept as constant input: {', '.join(isolated.background)}.")
    rows = [("regime", "; ".join(found.words))]
    what = "peak" if isolated.axes else "activation above threshold"
    if up is not None:
        kind = (
            "the activation jumps: an instability"
            if up.jump
            else "the activation grows gradually: no instability"
        )
        rows.append(("detection threshold", f"{_bracket(found, 'detection')}  ({kind})"))
        low = "0" if isolated.axes else f"-{found.thresholds.searched:g}"
        stays = f"none: the {what} stays down to an input of {low}"
        rows.append(("reverse detection", _bracket(found, "reverse") if down is not None else stays))
        both = found.bistable
        rows.append(
            ("bistable range", f"{both[0]:.4g} to {both[1]:.4g}" if both and both[0] < both[1] else "none")
        )
    if found.peak is not None:
        rows.append(("just above detection", _peak(found, found.peak)))
    memory = found.memory
    if memory is not None:
        left = len(memory.left)
        rows.append(
            (
                "input taken away",
                (
                    f"{left} peak{'' if left == 1 else 's'} left: {_peak(found, memory.left[0])}"
                    if left
                    else f"no {what} is left"
                ),
            )
        )
    if found.forgetting is not None:
        stays = (
            "is erased by a homogeneous input below"
            if found.self_sustained
            else "would stay with a homogeneous input above"
        )
        rows.append(("memory", f"a peak {stays} {_bracket(found, 'forgetting')}"))
        if found.suppression is not None:
            rows.append(("", f"or by a localised input below {_bracket(found, 'suppression')}"))
    if found.boosts:
        rows.append(("boost on a pre-shape", "; ".join(_boosted(b) for b in found.boosts)))
    if found.selection is not None:
        s = found.selection
        stronger = (
            "" if s.right is None else " (at the stronger one)" if s.right else " (not at the stronger one)"
        )
        apart = (
            f"; both stay from a distance of {_distance(found)} on"
            if found.separation
            else "; at no distance do both stay"
        )
        rows.append(("two equal inputs", _count(len(s.equal)) + apart))
        rows.append(("two inputs, one stronger", _count(len(s.different)) + stronger))
    if found.transitions and found.coarse_alone and isolated.axes:
        rows.append(("discretisation error", f"not measured: {found.coarse_alone}"))
    swept = found.ramp
    if not (swept.up.settled.all() and swept.down.settled.all()):
        rows.append(
            ("note", "the field did not settle at some inputs; their values are where it stood at the limit")
        )
    return "\n".join([*lines, "", *(f"  {label:26}{text}" for label, text in rows)])


def _folds(folds: Mapping[str, Confirmation]) -> str:
    """Return the thresholds that were computed as folds, and whether both methods agree."""
    if not folds:
        return f"  {'computed as folds':26}none: no threshold is an instability"
    parts: list[str] = []
    for name, fold in folds.items():
        said = f"not found ({fold.why})" if fold.value is None else f"{fold.value:.6g}"
        outside = fold.value is not None and not fold.inside
        parts.append(f"{NAMES[name]} {said}{', OUTSIDE the interval above' if outside else ''}")
    return f"  {'computed as folds':26}{'; '.join(parts)}"


NAMES = {"detection": "detection", "reverse": "reverse detection", "forgetting": "forgetting"}


def _bracket(found: Regimes, name: str) -> str:
    """Return a threshold, half of its interval, and its shift on a grid twice as fine if that exceeds half
    the interval.
    """
    t = found.transitions[name]
    half = (t.interval[1] - t.interval[0]) / 2
    text = f"{t.value:.4g} ± {half:.1g}"
    if found.discretisation is None:
        return text
    moved = found.discretisation[name]
    if moved is None:
        return text + ", none on a grid twice as fine"
    return text + (
        f", discretisation error {moved:.2g}"
        if abs(moved) > half
        else f", discretisation error below {half:.1g}"
    )


def _peak(found: Regimes, peak: Peak) -> str:
    axes = found.isolated.axes
    widths = [f"{w:.3g}{_unit(a.unit)}" for a, w in zip(axes, peak.width, strict=True)]
    return (
        f"width {' x '.join(widths)}, amplitude {peak.amplitude:.3g}"
        if axes
        else f"activation {peak.amplitude:.3g}"
    )


def _boosted(b: Boosted) -> str:
    share = f"input {b.preshape:.3g}: "
    if b.boost is None:
        return share + "none makes a peak"
    return share + f"{b.boost:.4g}" + ("" if b.localised else " (not one peak there)")


def _distance(found: Regimes) -> str:
    share = found.separation or 0.0
    return ", ".join(f"{share * a.range:.3g}{_unit(a.unit)}" for a in found.isolated.axes)


def _count(number: int) -> str:
    return f"{number or 'no'} peak{'' if number == 1 else 's'}"


def _unit(unit: str) -> str:
    return f" {unit}" if unit else ""
