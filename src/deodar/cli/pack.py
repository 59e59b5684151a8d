"""The command `deodar pack FILE`."""

from __future__ import annotations

import argparse
from pathlib import Path

from deodar.cli import _options
from deodar.cli._answer import CommandAnswer
from deodar.summary import sized

HELP = "pack a model, a record, an experiment or a figure into one file for a colleague, or unpack one"
EPILOG = """\
FILE is a document, a record, the folder of a run or of an experiment, an experiment (.json), or the file of a
figure (.toml); what it names by a relative path comes with it. deodar open FILE shows what a package holds;
run, experiment, plot and studio take a package as it is. Modules of your own are named in the package; add
--with-code to include them."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    _options.add_document(parser, "what to pack, or the package to unpack")
    parser.option(
        "--out -o",
        "OUT",
        "the package to write, OUT.deodar, or the folder to unpack into (default: FILE's name, here)",
        Path,
    )
    parser.flag("--with-code", "include the modules of your own that it needs; they run only with --trust")
    parser.flag("--unpack", "write what FILE holds into the folder OUT")
    _options.add_force(parser)
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Write the package, or extract its files."""
    # start-up time: these bring JAX
    from deodar.model import package
    from deodar.packing import packing

    if args.unpack:
        if args.with_code:
            args.wrong("--with-code packs modules, and --unpack unpacks")
        inner = packing.unpack(args.file, args.out, force=args.force)
        return CommandAnswer({"out": str(inner)}, [f"Unpacked {_options.shown(inner)}"])
    if args.out is not None and args.out.suffix.lower() != package.SUFFIX:
        args.wrong(
            f"the name of a package ends in {package.SUFFIX}: --out"
            f" {_options.shown(args.out.with_suffix(package.SUFFIX))}"
        )
    target = packing.pack(args.file, args.out, args.with_code, args.force)
    name, size = _options.shown(target), target.stat().st_size
    lines = [f"Wrote {name} ({sized(size)}). See what is inside: deodar open {name}"]
    for module in packing.contents(target).modules:
        if module.distribution:
            lines.append(f"It needs the package {module.distribution}, of which {module.name} is.")
        elif not module.files:
            lines.append(f"It needs your module {module.name}, which is not in it; --with-code includes it")
        else:
            lines.append(f"Your module {module.name} is in it: {', '.join(module.files)}")
    return CommandAnswer({"out": str(target), "bytes": size}, lines)
