"""The command `deodar tune FILE REQUIREMENTS`."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar import codec, regular_file
from deodar.cli import _options
from deodar.cli._answer import CommandAnswer
from deodar.errors import DocumentError

if TYPE_CHECKING:
    from deodar.analysis.tuning.tuned import Tuned

HELP = "find parameters at which a field meets requirements: thresholds, memory, selection, width of peaks"


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    _options.add_document(parser)
    parser.option("requirements", "REQUIREMENTS", "parameters and requirements, as JSON", Path)
    _options.add_set(parser)
    parser.option("--field", "PATH", "the field or node (default: the only one)")
    parser.option("--seed", "N", "seed of the search (default 0)", _options.whole)
    parser.option("--budget", "N", "most candidates of the search (default 8000)", _options.whole)
    parser.option(
        "-o --out",
        "TUNED",
        "write the tuned document, .json or .deodar; its notes say what it is tuned to",
        Path,
    )
    _options.add_force(parser)
    parser.flag("--no-progress", "do not show what is done")
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
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
        content = regular_file.read_bytes(args.requirements)
    except OSError as error:
        raise DocumentError(error.strerror or "cannot be read", where=str(args.requirements)) from None
    tuning = tuning_file(codec.read(content, codec.FEW_VALUES), str(args.requirements))
    options: dict[str, Any] = dict(tuning.options)
    options |= {k: v for k in ("field", "seed", "budget") if (v := getattr(args, k)) is not None}
    if args.out is not None:
        output.claim(args.out, args.force)
    hidden = args.no_progress or args.json or not sys.stderr.isatty()
    console = Console(stderr=True, quiet=hidden)
    with console.status("compiling") as status:
        tuned = tune(
            model,
            tuning.parameters,
            tuning.requirements,
            bounds=tuning.bounds,
            on=Resources(progress=lambda done: status.update(str(done))),
            **options,
        )
    if args.out is not None:
        notes = "\n\n".join(text for text in (tuned.model.document.notes, tuned.note) if text)
        tuned.model.describe(notes=notes)
        save(tuned.model, args.out, args.force)
    fields = tuned.data() | {"document": str(args.out) if args.out is not None else None}
    written = [] if args.out is None else [f"\nDocument: {args.out}"]
    return CommandAnswer(fields, [_table(tuned), *written], 0 if tuned.met else 1)


def _table(tuned: Tuned) -> str:
    """Return what was found in plain words."""
    strength, n = tuned.about["strength"], tuned.candidates
    state = "meets all requirements" if tuned.met else "does not meet all requirements"
    lines = [
        f"{tuned.field} {state}" + (", interrupted" if tuned.interrupted else ""),
        f"Measured alone, without noise, with inputs of {strength:g}; {n} candidates.",
        "",
    ]
    for name, margin in tuned.margins.items():
        reached = f"   at {tuned.reached[name]:.6g}" if name in tuned.reached else ""
        reached += " (exact)" if name in tuned.exact else ""
        lines.append(f"  {'met    ' if margin >= 0 else 'NOT MET'}  {margin:6.2f}  {name}{reached}")
    lines += ["", f"  {'parameter':32} {'before':>10} {'found':>10}   may move alone by"]
    for path, after in tuned.values.items():
        down, up = tuned.tolerated_alone.get(path, (0.0, 0.0))
        alone = f"   -{down:.1%} to +{up:.1%}" if tuned.size else ""
        lines.append(f"  {path:32} {tuned.before[path]:10.5g} {after:10.5g}{alone}")
    if tuned.size:
        lines.append(f"\nAll at once may move by {tuned.tolerated:.1%} ({tuned.size.points} random points).")
    lines += [f"\n{sentence[0].upper()}{sentence[1:]}." for sentence in tuned.reasons]
    return "\n".join(lines)
