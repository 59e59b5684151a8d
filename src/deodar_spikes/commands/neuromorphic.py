"""The command `deodar neuromorphic compare FILE` and `deodar neuromorphic chips`."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from deodar.cli import _options
from deodar.cli._answer import CommandAnswer
from deodar.model import output
from deodar_spikes import options

if TYPE_CHECKING:
    from deodar_spikes.comparison import Estimate, SpikingComparison

HELP = "run a model as a network of spiking neurons, and compare it with its rates"
EPILOG = """\
compare runs the model as rates, as spikes in deodar's simulator, and in norse where that is installed, in the
same measures. chips lists the limits of chips. The file of a network: deodar export nir MODEL."""

ROWS = {
    "winner": ("same winner as the rate model", "share"),
    "peaks": ("peaks", ""),
    "detection": ("detection after", "time"),
    "forgetting": ("forgetting after", "time"),
    "memory": ("peak without input at the end", "share"),
    "drift": ("drift of the peak", "axis"),
    "difference": ("rms difference from the mean rate", "share"),
}
"""Measures: their names in the table, and what they are."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    parser.add_argument("what", choices=("compare", "chips"), help="what to do")
    _options.add_document(
        parser, "of compare: a document (.json, .deodar), or example:NAME", nargs="?", default=None
    )
    parser.option("--trials", "N", "default 100", _options.whole, default=100)
    parser.option("--duration", "T", "document time (default: 1000 ms)", _options.positive)
    options.add(parser)
    parser.option("--seed", "N", "seed of noise and mismatch (default 0)", _options.whole)
    parser.option("--norse", "PYTHON", "Python of an environment with norse (default: this one)")
    parser.flag("--no-norse", "run without norse")
    _options.add_world(parser)
    parser.option("-o --out", "FIGURE", "draw rates beside spikes, of the first trial", Path)
    _options.add_force(parser)
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Compare, or list chips."""
    if args.what == "chips":
        return _chips()
    # start-up time: these bring JAX
    from deodar.figures import _files
    from deodar.importers.opening import load
    from deodar_spikes.comparison import compare_spikes
    from deodar_spikes.figure import spikes_figure

    file: Path | None = args.file
    if file is None:
        return args.wrong("the model is missing: deodar neuromorphic compare FILE")
    if args.out is not None:
        output.claim(args.out, args.force)
    model = load(file, trust=args.trust)
    doc = model.document
    duration = args.duration or 1.0 / _seconds(doc.time_unit)
    norse = False if args.no_norse else args.norse or True
    comparison = compare_spikes(
        model, duration, args.trials, options.read(args), _options.world(args.world), norse
    )
    if args.out is not None:
        first = {run: {k: v[:, 0] for k, v in r.items()} for run, r in comparison.runs.items()}
        figure = spikes_figure(first, comparison.times, doc.time_unit)
        _files.save_figure(figure, args.out, force=args.force)
    numbers = {**comparison.data(), "out": None if args.out is None else str(args.out)}
    return CommandAnswer(numbers, _lines(comparison, doc.time_unit, args))


def _seconds(unit: str) -> float:
    # start-up time: this brings the model
    from deodar.model.unit import unit_seconds

    return unit_seconds(unit)


def _lines(comparison: SpikingComparison, unit: str, args: argparse.Namespace) -> list[str]:
    """Return a table for each element."""
    network = comparison.prepared.translated.network
    lines = [
        f"{network.neurons:,} neurons, {network.synapses:,} synapses, steps of {network.step * 1e3:g} ms,"
        f" {comparison.prepared.limits.name}; {args.trials} trials"
    ]
    lines += [f"  {line}" for line in comparison.prepared.report.losses if line.verdict == "dropped"]
    for label, runs in comparison.estimates.items():
        lines += ["", f"{label:36}" + "".join(f"{run:>30}" for run in runs)]
        for name, (title, kind) in ROWS.items():
            cells = [_cell(runs[r][name], kind, unit) for r in runs]
            if any(cells):
                lines.append(f"  {title:34}" + "".join(f"{c or 'none':>30}" for c in cells))
    if not comparison.norse and not args.no_norse:
        lines += ["", "norse is not installed here: --norse PYTHON names an environment that has it."]
    if args.out is not None:
        lines += ["", f"Drawn: {_options.shown(args.out)}"]
    return lines


def _cell(e: Estimate, kind: str, unit: str) -> str:
    """Return a value and its interval, "" if no trial has one."""
    if not e.n:
        return ""
    scale, after = (100, " %") if kind == "share" else (1, f" {unit}" if kind == "time" else "")
    spread = (
        f" ({scale * e.interval[0]:.3g} to {scale * e.interval[1]:.3g})" if e.interval is not None else ""
    )
    return f"{scale * e.value:.3g}{after}{spread}"


def _chips() -> CommandAnswer:
    """List the chips and their limits."""
    # start-up time: this brings NumPy
    from deodar_spikes.chip_limits import chip_limits, chip_names

    chips = [chip_limits(name) for name in chip_names()]
    lines: list[str] = []
    for c in chips:
        lines.append(f"{c.name}: {c.meaning}")
        for name, source in c.sources.items():
            limit = getattr(c, name)
            shown = ", ".join(f"{k} {v:g}" for k, v in limit.items()) if isinstance(limit, Mapping) else limit
            lines.append(f"  {name:24}{shown!s:28}{source}")
    return CommandAnswer({"chips": [{k: _plain(v) for k, v in vars(c).items()} for c in chips]}, lines)


def _plain(value: object) -> object:
    return dict(value) if isinstance(value, Mapping) else value
