"""The command `deodar pack FILE`."""

from __future__ import annotations

import argparse
from pathlib import Path

from deodar import codec
from deodar.cli import _options
from deodar.errors import DocumentError
from deodar.model.output import claim

HELP = "pack a document and its arrays into one file, or unpack such a file"
EPILOG = """\
A package is a zip file with the document and its arrays. Every command that takes a document takes it as
it is, and dd.load does; any zip tool unpacks it."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    _options.add_document(parser)
    parser.add_argument(
        "--out",
        "-o",
        type=Path,
        metavar="OUT",
        help="the package to write, OUT.deodar (default: FILE's name, in the working folder)",
    )
    parser.add_argument(
        "--unpack",
        action="store_true",
        help="write FILE's document and arrays into the folder OUT (default: the working folder)",
    )
    _options.add_force(parser)
    _options.add_json(parser)
    _options.wrong(parser)


def run(args: argparse.Namespace) -> int:
    """Write the package, or extract its files."""
    # start-up time: these bring JAX
    from deodar.importers.opening import load
    from deodar.model import model, package

    loaded = load(args.file)
    if args.unpack:
        if not package.is_package(args.file):
            raise DocumentError(
                "is not a package", where=str(args.file), fix="Leave out --unpack to make one"
            )
        folder: Path = args.out or Path()
        if not folder.exists():
            claim(folder)
            folder.mkdir()
        target = folder / f"{args.file.stem}.json"
    else:
        target = args.out or Path(f"{args.file.stem}{package.SUFFIX}")
        if target.suffix.lower() != package.SUFFIX:
            args.wrong(
                f"the name of a package ends in {package.SUFFIX}: --out"
                f" {_options.shown(target.with_suffix(package.SUFFIX))}"
            )
    model.save(loaded, target, args.force)
    if args.json:
        print(codec.text({"out": str(target), "bytes": target.stat().st_size}))
    else:
        print(f"Wrote {_options.shown(target)}. Open it with: deodar studio {_options.shown(target)}")
    return 0
