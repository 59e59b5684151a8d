"""Options that several commands share."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, NoReturn

from deodar import codec
from deodar.errors import UnknownName
from deodar.importers import examples

if TYPE_CHECKING:
    from deodar.model.model import Model
    from deodar.worlds._base import World


class CommandParser(argparse.ArgumentParser):
    """The parser of a command, whose `run` refuses a call like argparse by `args.wrong(text)`."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self.set_defaults(wrong=self.error)

    def flag(self, name: str, meaning: str) -> None:
        """Add an option without a value."""
        self.add_argument(name, action="store_true", help=meaning)

    def option(
        self,
        names: str,
        noun: str | tuple[str, ...],
        meaning: str,
        parse: Callable[[str], Any] = str,
        **settings: Any,
    ) -> None:
        """Add an argument with a value.

        Args:
            names: its name, or an option's names with spaces between them, as they are typed.
            noun: what the help calls the value, or each of several.
            meaning: the help.
            parse: returns the value of a text.
            settings: other keywords of `add_argument`.
        """
        self.add_argument(*names.split(), metavar=noun, help=meaning, type=parse, **settings)

    def error(self, message: str) -> NoReturn:
        """Print an invalid call as one sentence with a fix, and exit with status 2."""
        self.exit(2, f"{self.prog}: {message}. Type: {self.prog} --help\n")


def add_each(parser: CommandParser, members: Mapping[str, ModuleType]) -> dict[str, str]:
    """Let each member with `arguments` add its own; return the name of the member by the option."""
    names: dict[str, str] = {}
    for name, member in members.items():
        if hasattr(member, "arguments"):
            before = {action.dest for action in parser._actions}
            member.arguments(parser)
            names |= {action.dest: name for action in parser._actions if action.dest not in before}
    return names


def add_json(parser: CommandParser) -> None:
    """Add `--json`."""
    parser.flag("--json", "print the answer as JSON")


def add_force(parser: CommandParser) -> None:
    """Add `--force`."""
    parser.flag("--force", "replace what an earlier run wrote there")


def add_world(parser: CommandParser) -> None:
    """Add `--world` and `--trust`."""
    parser.option("--world", "KIND:ARGUMENT", "what the model's sensors read, for example picture:photo.jpg")
    parser.flag("--trust", "allow functions that the document names to be imported and run")


def add_cores(parser: CommandParser) -> None:
    """Add `--cores`."""
    parser.option(
        "--cores", "N", "cores that a program uses (default 1, the quickest for most models)", whole
    )


def use_cores(cores: int | None, usual: int = 1) -> None:
    """Use the number of cores of `--cores`; without it `usual`, unless NPROC is set or JAX has started."""
    # start-up time: these bring JAX
    from deodar import cores as setting

    if cores is not None:
        setting.use_cores(cores)
    elif not setting.settled():
        setting.use_cores(usual)


def use_rounding(separate: bool) -> None:
    """Round products and sums separately if `--separate-rounding` is given, or a record was made so."""
    # start-up time: these bring JAX
    from deodar.batch.separate_rounding import use_separate_rounding

    if separate:
        use_separate_rounding()


def add_rounding(parser: CommandParser) -> None:
    """Add `--separate-rounding`."""
    parser.flag(
        "--separate-rounding",
        "round a product before it is added to something, so that parts of a model in other processes"
        " give the same bits as the whole (x86 only; takes longer)",
    )


def add_accuracy(parser: CommandParser) -> None:
    """Add `--precision` and `--accuracy`."""
    parser.add_argument(
        "--precision", choices=("float32", "float64"), help="of all numbers (default float32)"
    )
    parser.add_argument(
        "--accuracy",
        choices=("default", "exact"),
        help="of convolutions: default is within 1e-4, exact takes longer",
    )


def add_run(parser: CommandParser) -> None:
    """Add `--seed`, `--precision`, `--accuracy`, `--device`, `--cores`, `--separate-rounding` and
    `--no-progress`.
    """
    parser.option("--seed", "N", "seed of all noise, 0 to 4294967295 (default 0)", whole)
    add_accuracy(parser)
    parser.option(
        "--device",
        "NAME",
        "where to run: cpu, gpu, or one of several as gpu:1 (default cpu, the quickest for small models)",
    )
    add_cores(parser)
    add_rounding(parser)
    parser.flag("--no-progress", "show no progress bar")


