"""The commands `deodar run FILE` and `deodar run RECORD`."""

from __future__ import annotations

import argparse
import contextlib
import sys
import warnings
from collections.abc import Callable, Generator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deodar import codec
from deodar.cli import _live, _long, _options, _rescue
from deodar.codec import Json
from deodar.errors import Interrupted, OutputError, OutputExists, RecordError, RunWarning
from deodar.importers import examples

if TYPE_CHECKING:
    import xarray

    from deodar.batch.points import Sweep
    from deodar.model.document import Document
    from deodar.model.model import Model
    from deodar.recording.repeat import Difference, Repetition
    from deodar.worlds._base import World

HELP = "run a model and record it, or run a record again and compare"
EPILOG = """\
FILE is a document (.json). RECORD is a record (.zarr, .nc) or a folder that an earlier run wrote: it is
run again as it was, and compared. Both write a new folder with the record and the model that made it. Look
at it with: deodar plot FOLDER"""

OF_A_RECORD = (
    "duration",
    "dt",
    "seed",
    "record",
    "every",
    "trials",
    "sweep",
    "points",
    "own_noise",
    "set",
    "precision",
    "workers",
    "devices",
    "hosts",
    "cluster",
    "accuracy",
    "snapshots",
)
"""Options whose values a record contains."""

