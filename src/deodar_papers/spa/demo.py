"""Demonstration: the run of figures 10 to 12, or a maze of the user, with a figure and a video."""

from __future__ import annotations

import argparse
from pathlib import Path

from deodar_papers.papers import Demonstration, Show

HELP = "a robot plans its way through a maze while it drives"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of the demonstration."""
    group = parser.add_argument_group("spa", HELP)
    group.add_argument(
        "--maze",
        metavar="FILE",
        help="spa: a maze of your own, as FILE or FILE#NAME, or large; no obstacle appears",
    )
    group.add_argument(
        "--start",
        type=float,
        nargs="+",
        metavar="CM",
        help="spa: x, y and optionally the heading (rad) at which the robot starts",
    )
    group.add_argument("--goal", type=float, nargs=2, metavar="CM", help="spa: x and y of the goal")
    group.add_argument(
        "--noise",
        choices=("none", "low", "high"),
        help="spa: noise of its map and of its sensed position (default low)",
    )


def run(args: argparse.Namespace, show: Show) -> Demonstration:
    """Run the narrative of the paper, or drive through the maze that is given."""
    # start-up time: these bring JAX
    from deodar.architectures.spa import DIRECTIONS, maze
    from deodar.figures._files import save_figure
    from deodar.recording import files
    from deodar_papers.figures.plan import save_animation
    from deodar_papers.spa import narrative

    own = any(value is not None for value in (args.maze, args.start, args.goal, args.noise))
    duration, noise = narrative.LONGEST if own else narrative.DURATION, args.noise or "low"

    def shown(done: int) -> None:
        show("planning and driving", done / duration)

    if own:
        start = None if args.start is None else [*args.start, 0.0][:3]
        arena = maze(args.maze or "z", noise, start, args.goal)
        result = narrative.drive(arena, noise, args.seed, duration, shown)
        about = {"maze": result.arena.describe()}
    else:
        result = narrative.run(args.seed, duration, shown)
        about = {"obstacle_at": narrative.COMES}

    def fill(folder: Path) -> None:
        save_figure(result.figure(), folder / "spa.png")
        save_animation(result, folder / "spa.gif")
        # the motivation fields are as large as a video, and the pictures show them
        names = ["pose.output", *(f"{name}.strongest.output" for name in DIRECTIONS)]
        files.save_record(result.record[names], folder / "spa.zarr")

    return Demonstration(
        claims=narrative.claims(result),
        settings={"duration": duration, "noise": noise, **about},
        written="spa.png, spa.gif, the record (spa.zarr)",
        sentence=narrative.sentence(result),
        fill=fill,
    )
