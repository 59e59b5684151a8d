"""`deodar demo NAME`."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deodar.analysis.claims import Claim
    from deodar.demos import saliency

HELP = "run a demonstration: saliency on photographs, or spa, a robot that plans and drives"
OF = {"saliency": ("image", "untuned", "video", "camera", "cue"), "spa": ("maze", "start", "goal", "noise")}
"""Options that belong to one demo."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the command."""
    from deodar.cli import _options

    about = (
        "saliency: a colour cue selects an object in a photograph; spa: a robot plans its way through a maze"
        " while it drives"
    )
    parser.add_argument("name", choices=("saliency", "spa"), metavar="NAME", help=about)
    source = parser.add_mutually_exclusive_group()
    source.add_argument(
        "--image",
        type=Path,
        metavar="FILE",
        help="a photograph of your own instead of the three that come with deodar",
    )
    source.add_argument(
        "--untuned",
        action="store_true",
        default=None,
        help="twelve photographs on which no parameter was found",
    )
    source.add_argument(
        "--video", type=Path, metavar="FILE", help="a film of your own, from its beginning (extra vision)"
    )
    source.add_argument(
        "--camera",
        type=_options.whole,
        metavar="N",
        help="what a camera sees now, 0 for the first (extra vision)",
    )
    parser.add_argument(
        "--cue",
        type=float,
        action="append",
        metavar="HUE",
        help="with --image, --video, --camera: a hue to cue, in degrees (0 red, 120 green); may be repeated",
    )
    parser.add_argument(
        "--maze",
        metavar="FILE",
        help="spa: a maze of your own, as FILE or FILE#NAME, or large; nothing comes on the way",
    )
    parser.add_argument(
        "--start",
        type=float,
        nargs="+",
        metavar="CM",
        help="spa: where the robot starts: x, y and, if wanted, its heading in rad",
    )
    parser.add_argument("--goal", type=float, nargs=2, metavar="CM", help="spa: x and y of the goal")
    parser.add_argument(
        "--noise", choices=("none", "low", "high"), help="spa: of its map and place sense (default low)"
    )
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
    """Status 1 if a required claim is false."""
    from deodar.cli._options import use_cores
    from deodar.errors import DeodarError
    from deodar.recording import places

    strange = [
        (name, demo)
        for demo, names in OF.items()
        if demo != args.name
        for name in names
        if getattr(args, name) is not None
    ]
    if strange:
        name, demo = strange[0]
        raise DeodarError(
            f"--{name} belongs to the demo {demo}", where=f"demo {args.name}", fix=f"Leave out --{name}"
        )
    out = args.out or places.free(Path.cwd(), f"demo-{args.name}")
    claim(out, args.force)
    use_cores(args.cores)
    if args.name == "spa":
        from deodar.cli import _demo_spa

        return _tell(args, out, *_demo_spa.run(args))
    return _tell(args, out, *_saliency(args))


Told = tuple["list[Claim]", dict[str, Any], str, str, "Callable[[Path], None]"]
"""What a demo found: claims, settings, the names of what it writes, a sentence, and what fills the folder."""


def _tell(
    args: argparse.Namespace,
    wanted: Path,
    claims: list[Claim],
    settings: dict[str, Any],
    written: str,
    sentence: str,
    fill: Callable[[Path], None],
) -> int:
    from deodar.analysis.claims import failed, results
    from deodar.cli._options import paragraph, shown

    out, why = _written(args, wanted, fill)
    if args.json:
        elsewhere = {"instead_of": str(wanted)} if why else {}
        print(
            json.dumps(
                {"out": str(out), "claims": json.loads(results(claims, settings))["claims"], **elsewhere},
                indent=2,
                ensure_ascii=False,
            )
        )
    else:
        for c in claims:
            mark = "?" if c.holds is None else "yes" if c.holds else "NO"
            print(
                f"  {mark:4}{c.name}"
                + (f" -> {c.value}" if c.holds is not True or isinstance(c.value, int) else "")
            )
        print(f"Written to {shown(out)}: {written} and results.json.")
        print(sentence)
    if why:
        print(
            f"deodar demo: {paragraph([why, f'The demo is written to {shown(out)} instead'])}",
            file=sys.stderr,
        )
    return 1 if why or failed(claims) else 0


def _written(args: argparse.Namespace, out: Path, fill: Callable[[Path], None]) -> tuple[Path, str]:
    """Write the folder, to a second place where this one fails; the place, and why it is not the one that was
    asked for.
    """
    from deodar.cli import _rescue
    from deodar.errors import OutputError, OutputExists
    from deodar.recording import places

    try:
        places.write_folder(out, fill, replace=args.force)
        return out, ""
    except (OutputError, OutputExists) as error:
        return _rescue.elsewhere(error, out, fill, not args.json), str(error)


def _saliency(args: argparse.Namespace) -> Told:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    from deodar.analysis.claims import results
    from deodar.demos import saliency
    from deodar.demos.saliency_figure import figure, overview
    from deodar.figures._files import save_figure
    from deodar.recording import files

    scenes = _scenes(args)
    console = Console(file=sys.stderr)
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:>3.0f} %"))
    done: list[saliency.Result] = []
    with Progress(*columns, console=console, transient=True, disable=args.no_progress) as bar:
        task = bar.add_task("compiling", total=3 * len(scenes))
        drawn = []
        for scene in scenes:
            bar.update(task, description=f"looking at {scene.title}")
            done.append(saliency.look(scene, args.seed, lambda: bar.advance(task)))
            drawn.append(figure(done[-1]))
            bar.advance(task)

    def fill(folder: Path) -> None:
        for result, picture in zip(done, drawn, strict=True):
            save_figure(picture, folder / f"{result.scene.name}.png")
            files.save_record(result.record, folder / f"{result.scene.name}.zarr")
        if len(done) > 1:
            save_figure(overview(done), folder / "overview.png")
        (folder / "results.json").write_text(results(claims, settings))

    claims = [*(c for result in done for c in saliency.claims(result)), *saliency.totals(done)]
    settings = {
        "demo": args.name,
        "seed": args.seed,
        "duration": saliency.DURATION,
        "cue_at": saliency.CUE_AT,
    }
    names = ", ".join([*(f"{r.scene.name}.png" for r in done), *(["overview.png"] if len(done) > 1 else [])])
    return claims, settings, f"{names}, the records (*.zarr)", saliency.sentence(done), fill


def _scenes(args: argparse.Namespace) -> list[saliency.Scene]:
    from deodar.demos import saliency
    from deodar.worlds.camera import Camera

    cues = args.cue or ()
    if args.image:
        return [saliency.own(args.image, cues)]
    if args.video:
        return [saliency.filmed(args.video, cues)]
    return (
        saliency.photographs(bool(args.untuned))
        if args.camera is None
        else [saliency.watched(Camera(args.camera, period=saliency.PERIOD), cues)]
    )


def claim(out: Path, force: bool) -> None:
    """Refuse, before the run, a folder that could not be written after it; `force` replaces only what a demo
    wrote.
    """
    from deodar.errors import OutputExists
    from deodar.recording import places

    places.claim_folder(out, force)
    if out.is_dir() and any(out.iterdir()) and not (out / "results.json").is_file():
        raise OutputExists(
            "is not the folder of a demo, so it is not replaced", where=str(out), fix="Choose another name"
        )
