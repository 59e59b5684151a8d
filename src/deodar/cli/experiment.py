"""The command `deodar experiment FILE`."""

from __future__ import annotations

import argparse
import contextlib
import dataclasses as dc
import shlex
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar import codec
from deodar.cli import _long, _machines, _options, _package, _work_plan
from deodar.cli._answer import INTERRUPTED, CommandAnswer
from deodar.credentials import masked
from deodar.errors import OutputError, WorkerError
from deodar.recording import places

if TYPE_CHECKING:
    import xarray

    from deodar.experiments.experiment import Experiment
    from deodar.experiments.following import Standing
    from deodar.experiments.repeated_results import RepeatedResults

HELP = "run the trials of an experiment, and write a table with a row for each"
EPILOG = """\
Rows are written as trials end: Ctrl-C or a power failure loses none. The same call with --out FOLDER
resumes, with the same results as without the stop."""

MOST_CELLS = 24
"""Most combinations of levels that are listed; the table contains all of them."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    parser.option(
        "file",
        "FILE|FOLDER|merge",
        "an experiment (.json), which names its model; the folder of results: run it again and compare;"
        " a package of either; merge: write the rows of folders into --out",
        Path,
    )
    parser.option("folders", "FOLDER", "with merge: the folders", Path, nargs="*")
    parser.option(
        "--trials",
        "N|A:B",
        "trials of each combination of levels, instead of the file's; A:B: only the trials A to B - 1",
        trials,
    )
    parser.option(
        "--follow",
        "FOLDER",
        "print how far another process has come that writes this folder, until it ends",
        Path,
    )
    parser.option(
        "--seed", "N", "seed of all noise and of what is drawn, instead of the file's", _options.whole
    )
    parser.option(
        "--out -o", "DIR", "folder to write, or to resume (default: NAME-001, NAME-002, ... here)", Path
    )
    parser.option("--workers", "N", "share the trials among N processes of one core each", _options.whole)
    parser.option(
        "--records",
        "STORE",
        "write the records of trials into a folder, or to an address such as s3://BUCKET/NAME (extra"
        " store), with one object for each batch; all workers must reach it",
    )
    _machines.add_cluster(parser, "trials", mixed=True)
    _long.add_yes(parser)
    _options.add_world(parser)
    parser.flag("--check", "only check whether it can be run, and in which batches")
    parser.flag(
        "--plan", "only measure the beginning of a batch, and print memory and time for numbers of workers"
    )
    _options.add_json(parser)
    parser.flag("--no-progress", "show no progress bar")


def run(args: argparse.Namespace) -> CommandAnswer | int:
    """Run an experiment; status 1 if it was stopped, if all trials diverged, or if the repetition of results
    has other rows without a reason.
    """
    if args.file == Path("merge"):
        _options.use_cores(None)
        return _merge(args)
    if args.folders:
        args.wrong(f"only merge takes folders, and this is {args.file}")
    args.typed = args.file
    with _package.opened(args.file, args.trust) as args.file:
        return _run(args)


def _run(args: argparse.Namespace) -> CommandAnswer | int:
    # start-up time: these bring JAX
    from deodar.experiments.repeated_results import compare_results
    from deodar.experiments.results import ROWS, run_trials, stored
    from deodar.recording import provenance
    from deodar.resources import Resources

    before: Path | None = args.file if (args.file / ROWS).is_file() else None
    # one core, as in workers: the number of cores changes the last digits
    _options.use_cores(None, 1 if before is None else provenance.cores_of(stored(before)[0]))
    part = args.trials if isinstance(args.trials, tuple) else None
    experiment = _experiment(args, before, part)
    if args.follow is not None:
        return _follow(args, len(experiment.cells) if part is None else part[1] - part[0])
    cluster = _machines.cluster(args)
    setup = experiment.setup(args.trust)
    setup.store = args.records or ""
    if args.check:
        return _check(args, setup)
    if args.plan:
        return _work_plan.answer(setup)
    out: Path = args.out or places.free(Path.cwd(), experiment.name)
    _confirm(args, setup, out)
    try:
        on = Resources(workers=args.workers or None, cluster=cluster, progress=_options.progress(args))
        results = run_trials(setup, out, on, part)
    except (KeyboardInterrupt, OutputError, WorkerError) as stop:
        if not (out / ROWS).is_file():
            raise
        interrupted = isinstance(stop, KeyboardInterrupt)
        _tell_stop(args, out, part, "stopped" if interrupted else f"{stop}")
        return INTERRUPTED if interrupted else 1
    return _answer(args, out, results, None if before is None else compare_results(before, out))


def _experiment(args: argparse.Namespace, before: Path | None, part: tuple[int, int] | None) -> Experiment:
    """Return the experiment of a file, or of the folder of results, with the settings of the call."""
    # start-up time: these bring JAX
    from deodar.experiments.experiment import Experiment
    from deodar.experiments.results import EXPERIMENT
    from deodar.importers.opening import load

    stated = Experiment.load(args.file if before is None else before / EXPERIMENT, load)
    settings: dict[str, Any] = {"model": load(str(stated.model), trust=args.trust)}
    settings |= {
        key: value for key in ("trials", "seed", "world") if (value := getattr(args, key)) is not None
    }
    if part is not None:
        del settings["trials"]
    return dc.replace(stated, **settings)


def _tell_stop(args: argparse.Namespace, out: Path, part: tuple[int, int] | None, why: str) -> None:
    """Print why a run stopped, and the command that resumes it."""
    options = {
        "--trials": args.trials if part is None else f"{part[0]}:{part[1]}",
        "--seed": args.seed,
        "--world": args.world,
        "--workers": args.workers,
        "--records": None if args.records is None else shlex.quote(masked(args.records)),
    }
    command = ["deodar experiment", _options.shown(args.typed), "--out", _options.shown(out)]
    command += [f"{name} {value}" for name, value in options.items() if value is not None]
    command += _machines.cluster_again(args)
    command += [f"--{name}" for name in ("trust", "yes") if getattr(args, name)]
    sentence = _options.paragraph([why, "What is done is kept"])
    print(f"deodar experiment: {sentence} Resume with: {' '.join(command)}", file=sys.stderr)


def trials(text: str) -> int | tuple[int, int]:
    """Parse a number of trials, or a range of them, A:B."""
    first, colon, end = text.partition(":")
    return (_options.whole(first), _options.whole(end)) if colon else _options.whole(text)


trials.__name__ = "number of trials, or range A:B"


def _merge(args: argparse.Namespace) -> CommandAnswer:
    # start-up time: these bring JAX
    from deodar.experiments.merging import merge_results

    out: Path | None = args.out
    if out is None or not args.folders:
        args.wrong("merge needs folders and --out DIR")
    assert out is not None
    merged = merge_results(args.folders, out)
    missing = [f"{a}:{b}" for a, b in merged.gaps]
    count = merged.data.sizes["trial"]
    lines = [f"{count} trials. Written to {_options.shown(out)}."]
    if missing:
        listed = ", ".join(missing[:MOST_CELLS]) + (", ..." if len(missing) > MOST_CELLS else "")
        lines.append(f"Trials without a row, as --trials names them: {listed}")
    return CommandAnswer({"out": str(out), "trials": count, "missing": missing}, lines, 1 if missing else 0)


def _follow(args: argparse.Namespace, of: int) -> int:
    """Print the standing of a run whenever rows arrive; status 1 if it has stopped before its end.

    Where locks do not work, it is followed until Ctrl-C.
    """
    # start-up time: these bring JAX
    from deodar.experiments import following
    from deodar.experiments.following import QUIET_SECONDS, RowsTail, RowsWriter, standing
    from deodar.experiments.results import ROWS, stored
    from deodar.recording import writer_lock

    begun: tuple[float, int] | None = None
    rows_told = -1
    stored(args.follow)  # or the error that it is no such folder
    tail, rows, writer = RowsTail(args.follow / ROWS), list[dict[str, Any]](), RowsWriter(time.monotonic())
    with contextlib.suppress(KeyboardInterrupt):
        while True:
            running = writer_lock.is_written(args.follow)  # before the rows: it may end after them
            rows += tail.new()
            moment = time.monotonic()
            begun = begun or (moment, len(rows))
            runs = writer.runs(running, len(rows) > rows_told >= 0, moment)
            if len(rows) != rows_told:
                _tell_standing(args, standing(rows, of, begun, moment))
            if len(rows) >= of:
                return 0
            if running is False and not runs:
                _say("no process runs it; the call that began it resumes it")
                return 1
            if running is False and rows_told < 0:
                wait = f"rows of another one are awaited for {QUIET_SECONDS:g} s"
                _say(f"no process of this machine runs it; {wait}")
            rows_told = len(rows)
            time.sleep(following.FOLLOW_SECONDS)
    return 0


def _say(message: str) -> None:
    print(f"deodar experiment: {message}", file=sys.stderr, flush=True)


def _tell_standing(args: argparse.Namespace, standing: Standing) -> None:
    if args.json:
        print(codec.line(dc.asdict(standing) | {"share": standing.share}), flush=True)
        return
    time_left = "" if standing.left is None else f", {_long.duration(standing.left)} left"
    text = [f"{standing.rows} of {standing.of} trials ({100 * standing.share:.0f} %){time_left}"]
    text += [f"slowest: {standing.slowest}"] if standing.slowest else []
    text += [f"diverged: {cell}" for cell in standing.diverged]
    print("; ".join(text), flush=True)


def _confirm(args: argparse.Namespace, setup: Any, out: Path) -> None:
    """Ask for confirmation of a long run; trials whose rows are in the folder do not count."""
    # start-up time: these bring JAX
    from deodar.batch.simulate import LONG_STEPS
    from deodar.experiments.results import ROWS, load_results

    if setup.trials * setup.steps < LONG_STEPS:
        return
    remaining = setup.trials - (load_results(out).sizes["trial"] if (out / ROWS).is_file() else 0)
    size = f"{remaining} trials of at most {setup.steps:.3g} steps of dt = {setup.dt:g}"

    def seconds() -> float:
        first = setup.pieces()[0]
        a_step = _long.seconds_a_step(lambda n: setup.shortened(n).rows(first))
        return a_step * setup.steps * remaining / len(first) / min(args.workers or 1, len(setup.pieces()))

    _long.confirm(args, "experiment", remaining * setup.steps, size, seconds)


def _check(args: argparse.Namespace, setup: Any) -> int:
    pieces = [len(piece) for piece in setup.pieces()]
    batches = (
        f"in {len(pieces)} batch{'es' if len(pieces) > 1 else ''} of at most {max(pieces)}"
        if setup.batched
        else "one by one"
    )
    if args.json:
        print(codec.line({"trials": sum(pieces), "batched": setup.batched, "pieces": pieces}))
    else:
        print(f"{setup.experiment.name}: {sum(pieces)} trials, {batches}. Nothing is wrong with it.")
    return 0


def _answer(
    args: argparse.Namespace, out: Path, results: xarray.Dataset, repetition: RepeatedResults | None
) -> CommandAnswer:
    names = sorted(p.name for p in out.iterdir())
    outcomes = {
        str(name): int((results["outcome"] == name).sum())
        for name in sorted(set(results["outcome"].values.tolist()))
    }
    lost = int((results["diverged"] != "").sum()) if "diverged" in results.attrs else 0
    if lost:
        print(f"deodar experiment: warning: {results.attrs['diverged']}", file=sys.stderr)
    count = results.sizes["trial"]
    fields: dict[str, Any] = {"out": str(out), "trials": count, "outcomes": outcomes}
    fields |= {"diverged": lost, "files": names}
    counts = ", ".join(f"{name} {n}" for name, n in outcomes.items())
    none = "their batch begins before this part, and runs with that one"
    lines = [*_cells(results), f"{count} trials: {counts or none}."]
    lines.append(f"Written to {_options.shown(out)}: {', '.join(names)}.")
    if repetition is not None:
        fields["repetition"] = dc.asdict(repetition)
        lines.append(f"{repetition}.")
    if args.records is not None:
        fields["records"] = masked(args.records)
        lines.append(f"Records written to {masked(args.records)}; dd.open_records reads them.")
    faithful = repetition is None or repetition.faithful
    return CommandAnswer(fields, lines, 1 if 0 < lost == count or not faithful else 0)


def _cells(results: xarray.Dataset) -> Iterator[str]:
    """Yield for each combination of levels its outcomes and the median duration of a trial."""
    # start-up time
    import numpy as np

    from deodar.experiments.following import called

    factors = [str(name) for name in results.coords if name != "trial"]
    labels = list(zip(*(results[name].values.tolist() for name in factors), strict=True)) if factors else []
    unit = results["duration"].attrs["units"]
    cells = list(dict.fromkeys(labels))
    for cell in cells[:MOST_CELLS]:
        of = np.asarray([label == cell for label in labels])
        ended = results["outcome"].values[of].tolist()
        shares = ", ".join(
            f"{name} {100 * ended.count(name) / len(ended):.0f} %" for name in sorted(set(ended))
        )
        where = called(dict(zip(factors, cell, strict=True)))
        after = "" if unit in ("abstract", "") or unit.startswith("1 =") else f" {unit}"
        durations = results["duration"].values[of]
        finite = durations[~np.isnan(durations)]
        middle = f"median {np.median(finite):g}{after}" if finite.size else "no duration"
        yield f"  {where}: {len(ended)} trials, {shares}, {middle}"
    if len(cells) > MOST_CELLS:
        yield f"  ... and {len(cells) - MOST_CELLS} more combinations"