def arithmetic(args: argparse.Namespace) -> str:
    """Return the precision of `--precision` and `--accuracy`."""
    single = args.precision in (None, "float32")
    return "float32-exact" if single and args.accuracy == "exact" else args.precision or "float32"


def progress(args: argparse.Namespace) -> bool:
    """Return whether a command draws its progress, which it does on a terminal alone."""
    return sys.stderr.isatty() and not (args.no_progress or args.json)


def flags(*names: str) -> str:
    """Return the options of arguments as they are typed."""
    return ", ".join(f"--{name.replace('_', '-')}" for name in names)


def document(text: str) -> Path:
    """Return the path of a document, or that of the example which `example:NAME` names."""
    try:
        return examples.named(text)
    except UnknownName as error:
        raise argparse.ArgumentTypeError(error.at("shell")) from None


def add_document(
    parser: CommandParser, meaning: str = "a document (.json, .deodar), or example:NAME", **how: Any
) -> None:
    """Add `FILE`: a document, or an example by its name."""
    parser.add_argument("file", type=document, metavar="FILE", help=meaning, **how)


def add_set(parser: CommandParser) -> None:
    """Add `--set`, which `apply_set` applies."""
    parser.option("--set", "PATH=VALUE", "change a parameter first", setting, action="append")


def apply_set(model: Model, args: argparse.Namespace) -> None:
    """Change the parameters of a model that `--set` names."""
    for path, value in args.set or ():
        model.set(path, value)


def whole(text: str) -> int:
    """Parse an integer, 0 or above."""
    number = int(text)
    if number < 0:
        raise ValueError
    return number


whole.__name__ = "whole number"


def several(text: str) -> int | str:
    """Parse an integer, 0 or above, or `all`."""
    return text if text == "all" else whole(text)


several.__name__ = "whole number or all"


def positive(text: str) -> float:
    """Parse a number above 0."""
    number = float(text)
    if not 0 < number < float("inf"):
        raise ValueError
    return number


positive.__name__ = "number above 0"


def pair(text: str) -> tuple[str, str]:
    """Parse `PATH=VALUE`; a path may contain an equals sign."""
    path, sign, value = text.rpartition("=")
    if not sign or not path or not value:
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form PATH=VALUE")
    return path.strip(), value.strip()


def setting(text: str) -> tuple[str, Any]:
    """Parse `PATH=VALUE`, the value in JSON: a number, true, false, [1, 2]; any other value is text."""
    path, value = pair(text)
    try:
        return path, codec.parse(value)
    except ValueError:
        return path, value


def values(text: str) -> tuple[str, list[float]]:
    """Parse `PATH=V1,V2,...`."""
    path, listed = pair(text)
    try:
        return path, [float(v) for v in listed.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{listed!r} is not a list of numbers such as 4,6,8") from None


def world(text: str | None) -> World | None:
    """Open the world of `--world KIND:ARGUMENT`."""
    # start-up time: these bring JAX
    from deodar.recording.opened import named

    return None if text is None else named(text, f"--world {text}")


def figure(out: Path | None, stem: str) -> Path:
    """Return the path of a figure: the requested one, else the first free number in the working folder."""
    if out is not None:
        return out
    number = 1
    while (path := Path(f"{stem}-{number:03d}.png")).exists() or path.is_symlink():
        number += 1
    return path


def targets(args: argparse.Namespace, stem: str) -> tuple[Path | None, Path | None]:
    """Return the paths of a figure and of the file of what it shows.

    `--out` names either, `--save` the file; a figure without a name gets a free one.
    """
    out: Path | None = args.out
    if out is None or out.suffix.lower() not in (".nc", ".zarr"):
        return figure(out, stem), args.save
    if args.save is not None:
        args.wrong(f"--out {out} is a file already; leave out --save, or name a figure")
    return None, out


def shown(path: Path) -> str:
    """Return a path for a shell: relative inside the working folder, quoted if a shell would split it."""
    try:
        text = str(path.resolve().relative_to(Path.cwd()))
    except (OSError, ValueError):
        text = str(path)
    return shlex.quote(text)


def paragraph(parts: Sequence[str]) -> str:
    """Join sentences, each with a full stop."""
    return " ".join(p if p.endswith((".", "!", "?", ":")) else f"{p}." for p in parts if p)
