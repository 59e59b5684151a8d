"""Demonstration: a sequence of colours is taught, and produced in an arena, with a figure and a video."""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable
from pathlib import Path

from deodar_papers.papers import Demonstration, Show

HELP = "a robot is taught a sequence of colours and looks for them in an arena, in this order"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of the demonstration."""
    group = parser.add_argument_group("serial-order", HELP)
    which = group.add_mutually_exclusive_group()
    which.add_argument(
        "--figures",
        action="store_true",
        default=None,
        help="serial-order: draw figures 3, 8 and 12 of the paper instead, each from runs of its own",
    )
    which.add_argument(
        "--experiments",
        action="store_true",
        default=None,
        help="serial-order: write experiment files of ten colours, two cued sequences, a cue that changes,"
        " and a robot that is carried elsewhere instead",
    )
    which.add_argument(
        "--sequence",
        metavar="COLOURS",
        help="serial-order: 1 to 10 letters of R, Y, G, B, V: red, yellow, green, blue, violet"
        " (default RBGBY)",
    )


def run(args: argparse.Namespace, show: Show) -> Demonstration:
    """Teach a sequence and produce it."""
    # start-up time: these bring JAX
    from deodar.figures._files import save_figure
    from deodar.recording import files
    from deodar_papers.figures.sequence import animation_samples, save_sequence_animation, sequence_figure
    from deodar_papers.serial_order import narrative
    from deodar_papers.serial_order.views import camera_views

    def show_share(share: float, producing: bool) -> None:
        show("looking for the colours" if producing else "being taught", share)

    if args.figures:
        return _figures(args.seed, show_share)
    if args.experiments:
        return _experiments()
    sequence = narrative.SEQUENCE if args.sequence is None else args.sequence
    search = narrative.run(sequence, args.seed, show_share)

    def fill(folder: Path) -> None:
        save_figure(sequence_figure(search), folder / "serial-order.png")
        samples = list(animation_samples(search))
        times, poses = search.record["time"].values[samples], search.record[narrative.POSE].values[samples]
        views = camera_views(search.taught, search.begins, times, poses, args.seed)
        save_sequence_animation(search, views, search.taught.arena.side, folder / "serial-order.gif")
        files.save_record(search.small, folder / "serial-order.zarr")

    return Demonstration(
        claims=narrative.claims(search),
        settings={"sequence": search.sequence},
        written="serial-order.png, serial-order.gif, the record (serial-order.zarr)",
        sentence=narrative.sentence(search),
        fill=fill,
    )


def _figures(seed: int, show_share: Callable[[float, bool], None]) -> Demonstration:
    """Make the runs of the paper's other figures."""
    # start-up time: these bring JAX
    from deodar.figures._files import save_figure
    from deodar_papers.serial_order import figures

    paper_figures = figures.run(seed, show_share)
    drawn = paper_figures.draw()

    def fill(folder: Path) -> None:
        for name, figure in drawn.items():
            save_figure(figure, folder / f"{name}.png")

    return Demonstration(
        claims=figures.claims(paper_figures),
        settings={"figures": True},
        written=", ".join(f"{name}.png" for name in drawn),
        sentence=f"Drew {len(drawn)} figures of the paper from runs of deodar.",
        fill=fill,
    )


def _experiments() -> Demonstration:
    """Write the experiment files of the cases that the paper does not have."""
    # start-up time: these bring JAX
    from deodar.analysis.claims import Claim
    from deodar.experiments.experiment import Experiment
    from deodar_papers.serial_order import experiments

    with tempfile.TemporaryDirectory() as folder:
        problems = {path.name: Experiment.load(path).check() for path in experiments.write(Path(folder))}

    def fill(folder: Path) -> None:
        experiments.write(folder)

    return Demonstration(
        claims=[
            Claim(f"{name} can be run: problems", len(listed), 0, not listed, origin="ours")
            for name, listed in problems.items()
        ],
        settings={"experiments": True},
        written=f"{', '.join(problems)}, each with its model and its arena",
        sentence=f"Wrote {len(problems)} experiments. Run one: deodar experiment {next(iter(problems))}",
        fill=fill,
    )
