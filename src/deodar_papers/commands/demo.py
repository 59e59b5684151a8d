"""The command `deodar demo NAME`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from deodar import codec
from deodar.cli import _options, _rescue
from deodar.cli._options import paragraph, shown, use_cores
from deodar.codec import Json
from deodar.errors import DeodarError, OutputError, OutputExists
from deodar.model import output
from deodar.recording import places
from deodar_papers import papers

if TYPE_CHECKING:
    from deodar_papers.papers import Demonstration

HELP = (
    "run the quick form of a paper: saliency on photographs; serial-order, a robot that learns a sequence; or"
    " spa, a robot that plans and drives"
)


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command; each demonstration adds its own."""
    demos = papers.demos()
    about = "; ".join(f"{name}: {demo.HELP}" for name, demo in demos.items())
    parser.add_argument("name", choices=tuple(demos), metavar="NAME", help=about)
    parser.set_defaults(owners=_options.add_each(parser, demos))
    parser.add_argument(
        "--seed", type=_options.whole, default=0, metavar="N", help="seed of all noise (default 0)"
    )
    parser.add_argument(
        "--out",
        "-o",
        type=Path,
        metavar="DIR",
        help="folder for what is written (default: a new one in the working folder)",
    )
    parser.add_argument(
        "--force", action="store_true", help="replace the folder --out that an earlier demo wrote"
    )
    parser.add_argument("--json", action="store_true", help="print the claims as JSON")
    _options.add_cores(parser)
    parser.add_argument("--no-progress", action="store_true", help="show no progress bar")


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
    out = args.out or places.free(Path.cwd(), f"demo-{args.name}")
    claim(out, args.force)
    use_cores(args.cores)
    return _tell(args, out, _run(args))


def _run(args: argparse.Namespace) -> Demonstration:
    """Run the demonstration with a progress bar on stderr."""
    # start-up time
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:>3.0f} %"))
    console = Console(file=sys.stderr)
    with Progress(*columns, console=console, transient=True, disable=args.no_progress) as bar:
        task = bar.add_task("compiling", total=1.0)
        return papers.demos()[args.name].run(
            args, lambda what, share: bar.update(task, description=what, completed=share)
        )


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
        for c in demo.claims:
            mark = "?" if c.holds is None else "yes" if c.holds else "NO"
            print(
                f"  {mark:4}{c.name}"
                + (f" -> {c.value}" if c.holds is not True or isinstance(c.value, int) else "")
            )
        print(f"Written to {shown(out)}: {demo.written} and results.json.")
        print(demo.sentence)
    if why:
        print(
            f"deodar demo: {paragraph([why, f'The demo is written to {shown(out)} instead'])}",
            file=sys.stderr,
        )
    return 1 if why or failed(demo.claims) else 0


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
