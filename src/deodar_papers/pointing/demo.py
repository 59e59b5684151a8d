"""Demonstration: an arm points at the objects that colours and sides name, with a figure and a video."""

from __future__ import annotations

import argparse
from pathlib import Path

from deodar.errors import ParameterError, option
from deodar_papers.papers import Demonstration, Show

HELP = "an arm points at the green object on the left, then at the red one on the right (extra robots)"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of the demonstration."""
    group = parser.add_argument_group("pointing", HELP)
    group.add_argument(
        "--ask",
        action="append",
        metavar="CUES",
        help="pointing: a colour (red, green) and a side (left, right), such as 'red left'; may be repeated",
    )
    group.add_argument(
        "--robot", metavar="NAME", help="pointing: lwr4 (default), six, four, or an MJCF file of your own"
    )


def run(args: argparse.Namespace, show: Show) -> Demonstration:
    """Give the cues and point."""
    # start-up time: these bring JAX
    from deodar.figures import _encode
    from deodar.figures._files import save_figure
    from deodar_papers.pointing import figures, narrative

    asked = narrative.ASKED if not args.ask else tuple(_pair(words) for words in args.ask)
    result = narrative.run(asked, args.seed, args.robot, show)
    picture = figures.figure(result)

    def fill(folder: Path) -> None:
        save_figure(picture, folder / "pointing.png")
        _encode.write(result.frames, folder / "pointing.gif", "gif", 100 / narrative.EVERY)

    return Demonstration(
        claims=narrative.claims(result),
        settings={"asked": [" ".join(pair) for pair in asked], "robot": args.robot},
        written="pointing.png, pointing.gif",
        sentence=narrative.sentence(result),
        fill=fill,
    )


def _pair(words: str) -> tuple[str, str]:
    # start-up time: this brings JAX
    from deodar.architectures.pointing import COLOURS, SIDES

    parts = words.split()
    if len(parts) != 2 or parts[0] not in COLOURS or parts[1] not in SIDES:
        raise ParameterError(
            f"--ask is {words!r}; expected a colour and a side",
            fix=option(
                f"One of {', '.join(COLOURS)}, then one of {', '.join(SIDES)}:", "ask", "'green left'"
            ),
        )
    return parts[0], parts[1]
