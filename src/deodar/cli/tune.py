"""The command `deodar tune FILE REQUIREMENTS`."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar import codec
from deodar.cli import _options
from deodar.errors import DocumentError

if TYPE_CHECKING:
    from deodar.analysis.tuning.tuned import Tuned

HELP = "find parameters at which a field meets requirements: thresholds, memory, selection, width of peaks"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    _options.add_document(parser)
    parser.add_argument(
        "requirements", type=Path, metavar="REQUIREMENTS", help="parameters and requirements, as JSON"
    )
    _options.add_set(parser)
    parser.add_argument("--field", metavar="PATH", help="the field or node (default: the only one)")
    parser.add_argument("--seed", type=_options.whole, metavar="N", help="seed of the search (default 0)")
    parser.add_argument(
        "--budget", type=_options.whole, metavar="N", help="most candidates of the search (default 8000)"
    )
    parser.add_argument(
        "-o",
        "--out",
        type=Path,
        metavar="TUNED",
        help="write the tuned document, .json or .deodar; its notes say what it is tuned to",
    )
    _options.add_force(parser)
    parser.add_argument("--no-progress", action="store_true", help="do not show what is done")
    _options.add_json(parser)


def run(args: argparse.Namespace) -> int:
    """Print what was found, and write the tuned document; status 1 if a requirement is not met."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    _options.use_cores(None)
    # start-up time: these bring JAX
    from rich.console import Console

    from deodar.analysis.tuning.tune import tune
    from deodar.analysis.tuning.tuning_file import tuning_file
    from deodar.importers.opening import load
    from deodar.model import output
    from deodar.model.model import save
    from deodar.resources import Resources

    model = load(args.file)
    _options.apply_set(model, args)
    try:
        content = args.requirements.read_bytes()
    except OSError as error:
        raise DocumentError(error.strerror or "cannot be read", where=str(args.requirements)) from None
    wanted = tuning_file(codec.read(content), str(args.requirements))
    options: dict[str, Any] = dict(wanted.options)
    options |= {k: v for k in ("field", "seed", "budget") if (v := getattr(args, k)) is not None}
    if args.out is not None:
        output.claim(args.out, args.force)
    hidden = args.no_progress or args.json or not sys.stderr.isatty()
    console = Console(stderr=True, quiet=hidden)
    with console.status("compiling") as status:
        found = tune(
            model,
            wanted.parameters,
            wanted.requirements,
            bounds=wanted.bounds,
            on=Resources(
                progress=lambda what, n, margin: status.update(f"{what}: {n} candidates, margin {margin:.2g}")
            ),
            **options,
        )
    if args.out is not None:
        notes = "\n\n".join(text for text in (found.model.document.notes, found.note) if text)
        found.model.describe(notes=notes)
        save(found.model, args.out, args.force)
    if args.json:
        print(codec.text(found.data() | {"document": str(args.out) if args.out is not None else None}))
    else:
        print(_table(found))
        if args.out is not None:
            print(f"\nDocument: {args.out}")
    return 0 if found.met else 1


def _table(found: Tuned) -> str:
    """Return what was found in plain words."""
    strength, n = found.about["strength"], found.candidates
    state = "meets all requirements" if found.met else "does not meet all requirements"
    lines = [
        f"{found.field} {state}" + (", interrupted" if found.interrupted else ""),
        f"Measured alone, without noise, with inputs of {strength:g}; {n} candidates.",
        "",
    ]
    for name, margin in found.margins.items():
        value = f"   at {found.reached[name]:.6g}" if name in found.reached else ""
        value += " (exact)" if name in found.exact else ""
        lines.append(f"  {'met    ' if margin >= 0 else 'NOT MET'}  {margin:6.2f}  {name}{value}")
    lines += ["", f"  {'parameter':32} {'before':>10} {'found':>10}   may move alone by"]
    for path, value in found.values.items():
        down, up = found.tolerated_alone.get(path, (0.0, 0.0))
        alone = f"   -{down:.1%} to +{up:.1%}" if found.size else ""
        lines.append(f"  {path:32} {found.before[path]:10.5g} {value:10.5g}{alone}")
    if found.size:
        lines.append(f"\nAll at once may move by {found.tolerated:.1%} ({found.size.points} random points).")
    lines += [f"\n{sentence[0].upper()}{sentence[1:]}." for sentence in found.reasons]
    return "\n".join(lines)
