"""The command `deodar serve WORLD` or `deodar serve --model FILE`."""

from __future__ import annotations

import argparse
import signal
from types import FrameType
from typing import TYPE_CHECKING

from deodar import codec
from deodar.cli import _options
from deodar.session.interrupt import ending_signals

if TYPE_CHECKING:
    from deodar.worlds._base import World

HELP = "put a world or a model on the network, as a robot that another process moves"


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.option("world", "KIND:ARGUMENT", "the world, for example arena:blocks", nargs="?")
    parser.option(
        "--model",
        "FILE",
        "a model in place of a world: its motors are sensors of the other model, its sensors motors",
        _options.document,
    )
    parser.option("--at", "ENDPOINT", "where to listen (default tcp/127.0.0.1:7461, this machine alone)")
    parser.option(
        "--name",
        "NAME",
        "name of the robot (default: that of its file, or the kind of the world and a number)",
    )
    parser.add_argument(
        "--clock",
        choices=("step", "live"),
        help=(
            "step: the world waits for the commands of each period; live: it follows the wall clock"
            " (default: that of the robot file; step; live where the readings come from outside)"
        ),
    )
    parser.flag(
        "--trusted",
        "allow an endpoint beyond this machine, in a network of your own: messages are not encrypted; at one"
        " of this machine, let every process in",
    )
    for name, what in (
        ("certificate", "certificate of this server, for an endpoint tls/HOST:PORT, which encrypts messages"),
        ("key", "private key of the certificate"),
        ("authority", "certificate of the authority; only models with a certificate that it signed connect"),
    ):
        parser.option(f"--{name}", "FILE", what, default="")
    _options.add_rounding(parser)
    _options.add_json(parser)


def run(args: argparse.Namespace) -> int:
    """Serve until Ctrl-C, SIGTERM or the end of the terminal, then print what became of the messages."""
    # start-up time: these bring JAX
    from deodar_robots.zenoh import link
    from deodar_robots.zenoh.link import TlsFiles
    from deodar_robots.zenoh.server import WorldServer, free_name

    _options.use_rounding(args.separate_rounding)
    ended: list[int] = []

    def end(number: int, frame: FrameType | None) -> None:
        ended.append(number)

    world = _opened(args)
    stated = "step" if args.model else getattr(getattr(world, "file", None), "clock", None)
    clock = args.clock or stated or ("live" if world.wall_clock else "step")
    files = TlsFiles(args.authority, args.certificate, args.key)
    called, place = args.name or free_name(world), args.at or link.HERE
    server = WorldServer(world, called, place, clock, args.trusted, files)
    before = {number: signal.signal(number, end) for number in (signal.SIGINT, *ending_signals())}
    name, at = server.about.name, server.endpoint
    try:
        if not args.json:
            where = "" if at == link.HERE else f", at={at}"
            where += ", authority=FILE" if files else ""
            print(f'{name} at {at}, clock {clock}. Move it with: --world "zenoh:{name}{where}"', flush=True)
        server.serve(lambda: bool(ended))
    finally:
        server.close()
        for number, handler in before.items():
            signal.signal(number, handler)
    if args.json:
        print(codec.text({"robot": name, "at": at, "messages": dict(server.counts), "late": server.late}))
    else:
        counts = ", ".join(f"{count} {what}" for what, count in sorted(server.counts.items())) or "none"
        print(f"{name} has stopped. Messages: {counts}; {server.late} late periods")
    return 0


def _opened(args: argparse.Namespace) -> World:
    """Return what is served: a world or a model."""
    if (args.world is None) == (args.model is None):
        args.wrong("serve needs a KIND:ARGUMENT or a --model")
    if args.model is not None:
        # start-up time: this brings JAX
        from deodar.session.model_world import ModelWorld

        return ModelWorld.open(str(args.model))
    world = _options.world(args.world)
    assert world is not None
    return world
