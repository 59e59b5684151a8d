"""The options `deodar run FILE --live` and `deodar run FILE --cost`: a session, paced or measured."""

from __future__ import annotations

import argparse
import contextlib
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from deodar import codec
from deodar.cli import _options
from deodar.cli._answer import INTERRUPTED
from deodar.session.interrupt import interrupted_at_end

if TYPE_CHECKING:
    from deodar.session.recorder import Recorder
    from deodar.session.session import Session

OF_A_BATCH = ("trials", "workers", "sweep", "points", "own_noise", "snapshots")
"""Options that a session does not have."""

OF_A_RECORD = ("record", "every", "out", "force")
"""Options that require a record."""

OF_A_LIVE_RUN = ("speed", "longest_step")


def add(parser: _options.CommandParser) -> None:
    """Add `--live`, `--speed`, `--longest-step` and `--cost`."""
    parser.flag(
        "--live", "pace the run to the wall clock and print how well it kept to it; recorded with --record"
    )
    parser.option(
        "--speed", "S", "with --live: document time over wall time, or max (default 1: real time)", _speed
    )
    parser.option(
        "--longest-step", "DT", "with --live: let the step grow up to this where time is short", float
    )
    parser.flag("--cost", "print what each element costs in a step, measured at the end; writes no record")


def refuse_alone(args: argparse.Namespace) -> None:
    """Refuse options that require `--live`."""
    options = [name for name in OF_A_LIVE_RUN if getattr(args, name) is not None]
    if options:
        args.wrong(f"{_options.flags(*options)} needs --live")


def run(args: argparse.Namespace) -> int:
    """Run the session and print the meter, the costs, or both. Status 1 if it was stopped."""
    _refuse(args)
    if not args.live:
        refuse_alone(args)
    elif args.duration is None and args.file.is_file():
        args.wrong("a live run needs --duration, for example --duration 5000")
    session, duration = _session(args), args.duration or 0.0
    speed = 1.0 if args.speed is None else None if args.speed == "max" else args.speed
    answer: dict[str, object] = {}
    stopped = ""
    if args.live:
        # start-up time: these bring JAX
        from deodar.session.pace import Pace
        from deodar.session.run_live import run_live

        pace = Pace()
        with interrupted_at_end(), _recorded(args, session) as recorder:
            try:
                meter = run_live(session, duration, speed, args.longest_step, pace=pace)
            except KeyboardInterrupt:  # the usual end of a live run: the measurements are printed
                meter, unit = pace.meter(session), session.document.time_unit
                stopped = f"stopped at {session.time:g} of {duration:g} {unit}"
        answer["meter"] = meter.data() | {"complete": not stopped}
        if not args.json:
            print(_options.paragraph([str(meter)]))
        if recorder is not None:
            answer["out"] = str(recorder.path)
            if not args.json:
                folder = _options.shown(recorder.path)
                print(f"Wrote {', '.join(recorder.names)} to {folder}. Look at it with: deodar plot {folder}")
    else:
        session.run(duration)
    if args.cost and not stopped:
        costs = session.costs()
        answer["cost"] = costs.data()
        if not args.json:
            print(costs)
    if args.json:
        print(codec.text(answer))
    if stopped:
        print(f"deodar run: {_options.paragraph([stopped])}", file=sys.stderr)
    return INTERRUPTED if stopped else 0


def _refuse(args: argparse.Namespace) -> None:
    """Refuse options that do not fit."""
    options = [name for name in (*OF_A_BATCH, *OF_A_RECORD) if getattr(args, name)]
    if args.live and args.record:
        options = [name for name in options if name in OF_A_BATCH]
        if args.format != "zarr":
            args.wrong(f"a live run is recorded as zarr; `deodar export` converts it to {args.format}")
    if options:
        reason = "a session has no batch" if args.live and args.record else "nothing is recorded"
        args.wrong(
            f"with --{'live' if args.live else 'cost'} {reason},"
            f" so {_options.flags(*options)} cannot be given"
            + (" without --record" if args.live and not args.record else "")
        )


def _recorded(
    args: argparse.Namespace, session: Session
) -> contextlib.AbstractContextManager[Recorder | None]:
    """Begin the record of a live run, if one was asked for."""
    if not args.record:
        return contextlib.nullcontext()
    # start-up time: these bring JAX
    from deodar.recording import places

    out = args.out or places.free(Path(), session.document.name)
    return session.record(out, args.record, args.every, args.force)


def _session(args: argparse.Namespace) -> Session:
    # start-up time: these bring JAX
    from deodar.model.model import load
    from deodar.resources import Resources
    from deodar.session.session import Session

    model = load(args.file, trust=args.trust)
    _options.apply_set(model, args)
    return Session(
        model,
        args.dt,
        args.seed or 0,
        _options.arithmetic(args),
        _options.world(args.world),
        on=Resources(args.device, args.devices),
    )


def _speed(text: str) -> float | str:
    """Parse a number, or `max`."""
    return text if text == "max" else float(text)


_speed.__name__ = "speed"