WARNINGS = 3
"""Most warnings of the check that are printed before a run."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    parser.add_argument(
        "file",
        type=_options.document,
        metavar="FILE|RECORD",
        help="a document (.json, .deodar) or example:NAME to run, or a record to run again",
    )
    parser.add_argument(
        "--duration",
        type=float,
        metavar="D",
        help="how long, in the document's time unit (needed for a document; of an example as its notes say)",
    )
    parser.add_argument("--dt", type=float, help="Euler step (default: the document's own, else 1)")
    parser.add_argument(
        "--record",
        nargs="+",
        action="extend",
        metavar="PATH",
        help="ports to record, for example u.activation (default: every field, at the end)",
    )
    parser.add_argument("--every", type=float, metavar="T", help="time between records (default: every step)")
    parser.add_argument(
        "--trials", type=_options.whole, metavar="N", help="number of trials; they differ in their noise"
    )
    parser.add_argument(
        "--workers",
        type=_options.whole,
        metavar="N",
        help="share trials and sweep points among N processes of one core each",
    )
    _options.add_devices(parser)
    _options.add_hosts(parser)
    _options.add_cluster(parser, "pieces of a large batch")
    parser.add_argument(
        "--sweep",
        type=_options.values,
        action="append",
        metavar="PATH=V1,V2,...",
        help="run at each value; several make a grid",
    )
    parser.add_argument(
        "--points",
        type=Path,
        metavar="FILE",
        help="run at each point of a list: .csv (a line of paths, then one of numbers each) or .json",
    )
    parser.add_argument(
        "--own-noise",
        action="store_true",
        default=None,
        help="with --points: each point has noise of its own",
    )
    _options.add_set(parser)
    parser.add_argument(
        "--format", choices=("zarr", "netcdf", "csv"), default="zarr", help="of the record (default zarr)"
    )
    parser.add_argument(
        "--resume",
        action="store_true",
        help=(
            "continue a RECORD that was killed or stopped, with --cluster on a cluster; with --duration make"
            " a complete one longer"
        ),
    )
    parser.add_argument(
        "--snapshots",
        type=float,
        metavar="T",
        help="time between two stored states for --resume (default: about every 30 s of wall time)",
    )
    parser.add_argument(
        "--out",
        "-o",
        type=Path,
        metavar="DIR",
        help="folder to write (default: NAME-001, NAME-002, ... here)",
    )
    _options.add_run(parser)
    _long.add_yes(parser)
    _options.add_world(parser)
    _live.add(parser)
    _options.add_force(parser)
    _options.add_json(parser)
    _options.wrong(parser)


def run(args: argparse.Namespace) -> int:
    """Run a document, or repeat a record; status 1 if stopped, or if a repetition differs without a
    reason.
    """
    # start-up time: these bring JAX
    from deodar.importers.opening import require

    if args.file.suffix.lower() not in (".zarr", ".nc"):
        require(args.file)
    if args.duration is None and examples.holds(args.file):
        args.duration = examples.duration(args.file.stem)
    if not _is_record(args.file):
        _options.use_rounding(args.separate_rounding)
        _options.use_cores(args.cores)
    if args.hosts is not None and (args.live or args.cost):
        args.wrong("--live and --cost run on one host")
    if args.live or args.cost:
        return _live.run(args)
    _live.refuse_alone(args)
    if args.resume:
        return _resume(args)
    if _is_record(args.file):
        return _repeat(args)
    _options.join_hosts(args)
    # start-up time: this brings JAX
    from deodar.compiler import hosts

    with hosts.together(args.hosts is not None):
        return _simulate(args)


def _is_record(path: Path) -> bool:
    # start-up time: these bring JAX
    from deodar.recording import files

    if path.suffix.lower() == ".json" and not path.is_dir():
        return False
    return (
        path.is_dir()
        or not path.exists()
        or path.suffix.lower() in files.SUFFIXES.values()
        or files.is_record(path)
    )


def _simulate(args: argparse.Namespace) -> int:
    # start-up time: these bring JAX
    from deodar.batch import points_file
    from deodar.batch.simulate import simulate
    from deodar.compiler import hosts
    from deodar.importers.opening import load

    if args.duration is None and args.file.is_file():
        args.wrong("a document needs --duration, for example --duration 500")
    _once(args, "set")
    _once(args, "sweep")
    model = load(args.file, trust=args.trust)
    _options.apply_set(model, args)
    world = _options.world(args.world)
    if world is not None and world.wall_clock:
        args.wrong(f"the world {args.world} follows the wall clock, so the run needs --live")
    if hosts.first():
        _show_warnings(model, args.file, world)
    sweep: Sweep | None = dict(args.sweep) if args.sweep else None
    if args.points is not None:
        if sweep is not None:
            args.wrong("--points is a list and --sweep a grid; give one of them")
        sweep = points_file.read(args.points)
    cluster = _options.cluster(args)
    place = _Place(args, model.name) if hosts.first() else None
    step = model.document.step if args.dt is None else args.dt

    def simulated(duration: float, progress: bool | None = False, **into: Any) -> xarray.Dataset:
        return simulate(
            model,
            duration,
            dt=args.dt,
            seed=args.seed or 0,
            record=args.record,
            every=args.every,
            trials=args.trials,
            sweep=sweep,
            own_noise=bool(args.own_noise),
            precision=args.precision or "float32",
            world=world,
            progress=progress,
            workers=args.workers,
            cluster=cluster,
            device=args.device,
            devices=args.devices,
            accuracy=args.accuracy or "default",
            **into,
        )

    data, stopped, out = None, "", Path() if place is None else place.folder()
    progress = False if args.no_progress or args.json or place is None else None
    try:
        with _said_here():
            if hosts.count() == 1:  # several have no terminal
                _confirm(args, args.duration, step, simulated)
            data = simulated(
                args.duration or 0.0, progress, out=out, snapshots=args.snapshots, force=args.force
            )
    except Interrupted as error:
        data, stopped = error.data, str(error)
    if place is None:  # the first host writes, and says so
        return 1 if stopped else 0
    return _finish(args, _Written(out, place), data, model.document, stopped, None)


def _resume(args: argparse.Namespace) -> int:
    # start-up time: these bring JAX
    from deodar.batch.resume import resume
    from deodar.recording import files, provenance
    from deodar.recording.record import about

    free = ("duration", "cluster")
    given = [_flag(name) for name in OF_A_RECORD if name not in free and getattr(args, name) is not None] + [
        f"--{name}" for name in ("out", "force") if getattr(args, name)
    ]
    if given:
        args.wrong(f"a run is resumed as it began, in its folder, so {', '.join(given)} cannot be given")
    old = files.open_record(args.file)
    made, doc = about(old), provenance.document(about(old))
    old.close()
    _options.use_rounding(args.separate_rounding or provenance.rounds_separately(made))
    _options.use_cores(args.cores, provenance.cores_of(made))
    stopped = ""
    try:
        with _said_here():
            data = resume(
                args.file,
                args.duration,
                _options.world(args.world),
                args.trust,
                False if args.no_progress or args.json else None,
                lambda found: _accepts(args, found),
                _options.cluster(args),
            )
    except Interrupted as error:
        data, stopped = error.data, str(error)
    return _finish(args, _Written(args.file, None), data, doc, stopped, None)


def _flag(name: str) -> str:
    """Return the option as it is typed."""
    return f"--{name.replace('_', '-')}"


def _accepts(args: argparse.Namespace, found: Sequence[Difference]) -> bool:
    """Say what differs from the machine of the record, and ask whether to continue."""
    listed = "; ".join(map(str, found))
    print(f"deodar run: the rest of the run will not have the same bits: {listed}", file=sys.stderr)
    if args.yes or not sys.stdin.isatty() or not sys.stderr.isatty():
        return bool(args.yes)
    print("Continue? [y/N] ", end="", file=sys.stderr, flush=True)
    return sys.stdin.readline().strip().lower() in ("y", "yes")


def _confirm(
    args: argparse.Namespace, duration: float | None, dt: float, run: Callable[[float], object]
) -> None:
    """Ask for confirmation of a long run; `run` simulates a part of it to measure its speed."""
    # start-up time: these bring JAX
    from deodar.batch.simulate import expected_steps

    steps = expected_steps(duration or 0.0, dt)
    _long.confirm(
        args,
        "run",
        steps,
        f"{steps:.3g} steps of dt = {dt:g}",
        lambda: steps * _long.seconds_a_step(lambda n: run(n * dt)),
    )


def _show_warnings(model: Model, file: Path, world: World | None) -> None:
    """Print the first warnings of the check and of the world on stderr; they do not prevent the run."""
    # start-up time: this brings JAX
    from deodar.session import agreement

    found = [p for p in (*agreement.judge(model.document, world), *model.check()) if p.severity == "warning"]
    for warning in found[:WARNINGS]:
        print(f"deodar run: warning: {warning}", file=sys.stderr)
    if len(found) > WARNINGS:
        print(
            f"deodar run: warning: {len(found) - WARNINGS} more; type: deodar check {_options.shown(file)}",
            file=sys.stderr,
        )


def _repeat(args: argparse.Namespace) -> int:
    # start-up time: these bring JAX
    from deodar.batch.simulate import simulate
    from deodar.recording import files, provenance
    from deodar.recording.record import about
    from deodar.recording.repeat import compare, repeat

    given = [_flag(name) for name in OF_A_RECORD if getattr(args, name) is not None]
    if given:
        args.wrong(
            f"a record is run again as it was, so {', '.join(given)} cannot be given; run its model.json"
            " instead"
        )
    old = files.load_record(args.file)
    made = about(old)
    _options.use_rounding(args.separate_rounding or provenance.rounds_separately(made))
    _options.use_cores(args.cores, provenance.cores_of(made))
    place = _Place(args, str(old.attrs.get("title") or "record"))
    stopped = ""

    def simulated(model: Model, duration: float, **settings: Any) -> xarray.Dataset:
        quiet: dict[str, Any] = {**settings, "progress": False}
        _confirm(args, duration, settings["dt"], lambda time: simulate(model, time, **quiet))
        return simulate(model, duration, **settings)

    try:
        with _said_here():
            done = repeat(
                old,
                simulated,
                _options.world(args.world),
                args.trust,
                False if args.no_progress or args.json else None,
                args.device,
            )
    except Interrupted as error:
        done, stopped = compare(old, error.data), str(error)
    return _finish(args, place, done.data, provenance.document(about(old)), stopped, done)


@contextlib.contextmanager
def _said_here() -> Generator[None]:
    """Suppress the warnings of `simulate`, which the command line prints itself."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RunWarning)
        yield


