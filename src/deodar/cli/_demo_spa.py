"""The demo `spa` on the command line: a run with a bar, and what is written of it."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deodar.analysis.claims import Claim


def run(args: argparse.Namespace) -> tuple[list[Claim], dict[str, Any], str, str, Callable[[Path], None]]:
    """Run it; claims, settings, names of files, a sentence, and what fills the folder."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    from deodar.analysis.claims import results
    from deodar.architectures.spa import DIRECTIONS, maze
    from deodar.demos import spa
    from deodar.demos.spa_figure import figure
    from deodar.demos.spa_film import film
    from deodar.figures._files import save_figure
    from deodar.recording import files

    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:>3.0f} %"))
    with Progress(
        *columns, console=Console(file=sys.stderr), transient=True, disable=args.no_progress
    ) as bar:
        own = any(value is not None for value in (args.maze, args.start, args.goal, args.noise))
        duration, noise = spa.LONGEST if own else spa.DURATION, args.noise or "low"
        task = bar.add_task("planning and driving", total=duration)

        def shown(done: int) -> None:
            bar.update(task, completed=done)

        if own:
            start = None if args.start is None else [*args.start, 0.0][:3]
            result = spa.drive(
                maze(args.maze or "z", noise, start, args.goal), noise, args.seed, duration, shown
            )
        else:
            result = spa.go(args.seed, duration, shown)
    claims = spa.claims(result)
    told = {"obstacle_at": spa.COMES} if result.told else {"maze": result.arena.describe()}
    settings = {"demo": args.name, "seed": args.seed, "duration": duration, "noise": noise, **told}

    def fill(folder: Path) -> None:
        save_figure(figure(result), folder / "spa.png")
        film(result, folder / "spa.gif")
        # the motivation fields are as large as a film: what they showed stands in the pictures
        files.save_record(
            result.record[["pose.output", *(f"{name}.strongest.output" for name in DIRECTIONS)]],
            folder / "spa.zarr",
        )
        (folder / "results.json").write_text(results(claims, settings))

    return claims, settings, "spa.png, spa.gif, the record (spa.zarr)", spa.sentence(result), fill
