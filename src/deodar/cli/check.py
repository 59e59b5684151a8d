"""The command `deodar check FILE`."""

from __future__ import annotations

import argparse

from deodar.cli import _options
from deodar.cli._answer import CommandAnswer, problem_data
from deodar.errors import DocumentError

HELP = "list everything that is wrong with a document, and what is probably a mistake, each with its path"
EPILOG = """\
A problem stops a run; a warning never does. Status 1 if there is a problem, or, with --strict, a warning."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    _options.add_document(parser)
    parser.flag("--strict", "count warnings as problems: status 1")
    _options.add_json(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Check a document; status 1 if it has a problem or, with `--strict`, a warning."""
    # start-up time: these bring JAX
    from deodar.importers.opening import load

    try:
        model = load(args.file)
    except DocumentError as error:
        if not args.json:
            raise
        return CommandAnswer({"problems": problem_data(error.problems)}, status=1)
    problems = model.check()
    failed = any(args.strict or p.severity == "problem" for p in problems)
    lines = [("warning: " if p.severity == "warning" else "") + p.at("shell") for p in problems]
    if not failed:
        d, n = model.document, len(problems)
        good = f"no problem, {n} warning{'s' if n > 1 else ''}" if problems else "good"
        lines.append(f"{args.file}: {good}. {len(d.entries)} elements, {len(d.connections)} connections.")
    return CommandAnswer({"problems": problem_data(problems)}, lines, int(failed))
