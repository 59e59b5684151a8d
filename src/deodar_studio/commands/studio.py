"""The command `deodar studio [FILE|RECORD]`."""

from __future__ import annotations

import argparse
from pathlib import Path

from deodar.cli import _options

HELP = "open the studio in the browser: run a model, tune it, watch it"
EPILOG = """\
FILE is a document, an experiment, or a record (.zarr, .nc, or a folder that deodar run wrote), which is
played without running. A package of one of these (.deodar) is unpacked beside FILE. Without FILE it opens the
gallery of examples. The studio reads and writes files below FILE's folder (without FILE: below the working
folder), and listens on this machine only; with --host it can be reached from others. The page needs the token
in the printed address, also on this machine, which other users may share. A restart at the same port keeps
the token; with --host each start has a new one."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    _options.add_document(
        parser, "a document, an experiment, a record, a package of one (.deodar), or example:NAME", nargs="?"
    )
    parser.option(
        "--port", "N", "port to listen on (default: the first free one from 8430 on; 0: any)", _options.whole
    )
    parser.option(
        "--host", "H", "address to listen on (default 127.0.0.1: this machine only)", default="127.0.0.1"
    )
    parser.flag("--no-browser", "do not open the browser, only print the address")
    parser.flag(
        "--no-token", "allow everyone who can connect to use the studio: at least every user of this machine"
    )
    parser.flag(
        "--unattended", "a run that moves a robot continues without a page; otherwise it pauses after 5 s"
    )
    _options.add_world(parser)
    _options.add_cores(parser)


def run(args: argparse.Namespace) -> int:
    """Serve the studio until Ctrl-C."""
    # start-up time: these bring JAX
    from deodar.importers import examples, opening
    from deodar_studio.files.unpacked import unpacked

    if args.port is not None and args.port > 65535:
        args.wrong("a port is a number from 0 to 65535")
    file: Path | None = args.file
    # an example is opened as a copy without a file
    root = Path.cwd() if file is None or examples.holds(file) else file.resolve().parent
    if not root.is_dir():
        args.wrong(f"the folder {root} does not exist")
    if file is not None:
        opening.require(file)
        file, sentence = unpacked(file, args.trust)
        if sentence:
            print(f"deodar studio: {sentence}")
    # start-up time: these bring JAX
    from deodar_studio.web.serve import serve
    from deodar_studio.web.service import Service

    _options.use_cores(args.cores)

    def say(address: str) -> None:
        print(f"deodar studio: {address}\nStop it with Ctrl-C.", flush=True)

    world, token = _options.world(args.world), not args.no_token
    service = Service(root, file, args.trust, world, args.host, args.port, token, args.unattended)
    return serve(service, not args.no_browser, say)


def open_document(path: str) -> int:
    """Serve the studio with a document, as `deodar studio PATH` does."""
    parser = _options.CommandParser(prog="deodar studio")
    arguments(parser)
    return run(parser.parse_args([path]))