class _Place:
    """The output of a run: its path is checked before the run and printed after it."""

    def __init__(self, args: argparse.Namespace, name: str) -> None:
        # start-up time: these bring JAX
        from deodar.recording import folder, places

        self.given: Path | None = args.out
        self.name = name
        self.format: str = args.format
        self.force: bool = args.force
        if self.given is not None and folder.growing(self.given) == self.given:
            if self.format != "zarr":
                args.wrong(f"--out names a .zarr, so --format {self.format} cannot be given")
            folder.claim_growing(self.given, self.force)
        else:
            folder.claim(self.given or places.free(Path(), name), self.format, self.force)

    def folder(self) -> Path:
        """Return the folder of the run."""
        # start-up time: this brings JAX
        from deodar.recording import places

        return self.given or places.free(Path(), self.name)

    def write(self, data: xarray.Dataset, doc: Document, ask: bool) -> tuple[Path, Path, str]:
        """Write the run, or to another folder on failure; return the folder, the record in it, and the reason
        if it is another folder.
        """
        # start-up time: these bring JAX
        from deodar.recording import folder, places

        out = self.given or places.free(Path(), self.name)
        try:
            return out, folder.write(data, doc, out, self.format, self.force), ""
        except (OutputError, OutputExists, RecordError) as error:
            # the disk has space, but not enough for this record
            format, first = (self.format, []) if isinstance(error, OutputError) else ("zarr", [out.parent])
            second = _rescue.rescue(
                error, lambda parent: self._elsewhere(data, doc, parent, format), first, ask
            )
            return *second, str(error)

    def _elsewhere(self, data: xarray.Dataset, doc: Document, parent: Path, format: str) -> tuple[Path, Path]:
        # start-up time: these bring JAX
        from deodar.recording import folder, places

        out = places.free(parent, self.given.name if self.given is not None else self.name)
        return out, folder.write(data, doc, out, format)


