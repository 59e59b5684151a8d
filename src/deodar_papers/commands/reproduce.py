"""The command `deodar reproduce PAPER`."""

from __future__ import annotations

import argparse
import contextlib
import shutil
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from deodar import codec
from deodar.batch.on_cluster import ClusterPool
from deodar.cli import _machines, _options, _rescue
from deodar.cli._answer import CommandAnswer
from deodar.codec import Json
from deodar.errors import OutputError, UnknownName, WorkerError, did_you_mean
from deodar.experiments.jobs import run_jobs
from deodar.experiments.rows import Rows, claim
from deodar.model import output
from deodar.progress import lasting
from deodar.recording import places, writer_lock
from deodar.resources import Resources
from deodar_papers import papers

if TYPE_CHECKING:
    from deodar.cluster import Cluster
    from deodar.experiments.jobs import Job
    from deodar.experiments.rows import Rows
    from deodar_papers._report import Report

HELP = "run the experiments of a paper again, and check its claims"
EPILOG = """\
Results are written after each run: Ctrl-C or a power failure loses none. The same call with --out FOLDER
resumes, with the same results as without the stop. A folder that has only some of the conditions is extended
by the others."""

ROWS = "runs.jsonl"
RESULTS = "results.json"


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    parser.option("paper", "PAPER", f"which one: {', '.join(papers.PAPERS)}")
    parser.flag(
        "--quick",
        "a part of the runs, at most 20 of each condition; a claim is false only where they exclude it",
    )
    parser.option(
        "--only",
        "CONDITION",
        "only conditions whose names begin with this, for example z/carrot",
        nargs="+",
        default=[],
    )
    parser.option(
        "--out -o", "DIR", "folder to write, or to resume (default: PAPER-001, PAPER-002, ... here)", Path
    )
    parser.option("--workers", "N", "share the runs among N processes of one core each", _options.whole)
    _machines.add_cluster(parser, "runs")
    _options.add_json(parser)
    parser.flag("--no-progress", "show no progress bar")


def run(args: argparse.Namespace) -> CommandAnswer | int:
    """Reproduce a paper; status 1 if a required claim is false, or if the runs were stopped."""
    # start-up time: these bring JAX
    from deodar.compiler.device import find
    from deodar.recording.provenance import made_by

    _options.use_cores(None)  # one core, as in workers: the number of cores changes the last digits
    paper = papers.PAPERS[args.paper]
    jobs = _chosen(args, paper.jobs(args.quick))
    out: Path = args.out or places.free(Path.cwd(), args.paper)
    cluster = _machines.cluster(args)
    claim(out, ROWS, "a reproduction")
    with writer_lock.locked(out), _workers(cluster) as pool:
        made = made_by(find()) if pool is None else pool.made_by
        rows = Rows(out / ROWS, {**paper.about(args.quick), "made_by": dict(made)}, paper.BY_CONDITION)
        began, before = time.perf_counter(), len(rows.found)
        if not _ran(args, out, jobs, rows, pool):
            return 1
    settings = {
        "paper": args.paper,
        "quick": args.quick,
        "runs": len(rows.found),
        "of": sum(len(j.keys) for j in paper.jobs(args.quick)),
    }
    took = f"{len(rows.found) - before} of them in {lasting(time.perf_counter() - began)} by this call"
    return _write(args, out, paper.report(rows.found, args.quick), settings, took)


def _workers(cluster: Cluster | None) -> contextlib.AbstractContextManager[ClusterPool | None]:
    return contextlib.nullcontext() if cluster is None else ClusterPool(cluster)


