"""The command `deodar import FILE`."""

from __future__ import annotations

import argparse
from pathlib import Path

from deodar.cli import _options, _report
from deodar.cli._answer import CommandAnswer, problem_data
from deodar.importers.tools import IMPORTERS
from deodar.model import output

HELP = (
    "make a document from a file of another tool, with a report of what was carried, approximated or dropped"
)
EPILOG = """\
Known errors of the other tool are corrected, and listed; with --bugs they are reproduced. The report stays
in the document: as text in its notes, and line by line for the panel Import report of the studio. Status 1
with --strict if anything was not carried."""


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = f"Tools: {', '.join(p.name for p in IMPORTERS.packaged())}. {EPILOG}"
    _options.add_document(parser, "the file of the other tool")
    parser.option(
        "--out -o", "OUT", "the document to write (.json); without it only the report is shown", Path
    )
    parser.flag("--bugs", "reproduce known errors of the other tool")
    parser.flag("--strict", "fail, and write nothing, if anything is approximated or dropped")
    _options.add_json(parser)
    _options.add_force(parser)


def run(args: argparse.Namespace) -> CommandAnswer:
    """Import a file; status 1 if it cannot be read, or with `--strict` if a part was lost."""
    # start-up time: these bring JAX
    from deodar.importers.opening import read
    from deodar.importers.stored_report import located, with_report
    from deodar.model.model import Model, save

    if args.out is not None:
        output.claim(args.out, args.force)
    done = read(args.file, args.bugs)
    doc, report = done.model.document, done.report
    failed = args.strict and not report.faithful
    problems = done.model.check()
    if args.out is not None and not failed:
        save(Model(document=with_report(doc, report)), args.out, args.force)
    written = str(args.out) if args.out is not None and not failed else None
    fields = {**located(report, doc).data(), "problems": problem_data(problems), "out": written}
    lines: list[str] = []
    for severity, title in (
        ("problem", "It does not run as it is:"),
        ("warning", "It runs, but this is probably a mistake:"),
    ):
        if listed := [f"  {p.at('shell')}" for p in problems if p.severity == severity]:
            lines += [title, *listed]
    if failed:
        lines.append("Nothing was written: --strict.")
    elif args.out is not None:
        lines.append(f"Written: {_options.shown(args.out)}")
    return CommandAnswer(fields, _report.told(report, lines), int(failed))
