"""The commands `deodar examples`, `deodar examples copy NAME` and `deodar examples open NAME`."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

from deodar import regular_file
from deodar.cli import _options
from deodar.cli._answer import CommandAnswer
from deodar.errors import UnknownName
from deodar.importers import examples
from deodar.model import output

HELP = "list the examples that come with deodar, copy one, or open one in the studio"
EPILOG = """\
list prints every example with a sentence. copy writes its files into DIR, which is made if it is missing;
copy exercises and copy solutions write the notebooks of the exercises, and their solutions.
open starts the studio with a copy that has no file yet. Wherever a command takes the FILE of a model,
example:NAME stands for an example: deodar run example:selection"""

WIDEST = 110
"""Columns of the list in a pipe, which has no width."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    parser.add_argument(
        "what", nargs="?", default="list", choices=("list", "copy", "open"), help="what to do (default list)"
    )
    parser.option("name", "NAME", "copy, open: the example, for example selection", nargs="?")
    parser.option(
        "folder", "DIR", "copy: the folder to write into (default: the working folder)", Path, nargs="?"
    )
    _options.add_force(parser)
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer | int:
    """List, copy or open examples."""
    if args.what == "list":
        if args.name is not None:
            args.wrong(f"list takes no name. To copy it: deodar examples copy {args.name}")
        return _list()
    if args.name is None:
        args.wrong(f"{args.what} needs the NAME of an example. All examples: deodar examples")
    return _copy(args) if args.what == "copy" else _open(args)


def _list() -> CommandAnswer:
    listed = [
        {
            "name": n,
            "kind": kind,
            "file": str(examples.file(n)),
            "sentence": examples.sentence(n),
            "duration": examples.duration(n),
        }
        for kind, names in (("document", examples.names()), ("script", examples.scripts()))
        for n in names
    ]
    return CommandAnswer({"examples": listed}, _tables())


def _tables() -> Iterator[str]:
    """Print the list as tables, and yield what to type next."""
    # start-up time: only a terminal needs rich
    from rich import box
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    console = Console()
    if not console.is_terminal:  # a pipe has no width
        console = Console(width=WIDEST + 60)
    for title, names in (("models", examples.names()), ("scripts", examples.scripts())):
        table = Table(title, "", box=box.SIMPLE_HEAD)
        for name in names:
            table.add_row(name, escape(examples.sentence(name)))
        console.print(table)
    yield (
        "Run one with: deodar run example:NAME. Open one in the studio with: deodar examples open NAME. Copy"
        " one with: deodar examples copy NAME"
    )


def _copy(args: argparse.Namespace) -> CommandAnswer:
    sources = examples.parts(args.name)
    folder: Path = args.folder or Path()
    if args.folder is not None and not folder.exists():
        output.claim(folder)
        folder.mkdir()
    targets = [output.claim(folder / path.name, args.force) for path in sources]
    for source, target in zip(sources, targets, strict=True):
        output.write(target, regular_file.read_bytes(source))
    program = {".json": "deodar studio", ".ipynb": "jupyter lab"}.get(targets[0].suffix, "python")
    copied = ", ".join(map(_options.shown, targets))
    text = f"Copied {copied}. Next: {program} {_options.shown(targets[0])}"
    return CommandAnswer({"files": [str(t) for t in targets]}, [text])


def _open(args: argparse.Namespace) -> int:
    # start-up time: this imports the commands
    from deodar.cli import COMMANDS

    path = f"{examples.PREFIX}{args.name}"
    examples.named(path)
    opening = [command for command in COMMANDS.values() if hasattr(command, "open_document")]
    if not opening:
        raise UnknownName("no command of the installed packages opens a document", fix="Type: deodar doctor")
    return opening[0].open_document(path)
