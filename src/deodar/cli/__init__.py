"""The command line: one file for each command; the folder is the registry.

A command is a module with `HELP` (one line), `arguments(parser)` and `run(args) -> int`. Heavy imports stand inside `run`, so
that `deodar --help` answers at once.
"""

from __future__ import annotations

import argparse
import importlib
import pkgutil
import sys
from collections.abc import Sequence
from types import ModuleType
from typing import NoReturn

from deodar import __version__
from deodar.errors import DeodarError, did_you_mean


def commands() -> dict[str, ModuleType]:
    """Every command by name."""
    names = sorted(m.name for m in pkgutil.iter_modules(__path__) if not m.name.startswith("_"))
    return {name: importlib.import_module(f"deodar.cli.{name}") for name in names}


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """A wrong call is told in one sentence, with what to type; status 2."""
        self.exit(2, f"{self.prog}: {message}. Type: {self.prog} --help\n")


def parser() -> argparse.ArgumentParser:
    """The parser of the whole command line."""
    top = _Parser(prog="deodar", description="A workbench for Dynamic Field Theory.")
    top.add_argument("--version", action="version", version=f"deodar {__version__}")
    inside = top.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, module in commands().items():
        sub = inside.add_parser(name, help=module.HELP, description=module.HELP)
        module.arguments(sub)
        sub.set_defaults(run=module.run)
    return top


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; 0 means done, 1 an error told in one paragraph on stderr, 2 a wrong call."""
    given = list(sys.argv[1:] if argv is None else argv)
    if given and not given[0].startswith("-") and given[0] not in commands():
        print(f"deodar: there is no command {given[0]!r}. {did_you_mean(given[0], commands())}", file=sys.stderr)
        return 2
    args = parser().parse_args(given)
    try:
        return int(args.run(args))
    except DeodarError as error:
        print(f"deodar {args.command}: {error}", file=sys.stderr)
    except KeyboardInterrupt:
        print(f"deodar {args.command}: stopped", file=sys.stderr)
    except BrokenPipeError:
        sys.stderr.close()
    except OSError as error:
        print(f"deodar {args.command}: {error.strerror or error}{f': {error.filename}' if error.filename else ''}", file=sys.stderr)
    except MemoryError:
        print(f"deodar {args.command}: there is not enough memory for this. Take fewer samples or fewer trials", file=sys.stderr)
    return 1
