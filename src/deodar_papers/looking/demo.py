"""Demonstration: an event camera learns where to turn, with a figure and the model with its learned map."""

from __future__ import annotations

import argparse
from pathlib import Path

from deodar.errors import ParameterError
from deodar_papers.papers import Demonstration, Show

HELP = "an event camera on a pan-tilt unit learns where to turn"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of the demonstration."""
    group = parser.add_argument_group("looking", HELP)
    group.add_argument(
        "--mechanism",
        metavar="NAME",
        help="looking: how the map is learned, correcting (default) or paper",
    )
    group.add_argument("--gazes", type=int, metavar="N", help="looking: number of gazes (default 1000)")


def run(args: argparse.Namespace, show: Show) -> Demonstration:
    """Learn, and test the map."""
    # start-up time: these bring JAX
    from deodar.architectures.looking import MECHANISMS
    from deodar.figures._files import save_figure
    from deodar.model.document_files import save
    from deodar_papers.looking import figures, narrative

    mechanism = args.mechanism or next(iter(MECHANISMS))
    if mechanism not in MECHANISMS:
        raise ParameterError(f"--mechanism is {mechanism!r}", fix=f"One of {', '.join(MECHANISMS)}")
    gazes = narrative.GAZES if args.gazes is None else args.gazes
    if gazes < 1:
        raise ParameterError(f"--gazes is {gazes}; expected a number of 1 or more")
    result = narrative.run(mechanism, gazes, args.seed, show)
    picture = figures.of_demo(result)

    def fill(folder: Path) -> None:
        save_figure(picture, folder / "looking.png")
        save(result.model().document, folder / "looking.deodar")

    return Demonstration(
        claims=narrative.claims(result),
        settings={"mechanism": mechanism, "gazes": gazes},
        written="looking.png, looking.deodar (run it with --world eye)",
        sentence=narrative.sentence(result),
        fill=fill,
    )
