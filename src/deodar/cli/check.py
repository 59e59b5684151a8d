"""The command `deodar check FILE`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING

from deodar import codec
from deodar.cli import _options
from deodar.errors import DocumentError

if TYPE_CHECKING:
    from deodar.errors import Problem

HELP = "list everything that is wrong with a document, and what is probably a mistake, each with its path"
EPILOG = """\
A problem stops a run; a warning never does. Status 1 if there is a problem, or, with --strict, a warning."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = EPILOG
    _options.add_document(parser)
    parser.flag("--strict", "count warnings as problems: status 1")
    _options.add_json(parser)


def run(args: argparse.Namespace) -> int:
    """Check a document; status 1 if it has a problem or, with `--strict`, a warning."""
    # start-up time: these bring JAX
    from deodar.importers.opening import load

    try:
        model = load(args.file)
    except DocumentError as error:
        if not args.json:
            raise
        print(_json(error.problems))
        return 1
    problems = model.check()
    failed = any(args.strict or p.severity == "problem" for p in problems)
    if args.json:
        print(_json(problems))
        return int(failed)
    for p in problems:
        print(("warning: " if p.severity == "warning" else "") + p.at("shell"))
    if not failed:
        d, n = model.document, len(problems)
        good = f"no problem, {n} warning{'s' if n > 1 else ''}" if problems else "good"
        print(f"{args.file}: {good}. {len(d.entries)} elements, {len(d.connections)} connections.")
    return int(failed)


def _json(problems: Sequence[Problem]) -> str:
    listed = [
        {"severity": p.severity, "where": p.where, "what": p.what, "fix": p.fix_at("shell")} for p in problems
    ]
    return codec.text({"problems": listed})
