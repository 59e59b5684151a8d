"""`deodar check FILE`."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deodar.errors import Problem

HELP = "list everything that is wrong with a document, each with its path"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    parser.add_argument("file", type=Path, metavar="FILE", help="a document (.json)")
    parser.add_argument("--json", action="store_true", help="print the answer as JSON")


def run(args: argparse.Namespace) -> int:
    """Status 1 if there is any problem."""
    from deodar.errors import DocumentError
    from deodar.importers.opening import load

    try:
        model = load(args.file)
    except DocumentError as error:
        if not args.json:
            raise
        print(_json(error.problems))
        return 1
    problems = model.check()
    if args.json:
        print(_json(problems))
    elif problems:
        print("\n".join(str(p) for p in problems))
    else:
        d = model.document
        print(f"{args.file}: good. {len(d.entries)} elements, {len(d.connections)} connections.")
    return 1 if problems else 0


def _json(problems: Sequence[Problem]) -> str:
    return json.dumps({"problems": [{"where": p.where, "what": p.what, "fix": p.fix} for p in problems]}, indent=2, ensure_ascii=False)