class _Written:
    """The output of a run that was written during the run."""

    def __init__(self, path: Path, place: _Place | None) -> None:
        self.path, self.place = path, place
        self.given, self.name = path, path.name

    def write(self, data: xarray.Dataset, doc: Document, ask: bool) -> tuple[Path, Path, str]:
        """Convert the record to the requested format, if that is another one."""
        # start-up time: these bring JAX
        from deodar.recording import files, folder

        record = files.locate(self.path)[0]
        if self.place is None or self.place.format == "zarr":
            return self.path, record, ""
        try:
            return self.path, folder.convert(self.path, self.place.format), ""
        except (OutputError, RecordError) as error:
            return self.path, record, str(error)


def _finish(
    args: argparse.Namespace,
    place: _Place | _Written,
    data: xarray.Dataset | None,
    doc: Document,
    stopped: str,
    done: Repetition | None,
) -> int:
    # start-up time: these bring JAX
    from deodar.recording.files import SUFFIXES

    if stopped and (data is None or not _samples(data)):
        print(
            "deodar run:"
            f" {_options.paragraph([stopped, 'Nothing had been recorded, so nothing was written'])}",
            file=sys.stderr,
        )
        return 1
    assert data is not None
    out, record, failed = place.write(data, doc, not args.json)
    args.format = next(k for k, suffix in SUFFIXES.items() if suffix == record.suffix)
    good = not stopped and (done is None or done.faithful)
    if "diverged" in data.attrs:
        print(f"deodar run: warning: {data.attrs['diverged']}", file=sys.stderr)
    if args.json:
        elsewhere = {"instead_of": str(place.given) if place.given else place.name} if failed else {}
        print(codec.text({**_answer(out, record, data, stopped, done), **elsewhere}))
    wrote = f"Wrote {_contents(data)} to {_options.shown(out)}"
    look = (
        f"Look at it with: deodar plot {_options.shown(out)}"
        if args.format != "csv"
        else f"The table is {_options.shown(record)}"
    )
    if stopped:
        print(
            f"deodar run: {_options.paragraph([stopped, f'{wrote}, marked as incomplete', look])}",
            file=sys.stderr,
        )
        return 1
    if failed:
        instead = f"{wrote} as {record.name} instead" if isinstance(place, _Written) else f"{wrote} instead"
        print(f"deodar run: {_options.paragraph([failed, instead, look])}", file=sys.stderr)
        return 1
    if done is not None and (done.differences or not done.same_bits):
        print(
            f"deodar run: {_options.paragraph([('warning: ' if done.faithful else '') + str(done)])}",
            file=sys.stderr,
        )
    if not args.json:
        if done is not None and done.same_bits and not done.differences:
            print(_options.paragraph([str(done)]))
        print(
            _options.paragraph([wrote, look]).rstrip(".")
            if look.startswith("Look")
            else _options.paragraph([wrote, look])
        )
    return 0 if good else 1


def _samples(data: xarray.Dataset) -> int:
    """Return the number of times of the variable with most of them."""
    # start-up time: this brings xarray
    from deodar.recording import probe

    return max((n for d, n in data.sizes.items() if probe.is_time(str(d))), default=0)


def _contents(data: xarray.Dataset) -> str:
    names = list(map(str, data.data_vars))
    shown = ", ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")
    times = _samples(data)
    lead = [
        f"{data.sizes['trial']} trials" if "trial" in data.sizes else "",
        f"{times} times" if times != 1 else "one time",
    ]
    return f"{shown} ({', '.join(t for t in lead if t)})"


def _answer(
    out: Path, record: Path, data: xarray.Dataset, stopped: str, done: Repetition | None
) -> dict[str, Json]:
    answer: dict[str, Json] = {
        "out": str(out),
        "record": str(record),
        "variables": {
            str(n): dict(zip(map(str, v.dims), v.shape, strict=True)) for n, v in data.data_vars.items()
        },
        "complete": not stopped,
    }
    if (out / "model.json").is_file():
        answer["model"] = str(out / "model.json")
    if done is not None:
        answer["repetition"] = {
            "same_bits": done.same_bits,
            "differences": [{"what": d.what, "then": d.then, "now": d.now} for d in done.differences],
            "largest": {k: v if v < float("inf") else None for k, v in done.largest.items()},
            "compared": done.compared,
        }
    return answer


def _once(args: argparse.Namespace, name: str) -> None:
    paths = [path for path, _ in getattr(args, name) or ()]
    twice = next((p for p in paths if paths.count(p) > 1), None)
    if twice is not None:
        args.wrong(f"--{name} names {twice} twice")
