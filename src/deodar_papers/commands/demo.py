"""The command `deodar demo [NAME]`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

from deodar import cli, codec
from deodar.cli import _options, _question, _rescue
from deodar.cli._options import paragraph, shown, use_cores
from deodar.codec import Json
from deodar.errors import DeodarError, OutputError, OutputExists
from deodar.model import output
from deodar.progress import Tell, erase, telling
from deodar.recording import places
from deodar_papers import papers
from deodar_papers.papers import Demonstration
from deodar_papers.story import demo as story

HELP = (
    "show what a field does, in two moving pictures, or run a paper's quick form: saliency on photographs;"
    " serial-order, a robot that learns a sequence; or spa, a robot that plans and drives"
)

DEFAULT = "story"


class _Shown:
    """The progress of a demonstration, and lines on stdout; `quiet` hides the lines."""

    def __init__(self, tell: Tell, quiet: bool) -> None:
        self._tell, self._quiet = tell, quiet

    def __call__(self, task: str, share: float) -> None:
        self._tell(0, 1, task=task, share=share)

    def line(self, text: str) -> None:
        if not self._quiet:
            if sys.stdout.isatty():
                erase()
            print(text, flush=True)


def arguments(parser: _options.CommandParser) -> None:
    """Add the arguments of the command; each demonstration adds its own."""
    demos = papers.demos()
    about = "; ".join(f"{name}: {demo.HELP}" for name, demo in demos.items())
    parser.option("name", "NAME", about, nargs="?", choices=tuple(demos), default=DEFAULT)
    parser.set_defaults(owners=_options.add_each(parser, demos))
    parser.option("--seed", "N", "seed of all noise (default 0; of the story 12)", _options.whole)
    parser.option(
        "--out -o", "DIR", "folder for what is written (default: a new one in the working folder)", Path
    )
    parser.flag("--force", "replace the folder --out that an earlier demo wrote")
    parser.flag("--json", "print the claims as JSON")
    _options.add_cores(parser)
    parser.flag("--no-progress", "show no progress bar")


def run(args: argparse.Namespace) -> int:
    """Run a demonstration; status 1 if a required claim is false."""
    strange = [
        (option, demo)
        for option, demo in args.owners.items()
        if demo != args.name and getattr(args, option) is not None
    ]
    if strange:
        option, demo = strange[0]
        raise DeodarError(
            f"--{option} belongs to the demo {demo}", where=f"demo {args.name}", fix=f"Leave out --{option}"
        )
    demo = papers.demos()[args.name]
    if args.seed is None:
        args.seed = getattr(demo, "SEED", 0)
    out = args.out or _free(args.name)
    claim(out, args.force)
    use_cores(args.cores)
    with telling(_options.progress(args), "compiling") as tell:
        tell()
        done = demo.run(args, _Shown(tell, args.json))
    return _tell(args, out, done)


def _free(name: str) -> Path:
    """Return a folder in the working folder that does not exist."""
    if name != DEFAULT:
        return places.free(Path.cwd(), f"demo-{name}")
    first = Path.cwd() / story.FOLDER
    return places.free(Path.cwd(), story.FOLDER) if first.exists() else first


def _tell(args: argparse.Namespace, wanted: Path, demo: Demonstration) -> int:
    # start-up time: these bring JAX
    from deodar.analysis.claims import failed, results

    settings: Mapping[str, Json] = {"demo": args.name, "seed": args.seed, **demo.settings}
    text = results(demo.claims, settings)

    def fill(folder: Path) -> None:
        demo.fill(folder)
        output.write(folder / "results.json", text.encode())

    out, why = _written(args, wanted, fill)
    if args.json:
        elsewhere = {"instead_of": str(wanted)} if why else {}
        answer = {"out": str(out), "claims": codec.parse(text)["claims"], **elsewhere}
        print(codec.text(answer))
    else:
        print(*demo.lines(out), sep="\n")
    if why:
        print(
            f"deodar demo: {paragraph([why, f'The demo is written to {shown(out)} instead'])}",
            file=sys.stderr,
        )
    if not args.json and demo.model and _display():
        _offer(out / demo.model)
    return 1 if why or failed(demo.claims) else 0


def _display() -> bool:
    """Return whether a user is at a terminal, and a browser can show a page beside it."""
    window = sys.platform in ("win32", "darwin") or "DISPLAY" in os.environ or "WAYLAND_DISPLAY" in os.environ
    return window and sys.stdout.isatty() and _question.on_terminal()


def _offer(model: Path) -> None:
    """Offer to open a document in the studio."""
    if "studio" in cli.COMMANDS and _question.confirmed("Open the studio on this field?"):
        cli.main(["studio", str(model)])


def _written(args: argparse.Namespace, out: Path, fill: Callable[[Path], None]) -> tuple[Path, str]:
    """Write the folder, or another one on failure; return its path and the reason if it is another one."""
    try:
        places.write_folder(out, fill, replace=args.force)
        return out, ""
    except (OutputError, OutputExists) as error:
        return _rescue.elsewhere(error, out, fill, not args.json), error.at("shell")


def claim(out: Path, force: bool) -> None:
    """Refuse, before the run, a folder that could not be written; `force` replaces only results of a demo."""
    places.claim_folder(out, force)
    if out.is_dir() and any(out.iterdir()) and not (out / "results.json").is_file():
        raise OutputExists(
            "is not the folder of a demo, so it is not replaced", where=str(out), fix="Choose another name"
        )
