"""The command `deodar script FILE`."""

from __future__ import annotations

import argparse
import itertools
from pathlib import Path

from deodar.cli import _options
from deodar.cli._answer import CommandAnswer
from deodar.errors import OutputError
from deodar.model import output

HELP = "write a Python script that makes the same document"


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    _options.add_document(parser)
    parser.option("--out -o", "SCRIPT", "the script to write (default: print it)", Path)
    _options.add_force(parser)
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Write the script, or print it."""
    # start-up time: this brings JAX
    from deodar.importers.opening import load

    if args.out is not None and args.out.exists() and args.out.samefile(args.file):
        raise OutputError("is the document itself", where=str(args.out), fix="Choose another name: --out")
    script = load(args.file).to_script(_free(args.file.stem, args.out or Path("script.py")))
    if args.out is not None:
        output.write(output.claim(args.out, args.force), script.encode())
    if args.out is None:
        return CommandAnswer({"out": None, "script": script}, [script.removesuffix("\n")])
    wrote = f"Wrote {_options.shown(args.out)}. Type: python {_options.shown(args.out)}"
    return CommandAnswer({"out": str(args.out), "script": script}, [wrote])


def _free(stem: str, script: Path) -> str:
    """Return the name of a document that does not exist where the script will run: beside it."""
    names = itertools.chain([f"{stem}.json"], (f"{stem}-{n}.json" for n in itertools.count(2)))
    return next(name for name in names if not script.with_name(name).exists())