def _ran(
    args: argparse.Namespace, out: Path, jobs: Sequence[Job], rows: Rows, pool: ClusterPool | None
) -> bool:
    """Run the jobs, and return whether they came to their end; otherwise say how to resume them."""
    try:
        on = Resources(workers=args.workers or None, progress=_options.progress(args))
        run_jobs(jobs, rows, on, pool)
    except KeyboardInterrupt:
        print(
            f"deodar reproduce: stopped; {len(rows.found)} runs are kept. Resume with: {_again(args, out)}",
            file=sys.stderr,
        )
        return False
    except (OutputError, WorkerError) as error:
        why = _options.paragraph([error.at("shell"), f"{len(rows.found)} runs are kept"])
        print(f"deodar reproduce: {why} Resume with: {_again(args, out)}", file=sys.stderr)
        return False
    return True


def _again(args: argparse.Namespace, out: Path) -> str:
    """Return the call that resumes this one."""
    again = " ".join(
        ["deodar reproduce", args.paper, *(["--quick"] if args.quick else []), "--out", _options.shown(out)]
    )
    again = " ".join([again, *_machines.cluster_again(args)])
    return again + (f" --only {' '.join(args.only)}" if args.only else "")


def _chosen(args: argparse.Namespace, jobs: Sequence[Job]) -> list[Job]:
    """Return the jobs of the conditions in `--only`, or all jobs without it."""
    conditions = sorted({key.rpartition("/")[0] for job in jobs for key in job.keys})
    for name in args.only:
        if not any(c.startswith(name) for c in conditions):
            raise UnknownName(f"no condition begins with {name!r}", fix=did_you_mean(name, conditions))
    return [job for job in jobs if not args.only or job.keys[0].startswith(tuple(args.only))]


def _write(
    args: argparse.Namespace, asked: Path, report: Report, settings: Mapping[str, Json], took: str
) -> CommandAnswer:
    """Write report and figures, and return the claims; `took` says how many runs this call computed, and in
    what time.
    """
    # start-up time: these bring JAX
    from deodar.analysis.claims import failed, results
    from deodar.figures import _files

    text = results(report.claims, settings)

    def fill(folder: Path) -> None:
        for name, figure in report.figures.items():
            _files.save_figure(figure, folder / f"{name}.png", force=True)
        for name, table in report.tables.items():
            output.write(folder / f"{name}.md", table.encode())
        output.write(folder / RESULTS, text.encode())

    def fill_second(folder: Path) -> None:
        shutil.copyfile(asked / ROWS, folder / ROWS)
        fill(folder)

    out, why = asked, ""
    try:
        fill(asked)
    except OutputError as error:
        out, why = _rescue.elsewhere(error, asked, fill_second, not args.json), error.at("shell")
    lines: list[str] = []
    for c in report.claims:
        mark = "?" if c.holds is None else "yes" if c.holds else "NO"
        interval = "" if c.interval is None else f", 95 % interval {c.interval[0]:g} to {c.interval[1]:g}"
        wanted = "no target" if c.origin == "none" else f"wanted {c.target}, {c.origin}"
        inferred = f"; no evidence, it assumes {c.assumes}" if c.inferred else ""
        reached = "nothing yet" if c.value is None else c.value
        lines.append(f"  {mark:4}{c.name} -> {reached} ({wanted}; n {c.n}{interval}{inferred})")
    names = [ROWS, RESULTS, *(f"{n}.md" for n in report.tables), *(f"{n}.png" for n in report.figures)]
    required = [c for c in report.claims if c.kind == "required"]
    held, open_ = sum(c.holds is True for c in required), sum(c.holds is None for c in required)
    lines += [
        f"Written to {_options.shown(out)}: {', '.join(names)}.",
        f"{settings['runs']} of {settings['of']} runs, {took}. Of {len(required)} required claims {held}"
        f" hold, {open_} are undecided.",
    ]
    if why:
        sentences = [why, f"The report and a copy of the runs are written to {_options.shown(out)} instead"]
        print(
            f"deodar reproduce: {_options.paragraph(sentences)} With room there, write it with:"
            f" {_again(args, asked)}",
            file=sys.stderr,
        )
    stated = {"out": str(out), **codec.parse(text), **({"instead_of": str(asked)} if why else {})}
    return CommandAnswer(stated, lines, 1 if why or failed(report.claims) else 0)
