"""The command `deodar open FILE`."""

from __future__ import annotations

import argparse

from deodar.cli import _options
from deodar.cli._answer import CommandAnswer

HELP = "show what a package, a record, an experiment or a figure holds, and what made it"
EPILOG = """\
Nothing that a file holds is run. A file of another tool is shown as the model that it becomes."""

COMMANDS = {
    "document": ("run {file} --duration D", "studio {file}"),
    "record": ("run {file}", "plot {file}", "studio {file}"),
    "experiment": ("experiment {file}",),
    "results": ("experiment {file}",),
    "table": (),
    "figure": ("plot {file}",),
}
"""What to type next, for each kind of work."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    _options.add_document(parser, "a package (.deodar), a document, a record, an experiment or a figure")
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Print the contents."""
    # start-up time: this brings JAX
    from deodar.packing import packing

    contents = packing.contents(args.file)
    lines, file = [repr(contents)[1:-1]], _options.shown(args.file)
    if any(module.files for module in contents.modules):
        lines.append(f"Its modules run only with --trust. Read them first: deodar pack {file} --unpack")
    lines += [f"Next: deodar {command.format(file=file)}" for command in COMMANDS[contents.kind]]
    return CommandAnswer(contents.to_data(), lines)
