"""The command line: one module per command; every module in this folder is a command.

A command is a module with `HELP` (one line), `arguments(parser)` and `run(args)`, which returns a
`CommandAnswer`, or the status if it prints by itself. Heavy imports are inside `run`, so that `deodar --help`
starts quickly.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import importlib
import pkgutil
import sys
import warnings
from collections.abc import Generator, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from deodar import __version__
from deodar.cli._answer import INTERRUPTED, CommandAnswer
from deodar.cli._options import CommandParser
from deodar.errors import DeodarError, RunWarning, UnknownName, first_line
from deodar.extensions import Extensions, requires


@functools.cache
def _own() -> dict[str, ModuleType]:
    """Return the commands of this folder; a module has a trailing underscore if the name is a keyword."""
    names = sorted(m.name for m in pkgutil.iter_modules(__path__) if not m.name.startswith("_"))
    return {name.rstrip("_"): importlib.import_module(f"deodar.cli.{name}") for name in names}


COMMANDS: Extensions[ModuleType] = Extensions(
    "commands", "command", _own, requires("HELP", "arguments", "run")
)
"""The commands by name."""


def _needed(words: Sequence[str]) -> dict[str, ModuleType]:
    """Return the commands that a call may name: its words that are commands, or all if there are none."""
    named = {word: COMMANDS[word] for word in words if word in COMMANDS}
    return named or dict(sorted(COMMANDS.items()))


def parser(words: Sequence[str] = ()) -> argparse.ArgumentParser:
    """Return the parser of the command line, with the commands that the call needs."""
    top = CommandParser(prog="deodar", description="A workbench for Dynamic Field Theory.")
    top.add_argument("--version", action="version", version=f"deodar {__version__}")
    top.add_argument(
        "--import",
        dest="imports",
        action="append",
        default=[],
        metavar="MODULE",
        help="import a module with elements of your own first",
    )
    inside = top.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, module in _needed(words).items():
        sub = inside.add_parser(name, help=module.HELP, description=module.HELP)
        module.arguments(sub)
        sub.set_defaults(run=module.run)
    return top


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; status 0: success, 1: an error, printed as one paragraph on stderr, 2: an invalid
    call.
    """
    words = list(sys.argv[1:] if argv is None else argv)
    if words and not words[0].startswith("-"):
        try:
            COMMANDS[words[0]]
        except UnknownName as error:
            print(f"deodar: {error.at('shell')}", file=sys.stderr)
            return 2
    args = parser(words).parse_args(words)
    try:
        for name in args.imports:
            _import(name)
        with _warnings_of(args.command):
            answer = args.run(args)
            return answer.tell(args.json) if isinstance(answer, CommandAnswer) else int(answer)
    except DeodarError as error:
        print(f"deodar {args.command}: {error.at('shell')}", file=sys.stderr)
    except KeyboardInterrupt:
        print(f"deodar {args.command}: stopped", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        sys.stderr.close()
    except OSError as error:
        print(
            f"deodar {args.command}:"
            f" {error.strerror or error}{f': {error.filename}' if error.filename else ''}",
            file=sys.stderr,
        )
    except MemoryError:
        print(
            f"deodar {args.command}: there is not enough memory for this. Use fewer samples or fewer trials",
            file=sys.stderr,
        )
    except Exception as error:
        # start-up time
        from deodar import last_error

        last_error.note(error, f"deodar {args.command}", words[1:])
        error.add_note("This is an error of deodar itself. For a fault report type: deodar doctor --report")
        raise
    return 1


@contextlib.contextmanager
def _warnings_of(command: str) -> Generator[None]:
    """Print warnings of a run as one line, without the place in the code that they come from."""
    with warnings.catch_warnings():
        show = warnings.showwarning

        def printed(message: Warning | str, category: type[Warning], *place: Any, **file: Any) -> None:
            if issubclass(category, RunWarning):
                print(f"deodar {command}: warning: {message}", file=sys.stderr)
            else:
                show(message, category, *place, **file)

        warnings.showwarning = printed
        yield


def _import(name: str) -> None:
    """Import a module of the user, named on the command line, to register its kinds."""
    if str(Path.cwd()) not in sys.path:
        sys.path.insert(0, str(Path.cwd()))
    try:
        importlib.import_module(name)
    except DeodarError:
        raise
    except Exception as error:  # a module may raise any exception
        raise UnknownName(
            f"the module {name!r} cannot be imported ({type(error).__name__}: {first_line(error)})",
            fix="It is named without .py and found in the working folder",
        ) from None
